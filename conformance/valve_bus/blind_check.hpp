#pragma once

#include <cstdint>
#include <string_view>

#include "conformance/judging.hpp"

// What the block check of this bus cannot see, and what is taken wrong for it. That is a weakness of the bus
// and no fault of who is judged: such a pass is a warn.
namespace fieldproof::conformance {

inline constexpr std::string_view kCheckDoesNotSeeIt = "check_does_not_see_it";

// Of so many that were wrong, so many were taken: "8 of 17 hit writes were taken wrong: an exclusive or does
// not see ...". Says nothing where none was.
inline void warn_of_blind_check(CaseJudge& judge, std::uint64_t taken, std::uint64_t wrong,
                                std::string_view what) {
  if (taken == 0) return;
  judge.warn(kCheckDoesNotSeeIt,
             {{"no wrong data are taken"},
              fmt::format("{} of {} {}: an exclusive or does not see an even number of errors in a column",
                          taken, wrong, what)});
}

}  // namespace fieldproof::conformance
