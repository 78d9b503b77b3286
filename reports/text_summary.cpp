#include "reports/text_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/judge/result_json.hpp"
#include "harness/kernel/time.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using judge::Finding;
using judge::Verdict;

std::string_view colour_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "\x1b[32m";
    case Verdict::warn:
    case Verdict::inconclusive:
      return "\x1b[33m";
    case Verdict::fail:
    case Verdict::error:
      return "\x1b[31m";
    case Verdict::none:
    case Verdict::not_applicable:
      break;
  }
  return "\x1b[2m";
}

std::string painted(Verdict verdict, std::string_view text, const TextOptions& options) {
  if (!options.colour) return std::string(text);
  return fmt::format("{}{}\x1b[0m", colour_of(verdict), text);
}

// "  name            text", with the lines of the text below each other.
std::string field(std::string_view name, std::string_view text) {
  std::string lines = escaped_block(text);
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos;) {
    lines.insert(at + 1, std::string(20, ' '));
    at += 21;
  }
  return fmt::format("  {:<18}{}\n", name, lines);
}

std::string reference_text(const judge::Reference& reference) {
  std::string text = reference.source;
  if (!reference.clause.empty()) text += ", " + reference.clause;
  text += fmt::format(" [{}", name(reference.standing));
  return text + (judge::is_verified(reference.standing) ? "]" : ", unverified]");
}

std::string list_fields(std::string_view first, std::string_view others,
                        const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += field(out.empty() ? first : others, text);
  return out;
}

std::string one_finding(const Finding& finding, const TextOptions& options) {
  std::string out = fmt::format(
      "  {}\n", painted(finding.verdict,
                        fmt::format("{}: {}", name(finding.verdict), escaped_line(finding.reason)), options));
  out += field("requirement", finding.requirement);
  out += field("source", reference_text(finding.reference));
  out += list_fields("expected", "  or", finding.expected);
  out += field("actual", finding.actual);
  out += field("time", kernel::describe(finding.time));
  if (!finding.step.empty()) out += field("in step", finding.step);
  if (!finding.first_difference.empty()) out += field("first difference", finding.first_difference);
  out += list_fields("decisive", "", finding.decisive);
  return out + list_fields("decode", "", finding.decode);
}

bool is_worth_telling(const CaseResult& result) {
  return counted_verdict(result) > Verdict::pass;
}

std::string counts_text(const Counts& counts) {
  std::string out = fmt::format("{} of {} selected cases judged:", counts.judged, counts.selected);
  const char* separator = " ";
  for (const Verdict verdict :
       {Verdict::pass, Verdict::warn, Verdict::inconclusive, Verdict::fail, Verdict::error}) {
    if (counts.of(verdict) == 0 && verdict != Verdict::pass && verdict != Verdict::fail) continue;
    out += fmt::format("{}{} {}", separator, counts.of(verdict), name(verdict));
    separator = ", ";
  }
  if (counts.of(Verdict::not_applicable) > 0) {
    out += fmt::format("; {} not applicable", counts.of(Verdict::not_applicable));
  }
  if (counts.expected > 0) out += fmt::format("; {} expected by the baseline", counts.expected);
  if (counts.not_run() > 0) out += fmt::format("; {} not run", counts.not_run());
  return out + "\n";
}

// A part of a plan that never hit may be a slip of its writer, and a pass then says less than it seems.
std::string planned_faults_text(const Run& run) {
  constexpr std::size_t kMostLines = 20;
  std::vector<PlannedFault> faults = planned_faults(run);
  std::ranges::stable_partition(faults, [](const PlannedFault& fault) { return fault.cases_hit == 0; });
  std::string out;
  for (const PlannedFault& fault : std::span(faults).first(std::min(kMostLines, faults.size()))) {
    const std::string name = fault.part.name.empty() ? "" : " (" + fault.part.name + ")";
    out += fmt::format("plan {}: ", escaped_line(fault.part.place + name));
    out += fault.cases_hit == 0
               ? fmt::format("never hit in {} cases\n", fault.cases)
               : fmt::format("hit {} times, in {} of {} cases\n", fault.hits, fault.cases_hit, fault.cases);
  }
  if (faults.size() > kMostLines) {
    out += fmt::format("plan: {} more parts are in results.json\n", faults.size() - kMostLines);
  }
  return out;
}

// The heaviest case that does not pass, the first one of those in the catalogue.
const CaseResult* worst_case(const Run& run) {
  const auto worst = std::max_element(
      run.cases.begin(), run.cases.end(),
      [](const CaseResult& a, const CaseResult& b) { return counted_verdict(a) < counted_verdict(b); });
  return worst == run.cases.end() || counted_verdict(*worst) < Verdict::inconclusive ? nullptr : &*worst;
}

}  // namespace

std::string escaped_line(std::string_view text) {
  return kernel::escaped_line(text);
}

std::string escaped_block(std::string_view text) {
  std::string out;
  for (;;) {
    const std::size_t end = text.find_first_of("\n\t");
    out += escaped_line(text.substr(0, end));
    if (end == std::string_view::npos) return out;
    out += text.at(end);
    text.remove_prefix(end + 1);
  }
}

std::string run_header(const RunIdentity& identity, const Manifest& manifest) {
  const auto hash = [](const std::string& text) {
    return text.empty() ? std::string("none") : escaped_line(text);
  };
  return fmt::format("fieldproof {}, seed {}, suite {}, build {} ({}), plan {}, network {}\n",
                     escaped_line(identity.tool_version), identity.seed, escaped_line(identity.suite_version),
                     escaped_line(manifest.build_type), escaped_line(manifest.compiler),
                     hash(identity.plan_hash), hash(identity.network_hash));
}

std::string case_line(const CaseResult& result, const TextOptions& options) {
  std::string out = painted(result.verdict, fmt::format("{:<14}", name(result.verdict)), options);
  out += " " + escaped_line(result.id);
  if (!result.reason.empty()) out += "  (" + escaped_line(result.reason) + ")";
  if (!result.expected_because.empty()) out += ", expected: " + escaped_line(result.expected_because);
  return out + "\n";
}

std::string measurement_lines(const CaseResult& result) {
  std::string out;
  for (const judge::Measurement& measured : result.measurements) {
    out += field("", fmt::format("{}: {:.10g} {}", escaped_line(measured.name), measured.value,
                                 escaped_line(measured.unit)));
    if (measured.low != measured.value || measured.high != measured.value) {
      out.pop_back();
      out += fmt::format("  (limits {:.10g} to {:.10g})\n", measured.low, measured.high);
    }
  }
  return out;
}

std::string finding_text(const RunIdentity& identity, const CaseResult& result, const TextOptions& options) {
  std::string out = case_line(result, options);
  if (!result.purpose.empty()) out += field("purpose", result.purpose);
  if (result.findings.empty()) {
    out += field("requirement", result.requirement);
    out += field("source", reference_text(result.reference));
  }
  for (const Finding& finding : result.findings) out += one_finding(finding, options);
  out += list_fields("settings", "", result.settings);
  out += field("seed", fmt::format("{} (of the case)", result.seed));
  out += field("fingerprint", judge::fingerprint_text(result.fingerprint));
  const std::string command =
      options.reproduce.empty() ? reproduce_command(identity, result.id) : options.reproduce;
  return out + field("reproduce", escaped_line(command));
}

std::string unverified_text(std::size_t unverified, std::size_t judged) {
  if (unverified == 0) return "";
  // All that judge; a case that does not apply rests on nothing.
  judged = std::max(unverified, judged);
  return fmt::format("{} of these {} verdicts ({:.0f} %) rest on an unverified source", unverified, judged,
                     100.0 * static_cast<double>(unverified) / static_cast<double>(judged));
}

std::string summary_text(const Run& run, const TextOptions& options) {
  std::string out;
  std::size_t told = 0;
  std::size_t untold = 0;
  for (const CaseResult& result : run.cases) {
    if (!is_worth_telling(result)) continue;
    if (told == options.findings) {
      ++untold;
      continue;
    }
    ++told;
    out += finding_text(run.identity, result, options) + "\n";
  }
  if (untold > 0) out += fmt::format("{} more cases with findings are in results.json\n\n", untold);
  if (!run.is_complete()) {
    out += "the result is incomplete: " + escaped_line(run.identity.incomplete_because) + "\n";
  }
  const Verdict heaviest = headline(run);
  out += painted(heaviest, name(heaviest), options) + ": " + counts_text(count(run));
  if (const std::string text = unverified_text(unverified_verdicts(run), count(run).judged); !text.empty())
    out += text + "\n";
  out += planned_faults_text(run);
  for (const std::string& caveat : run.identity.caveats) out += "unverified: " + escaped_line(caveat) + "\n";
  for (const std::string& stale : run.identity.stale_expectations) {
    out += "baseline: " + escaped_line(stale) + "\n";
  }
  const CaseResult* worst = worst_case(run);
  if (worst == nullptr) return out;
  return out + "reproduce: " + escaped_line(reproduce_command(run.identity, worst->id)) + "\n";
}

}  // namespace fieldproof::reports
