#include "campaign/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "campaign/distribution.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::campaign {
namespace {

using nlohmann::ordered_json;

constexpr double kConfidence = 0.95;
constexpr std::size_t kShown = 20;  // jobs that did not end well

std::string_view word_of(Decision decision) {
  constexpr std::array<std::string_view, 3> kWords = {"open", "below", "above"};
  return kWords.at(static_cast<std::size_t>(decision));
}

// Exchanges in which a wrong word was accepted, and what so few of them can hide.
struct WrongShare {
  std::uint64_t wrong = 0;
  std::uint64_t total = 0;
  double upper = 1;
};

WrongShare share_of(const Report& report, const Counts& ledger, std::string_view whole) {
  WrongShare share{count_of(ledger, "wrong_cycles"), count_of(ledger, whole), 1};
  if (share.total > 0 && report.bound)
    share.upper = report.bound(std::min(share.wrong, share.total), share.total, kConfidence);
  return share;
}

ordered_json ledger_json(const Report& report, const Totals& totals) {
  ordered_json json = totals.ledger;
  ordered_json shares = ordered_json::array();
  for (const char* whole : {"sent", "data_differed"}) {
    const WrongShare share = share_of(report, totals.ledger, whole);
    shares.push_back(
        {{"of", whole}, {"wrong", share.wrong}, {"total", share.total}, {"upper_bound_95", share.upper}});
  }
  return {{"counts", std::move(json)}, {"accepted_wrong", std::move(shares)}};
}

ordered_json confidence_json(const Confidence& confidence) {
  return {{"rate", confidence.goal().rate},
          {"confidence", confidence.goal().confidence},
          {"of", confidence.goal().is_of_differed ? "data_differed" : "sent"},
          {"wrong", confidence.wrong()},
          {"total", confidence.total()},
          {"looks", confidence.looks()},
          {"lower_bound", confidence.lower()},
          {"upper_bound", confidence.upper()},
          {"decision", word_of(confidence.decision())}};
}

ordered_json job_json(const Report& report, const Outcome& outcome) {
  ordered_json json = {
      {"id", outcome.id}, {"command", report.command(outcome.id)}, {"exit_code", outcome.exit_code}};
  if (!outcome.headline.empty()) json["headline"] = outcome.headline;
  if (!outcome.killed.empty()) json["killed"] = outcome.killed;
  if (!outcome.message.empty()) json["message"] = outcome.message;
  if (!outcome.cases.empty()) json["cases"] = outcome.cases;
  if (!outcome.failed.empty()) json["failed"] = outcome.failed;
  if (!outcome.search.empty()) json["search"] = outcome.search;
  if (!outcome.ledger.empty()) json["ledger"] = outcome.ledger;
  if (!outcome.files.empty()) json["files"] = outcome.files;
  return json;
}

std::vector<const Outcome*> jobs_of(const MergedCorpus& corpus, const Report& report) {
  std::vector<const Outcome*> jobs;
  for (const std::uint64_t id : corpus.jobs) jobs.push_back(&report.outcomes->at(id));
  return jobs;
}

ordered_json search_json(const Report& report, const Totals& totals) {
  ordered_json corpora = ordered_json::array();
  for (const MergedCorpus& one : report.corpora) {
    ordered_json growth = ordered_json::array();
    for (const JointGrowth& point : joint_growth(jobs_of(one, report)))
      growth.push_back({{"run", point.run}, {"all", point.all}, {"edges", point.edges}});
    corpora.push_back({{"name", one.name},
                       {"command", one.command},
                       {"jobs", one.jobs},
                       {"sequences", one.sequences},
                       {"edges", one.edges},
                       {"growth", std::move(growth)}});
    if (!one.message.empty()) corpora.back()["message"] = one.message;
  }
  return {{"counts", totals.search}, {"corpora", std::move(corpora)}};
}

std::string corpus_text(const Report& report, const MergedCorpus& corpus) {
  const std::string growth = text_of(joint_growth(jobs_of(corpus, report)));
  if (!corpus.message.empty()) {
    return fmt::format("{}: {}; {} sequences in corpus/{}, not made smaller: {}\n", corpus.name, growth,
                       corpus.sequences, corpus.name, kernel::escaped_line(corpus.message));
  }
  return fmt::format("{}: {} in each of {} jobs; {} sequences in corpus/{} pass {} together\n", corpus.name,
                     growth, corpus.jobs.size(), corpus.sequences, corpus.name, corpus.edges);
}

std::string job_text(const Report& report, const Outcome& outcome) {
  std::string text = fmt::format("job {}: {}\n  {}\n", outcome.id,
                                 outcome.killed.empty()
                                     ? fmt::format("exit code {}", outcome.exit_code)
                                     : fmt::format("its process {}, {} times", outcome.killed, kMostLosses),
                                 kernel::escaped_line(report.command(outcome.id)));
  if (!outcome.message.empty()) text += fmt::format("  {}\n", kernel::escaped_line(outcome.message));
  if (!outcome.failed.empty()) {
    text += fmt::format("  {} failed, the first is {}\n", outcome.failed.size(),
                        kernel::escaped_line(outcome.failed.front()));
  }
  return text;
}

std::string counted(const auto& counts, std::string_view each) {
  std::vector<std::string> parts;
  for (const auto& [name, number] : counts) {
    if (number > 0) parts.push_back(fmt::format("{} {}{}", number, each, name));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string confidence_text(const Confidence& confidence) {
  const std::string goal = fmt::format("{:g} of the exchanges {} with {:g} %", confidence.goal().rate,
                                       confidence.goal().is_of_differed ? "data_differed" : "sent",
                                       confidence.goal().confidence * 100);
  if (confidence.decision() == Decision::open) return fmt::format("not decided: {}", goal);
  return fmt::format("accepted wrong: shown to be {} {}", word_of(confidence.decision()), goal);
}

}  // namespace

Totals totals_of(const std::map<std::uint64_t, Outcome>& outcomes) {
  Totals totals;
  for (const auto& [id, outcome] : outcomes) {
    ++totals.by_exit_code[outcome.exit_code];
    if (!outcome.headline.empty()) ++totals.by_headline[outcome.headline];
    if (!outcome.killed.empty()) ++totals.killed;
    totals.failed_cases += outcome.failed.size();
    add(outcome.cases, totals.cases);
    add(outcome.ledger, totals.ledger);
    if (!outcome.search.empty()) {
      add({{"jobs", 1},
           {"run", count_of(outcome.search, "run")},
           {"found", count_of(outcome.search, "found")}},
          totals.search);
    }
    totals.caveats.insert(outcome.caveats.begin(), outcome.caveats.end());
  }
  return totals;
}

int worst_exit_code(const std::map<std::uint64_t, Outcome>& outcomes) {
  constexpr std::array kOrder = {70, 64, 65, 74, 5, 1, 3, 2, 4, 0};
  std::size_t worst = kOrder.size() - 1;
  for (const auto& [id, outcome] : outcomes) {
    const auto* const at = std::ranges::find(kOrder, outcome.exit_code);
    // A code that no verb has is an error of fieldproof.
    worst = std::min(worst, at == kOrder.end() ? 0 : static_cast<std::size_t>(at - kOrder.begin()));
  }
  return kOrder.at(worst);
}

std::string document_text(const Report& report) {
  const Totals totals = totals_of(*report.outcomes);
  ordered_json codes = ordered_json::object();
  for (const auto& [code, number] : totals.by_exit_code) codes[std::to_string(code)] = number;
  ordered_json document = {{"schema", "fieldproof/campaign/1"},
                           {"title", report.title},
                           {"suite_version", report.suite_version},
                           {"plan_hash", report.plan_hash},
                           {"is_complete", report.incomplete_because.empty()},
                           {"incomplete_because", report.incomplete_because},
                           {"exit_code", report.exit_code},
                           {"counts",
                            {{"planned", report.planned},
                             {"jobs", report.outcomes->size()},
                             {"killed", totals.killed},
                             {"by_exit_code", std::move(codes)},
                             {"by_headline", totals.by_headline}}}};
  if (!totals.cases.empty()) {
    document["cases"] = {{"by_verdict", totals.cases}, {"failed", totals.failed_cases}};
  }
  if (!totals.ledger.empty()) document["ledger"] = ledger_json(report, totals);
  if (!totals.search.empty()) document["search"] = search_json(report, totals);
  if (!totals.caveats.empty()) document["unverified"] = totals.caveats;
  if (report.confidence != nullptr) document["confidence"] = confidence_json(*report.confidence);
  document["jobs"] = ordered_json::array();
  for (const auto& [id, outcome] : *report.outcomes) document["jobs"].push_back(job_json(report, outcome));
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string report_text(const Report& report) {
  const Totals totals = totals_of(*report.outcomes);
  std::string text;
  std::size_t shown = 0;
  std::size_t bad = 0;
  for (const auto& [id, outcome] : *report.outcomes) {
    if (outcome.exit_code == 0 || outcome.exit_code == 4) continue;
    ++bad;
    if (++shown <= kShown) text += job_text(report, outcome);
  }
  if (bad > kShown) text += fmt::format("... and {} more\n", bad - kShown);
  for (const std::string& caveat : totals.caveats)
    text += fmt::format("unverified: {}\n", kernel::escaped_line(caveat));
  text += fmt::format("{} of {} jobs: {}\n", report.outcomes->size(), report.planned,
                      counted(totals.by_exit_code, "with exit code "));
  if (!totals.cases.empty()) text += fmt::format("cases: {}\n", counted(totals.cases, ""));
  if (!totals.ledger.empty()) {
    const WrongShare sent = share_of(report, totals.ledger, "sent");
    const WrongShare differed = share_of(report, totals.ledger, "data_differed");
    text += fmt::format(
        "exchanges: {} sent, data differed in {}, {} accepted wrong; at most {:.3g} of those sent, {:.3g} of "
        "those whose data differed (one-sided 95 %)\n",
        sent.total, differed.total, sent.wrong, sent.upper, differed.upper);
  }
  if (!totals.search.empty()) {
    text += fmt::format("searches: {}, {} sequences, {} findings\n", count_of(totals.search, "jobs"),
                        count_of(totals.search, "run"), count_of(totals.search, "found"));
  }
  for (const MergedCorpus& corpus : report.corpora) text += corpus_text(report, corpus);
  if (report.confidence != nullptr) text += confidence_text(*report.confidence) + "\n";
  if (!report.incomplete_because.empty()) text += fmt::format("incomplete: {}\n", report.incomplete_because);
  return text;
}

}  // namespace fieldproof::campaign
