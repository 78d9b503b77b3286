#pragma once

#include <cstdint>
#include <optional>

// Words that tell which edge of a signal they show. Bit 0 is the signal itself, high after an odd number of
// edges; the other bits number the edges, so that what appears at an output can be matched to what was at the
// input also where pulses are lost. Numbers are multiplied by an odd constant: words of neighbouring edges
// differ in many bits, and a word that mixes two of them, or in which bits are wrong, is hardly ever the word
// of a recent edge.
//
// Limits: with b bits the numbers repeat every 2^b edges; a number is read as the latest one that fits.
namespace fieldproof::measure {

class EdgeCode {
 public:
  // 1 to 16 bits; with one bit a lost pulse cannot be seen.
  explicit EdgeCode(unsigned bits = 16);

  std::uint16_t word(std::uint64_t edges) const;
  // The latest number of edges, at most `newest`, with this word; nothing when there has been none.
  std::optional<std::uint64_t> edges(std::uint16_t word, std::uint64_t newest) const;

 private:
  std::uint64_t mask_;
};

}  // namespace fieldproof::measure
