// For tests: a small run with every verdict in it, one case caught with all that a finding can say, and text
// of an implementation that tries to leave its format.
#pragma once

#include "reports/results.hpp"

namespace fieldproof::reports {

inline judge::CaseResult sample_case(const std::string& id, judge::Verdict verdict,
                                     const std::string& reason = "") {
  judge::CaseResult result;
  result.id = id;
  result.verdict = verdict;
  result.reason = reason;
  result.purpose = "IS-1";
  result.requirement = "A slave keeps its outputs when the check of a cycle fails.";
  result.reference = {"a data sheet", "frame check", judge::Standing::searched};
  result.seed = 11;
  result.fingerprint = 0x0123456789abcdef;
  result.virtual_time = 814'800 * kernel::kNanosecond;
  result.wall_time_us = 1'250;
  return result;
}

inline judge::CaseResult sample_failure() {
  judge::CaseResult result = sample_case("interbus/slave/data_cycle/outputs_are_kept", judge::Verdict::fail,
                                         "output_changed_by_rejected_cycle");
  result.purpose = "IS-14";
  result.reference = {"project", "", judge::Standing::own};
  result.measurements = {{"cycle_time", "us", 755.5, 754.0, 756.0}};
  result.log = "slave: \x1b[2J<b>ready</b> ]]>\xff";
  judge::Finding finding;
  finding.reason = result.reason;
  finding.requirement = result.requirement;
  finding.reference = result.reference;
  finding.expected = {"outputs stay 0x00FF", "outputs go to the declared safe state 0x0000"};
  finding.actual = "outputs became \x1b[31m0xA5FF\x1b[0m";
  finding.time = kernel::kStart + 814'800 * kernel::kNanosecond;
  finding.step = "3 of 4: expected: the outputs stay";
  finding.first_difference = "output octet 0, bit 5";
  finding.decisive = {"command 2, data: without it it passes", "words \x1b[2J<b>2</b>: with 1 it passes"};
  finding.decode = {"levels    0 11111111 1", "telegram  data 0xA5",
                    "cycle     loopback word, 2 octets,\ncheck wrong"};
  result.findings = {finding};
  result.settings = {"bit_rate 2 Mbit/s in place of 500 kbit/s"};
  return result;
}

inline Run sample_run() {
  using judge::Verdict;
  Run run;
  run.identity.tool_version = "0.1.0";
  run.identity.suite_version = "interbus 1";
  run.identity.seed = 7;
  run.identity.volume = "full";
  run.identity.plan_hash = "0011223344556677";
  run.identity.plan = {{"/rules/0", "a loose plug"}, {"/disturbances/0", "</script><b>welder"}};
  run.identity.pics_hash = "00112233445566ff";
  run.identity.selectors = {"interbus/**"};
  run.identity.implementations = {{"slave", 3, "mutant:accepts_bad_check"}};
  run.identity.inputs = {{"ring.json", "8899aabbccddeeff"}, {"gone.so", ""}};
  run.identity.reproduce_options = "--seed 7 --iut slave@3=mutant:accepts_bad_check";
  run.identity.selected = 8;
  run.identity.incomplete_because = "interrupted by SIGINT";
  run.identity.exit_code = 130;
  run.cases = {sample_case("interbus/slave/data_cycle/loopback_returns", Verdict::pass),
               sample_failure(),
               sample_case("interbus/slave/id_cycle/code_is_told", Verdict::warn, "late"),
               sample_case("interbus/slave/id_cycle/length_is_told", Verdict::inconclusive, "closer_than_u"),
               sample_case("interbus/master/stop/bus_is_left", Verdict::error, "internal_error"),
               sample_case("interbus/master/stop/branch_is_left", Verdict::not_applicable,
                           "the implementation declares no branch"),
               sample_case("interbus/master/stop/none", Verdict::none)};
  run.cases[0].planned_hits = {12, 0};
  run.cases[1].planned_hits = {0, 0};
  return run;
}

inline Manifest sample_manifest() {
  Manifest manifest;
  manifest.build_type = "Release";
  manifest.compiler = "a compiler 1";
  manifest.host = "bench";
  manifest.arguments = {"fieldproof", "run", "interbus/**", "--jobs", "2"};
  manifest.started = "2026-01-02T03:04:05Z";
  manifest.finished = "2026-01-02T03:04:06Z";
  manifest.wall_time_us = 900'000;
  manifest.jobs = 2;
  return manifest;
}

}  // namespace fieldproof::reports
