#include "harness/judge/verdict.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace fieldproof::judge {
namespace {

constexpr std::array<std::string_view, 7> kVerdictNames = {"none",         "not-applicable", "pass", "warn",
                                                           "inconclusive", "fail",           "error"};
constexpr std::array<std::string_view, 7> kStandingNames = {"seed",    "sure",   "searched", "calc",
                                                            "derived", "memory", "own"};

template <typename T>
std::optional<T> value_named(const std::array<std::string_view, 7>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<T>(found - names.begin());
}

}  // namespace

bool is_verified(Standing standing) {
  return standing < Standing::memory;
}

std::string_view name(Verdict verdict) {
  return kVerdictNames.at(static_cast<std::size_t>(verdict));
}

std::string_view name(Standing standing) {
  return kStandingNames.at(static_cast<std::size_t>(standing));
}

std::optional<Verdict> verdict_from(std::string_view name) {
  return value_named<Verdict>(kVerdictNames, name);
}

std::optional<Standing> standing_from(std::string_view name) {
  return value_named<Standing>(kStandingNames, name);
}

Reference resting_on_both(Reference whole, const Reference& part) {
  if (!whole.clause.empty()) whole.clause += "; ";
  whole.clause += part.source;
  if (!part.clause.empty()) whole.clause += ": " + part.clause;
  whole.standing = std::max(whole.standing, part.standing);
  return whole;
}

}  // namespace fieldproof::judge
