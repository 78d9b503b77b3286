#include "cli/explained_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <utility>
#include <vector>

#include "harness/config/nearest.hpp"
#include "harness/field/written_table.hpp"
#include "harness/kernel/error.hpp"
#include "harness/network/acceptance.hpp"

namespace fieldproof::cli {
namespace {

using Tables = std::vector<std::pair<std::string, const field::AnyTable*>>;

Tables tables_of(const conformance::Catalogue& catalogue) {
  Tables tables;
  for (const auto& suite : catalogue.suites()) {
    for (const field::NamedTable& one : suite->tables()) {
      tables.emplace_back(fmt::format("{}/{}", suite->protocol(), one.name), one.table);
    }
  }
  tables.emplace_back("network/acceptance", &network::kAcceptanceTable);
  return tables;
}

// Roles of a protocol that share a row have it said once.
std::string explained_row(const Tables& tables, std::string_view name) {
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;
  for (const auto& [place, table] : tables) {
    const auto text = field::explained(*table, name);
    if (!text) continue;
    if (!texts.empty() && texts.back().first == *text) {
      texts.back().second.push_back(place);
    } else {
      texts.push_back({*text, {place}});
    }
  }
  std::string all;
  for (const auto& [text, places] : texts) {
    all += fmt::format("{}{}\nof\n  {}\n", all.empty() ? "" : "\n", text, fmt::join(places, ", "));
  }
  return all;
}

}  // namespace

std::optional<std::string> explained_numbers(const conformance::Catalogue& catalogue, std::string_view word) {
  const Tables tables = tables_of(catalogue);
  for (const auto& [place, table] : tables) {
    if (place == word) return fmt::format("{}\n\n{}", place, field::columns_of(*table));
  }
  if (word.find('/') != std::string_view::npos) return std::nullopt;
  std::string text = explained_row(tables, word);
  if (!text.empty()) return text;
  std::set<std::string> names;
  for (const auto& [place, table] : tables) {
    for (const field::WrittenRow& row : field::written_rows(*table)) names.insert(row.name);
  }
  const std::vector<std::string> candidates(names.begin(), names.end());
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no test case, role or number '{}'; the nearest numbers are {}",
                                  word, fmt::join(config::nearest(word, candidates, 3), ", ")));
}

}  // namespace fieldproof::cli
