#include "reports/campaign_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

namespace fieldproof::reports {
namespace {

using judge::Verdict;
using Content = nlohmann::ordered_json;

constexpr std::size_t kMostFailedNames = 20;  // of one job

// A value with blanks stands in quotes, and a seed has none.
std::string without_seed(std::string command) {
  constexpr std::string_view kSeed = " --seed=";
  const std::size_t begin = command.find(kSeed);
  if (begin == std::string::npos) return command;
  const std::size_t end = command.find(' ', begin + 1);
  command.erase(begin, end == std::string::npos ? end : end - begin);
  return command;
}

void add_counts(const Content& job, const char* member, Content& sums) {
  const auto counts = job.find(member);
  if (counts == job.end()) return;
  for (const auto& [name, count] : counts->items()) {
    Content& sum = sums[name];
    sum = (sum.is_null() ? 0 : sum.get<std::uint64_t>()) + count.get<std::uint64_t>();
  }
}

void add_one(Content& sums, const std::string& name) {
  Content& sum = sums[name];
  sum = (sum.is_null() ? 0 : sum.get<std::uint64_t>()) + 1;
}

Content row_of(const std::string& command) {
  return {{"command", command},
          {"jobs", 0},
          {"by_exit_code", Content::object()},
          {"by_headline", Content::object()},
          {"cases", Content::object()},
          {"ledger", Content::object()}};
}

void add_job(const Content& job, Content& row) {
  row["jobs"] = row["jobs"].get<std::uint64_t>() + 1;
  add_one(row["by_exit_code"], std::to_string(job.at("exit_code").get<int>()));
  if (const auto headline = job.find("headline"); headline != job.end())
    add_one(row["by_headline"], headline->get<std::string>());
  add_counts(job, "cases", row["cases"]);
  add_counts(job, "ledger", row["ledger"]);
}

bool is_worth_telling(const Content& job) {
  constexpr int kNothingToJudge = 4;
  const int code = job.at("exit_code").get<int>();
  const std::string headline = job.value("headline", "");
  return (code != 0 && code != kNothingToJudge) || headline == "C" || headline == "D";
}

Content finding_of(Content job) {
  // An ordered object moves its members when one is added.
  std::size_t left_out = 0;
  if (const auto failed = job.find("failed"); failed != job.end() && failed->size() > kMostFailedNames) {
    left_out = failed->size() - kMostFailedNames;
    failed->erase(failed->begin() + kMostFailedNames, failed->end());
  }
  if (left_out > 0) job["failed_left_out"] = left_out;
  for (const char* member : {"cases", "ledger", "files"}) job.erase(member);
  return job;
}

// How a verb ended, in words that follow "3 jobs".
struct Ending {
  Verdict verdict;
  std::string_view words;
};

Ending ending_of(const std::string& code) {
  static const std::map<std::string, Ending, std::less<>> kEndings = {
      {"0", {Verdict::pass, ""}},
      {"1", {Verdict::fail, "failed"}},
      {"2", {Verdict::inconclusive, "could not be told"}},
      {"3", {Verdict::warn, "ended otherwise than what is stored"}},
      {"4", {Verdict::none, ""}},
  };
  const auto found = kEndings.find(code);
  return found == kEndings.end() ? Ending{Verdict::error, "ended in an error"} : found->second;
}

void say_how_jobs_ended(const nlohmann::json& counts, Said& said) {
  std::map<Verdict, std::pair<std::uint64_t, std::string_view>, std::greater<>> endings;
  for (const auto& [code, count] : counts.at("by_exit_code").items()) {
    const Ending ending = ending_of(code);
    said.verdict = std::max(said.verdict, ending.verdict);
    if (ending.words.empty()) continue;
    endings[ending.verdict].first += count.get<std::uint64_t>();
    endings[ending.verdict].second = ending.words;
  }
  for (const auto& [verdict, ending] : endings) {
    add_words(said.sentence,
              said.sentence.empty()
                  ? fmt::format("{} of {} of a campaign {}", ending.first,
                                several(counts.at("jobs").get<std::size_t>(), "job"), ending.second)
                  : fmt::format("{} {}", ending.first, ending.second));
  }
}

void say_criteria(const nlohmann::json& counts, Said& said) {
  for (const auto& [criterion, verdict] :
       {std::pair("D", Verdict::fail), std::pair("C", Verdict::fail), std::pair("B", Verdict::warn)}) {
    const auto jobs = counts.at("by_headline").value(criterion, std::uint64_t{0});
    if (jobs == 0) continue;
    said.verdict = std::max(said.verdict, verdict);
    if (verdict == Verdict::warn && said.verdict > verdict) continue;
    add_words(said.sentence,
              fmt::format("criterion {} in {} of a campaign", criterion, several(jobs, "job")));
  }
}

void say_decision(const nlohmann::json& confidence, Said& said) {
  const std::string goal = fmt::format("{:g} of the exchanges {}", confidence.at("rate").get<double>(),
                                       confidence.at("of") == "sent" ? "sent" : "whose data differed");
  if (confidence.at("decision") == "above") {
    said.verdict = std::max(said.verdict, Verdict::fail);
    add_words(said.sentence, fmt::format("wrong words are accepted in more than {}", goal));
  } else if (confidence.at("decision") == "open") {
    said.verdict = std::max(said.verdict, Verdict::inconclusive);
    add_words(said.sentence,
              fmt::format("whether wrong words are accepted in less than {} is not decided", goal));
  }
}

}  // namespace

nlohmann::ordered_json campaign_content(nlohmann::ordered_json document) {
  std::map<std::string, std::size_t> places;
  Content rows = Content::array();
  Content findings = Content::array();
  std::size_t untold = 0;
  std::size_t rows_left_out = 0;
  for (const Content& job : document.at("jobs")) {
    const std::string command = without_seed(job.at("command").get<std::string>());
    const auto [place, is_new] = places.emplace(command, places.size());
    if (is_new && place->second < kMostCampaignRows) rows.push_back(row_of(command));
    if (is_new && place->second >= kMostCampaignRows) ++rows_left_out;
    if (place->second < kMostCampaignRows) add_job(job, rows.at(place->second));
    if (!is_worth_telling(job)) continue;
    if (findings.size() < kMostCampaignFindings) {
      findings.push_back(finding_of(job));
    } else {
      ++untold;
    }
  }
  document.erase("jobs");
  document["rows"] = std::move(rows);
  document["rows_left_out"] = rows_left_out;
  document["findings"] = std::move(findings);
  document["findings_left_out"] = untold;
  return document;
}

Said said_by_campaign(const nlohmann::json& document) {
  Said said;
  const nlohmann::json& counts = document.at("counts");
  const auto jobs = counts.at("jobs").get<std::size_t>();
  say_how_jobs_ended(counts, said);
  say_criteria(counts, said);
  if (document.contains("confidence")) say_decision(document.at("confidence"), said);
  if (said.verdict == Verdict::none) {
    said.verdict = Verdict::inconclusive;
    add_words(said.sentence, "no job of a campaign judged anything");
  }
  if (document.at("is_complete") == false) {
    said.verdict = std::max(said.verdict, Verdict::inconclusive);
    add_words(said.sentence, fmt::format("the campaign is incomplete: {} of {} ended", jobs,
                                         several(counts.at("planned").get<std::size_t>(), "job")));
  }
  if (said.sentence.empty())
    said.sentence = fmt::format("all {} of a campaign ended well", several(jobs, "job"));
  return said;
}

}  // namespace fieldproof::reports
