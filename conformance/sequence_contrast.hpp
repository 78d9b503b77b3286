#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "conformance/sequence.hpp"

// What decides whether a sequence fails: each of its settings, faults and numbers is left out or changed
// alone, and each command of which none of these decides. Of what decides there is a line with what was
// tried: "ms 20 in command 2, period: with 19 it passes, with 21 it fails, too".
namespace fieldproof::conformance {

// Runs a sequence: true when it fails for the reason that is asked about, false when it passes; nothing when
// it does neither, or when there is no time left.
using SequenceShows = std::function<std::optional<bool>(const Sequence&)>;

inline constexpr std::size_t kMostContrasts = 10;  // lines

// `smallest` fails, and nothing that it can do without is left in it.
std::vector<std::string> contrasts(const Sequence& smallest, const SequenceVocabulary& vocabulary,
                                   const SequenceShows& shows);

}  // namespace fieldproof::conformance
