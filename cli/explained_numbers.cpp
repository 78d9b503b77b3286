#include "cli/explained_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <utility>
#include <vector>

#include "conformance/derived_cases.hpp"
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

constexpr std::string_view kAboutSequences =
    "  A run takes others of them with each seed, whose number differs a little, and fills up with "
    "sequences\n"
    "  about two things at once. How many transitions of states there are is asked of the reference: the\n"
    "  result of that case says it.\n";

// Nothing where this is no role of which cases are derived.
std::string sequences_of(const conformance::Catalogue& catalogue, std::string_view role) {
  std::string text;
  for (const auto& suite : catalogue.suites()) {
    for (const conformance::RoleRow& row : suite->role_rows()) {
      if (fmt::format("{}/{}", suite->protocol(), row.name) != role) continue;
      for (const auto* const sequences : {&row.sequences, &row.more_sequences}) {
        if (!*sequences) continue;
        for (const conformance::DerivedExtent& one : conformance::derived_extents((*sequences)->role))
          text += fmt::format("  {:<68} {:>9} {:>7} {:>7}\n", one.id, one.there_are, one.quick, one.full);
      }
    }
  }
  if (text.empty()) return text;
  return fmt::format("\n{:<70} {:>9} {:>7} {:>7}\n{}{}", "sequences about one thing", "there are", "quick",
                     "full", text, kAboutSequences);
}

}  // namespace

std::optional<std::string> explained_numbers(const conformance::Catalogue& catalogue, std::string_view word) {
  const Tables tables = tables_of(catalogue);
  for (const auto& [place, table] : tables) {
    if (place == word)
      return fmt::format("{}\n\n{}{}", place, field::columns_of(*table), sequences_of(catalogue, place));
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
