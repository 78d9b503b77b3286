#include "harness/line/delimited_frame.hpp"

#include <array>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {
namespace {

using enum Symbol;

constexpr std::uint8_t kPreambleOctet = 0xAA;
constexpr std::array kStartDelimiter{one,  non_data_plus,  non_data_minus, one,
                                     zero, non_data_minus, non_data_plus,  zero};
constexpr std::array kEndDelimiter{
    one, non_data_plus, non_data_minus, non_data_plus, non_data_minus, one, zero, one};
constexpr std::size_t kDelimiterLevels = 2 * kStartDelimiter.size();

Levels delimiter_levels(const ManchesterCode& code, std::span<const Symbol> symbols) {
  Levels levels;
  for (const Symbol symbol : symbols) code.append(levels, symbol);
  return levels;
}

class FrameFinder {
 public:
  explicit FrameFinder(const Levels& half_bits)
      : half_bits_(half_bits), code_(shared_code()), start_(of(kStartDelimiter)), end_(of(kEndDelimiter)) {}

  std::vector<DelimitedFrame> find() {
    std::vector<DelimitedFrame> frames;
    for (std::size_t at = 0; at + kDelimiterLevels <= half_bits_.size();) {
      if (!is(start_, at)) {
        ++at;
        continue;
      }
      frames.push_back({.half_bit = at, .octets = {}});
      at = read(frames.back(), at + kDelimiterLevels);
    }
    return frames;
  }

 private:
  static constexpr std::uint64_t kDelimiterMask = (std::uint64_t{1} << kDelimiterLevels) - 1;

  // Its table is made once: many stations look into each transmission.
  static const ManchesterCode& shared_code() {
    static const ManchesterCode code{ManchesterLayout{}};
    return code;
  }
  std::uint64_t of(std::span<const Symbol> delimiter) const {
    return delimiter_levels(code_, delimiter).window(0) & kDelimiterMask;
  }
  bool is(std::uint64_t delimiter, std::size_t at) const {
    return at + kDelimiterLevels <= half_bits_.size() &&
           (half_bits_.window(at) & kDelimiterMask) == delimiter;
  }

  // Returns where to look for the next one.
  std::size_t read(DelimitedFrame& frame, std::size_t at) const {
    unsigned bits = 0;
    unsigned octet = 0;
    for (; at + 2 <= half_bits_.size(); at += 2) {
      if (is(end_, at)) {
        frame.end = bits == 0 ? FrameEnd::whole : FrameEnd::cut_octet;
        return at + kDelimiterLevels;
      }
      if (is(start_, at)) {
        frame.end = FrameEnd::begun_anew;
        return at;
      }
      const Symbol symbol = code_.symbol_of(half_bits_[at], half_bits_[at + 1]);
      if (!is_data(symbol)) {
        frame.end = FrameEnd::code_violation;
        return at;
      }
      octet = octet << 1 | (symbol == one ? 1U : 0U);
      if (++bits < 8) continue;
      frame.octets.push_back(static_cast<std::uint8_t>(octet));
      bits = octet = 0;
    }
    return at;
  }

  const Levels& half_bits_;
  const ManchesterCode& code_;
  std::uint64_t start_;
  std::uint64_t end_;
};

}  // namespace

void DelimitedFrameCode::append(Levels& levels, std::span<const std::uint8_t> octets,
                                unsigned preamble_octets) const {
  FIELDPROOF_CHECK(preamble_octets >= 1 && preamble_octets <= kMostPreambleOctets,
                   "a preamble has 1 to 8 octets");
  for (unsigned n = 0; n < preamble_octets; ++n) code_.append_octet(levels, kPreambleOctet);
  for (const Symbol symbol : kStartDelimiter) code_.append(levels, symbol);
  for (const std::uint8_t octet : octets) code_.append_octet(levels, octet);
  for (const Symbol symbol : kEndDelimiter) code_.append(levels, symbol);
}

std::string_view text_of(FrameEnd end) {
  switch (end) {
    case FrameEnd::whole:
      return "whole";
    case FrameEnd::code_violation:
      return "code violation";
    case FrameEnd::cut_octet:
      return "part of an octet";
    case FrameEnd::begun_anew:
      return "begun anew";
    case FrameEnd::signal_lost:
      return "signal lost";
  }
  return "";
}

// In whole numbers: a run of n levels at `rate` has n * 2 * bit_rate / rate half bits.
Levels half_bits_of(const Waveform& wave, std::int64_t bit_rate) {
  __extension__ using Wide = __int128;
  const Wide rate = wave.rate;
  // Written half bit by half bit, as stations do, it is what it is.
  if (rate == 2 * static_cast<Wide>(bit_rate)) return wave.levels;
  Levels half_bits;
  for (std::size_t at = 0; at < wave.levels.size();) {
    const std::size_t end = wave.levels.end_of_run(at);
    const Wide half_bits_of_run = (2 * static_cast<Wide>(end - at) * 2 * bit_rate + rate) / (2 * rate);
    half_bits.append_fill(wave.levels[at], static_cast<std::size_t>(half_bits_of_run));
    at = end;
  }
  return half_bits;
}

std::vector<DelimitedFrame> delimited_frames_in(const Waveform& wave, std::int64_t bit_rate) {
  if (wave.rate == 2 * bit_rate) return FrameFinder(wave.levels).find();  // without a copy
  return FrameFinder(half_bits_of(wave, bit_rate)).find();
}

Waveform turned(const Waveform& wave) {
  Waveform other = wave;
  other.levels.invert(0, other.levels.size());
  return other;
}

}  // namespace fieldproof::line
