// A history for a terminal, and as data of the page.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/document_verdict.hpp"
#include "reports/history.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::reports {
namespace {

using HistoryJson = nlohmann::ordered_json;

constexpr std::size_t kMostTold = 20;        // of a kind, at a terminal
constexpr std::size_t kMostOnPage = 200;     // cases of a kind
constexpr std::size_t kMostQuantities = 60;  // with their values

std::string more_text(std::size_t count) {
  return count > kMostTold ? fmt::format("  ... and {} more\n", count - kMostTold) : "";
}

// Where there is one setup only, nobody asks which.
std::string of_setup(const History& history, std::size_t setup) {
  return history.setups.size() < 2 ? "" : fmt::format(" [{}]", setup + 1);
}

std::string runs_table(const History& history) {
  std::string text = fmt::format("{:<20} {:<13} {:>7} {:>7} {:>7} {:>7} {:>9}  {}\n", "started", "verdict",
                                 "passed", "failed", "open", "not run", "time, s", "run");
  for (const HistoryRun& run : history.runs) {
    text += fmt::format("{:<20} {:<13} {:>7} {:>7} {:>7} {:>7} {:>9.1f}  {}{}\n", escaped_line(run.started),
                        judge::name(run.verdict), run.passed, run.failed, run.inconclusive, run.not_run,
                        static_cast<double>(run.wall_time_us) / 1e6, escaped_line(run.name),
                        of_setup(history, run.setup));
  }
  return text;
}

std::string setups_text(const History& history) {
  if (history.setups.size() < 2) return "";
  std::string text = "runs are compared with those of the same setup only:\n";
  for (std::size_t n = 0; n < history.setups.size(); ++n)
    text += fmt::format("  [{}] {}\n", n + 1, escaped_line(history.setups[n]));
  return text;
}

std::string verdicts_text(const FlakyCase& flaky) {
  constexpr std::size_t kMost = 12;
  const std::size_t first = flaky.verdicts.size() > kMost ? flaky.verdicts.size() - kMost : 0;
  std::string text = first > 0 ? "..." : "";
  for (std::size_t n = first; n < flaky.verdicts.size(); ++n)
    add_words(text, std::string(judge::name(flaky.verdicts[n].second)), " ");
  return text;
}

std::string flaky_text(const History& history) {
  if (history.flaky.empty()) return "";
  std::string text =
      fmt::format("flaky ({}): the verdict comes and goes under one suite\n", history.flaky.size());
  for (std::size_t n = 0; n < std::min(history.flaky.size(), kMostTold); ++n) {
    const FlakyCase& flaky = history.flaky[n];
    text += fmt::format("  {}{}: {}{}\n", escaped_line(flaky.id), of_setup(history, flaky.setup),
                        verdicts_text(flaky), flaky.has_equal_seeds ? ", also with equal seeds" : "");
  }
  return text + more_text(history.flaky.size());
}

std::string broken_text(const History& history) {
  if (history.broken.empty()) return "";
  std::string text = fmt::format("began to fail ({})\n", history.broken.size());
  for (std::size_t n = 0; n < std::min(history.broken.size(), kMostTold); ++n) {
    const BrokenCase& broken = history.broken[n];
    text += fmt::format("  {}{}: fails since {}, passed in {}  ({})\n", escaped_line(broken.id),
                        of_setup(history, broken.setup), escaped_line(history.runs[broken.first_bad].name),
                        escaped_line(history.runs[broken.last_good].name), escaped_line(broken.reason));
  }
  return text + more_text(history.broken.size());
}

std::string numbers_text(const History& history) {
  std::string text;
  std::size_t shown = 0;
  std::size_t worth = 0;
  for (const Quantity& quantity : history.quantities) {
    const Drifts drifts = history.drifts(quantity);
    if (drifts != Drifts::yes && drifts != Drifts::perhaps) continue;
    ++worth;
    if (++shown > kMostTold) continue;
    text += fmt::format("  {}{}: {:.6g} to {:.6g} {}, {}\n", escaped_line(quantity.name),
                        of_setup(history, quantity.setup), quantity.values.front().second,
                        quantity.values.back().second, escaped_line(quantity.unit),
                        drift_text(history, quantity));
  }
  const std::string title =
      fmt::format("measured numbers: {} in two runs or more, {} of them vary in {} runs or more\n",
                  history.quantities.size(), history.varying, kFewestForTrend);
  return title + text + more_text(worth);
}

std::string left_out_text(const History& history) {
  std::string text;
  if (history.found.older > 0)
    text += fmt::format("{} older runs are there, and not looked at\n", history.found.older);
  if (history.found.left_out.empty()) return text;
  text += fmt::format("left out ({})\n", history.found.left_out.size());
  for (const LeftOut& one : history.found.left_out)
    text += fmt::format("  {}: {}\n", escaped_line(one.name), escaped_line(one.why));
  return text;
}

HistoryJson run_json_of(const HistoryRun& run) {
  return {{"name", kernel::as_utf8(run.name)},
          {"started", kernel::as_utf8(run.started)},
          {"setup", run.setup},
          {"suite_version", kernel::as_utf8(run.suite_version)},
          {"seed", std::to_string(run.seed)},
          {"verdict", judge::name(run.verdict)},
          {"sentence", kernel::as_utf8(run.sentence)},
          {"passed", run.passed},
          {"failed", run.failed},
          {"inconclusive", run.inconclusive},
          {"not_run", run.not_run},
          {"wall_time_us", run.wall_time_us}};
}

HistoryJson flaky_json(const FlakyCase& flaky) {
  HistoryJson verdicts = HistoryJson::array();
  for (const auto& [run, verdict] : flaky.verdicts) verdicts.push_back({run, judge::name(verdict)});
  return {{"id", kernel::as_utf8(flaky.id)},
          {"setup", flaky.setup},
          {"suite_version", kernel::as_utf8(flaky.suite_version)},
          {"has_equal_seeds", flaky.has_equal_seeds},
          {"verdicts", std::move(verdicts)}};
}

HistoryJson quantity_json(const History& history, const Quantity& quantity) {
  constexpr std::array kWords = {"untested", "no", "perhaps", "yes"};
  HistoryJson values = HistoryJson::array();
  for (const auto& [run, value] : quantity.values) values.push_back({run, value});
  return {{"name", kernel::as_utf8(quantity.name)},
          {"unit", kernel::as_utf8(quantity.unit)},
          {"setup", quantity.setup},
          {"drifts", kWords.at(static_cast<std::size_t>(history.drifts(quantity)))},
          {"words", kernel::as_utf8(drift_text(history, quantity))},
          {"values", std::move(values)}};
}

}  // namespace

std::string drift_text(const History& history, const Quantity& quantity) {
  const Trend& trend = quantity.trend;
  const auto [least, most] =
      std::ranges::minmax(quantity.values, {}, &std::pair<std::size_t, double>::second);
  if (least.second == most.second) return "the same in all runs";
  const std::string how = fmt::format("by {:+.3g} {} from run to run (p = {:.2g})", trend.slope,
                                      quantity.unit, trend.probability);
  switch (history.drifts(quantity)) {
    case Drifts::untested:
      return fmt::format("too few runs to speak of a drift ({} of {})", trend.values, kFewestForTrend);
    case Drifts::no:
      return fmt::format("no drift to be seen (p = {:.2g})", trend.probability);
    case Drifts::perhaps:
      return fmt::format("may drift, {}, which chance shows among {} numbers as well", how, history.varying);
    case Drifts::yes:
      return "drifts " + how;
  }
  return "";
}

std::string history_text(const History& history) {
  return fmt::format("{} below {}, the oldest first\n", several(history.runs.size(), "run"),
                     escaped_line(history.folder)) +
         runs_table(history) + setups_text(history) + broken_text(history) + flaky_text(history) +
         numbers_text(history) + left_out_text(history);
}

nlohmann::ordered_json history_json(const History& history) {
  HistoryJson json = {{"folder", kernel::as_utf8(history.folder)},
                      {"runs", HistoryJson::array()},
                      {"setups", HistoryJson::array()},
                      {"flaky", HistoryJson::array()},
                      {"broken", HistoryJson::array()},
                      {"quantities", HistoryJson::array()},
                      {"counts",
                       {{"flaky", history.flaky.size()},
                        {"broken", history.broken.size()},
                        {"quantities", history.quantities.size()},
                        {"varying", history.varying},
                        {"older", history.found.older}}},
                      {"left_out", HistoryJson::array()}};
  for (const HistoryRun& run : history.runs) json["runs"].push_back(run_json_of(run));
  for (const std::string& setup : history.setups) json["setups"].push_back(kernel::as_utf8(setup));
  for (std::size_t n = 0; n < std::min(history.flaky.size(), kMostOnPage); ++n)
    json["flaky"].push_back(flaky_json(history.flaky[n]));
  for (std::size_t n = 0; n < std::min(history.broken.size(), kMostOnPage); ++n) {
    const BrokenCase& broken = history.broken[n];
    json["broken"].push_back({{"id", kernel::as_utf8(broken.id)},
                              {"setup", broken.setup},
                              {"last_good", broken.last_good},
                              {"first_bad", broken.first_bad},
                              {"reason", kernel::as_utf8(broken.reason)}});
  }
  for (std::size_t n = 0; n < std::min(history.quantities.size(), kMostQuantities); ++n)
    json["quantities"].push_back(quantity_json(history, history.quantities[n]));
  for (const LeftOut& one : history.found.left_out)
    json["left_out"].push_back({{"name", kernel::as_utf8(one.name)}, {"why", kernel::as_utf8(one.why)}});
  return json;
}

}  // namespace fieldproof::reports
