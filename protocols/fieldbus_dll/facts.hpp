#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/judge/verdict.hpp"

// The table of sources of a profile: each number of its rules with where it comes from and how far it can be
// trusted.
namespace fieldproof::fieldbus_dll {

struct Fact {
  std::string_view rule;
  std::string value;        // as a person reads it, with unit
  std::string_view source;  // in own words
  judge::Standing standing;
};

template <typename Rules>
struct FactRow {
  std::string_view rule;
  std::string (*value)(const Rules&);
  std::string_view source;
  judge::Standing standing;
};

inline constexpr std::string_view kSourceVendors =
    "vendors' tables of link parameters: inside of their range";
inline constexpr std::string_view kSourceMemory = "IEC 61158, from memory";
inline constexpr std::string_view kSourceOwn = "this project's choice";
inline constexpr std::string_view kSourceChanged = "changed for this run";

// A value that differs from the reference's has the standing `own`.
template <typename Rules>
std::vector<Fact> facts_of(std::span<const FactRow<Rules>> rows, const Rules& rules) {
  std::vector<Fact> all;
  for (const FactRow<Rules>& row : rows) {
    Fact& fact = all.emplace_back(Fact{row.rule, row.value(rules), row.source, row.standing});
    if (fact.value == row.value(Rules{})) continue;
    fact.source = kSourceChanged;
    fact.standing = judge::Standing::own;
  }
  return all;
}

}  // namespace fieldproof::fieldbus_dll
