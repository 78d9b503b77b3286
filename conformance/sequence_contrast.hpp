#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/sequence.hpp"
#include "harness/judge/finding.hpp"

// What decides whether a sequence fails: each of its settings, faults and numbers is left out or changed
// alone, and each command of which none of these decides. Of what decides there is a line with what was
// tried: "ms 20 in command 2, period: with 19 it passes, with 21 it fails, too". Octets are not changed.
// Equal commands in a row are one, as where a finding lists them. A sequence may also pass because from some
// command on nobody can say what is right.
namespace fieldproof::conformance {

enum class Shown {
  alike,      // it fails for the reason that is asked about
  otherwise,  // it fails for another one
  passes,
  not_judged,  // it is not applicable, or inconclusive
  not_tried    // there is no time left
};
Shown shown_by(const judge::CaseResult& result, std::string_view reason);

using SequenceShows = std::function<Shown(const Sequence&)>;

inline constexpr std::size_t kMostContrasts = 10;      // lines
inline constexpr std::size_t kMostContrastRuns = 100;  // a last line says when that was too few

// `smallest` fails; what it can do without it should have lost before.
std::vector<std::string> contrasts(const Sequence& smallest, const SequenceVocabulary& vocabulary,
                                   const SequenceShows& shows);

}  // namespace fieldproof::conformance
