#include "harness/judge/verdict.hpp"

#include <array>

namespace fieldproof::judge {
namespace {

constexpr std::array<std::string_view, 7> kVerdictNames = {"none",         "not-applicable", "pass", "warn",
                                                           "inconclusive", "fail",           "error"};
constexpr std::array<std::string_view, 7> kStandingNames = {"seed",    "sure",   "searched", "calc",
                                                            "derived", "memory", "own"};

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
  for (std::size_t i = 0; i < kVerdictNames.size(); ++i) {
    if (kVerdictNames.at(i) == name) return static_cast<Verdict>(i);
  }
  return std::nullopt;
}

}  // namespace fieldproof::judge
