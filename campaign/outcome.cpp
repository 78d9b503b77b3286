#include "campaign/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::campaign {
namespace {

using nlohmann::ordered_json;

constexpr int kLastVerdict = 4;  // exit codes above it are no verdicts

void read_run(const ordered_json& document, Outcome& outcome) {
  outcome.headline = document.at("headline");
  document.at("counts").at("by_verdict").get_to(outcome.cases);
  std::erase_if(outcome.cases, [](const auto& counted) { return counted.second == 0; });
  document.at("run").at("caveats").get_to(outcome.caveats);
  for (const ordered_json& one : document.at("cases")) {
    const std::string verdict = one.at("verdict");
    if ((verdict == "fail" || verdict == "error") && !one.contains("expected_because"))
      outcome.failed.push_back(one.at("id"));
  }
}

// The numbers of a ledger, and of its balance how many put the checks to the test.
Counts counts_of(const ordered_json& ledger) {
  Counts counts;
  for (const auto& [name, number] : ledger.items()) {
    if (number.is_number()) counts[name] = number.get<std::uint64_t>();
  }
  counts["data_differed"] = ledger.at("balance").at("data_differed").get<std::uint64_t>();
  return counts;
}

// The worst criterion of all tests, and the sum of their ledgers.
void read_emc(const ordered_json& document, Outcome& outcome) {
  document.at("unverified").get_to(outcome.caveats);
  for (const char* part : {"tests", "channels"}) {
    for (const ordered_json& test : document.at(part)) {
      add(counts_of(test.at("ledger")), outcome.ledger);
      outcome.headline = std::max(outcome.headline, test.at("criterion").get<std::string>());
    }
  }
}

void read_fuzz(const ordered_json& document, Outcome& outcome) {
  const auto& stored = document.at("stored");
  outcome.search = {{"run", document.at("run").get<std::uint64_t>() + stored.at("run").get<std::uint64_t>()},
                    {"stored", stored.at("read").get<std::uint64_t>()},
                    {"edges", document.at("edges").get<std::uint64_t>()},
                    {"kept", document.at("kept").get<std::uint64_t>()},
                    {"found", document.contains("found") ? 1 : 0}};
  for (const ordered_json& point : document.at("growth"))
    outcome.growth.push_back({point.at("run").get<std::uint64_t>(), point.at("edges").get<std::uint64_t>()});
  const std::size_t left_out = stored.at("left_out").size();
  if (left_out > 0) outcome.caveats.push_back(fmt::format("{} stored sequences were left out", left_out));
}

// Of all its roles together.
std::string detected_in(const ordered_json& roles) {
  std::uint64_t found = 0;
  std::uint64_t of = 0;
  for (const ordered_json& role : roles) {
    found += role.at("found").get<std::uint64_t>();
    of += role.at("of").get<std::uint64_t>();
  }
  return fmt::format("found {} of {}", found, of);
}

void read_document(const ordered_json& document, Outcome& outcome) {
  const std::string kind = document.value("schema", "");
  if (kind == "fieldproof/results/1") read_run(document, outcome);
  if (kind == "fieldproof/emc/1") read_emc(document, outcome);
  if (kind == "fieldproof/fuzz/1") read_fuzz(document, outcome);
  if (kind == "fieldproof/measurement/1") outcome.headline = document.at("agreement");
  if (kind == "fieldproof/matrix/1")
    outcome.headline =
        document.at("holes").empty() ? "complete" : fmt::format("{} holes", document.at("holes").size());
  if (kind == "fieldproof/detection/1") outcome.headline = detected_in(document.at("roles"));
}

std::string last_line(const std::string& log) {
  const std::size_t end = log.find_last_not_of('\n');
  if (end == std::string::npos) return {};
  const std::size_t before = log.rfind('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return kernel::as_utf8(std::string_view(log).substr(begin, end + 1 - begin));
}

}  // namespace

bool is_of_corpus(std::string_view name) {
  return name.starts_with(std::string(kCorpus) + "/");
}

void add(const Counts& more, Counts& sum) {
  for (const auto& [name, number] : more) sum[name] += number;
}

std::uint64_t count_of(const Counts& counts, std::string_view name) {
  const auto found = counts.find(name);
  return found == counts.end() ? 0 : found->second;
}

Outcome outcome_of(const JobResult& result) {
  Outcome outcome;
  outcome.id = result.id;
  outcome.exit_code = result.exit_code;
  outcome.wall_time_ms = result.wall_time_ms;
  outcome.kept = result.files.size();
  if (result.exit_code > kLastVerdict) outcome.message = last_line(result.log);
  for (const KeptFile& file : result.files)
    if (file.name != kDocument && !is_of_corpus(file.name)) outcome.files.push_back(file.name);
  const std::string_view text = result.file(kDocument);
  if (text.empty()) return outcome;
  try {
    read_document(ordered_json::parse(text), outcome);
  } catch (const ordered_json::exception& broken) {
    outcome.exit_code = 70;
    outcome.message = fmt::format("{} is not what the verb writes: {}", kDocument, broken.what());
  }
  return outcome;
}

std::string to_json(const Outcome& outcome) {
  ordered_json growth = ordered_json::array();
  for (const GrowthPoint& point : outcome.growth) growth.push_back({point.run, point.edges});
  const ordered_json json = {{"id", outcome.id},
                             {"exit_code", outcome.exit_code},
                             {"killed", outcome.killed},
                             {"headline", outcome.headline},
                             {"message", outcome.message},
                             {"files", outcome.files},
                             {"kept", outcome.kept},
                             {"cases", outcome.cases},
                             {"failed", outcome.failed},
                             {"search", outcome.search},
                             {"growth", std::move(growth)},
                             {"ledger", outcome.ledger},
                             {"caveats", outcome.caveats},
                             {"wall_time_ms", outcome.wall_time_ms}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

Outcome outcome_from_json(std::string_view text, const std::string& place) {
  try {
    const ordered_json json = ordered_json::parse(text);
    Outcome outcome;
    json.at("id").get_to(outcome.id);
    json.at("exit_code").get_to(outcome.exit_code);
    json.at("killed").get_to(outcome.killed);
    json.at("headline").get_to(outcome.headline);
    json.at("message").get_to(outcome.message);
    json.at("files").get_to(outcome.files);
    json.at("kept").get_to(outcome.kept);
    json.at("cases").get_to(outcome.cases);
    json.at("failed").get_to(outcome.failed);
    json.at("search").get_to(outcome.search);
    for (const ordered_json& point : json.at("growth"))
      outcome.growth.push_back({point.at(0).get<std::uint64_t>(), point.at(1).get<std::uint64_t>()});
    json.at("ledger").get_to(outcome.ledger);
    json.at("caveats").get_to(outcome.caveats);
    json.at("wall_time_ms").get_to(outcome.wall_time_ms);
    return outcome;
  } catch (const ordered_json::exception& broken) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: this is no outcome of a job: {}", place, broken.what()));
  }
}

}  // namespace fieldproof::campaign
