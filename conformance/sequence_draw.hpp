#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "conformance/sequence.hpp"

// Random sequences of a vocabulary, drawn by RapidCheck.
//
// Contract: the n-th sequence of a seed is the same everywhere. Small sequences come first: lengths grow with
// n, up to the vocabulary's most. Each second one begins with one of its situations, and with a setting that
// shows there; of the others, each second one begins with one of its beginnings. Each third one has settings,
// which say nothing about its commands: mostly one, at an end of its range or beside it, and never such that
// the role objects to.
namespace fieldproof::conformance {

using SequenceFails = std::function<bool(const Sequence&)>;

class SequenceSource {
 public:
  // The vocabulary must outlive the source.
  SequenceSource(const SequenceVocabulary& vocabulary, std::uint64_t seed)
      : vocabulary_(vocabulary), seed_(seed) {}

  Sequence draw(std::uint64_t n) const;
  // The same sequence, or what RapidCheck's own steps make of it as long as it fails. Quick and coarse: it
  // does not look for the smallest.
  Sequence smaller(std::uint64_t n, const SequenceFails& still_fails) const;

 private:
  const SequenceVocabulary& vocabulary_;
  std::uint64_t seed_;
};

// So many, long ones among them, without their settings.
std::vector<Sequence> drawn_commands(const SequenceVocabulary& vocabulary, std::uint64_t seed,
                                     std::uint64_t count);

}  // namespace fieldproof::conformance
