// The telegram receiver fed with levels that are not as wide as its bits: it samples them.
//
// Input: kind and rate or refinement, number of cuts with the place of the first, step to the next, then the
// levels, eight to an octet. Invariants: at any refinement of the bits the telegrams are those of a
// bit-by-bit decoder, in any division; at any other rate with a grid the division changes nothing; at a rate
// without one the number of telegrams is bounded.

#include "fuzz/telegram_line.hpp"

namespace {

using fieldproof::fuzz::Cuts;
using fieldproof::fuzz::Hearing;
using fieldproof::fuzz::kBitRate;
using fieldproof::fuzz::Log;
using fieldproof::fuzz::OctetReader;
using fieldproof::line::Waveform;

constexpr std::size_t kLargestInput = 20;

// Rates with a whole number of picoseconds to a level: a cut lies on the grid of what it cuts.
constexpr std::array<std::int64_t, 16> kExactRates = {
    250'000,   400'000,   500'000,   512'000,   625'000,   800'000,    1'000'000,  1'250'000,
    2'000'000, 2'500'000, 3'125'000, 4'000'000, 5'000'000, 10'000'000, 12'500'000, 20'000'000};

// Levels to a bit, by the same reason.
constexpr std::array<unsigned, 8> kRefinements = {2, 4, 5, 8, 10, 16, 20, 25};

enum class Kind : std::uint8_t { refined, exact_rate, any_rate };

// Kept from one input to the next so that no input pays for its making.
struct Workplace {
  Hearing hearing;
  Waveform bits;  // the levels as the input has them
  Waveform line;  // at the rate in work
  Log expected;
  Log heard;
};

void refine(const Waveform& bits, unsigned times, Waveform& line) {
  line.rate = kBitRate * times;
  for (std::size_t n = 0; n < bits.levels.size(); ++n) {
    line.levels.append(bits.levels[n] ? ~std::uint64_t{0} : 0, times);
  }
}

void set_line(Workplace& place, Kind kind, unsigned rate) {
  place.line.levels.clear();
  if (kind == Kind::refined) return refine(place.bits, kRefinements[rate % kRefinements.size()], place.line);
  place.line.levels.append(place.bits.levels);
  place.line.rate = kind == Kind::exact_rate ? kExactRates[rate % kExactRates.size()]
                                             : 200'001 + 49'999 * std::int64_t{rate};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLargestInput) return -1;
  static Workplace place;
  OctetReader input(data, size);
  const std::uint8_t first = input.octet();
  const Kind kind = static_cast<Kind>(first % 3);
  const Cuts cuts = fieldproof::fuzz::read_cuts(input);
  place.bits.rate = kBitRate;
  place.bits.levels.clear();
  for (const std::uint8_t octet : input.take(kLargestInput)) place.bits.levels.append(octet, 8);
  set_line(place, kind, first / 3U);
  if (kind == Kind::refined) {
    Hearing::hear_bits(place.bits.levels, place.expected);
  } else {
    place.hearing.hear_whole(place.line, place.expected);
  }
  place.hearing.hear_divided(place.line, cuts, place.heard);
  FIELDPROOF_CHECK(kind == Kind::any_rate || place.heard.is_same(place.expected),
                   "the telegrams are those of the line, however it is divided");
  return 0;
}
