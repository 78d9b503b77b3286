#pragma once

#include <algorithm>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/test_case.hpp"

// What a basic station of a data link does, a link master does in standby: the same cases and sequences for
// it, under ids of their own. The mutants of a basic station play a link master that is never anything else.
namespace fieldproof::conformance {

struct Standby {
  std::string_view of_station;                // "fieldbus_dll/ff_device/"
  std::string_view of_master;                 // "fieldbus_dll/ff_las/standby/"
  std::span<const std::string_view> without;  // cases of a station that are none of a link master
};

// In front of the name of a mutant of a basic station that plays a link master.
inline constexpr std::string_view kStandbyMutant = "standby_";

void put_in_standby(TestCase& test_case, const Standby& standby);
void put_in_standby(MustCatch& caught);
// `words` makes the vocabulary one of a link master.
SequenceRole sequences_in_standby(SequenceRole of_station, const Standby& standby,
                                  void (*words)(SequenceVocabulary&));

// `all`: cases of both roles.
template <typename Case>
std::vector<Case> cases_in_standby(const std::vector<Case>& all, const Standby& standby) {
  std::vector<Case> made;
  for (const Case& one : all) {
    const std::string& id = one.test_case.id;
    if (!id.starts_with(standby.of_station) || is_canary(one.test_case) ||
        std::ranges::find(standby.without, id) != standby.without.end())
      continue;
    Case& in_standby = made.emplace_back(one);
    put_in_standby(in_standby.test_case, standby);
    in_standby.needs.is_in_standby = true;
    if (in_standby.asked_with) in_standby.asked_with->is_in_standby = true;
  }
  return made;
}

bool is_caught(std::string_view mutant, const std::vector<MustCatch>& catches);

// Of the mutants of a station those that a case or the sequences of a link master in standby catch.
template <typename Table, typename Case>
std::vector<typename Table::Row> mutants_in_standby(const Table& of_station, const std::vector<Case>& cases,
                                                    const SequenceRole& sequences) {
  static std::deque<std::string> texts;
  std::vector<typename Table::Row> rows;
  for (const typename Table::Row& row : of_station.rows()) {
    const std::string& name = texts.emplace_back(std::string(kStandbyMutant) + std::string(row.name));
    const bool is_of_case =
        std::ranges::any_of(cases, [&](const Case& one) { return is_caught(name, one.test_case.catches); });
    const bool is_of_sequences = std::ranges::any_of(
        sequences.derived_catches, [&](const DerivedCatch& one) { return one.caught.mutant == name; });
    if (!is_of_case && !is_of_sequences) continue;
    const std::string& text = texts.emplace_back("in standby: " + std::string(row.description));
    rows.push_back({name, row.label, text, row.make});
  }
  return rows;
}

}  // namespace fieldproof::conformance
