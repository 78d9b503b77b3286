// What `--iut` says: who plays which role.
//
//   ref                          the reference, in the role of each case
//   mutant:crc_preset_zero      the reference with one mutant; its role is the only one that has it
//   exec:./node --fast           a process; unix:PATH and tcp:HOST:PORT: who listens there
//   own                          what a program with suites of its own brings along
//   slave=mutant:late           the role is said
//   slave@3=mutant:late         and the position: 1 is next to the master
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

// Throws kernel::Error(usage) for an unknown kind, role, position or mutant, with the nearest one, and for
// two that want the same place. `among` are the selected cases: a bare mutant is looked for in their
// roles. `last_position` where it is not 0 takes the place of what the suites say.
std::vector<conformance::Assignment> parse_implementations(std::span<const std::string> texts,
                                                           const conformance::Catalogue& catalogue,
                                                           std::span<const conformance::Entry> among,
                                                           std::size_t last_position = 0);
// Throws kernel::Error(usage) for one whose role takes part in none of these cases, where there are any.
void expect_parts(std::span<const conformance::Assignment> implementations,
                  std::span<const conformance::Entry> among);
// For verbs that look at positions themselves.
inline constexpr std::size_t kAnyPosition = 1'000'000;

// The same for an assignment that a case file of this suite stores: why it cannot be served, or nothing.
std::optional<std::string> reason_not_runnable(const conformance::Assignment& assignment,
                                               const conformance::Suite& suite,
                                               std::size_t last_position = 0);

}  // namespace fieldproof::cli
