#include "cli/detection_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace fieldproof::cli {
namespace {

using conformance::Detection;
using conformance::DetectionTable;
using conformance::MutantDetections;
using nlohmann::ordered_json;

// Of those that were found, in ascending order.
std::vector<std::uint64_t> commands_to_find(const MutantDetections& mutant) {
  std::vector<std::uint64_t> all;
  for (const Detection& one : mutant.by_seed)
    if (one.found) all.push_back(*one.found);
  std::ranges::sort(all);
  return all;
}

std::optional<std::uint64_t> first_trigger(const MutantDetections& mutant) {
  std::optional<std::uint64_t> first;
  for (const Detection& one : mutant.by_seed)
    if (one.triggered && (!first || *one.triggered < *first)) first = one.triggered;
  return first;
}

// The seeds may find it by different reasons; the first one's stands for them.
std::string reason_of(const MutantDetections& mutant) {
  const auto found =
      std::ranges::find_if(mutant.by_seed, [](const Detection& one) { return one.found.has_value(); });
  return found == mutant.by_seed.end() ? "" : found->reason;
}

std::string row_text(const MutantDetections& mutant, std::size_t width) {
  const std::vector<std::uint64_t> commands = commands_to_find(mutant);
  const std::string found = fmt::format("{} of {}", commands.size(), mutant.by_seed.size());
  if (commands.empty()) return fmt::format("  {:<{}}  {:>8}\n", mutant.mutant->name, width, found);
  return fmt::format("  {:<{}}  {:>8}  {:>10}  {:>10}  {}\n", mutant.mutant->name, width, found,
                     commands[commands.size() / 2], commands.back(), reason_of(mutant));
}

std::string missed_text(const MutantDetections& mutant) {
  const auto trigger = first_trigger(mutant);
  const std::string what =
      trigger ? fmt::format("what it does differs after {} commands, and nothing compares it", *trigger)
              : std::string("no sequence made it do anything else than the reference");
  const std::string suite =
      mutant.suite_catch.empty() ? "" : fmt::format("; found by {}", mutant.suite_catch);
  return fmt::format("not found: {} ({}): {}{}\n", mutant.mutant->name, mutant.mutant->description, what,
                     suite);
}

ordered_json number_or_null(const std::optional<std::uint64_t>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json mutant_json(const MutantDetections& mutant) {
  ordered_json seeds = ordered_json::array();
  for (const Detection& one : mutant.by_seed) {
    seeds.push_back({{"commands", one.commands},
                     {"triggered", number_or_null(one.triggered)},
                     {"found", number_or_null(one.found)},
                     {"reason", one.reason}});
  }
  return {{"name", mutant.mutant->name},
          {"description", mutant.mutant->description},
          {"suite_catch", mutant.suite_catch},
          {"seeds", std::move(seeds)}};
}

}  // namespace

bool is_detected_enough(const DetectionTable& table) {
  return static_cast<double>(table.found()) >= kLeastDetected * static_cast<double>(table.pairs());
}

std::string detection_text(const DetectionTable& table) {
  std::string text =
      fmt::format("{}: {} mutants, sequences of check, {} seeds from {} on, at most {} commands each\n",
                  table.role, table.mutants.size(), table.seeds, table.first_seed, table.most_commands);
  std::size_t width = 6;
  for (const MutantDetections& one : table.mutants) width = std::max(width, one.mutant->name.size());
  text += fmt::format("  {:<{}}  {:>8}  {:>10}  {:>10}  reason\n", "mutant", width, "found", "commands",
                      "at most");
  for (const MutantDetections& one : table.mutants) text += row_text(one, width);
  for (const MutantDetections& one : table.mutants)
    if (commands_to_find(one).size() < one.by_seed.size()) text += missed_text(one);
  for (const std::string& one : table.false_alarms)
    text += fmt::format("the reference was accused, {}\n", one);
  if (!table.is_complete) text += "the table is incomplete\n";
  const double share = table.pairs() == 0
                           ? 0
                           : 100.0 * static_cast<double>(table.found()) / static_cast<double>(table.pairs());
  return text +
         fmt::format("{}: found {} of {} ({:.1f} %)\n\n", table.role, table.found(), table.pairs(), share);
}

std::string detection_json(std::span<const DetectionTable> tables) {
  ordered_json json{{"schema", "fieldproof/detection/1"}, {"roles", ordered_json::array()}};
  for (const DetectionTable& table : tables) {
    ordered_json mutants = ordered_json::array();
    for (const MutantDetections& one : table.mutants) mutants.push_back(mutant_json(one));
    json["roles"].push_back({{"role", table.role},
                             {"first_seed", std::to_string(table.first_seed)},
                             {"seeds", table.seeds},
                             {"most_commands", table.most_commands},
                             {"complete", table.is_complete},
                             {"found", table.found()},
                             {"of", table.pairs()},
                             {"false_alarms", table.false_alarms},
                             {"mutants", std::move(mutants)}});
  }
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
