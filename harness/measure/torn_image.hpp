#pragma once

#include <cstdint>
#include <vector>

#include "harness/kernel/time.hpp"

// Counts torn process images: instants from which on the words of one image, that were all taken from inputs
// at one instant, show different edges of one signal.
//
// Contract: words are told in the order of their instants, those of one instant in any order; an image is
// looked at when all words of its instant are there, that is when a later instant comes or at `finish`. An
// image of one word cannot be torn.
namespace fieldproof::measure {

class TornImageCounter {
 public:
  explicit TornImageCounter(std::size_t words) : shown_(words, 0) {}

  // The word shows this edge from now on.
  void on_word(std::size_t word, kernel::Time when, std::uint64_t edge);
  void finish();

  std::uint64_t torn_images() const { return torn_images_; }
  std::uint64_t images() const { return images_; }

 private:
  std::vector<std::uint64_t> shown_;
  kernel::Time when_{};
  bool is_open_ = false;
  std::uint64_t torn_images_ = 0;
  std::uint64_t images_ = 0;
};

}  // namespace fieldproof::measure
