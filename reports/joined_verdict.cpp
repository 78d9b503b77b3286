#include "reports/joined_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "reports/diff.hpp"
#include "reports/document_verdict.hpp"
#include "reports/history.hpp"
#include "reports/measurement_writer.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;

// What a set of cases came to; sums over runs are told by the same words.
struct CaseSums {
  std::size_t selected = 0;
  std::size_t judged = 0;
  std::size_t failed = 0;  // neither these nor errors are expected
  std::size_t errors = 0;
  std::size_t inconclusive = 0;
  std::size_t warned = 0;
  std::size_t expected = 0;

  void add(const Run& run) {
    const Counts counts = count(run);
    selected += counts.selected;
    judged += counts.judged;
    expected += counts.expected;
    for (const judge::CaseResult& result : run.cases) {
      const Verdict verdict = counted_verdict(result);
      failed += verdict == Verdict::fail ? 1U : 0U;
      errors += verdict == Verdict::error ? 1U : 0U;
      inconclusive += verdict == Verdict::inconclusive ? 1U : 0U;
      warned += verdict == Verdict::warn ? 1U : 0U;
    }
  }

  std::string text() const {
    if (judged == 0) return "no case was judged";
    const std::string of_judged = fmt::format("of {}", several(judged, "judged case"));
    std::string words;
    if (failed > 0) words = fmt::format("{} {} failed", failed, of_judged);
    if (errors > 0 && failed > 0) words += fmt::format(" and {} ended in an error", errors);
    if (errors > 0 && failed == 0) words = fmt::format("{} {} ended in an error", errors, of_judged);
    if (words.empty() && inconclusive > 0) {
      words = fmt::format("{} {} could not be told; none failed", inconclusive, of_judged);
    }
    const std::string_view all_failed = expected > 0 ? "passed, or failed as the baseline expects" : "passed";
    if (words.empty() && warned > 0) {
      words =
          fmt::format("no failure among {}, {}", several(judged, "judged case"), several(warned, "warning"));
    }
    if (words.empty()) words = fmt::format("all {} {}", several(judged, "judged case"), all_failed);
    if (expected > 0) words += fmt::format(" ({} as expected)", expected);
    return words;
  }
};

// What the exit code knows beyond the cases: strictness, a stale baseline.
Verdict by_exit_code(int code) {
  switch (code) {
    case 1:
      return Verdict::fail;
    case 2:
      return Verdict::inconclusive;
    case 3:
      return Verdict::warn;
    case 5:
    case 70:
      return Verdict::error;
    default:
      return Verdict::none;
  }
}

Said said_by_run(const Run& run) {
  CaseSums sums;
  sums.add(run);
  Said said{std::max(headline(run), by_exit_code(run.identity.exit_code)), sums.text()};
  const bool is_whole = run.is_complete() && count(run).not_run() == 0;
  if (sums.judged == 0 || !is_whole) said.verdict = std::max(said.verdict, Verdict::inconclusive);
  if (!is_whole) {
    const std::size_t not_run = count(run).not_run();
    said.sentence += "; the run is incomplete: ";
    said.sentence += not_run == 0 ? run.identity.incomplete_because
                                  : fmt::format("{} of {} have no verdict", not_run,
                                                several(sums.selected, "selected case"));
  }
  if (!run.identity.stale_expectations.empty()) {
    said.verdict = std::max(said.verdict, Verdict::warn);
    said.sentence += "; the baseline says what is not so any more";
  }
  return said;
}

void add_caveat(JoinedVerdict& joined, const std::string& text, const std::string& name) {
  auto found = std::ranges::find(joined.caveats, text, &JoinedCaveat::text);
  if (found == joined.caveats.end()) found = joined.caveats.insert(found, {text, {}});
  if (std::ranges::find(found->names, name) == found->names.end()) found->names.push_back(name);
}

// Of a comparison the second run is handed over, so its verdicts alone count.
void add_unverified_sources(const PageContent& content, JoinedVerdict& joined) {
  std::size_t unverified = 0;
  std::size_t judged = 0;
  std::vector<std::string> names;
  for (const PageRun& page : content.runs) {
    if (content.is_comparison && &page == &content.runs.front()) continue;
    const std::size_t of_run = unverified_verdicts(page.stored.run);
    unverified += of_run;
    judged += count(page.stored.run).judged;
    if (of_run > 0) names.push_back(page.name);
  }
  const std::string text = unverified_text(unverified, judged);
  if (text.empty()) return;
  for (const std::string& name : names) add_caveat(joined, text, name);
}

// Measurements of earlier programs have their caveats among the conditions.
void add_caveats_of(const nlohmann::json& document, const std::string& name, JoinedVerdict& joined) {
  for (const nlohmann::json& caveat : document.value("unverified", nlohmann::json::array()))
    add_caveat(joined, caveat.get<std::string>(), name);
  for (const nlohmann::json& condition : document.value("conditions", nlohmann::json::array())) {
    if (condition.at("name") == kCaveat) add_caveat(joined, condition.at("value").get<std::string>(), name);
  }
}

// "4 runs: 2 failed, 1 inconclusive (12 of 170 judged cases failed)"
std::string runs_text(const JoinedVerdict& joined, const CaseSums& sums) {
  if (joined.runs.size() == 1) return joined.runs.front().sentence;
  std::string words;
  constexpr std::array kWorth = {
      std::pair(Verdict::error, "ended in an error"), std::pair(Verdict::fail, "failed"),
      std::pair(Verdict::inconclusive, "inconclusive"), std::pair(Verdict::warn, "with warnings")};
  for (const auto& [verdict, word] : kWorth) {
    const auto count = std::ranges::count(joined.runs, verdict, &JudgedPart::verdict);
    if (count > 0) add_words(words, fmt::format("{} {}", count, word));
  }
  const std::string cases = sums.text();
  return fmt::format("{}: {}", several(joined.runs.size(), "run"),
                     words.empty() ? cases : fmt::format("{} ({})", words, cases));
}

std::string documents_text(const JoinedVerdict& joined) {
  constexpr std::size_t kMost = 3;
  std::string words;
  std::size_t untold = 0;
  std::size_t told = 0;
  std::size_t good = 0;
  for (const JudgedPart& part : joined.documents) {
    if (part.verdict == Verdict::none) continue;
    if (part.verdict == Verdict::pass) {
      ++good;
    } else if (told++ < kMost) {
      add_words(words, part.sentence, "; ");
    } else {
      ++untold;
    }
  }
  if (untold > 0) add_words(words, fmt::format("{} more do not hold", several(untold, "document")), "; ");
  if (good == 1 && joined.documents.size() == 1) return joined.documents.front().sentence;
  if (good > 0) add_words(words, several(good, "document") + (good == 1 ? " holds" : " hold"), "; ");
  return words;
}

// Of two runs that are compared the second says how it is now; the first only what has changed.
Said said_by_comparison(const PageRun& before, const PageRun& after) {
  Said said = said_by_run(after.stored.run);
  const Difference difference = compare(before.stored.run, after.stored.run);
  std::string words;
  const auto add = [&words](std::size_t count, std::string_view one, std::string_view many) {
    if (count > 0) add_words(words, fmt::format("{} {}", count, count == 1 ? one : many));
  };
  add(difference.new_failures.size(), "new failure", "new failures");
  add(difference.fixed.size(), "case is fixed", "cases are fixed");
  add(difference.disappeared.size(), "case is gone", "cases are gone");
  if (words.empty()) words = "nothing fails that did not, and nothing is fixed";
  said.sentence += fmt::format("; since {}: {}", before.name, words);
  // Of what is not judged any more nobody knows.
  if (!difference.incomplete.empty() || !difference.disappeared.empty())
    said.verdict = std::max(said.verdict, Verdict::inconclusive);
  return said;
}

// The newest run of each setup says how it is now; what comes and goes, or drifts, is at least a warning.
JudgedPart judged_history(const History& history) {
  JudgedPart part{fmt::format("history of {}", history.folder), Verdict::none, ""};
  for (std::size_t setup = 0; setup < history.setups.size(); ++setup) {
    const auto newest = std::find_if(history.runs.rbegin(), history.runs.rend(),
                                     [setup](const HistoryRun& run) { return run.setup == setup; });
    if (newest == history.runs.rend() || (newest->verdict <= part.verdict && !part.sentence.empty()))
      continue;
    part.verdict = newest->verdict;
    part.sentence = fmt::format("the newest run, {}: {}", newest->name, newest->sentence);
  }
  const auto drifts = std::ranges::count_if(
      history.quantities, [&](const Quantity& quantity) { return history.drifts(quantity) == Drifts::yes; });
  const auto add = [&part](std::size_t count, std::string_view one, std::string_view of_one,
                           std::string_view of_many) {
    if (count == 0) return;
    part.verdict = std::max(part.verdict, Verdict::warn);
    add_words(part.sentence, fmt::format("{} {}", several(count, one), count == 1 ? of_one : of_many), "; ");
  };
  add(history.broken.size(), "case", "began to fail", "began to fail");
  add(history.flaky.size(), "case", "is flaky", "are flaky");
  add(static_cast<std::size_t>(drifts), "measured number", "drifts", "drift");
  return part;
}

}  // namespace

JudgedPart judged_run(const std::string& name, const Run& run) {
  const Said said = said_by_run(run);
  return {name, said.verdict, said.sentence};
}

JoinedVerdict joined_verdict(const PageContent& content) {
  JoinedVerdict joined;
  CaseSums sums;
  for (const PageRun& run : content.runs) {
    sums.add(run.stored.run);
    joined.runs.push_back(judged_run(run.name, run.stored.run));
    for (const std::string& caveat : run.stored.run.identity.caveats) add_caveat(joined, caveat, run.name);
  }
  add_unverified_sources(content, joined);
  for (const PageDocument& document : content.documents) {
    const nlohmann::json json = nlohmann::json::parse(document.json, nullptr, true, true);
    const Said said = said_by_document(json);
    joined.documents.push_back({document.name, said.verdict, said.sentence});
    add_caveats_of(json, document.name, joined);
  }
  if (content.history) joined.histories.push_back(judged_history(*content.history));
  for (const auto* parts : {&joined.runs, &joined.documents, &joined.histories}) {
    if (parts == &joined.runs && content.is_comparison) continue;
    for (const JudgedPart& part : *parts) joined.verdict = std::max(joined.verdict, part.verdict);
  }
  if (content.is_comparison) {
    const Said said = said_by_comparison(content.runs.at(0), content.runs.at(1));
    joined.verdict = std::max(joined.verdict, said.verdict);
    joined.sentence = said.sentence;
  } else if (!joined.runs.empty()) {
    joined.sentence = runs_text(joined, sums);
  }
  add_words(joined.sentence, documents_text(joined), "; ");
  if (!joined.histories.empty()) add_words(joined.sentence, joined.histories.front().sentence, "; ");
  if (joined.sentence.empty()) joined.sentence = "nothing here has a verdict";
  return joined;
}

std::string joined_text(const JoinedVerdict& joined) {
  std::string text = fmt::format("{}: {}\n", name(joined.verdict), escaped_line(joined.sentence));
  if (joined.runs.size() + joined.documents.size() + joined.histories.size() < 2) return text;
  for (const auto* parts : {&joined.runs, &joined.documents, &joined.histories}) {
    for (const JudgedPart& part : *parts) {
      text +=
          fmt::format("  {:<13} {}: {}\n", part.verdict == Verdict::none ? "no verdict" : name(part.verdict),
                      escaped_line(part.name), escaped_line(part.sentence));
    }
  }
  return text;
}

}  // namespace fieldproof::reports
