#include "reports/github_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reports/text_summary.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using judge::Verdict;

constexpr std::size_t kMostLines = 9;
constexpr std::size_t kMostOctets = 900'000;  // a summary has 1 MiB
constexpr std::size_t kLongestText = 1'000;

// The data of a workflow command; of a property also what separates properties.
std::string command_text(std::string_view text, std::string_view reserved) {
  std::string out;
  for (const char c : text) {
    out += reserved.find(c) == std::string_view::npos ? std::string(1, c)
                                                      : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}
std::string data(std::string_view text) {
  return command_text(escaped_block(text), "%\r\n");
}
std::string property_text(std::string_view text) {
  return command_text(escaped_line(text), "%\r\n:,");
}

// One line of Markdown that has no markup.
std::string plain_markdown(std::string_view text) {
  constexpr std::string_view kPunctuation = "!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~";
  std::string out;
  for (const char c : escaped_line(text.substr(0, kLongestText))) {
    out += kPunctuation.find(c) == std::string_view::npos ? std::string(1, c)
                                                          : fmt::format("&#{};", static_cast<int>(c));
  }
  return out;
}

// Those that GitHub is to show, the worst first, in the order of the run among equals.
std::vector<const CaseResult*> worst_first(const Run& run, const OutcomeRules& rules) {
  std::vector<const CaseResult*> cases;
  for (const CaseResult& result : run.cases) {
    const Outcome outcome = outcome_of(result, rules);
    if (outcome == Outcome::failure || outcome == Outcome::error) cases.push_back(&result);
  }
  std::ranges::stable_sort(cases, std::ranges::greater{}, [](const CaseResult* one) { return one->verdict; });
  return cases;
}

std::string annotation_text(const RunIdentity& identity, const CaseResult& result) {
  std::string text = verdict_message(result);
  if (!result.findings.empty()) {
    const judge::Finding& finding = result.findings.front();
    text += fmt::format("\nrequirement: {}\nactual: {}", finding.requirement, finding.actual);
  }
  text = text.substr(0, kLongestText);
  return text + "\nreproduce: " + reproduce_command(identity, result.id);
}

std::string line(std::string_view title, std::string_view text) {
  return fmt::format("::error title={}::{}\n", property_text(title), data(text));
}

}  // namespace

std::string github_annotations(const Run& run, const OutcomeRules& rules) {
  std::string out;
  std::size_t shown = 0;
  for (const Complaint& complaint : complaints_about(run, rules)) {
    if (complaint.outcome == Outcome::skipped) continue;
    out += line(complaint.name, complaint.text);
    ++shown;
  }
  const std::vector<const CaseResult*> cases = worst_first(run, rules);
  const std::size_t room = std::min(cases.size(), kMostLines - shown);
  for (std::size_t n = 0; n < room; ++n) {
    out += line(cases[n]->id, annotation_text(run.identity, *cases[n]));
  }
  if (cases.size() > room) {
    out += line("fieldproof",
                fmt::format("{} more cases did not pass; the report has them", cases.size() - room));
  }
  return out;
}

std::string github_summary(const Run& run, const OutcomeRules& rules) {
  const Counts counts = count(run);
  std::string out = fmt::format(
      "### fieldproof: {}\n\n{} of {} selected cases judged: {} pass, {} warn, {} inconclusive, "
      "{} fail, {} error; {} not applicable\n\nseed {}, suite {}\n\n",
      name(headline(run)), counts.judged, counts.selected, counts.of(Verdict::pass), counts.of(Verdict::warn),
      counts.of(Verdict::inconclusive), counts.of(Verdict::fail), counts.of(Verdict::error),
      counts.of(Verdict::not_applicable), run.identity.seed, plain_markdown(run.identity.suite_version));
  for (const Complaint& complaint : complaints_about(run, rules)) {
    out += fmt::format("**{}**: {}\n\n", plain_markdown(complaint.name), plain_markdown(complaint.text));
  }
  const std::vector<const CaseResult*> cases = worst_first(run, rules);
  if (cases.empty()) return out;
  out += "| verdict | case | why | again |\n|---|---|---|---|\n";
  std::size_t shown = 0;
  for (; shown < cases.size() && out.size() < kMostOctets; ++shown) {
    const CaseResult& result = *cases[shown];
    out += fmt::format("| {} | {} | {} | {} |\n", name(result.verdict), plain_markdown(result.id),
                       plain_markdown(outcome_message(result)),
                       plain_markdown(reproduce_command(run.identity, result.id)));
  }
  if (cases.size() > shown) out += fmt::format("\n{} more did not pass\n", cases.size() - shown);
  return out + "\n";
}

std::string github_log(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    std::string line(text.substr(0, end));
    // The runner looks for one after blanks, for the other anywhere.
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin != std::string::npos && line.compare(begin, 2, "::") == 0) line.insert(begin, "| ");
    for (std::size_t at = 0; (at = line.find("##[", at)) != std::string::npos;) line.insert(at + 2, " ");
    out += line;
    text.remove_prefix(end);
  }
  return out;
}

}  // namespace fieldproof::reports
