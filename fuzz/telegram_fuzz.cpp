// The telegram receiver fed with arbitrary levels as wide as bits, in any division into waveforms.
//
// Input: number of cuts with the place of the first, step to the next, then the levels, eight to an octet.
// Invariant: the telegrams are those of a bit-by-bit decoder, however the line is divided.

#include "fuzz/telegram_line.hpp"

using fieldproof::fuzz::Cuts;
using fieldproof::fuzz::Hearing;
using fieldproof::fuzz::Log;
using fieldproof::fuzz::OctetReader;
using fieldproof::line::Waveform;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargestInput = 64;
  if (size > kLargestInput) return -1;
  static Hearing hearing;
  static Waveform wave;
  static Log expected;
  static Log heard;
  OctetReader input(data, size);
  const Cuts cuts = fieldproof::fuzz::read_cuts(input);
  wave.rate = fieldproof::fuzz::kBitRate;
  wave.levels.clear();
  for (const std::uint8_t octet : input.take(kLargestInput)) wave.levels.append(octet, 8);
  Hearing::hear_bits(wave.levels, expected);
  hearing.hear_divided(wave, cuts, heard);
  FIELDPROOF_CHECK(heard.is_same(expected), "the telegrams are those of the line, however it is divided");
  return 0;
}
