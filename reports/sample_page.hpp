// For tests: a page with everything on it. A run of a hundred cases, a dozen of which failed and have a time
// line; a document of each kind; and names that try to leave their element.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/history.hpp"
#include "reports/html_writer.hpp"
#include "reports/measurement_writer.hpp"
#include "reports/publication.hpp"
#include "reports/sample_campaign.hpp"
#include "reports/sample_detection.hpp"
#include "reports/sample_fuzz.hpp"
#include "reports/sample_measurement.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {

inline constexpr const char* kHostileName = "</script><img src=x onerror=alert(1)><!--<script>alert(2)//";

// Forty frames that two stations send in turn; every seventh is changed by a fault.
inline std::string sample_timeline(const std::string& case_id) {
  using Ordered = nlohmann::ordered_json;
  constexpr std::int64_t kFrame = 26'000'000;
  constexpr std::int64_t kBegin = 1'000'000'000'000'000;  // beyond what a double counts in picoseconds
  Ordered json = {{"schema", "fieldproof/timeline/1"},
                  {"case", case_id},
                  {"is_cut", true},
                  {"channels", {{{"name", "master to slave"}}, {{"name", kHostileName}}}},
                  {"transmissions", Ordered::array()},
                  {"faults", Ordered::array()},
                  {"observations", Ordered::array()},
                  {"findings", Ordered::array()},
                  {"windows", Ordered::array()}};
  for (std::int64_t n = 0; n < 40; ++n) {
    const std::int64_t start = kBegin + n * 2 * kFrame;
    json["transmissions"].push_back({{"channel", n % 2},
                                     {"start_ps", std::to_string(start)},
                                     {"end_ps", std::to_string(start + kFrame)},
                                     {"text", fmt::format("data telegram {:02X}h", n)},
                                     {"levels", 13},
                                     {"is_changed", n % 7 == 3}});
    if (n % 7 != 3) continue;
    json["faults"].push_back(
        {{"channel", n % 2}, {"time_ps", std::to_string(start + kFrame / 2)}, {"text", "flips level 6"}});
    json["observations"].push_back({{"channel", 0},
                                    {"time_ps", std::to_string(start + 2 * kFrame)},
                                    {"what", "output word 0"},
                                    {"value", "0xa5ff"}});
  }
  json["findings"].push_back({{"time_ps", std::to_string(kBegin + 20 * kFrame)},
                              {"reason", "outputs_changed"},
                              {"requirement", "outputs are kept"},
                              {"expected", "no change"},
                              {"actual", kHostileName}});
  json["windows"].push_back({{"kind", "burst"},
                             {"from_ps", std::to_string(kBegin + 5 * kFrame)},
                             {"to_ps", std::to_string(kBegin + 30 * kFrame)}});
  json["steps"] = {{{"time_ps", std::to_string(kBegin)}, {"text", "1 of 2: the master sends frames"}},
                   {{"time_ps", std::to_string(kBegin + 15 * kFrame)}, {"text", kHostileName}}};
  return json.dump(1);
}

inline PageRun sample_page_run() {
  PageRun page;
  page.name = "20260102T030405Z-7";
  page.stored.manifest = sample_manifest();
  page.stored.run = sample_run();
  Run& run = page.stored.run;
  run.identity.implementations[0].uri = kHostileName;
  run.cases.push_back(sample_case(kHostileName, judge::Verdict::pass));
  for (int n = 0; run.cases.size() < 100; ++n) {
    judge::CaseResult result = n < 12 ? sample_failure() : sample_case("", judge::Verdict::pass);
    result.id = fmt::format("interbus/slave/sample/case_{}", n);
    if (n < 12) {
      page.timelines[result.id] = sample_timeline(result.id);
      page.files[result.id] = {"case.json", "timeline.json", "trace.txt"};
      result.findings[0].actual = kHostileName;
      result.findings[0].step = "2 of 3: expected: outputs stay";
    }
    run.cases.push_back(std::move(result));
  }
  run.identity.selected = run.cases.size() + 1;
  return page;
}

inline nlohmann::ordered_json sample_emc() {
  using Ordered = nlohmann::ordered_json;
  Ordered json = {
      {"schema", "fieldproof/emc/1"},
      {"protocol", "interbus"},
      {"command", "fieldproof emc interbus --seed 7"},
      {"network", "one coupler"},
      {"implementations", kHostileName},
      {"profile", "A"},
      {"threshold_volts", 47.5},
      {"unverified", {"The coupling is not calibrated.", "clamp_pf has no verified source."}},
      {"criteria", Ordered::array()},
      {"seed", "7"},
      {"is_complete", true},
      {"duration_s", 3.0},
      {"tests", Ordered::array()},
      {"places",
       {{{"receiver", "slave@1/in"}, {"exposed", true}},
        {{"receiver", "slave@2/in"}, {"exposed", false}, {"why_not", "a local bus"}}}},
      {"acceptance",
       {{{"name", "recovery_cycles"}, {"value", "2 cycles"}, {"source", "as agreed"}, {"standing", "own"}}}},
      {"recovery_limit", {{"exchanges", 5}, {"exchange", "cycle"}, {"source", "published"}}},
      {"inputs",
       {{{"path", kHostileName}, {"hash", "77148d8a4f1248d3"}}, {{"path", "gone.so"}, {"hash", ""}}}},
      {"pulse",
       {{"open_circuit_volts", 1000.0},
        {"polarity", "-"},
        {"receiver", kHostileName},
        {"level_ns", 2000.0},
        {"sampled_sixteenths", {7, 8, 9}},
        {"bit_v", 2.0},
        {"threshold_v", 0.0},
        {"hysteresis_mv", 50.0},
        {"step_ns", 100.0},
        {"generator_v", {0.0, -900.0, -300.0, -50.0, 0.0, 0.0}},
        {"receiver_v", {0.0, -8.0, -5.0, -2.5, -1.0, 0.0}},
        {"wrong_ns", {Ordered::array(), {{20.0, 320.0}}}}}},
      {"residual",
       {{"frame_check", "CRC-16/IBM-3740"},
        {"bits", 160},
        {"worst_ber", 0.02},
        {"worst_share_of_corrupted", 1e-5},
        {"expected_wrong_at_most", 0.001},
        {"probability_at_ber_0.01", 1e-6},
        {"rate_per_hour_at_ber_0.01", 1e-3}}},
      {"total",
       {{"corrupted", 160},
        {"detected", 80},
        {"accepted_wrong", 4},
        {"balance",
         {{"exposed", 57'600},
          {"untouched", 57'436},
          {"hit_without_effect", 80},
          {"rejected", 80},
          {"accepted_wrong", 4},
          {"data_differed", 84}}},
        {"upper_bound_of_share", 0.107}}}};
  json["thresholds"] = {
      {"is_complete", true},
      {"text", "A up to 46 V, B from 48 V, C seen from 1472 V, D not seen up to 4000 V"},
      {"a_up_to_volts", 46},
      {"b_from_volts", 48},
      {"c_seen_from_volts", 1472},
      {"d_seen_from_volts", nullptr},
      {"searched_to_volts", 4000},
      {"tests", 4},
      {"test_s", 1.0},
      {"references",
       {{"is_complete", true},
        {"text", "A up to 52 V, B from 54 V, C not seen up to 4000 V, D not seen up to 4000 V"},
        {"a_up_to_volts", 52},
        {"b_from_volts", 54},
        {"c_seen_from_volts", nullptr},
        {"d_seen_from_volts", nullptr},
        {"searched_to_volts", 4000}}},
      {"probes", {{{"volts", 48}, {"criterion", "B"}}}}};
  json["hint"] = "all levels lie on one side, above where A ends; A was found up to 46 V";
  json["sensitivity"] = {{"is_complete", true},
                         {"level", "4 (2000 V)"},
                         {"criterion", "B"},
                         {"tests", 12},
                         {"test_s", 1.0},
                         {"parameters",
                          {{{"name", "ring_q"},
                            {"unit", ""},
                            {"value", 4.0},
                            {"from", 2.0},
                            {"to", 5.66},
                            {"holds", false},
                            {"above", {{"value", 8.0}, {"criterion", "C"}}}}}}};
  const std::string criteria = "ABCD";
  for (const char criterion : criteria) {
    json["criteria"].push_back({{"criterion", std::string(1, criterion)}, {"meaning", "as agreed"}});
  }
  for (int n = 0; n < 16; ++n) {
    json["tests"].push_back(
        {{"level", fmt::format("{} ({} V)", n / 4 + 1, 250 << (n / 4))},
         {"open_circuit_volts", 250 << (n / 4)},
         {"repetition", n % 4 < 2 ? "5 kHz" : "100 kHz"},
         {"polarity", n % 2 == 0 ? "+" : "-"},
         {"came_up", n != 7},
         {"criterion", std::string(1, criteria.at(static_cast<std::size_t>(n) / 4))},
         {"decided_by", n < 8 ? "" : "recovery_cycles: 2 cycles"},
         {"longest_bad_run", n},
         {"recovered_by_itself", n < 10},
         {"recovered_after_start", n < 14},
         {"recovery_cycles", 1},
         {"recovery_s", 0.00312},
         {"bus_stops", n / 8},
         {"quality_bit", false},
         {"cycle_time_us", 814.0},
         {"reference",
          {{"came_up", true},
           {"criterion", n < 12 ? "B" : "C"},
           {"exposed", 3600},
           {"rejected", 2},
           {"accepted_wrong", 0},
           {"longest_bad_run", 1},
           {"recovered_by_itself", true},
           {"recovered_after_start", false},
           {"recovery_cycles", 1},
           {"bus_stops", 0}}},
         {"complaint", ""},
         {"cycles",
          {{{"cycle", "cycle"},
            {"theory_us", 814.0},
            {"theory_is_bound", false},
            {"form", "structure of the frame"},
            {"quiet", {{"count", 0}}},
            {"burst", {{"count", 0}}},
            {"recovery", {{"count", 0}}}}}},
         {"bursts", 10},
         {"evidence", {{"text", "5 exchanges rejected in 10 bursts"}, {"c_at_most", 0.26}}},
         {"ledger",
          {{"sent", 3600},
           {"corrupted", 10},
           {"detected", 5},
           {"missing", 0},
           {"retried", 0},
           {"repeated", 5},
           {"accepted_wrong_inputs", n / 12},
           {"accepted_wrong_outputs", 0},
           {"wrong_cycles", n / 12},
           {"missed_outputs", 0},
           {"cleared_outputs", 1},
           {"partly_latched", 0},
           {"balance",
            {{"exposed", 3600},
             {"untouched", 3590 - n / 12},
             {"hit_without_effect", 5},
             {"rejected", 5},
             {"accepted_wrong", n / 12},
             {"data_differed", 5 + n / 12}}}}},
         {"line",
          {{"transmissions", 1'700'000},
           {"hit", 38'000},
           {"changed", 37'000},
           {"pulses", 59'000},
           {"wrong_levels", 63'000}}}});
  }
  Ordered channel = {{"channel", "bsc"},
                     {"flip_probability", 0.002},
                     {"receivers", 2},
                     {"undetected_by_code_word", 1e-12},
                     {"undetected_by_shift", 1e-9},
                     {"undetected_by_misframing", 1e-10},
                     {"expected_wrong_cycles_at_most", 7.2e-6},
                     {"chance_of_count", 1.0}};
  for (const auto& [key, value] : json["tests"].front().items()) {
    const bool is_of_bursts = key == "level" || key == "open_circuit_volts" || key == "repetition" ||
                              key == "polarity" || key == "reference";
    if (!is_of_bursts) channel[key] = value;
  }
  json["channels"] = Ordered::array({std::move(channel)});
  return json;
}

inline nlohmann::ordered_json sample_residual() {
  using Ordered = nlohmann::ordered_json;
  const Ordered worst = {{"ber", 0.05}, {"probability", 1.8e-5}, {"rises_throughout", false}};
  Ordered json = {{"schema", "fieldproof/residual/1"},
                  {"frame_check", "CRC-16/IBM-3740"},
                  {"width", 16},
                  {"polynomial", "0x1021"},
                  {"bits", 120},
                  {"hamming_distance", 4},
                  {"weights_up_to", 6},
                  {"weights", {{{"weight", 0}, {"count", "1"}}, {{"weight", 4}, {"count", "470"}}}},
                  {"worst", worst},
                  {"worst_up_to_usual", worst},
                  {"usual_ber", 0.01},
                  {"safety_source", "IEC 61784-3"},
                  {"safety_standing", "memory"},
                  {"messages_per_hour", 3600},
                  {"receivers", 1},
                  {"seed", "7"},
                  {"points", Ordered::array()}};
  double probability = 4.7e-22;
  for (const double ber : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    json["points"].push_back({{"ber", ber},
                              {"probability", probability},
                              {"share_of_corrupted", probability / ber},
                              {"proper_bound", probability / 2},
                              {"rate_per_hour", probability * 3600},
                              {"proper_bound_exceeded", true}});
    probability *= 1e4;
  }
  return json;
}

inline nlohmann::ordered_json sample_matrix() {
  using Ordered = nlohmann::ordered_json;
  const Ordered passed = {{"kind", "passed"}, {"verdict", "pass"}};
  const Ordered caught = {{"kind", "caught"}, {"verdict", "fail"}, {"reason", "late"}, {"declared", "late"}};
  const Ordered missed = {{"kind", "missed"}, {"verdict", "pass"}, {"declared", "late"}};
  Ordered role = {{"role", "slave"},
                  {"mutants",
                   {{{"name", "answers_late"}, {"label", "MS1"}, {"description", kHostileName}},
                    {{"name", "never_answers"}, {"label", ""}, {"description", "says nothing"}}}},
                  {"cases", Ordered::array()}};
  role["cases"].push_back({{"id", "interbus/slave/sample/case_0"},
                           {"purpose", "IS-1"},
                           {"reference", passed},
                           {"cells", {caught, missed}}});
  return {{"schema", "fieldproof/matrix/1"},
          {"protocol", "interbus"},
          {"seed", "7"},
          {"complete", true},
          {"roles", {role}},
          {"holes",
           {{{"kind", "missed"},
             {"case", "interbus/slave/sample/case_0"},
             {"mutant", "never_answers"},
             {"sentence", "nothing catches it"}}}}};
}

inline Publication sample_publication() {
  PublishedSection section;
  section.heading = "Cycle time";
  section.note = "as printed";
  section.rows = {
      {"calculated", "0.755 ms", "0.7550 ms", "by the formula", within(0.755, 0.0005, 0.755, "ms")},
      {"delay", "", "1.1 to 1.9 ms", "pictures only", std::nullopt}};
  section.traces = {{"50 Hz", sample_measurement().series[0].trace}};
  section.figures = {{"Step <response>",
                      "time, s",
                      "per cent",
                      {{"with bus", {{0, 0}, {1, 60.5}, {2, 50}}}, {"without bus", {{0, 0}, {1.5, 50}}}}}};
  return {"A paper", 7, {section}};
}

inline PageContent sample_page() {
  PageContent content;
  content.catalogue.suite_version = sample_run().identity.suite_version;
  for (const judge::CaseResult& result : sample_page_run().stored.run.cases) {
    content.catalogue.stories[result.id] = {
        "one bit of a cycle flips",
        "outputs stay",
        {"1 of 3: the master sends a cycle", "2 of 3: expected: outputs stay",
         "3 of 3: the master sends another"},
        {"answers_late, late"}};
  }
  content.runs = {sample_page_run()};
  content.documents = {{"measurement.json", measurement_json(sample_burst_measurement())},
                       {"emc.json", sample_emc().dump()},
                       {"residual.json", sample_residual().dump()},
                       {"publication.json", publication_json(sample_publication())},
                       {"matrix.json", sample_matrix().dump()},
                       {"detection.json", sample_detection(kHostileName).dump()},
                       {"nightly/campaign.json", sample_campaign(kHostileName).dump()},
                       {"fit.json", sample_fit(kHostileName).dump()},
                       {"fuzz.json", sample_fuzz(kHostileName).dump()}};
  content.cover = {"A test report", kHostileName, "a customer", kHostileName};
  return content;
}

}  // namespace fieldproof::reports
