#include "conformance/fieldbus_dll/link_transmission.hpp"

#include <array>
#include <utility>

#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kHalfBitsOfOctet = 16;

}  // namespace

line::Levels half_bits_with_other_check(const Octets& octets, unsigned kind) {
  const line::FrameCheckParameters right = line::frame_check_named("CRC-16/PROFIBUS");
  std::array variants{right,
                      right,
                      right,
                      right,
                      line::frame_check_named("CRC-16/IBM-3740"),
                      line::frame_check_named("CRC-16/GENIBUS")};
  variants[0].xorout = variants[2].xorout = 0;
  variants[1].init = variants[2].init = 0;
  variants[3].refin = variants[3].refout = true;
  if (kind >= variants.size()) {
    Octets exchanged = with_frame_check(octets);
    std::swap(exchanged.end()[-2], exchanged.end()[-1]);
    return half_bits_of_frame(exchanged);
  }
  Octets checked = octets;
  const auto check = static_cast<unsigned>(line::FrameCheck(variants.at(kind)).compute(octets));
  checked.push_back(static_cast<std::uint8_t>(check >> 8));
  checked.push_back(static_cast<std::uint8_t>(check & 0xFF));
  return half_bits_of_frame(checked);
}

line::Waveform jittered(LinkBench& bench, const line::Levels& half_bits) {
  constexpr std::int64_t kFiner = 100;
  constexpr std::uint64_t kMost = 20;
  line::Waveform wave{bench.now(), 2 * bench.link().bit_rate * kFiner, {}};
  std::size_t written = 0;
  for (std::size_t at = 0; at < half_bits.size();) {
    const std::size_t end = half_bits.end_of_run(at);
    std::size_t edge = end * kFiner;
    if (end < half_bits.size()) edge += bench.random().below(2 * kMost + 1) - kMost;
    wave.levels.append_fill(half_bits[at], edge - written);
    written = edge;
    at = end;
  }
  return wave;
}

line::Waveform clocked(const LinkBench& bench, const line::Levels& half_bits, std::int64_t per_mille) {
  return {bench.now(), 2 * bench.link().bit_rate * per_mille / 1'000, half_bits};
}

line::Levels frame_of_link(const LinkBench& bench, const Octets& octets) {
  return half_bits_of_frame(with_frame_check(octets), bench.link().preamble_octets);
}

line::Levels begun_within_an_octet(const LinkBench& bench, const Octets& octets, std::size_t bits) {
  const line::Levels whole = frame_of_link(bench, octets);
  const std::size_t preamble = bench.link().preamble_octets * kHalfBitsOfOctet;
  line::Levels levels;
  levels.append(whole, 0, preamble + 2 * kHalfBitsOfOctet + 2 * bits);
  levels.append(whole, preamble, whole.size() - preamble);
  return levels;
}

line::Levels in_front_of(const line::Levels& frame, std::size_t kind, std::size_t half_bits) {
  constexpr std::size_t kCutFrame = 3;
  line::Levels levels;
  if (kind == kCutFrame) {
    const std::size_t cut = frame.size() / 2 - frame.size() / 2 % 2;
    levels.append(frame, 0, cut);
    levels.append_fill(!levels[cut - 1], 2 + half_bits);
  }
  for (std::size_t n = 0; n < half_bits && kind < kCutFrame; ++n)
    levels.append_fill(kind == 0 || (kind == 1 ? n % 2 == 1 : n / 2 % 2 == 0), 1);
  levels.append(frame, 0, frame.size());
  return levels;
}

line::Levels with_tail(const LinkBench& bench, const Octets& octets, std::size_t tail) {
  line::Levels levels = frame_of_link(bench, octets);
  for (std::size_t n = 0; n < tail * kHalfBitsOfOctet / 2; ++n) levels.append(n % 3 == 0 ? 0b10 : 0b01, 2);
  return levels;
}

line::Waveform with_pulse(LinkBench& bench, const Octets& octets) {
  constexpr std::int64_t kLevelsUnderBursts = 4'000'000;  // a second
  const line::Levels half_bits = frame_of_link(bench, octets);
  const auto fine = static_cast<std::size_t>(kLevelsUnderBursts / (2 * bench.link().bit_rate));
  line::Waveform wave{bench.now(), kLevelsUnderBursts, {}};
  for (std::size_t n = 0; n < half_bits.size(); ++n) wave.levels.append_fill(half_bits[n], fine);
  const std::size_t half_bit = 2 * kHalfBitsOfOctet + bench.random().below(half_bits.size() / 2);
  wave.levels.flip(half_bit * fine + fine / 4);
  return wave;
}

SequenceWord link_received() {
  return {.word = "received",
          .meaning =
              "data of 200 octets for its user, with so many octets of preamble, up to 8, 9 and 10: by "
              "a clock that is 0.2 % fast, or slow, 11: with edges that are up to a tenth of a bit off",
          .numbers = {{"how", 1, kEdgesAreOff, 1}, link_silence()},
          .weight = 4,
          .is_no_frame = true};
}

void send_received(LinkBench& bench, const Octets& octets, std::int64_t how) {
  constexpr std::int64_t kFast = 1'002;
  constexpr std::int64_t kSlow = 998;
  const unsigned preamble = how <= kMostPreamble ? static_cast<unsigned>(how) : bench.link().preamble_octets;
  const line::Levels half_bits = half_bits_of_frame(with_frame_check(octets), preamble);
  if (how == kEdgesAreOff) {
    bench.send_wave(jittered(bench, half_bits));
  } else {
    bench.send_wave(clocked(bench, half_bits,
                            how == kClockIsFast   ? kFast
                            : how == kClockIsSlow ? kSlow
                                                  : 1'000));
  }
}

SequenceWord link_in_front() {
  return {.word = "in_front",
          .meaning =
              "data for its user, and in front so many half bits that are no preamble: 0: of one level, 1: "
              "alternating, 2: two and two, 3: a frame that they cut off",
          .numbers = {{"kind", 0, kKindsInFront - 1, 0}, {"half_bits", 1, kMostInFront, 1}, link_silence()},
          .weight = 4,
          .is_no_frame = true};
}

void send_in_front(LinkBench& bench, const Octets& octets, std::int64_t kind, std::int64_t half_bits) {
  bench.send_half_bits(in_front_of(frame_of_link(bench, octets), static_cast<std::size_t>(kind),
                                   static_cast<std::size_t>(half_bits)));
}

SequenceWord link_checked() {
  return {.word = "checked",
          .meaning =
              "a token for the station with the check of another kind of line: without complement, "
              "beginning with 0, both, reflected, CCITT, CCITT with complement, its octets exchanged",
          .numbers = {{"kind", 0, kOtherChecks - 1, 0}, link_silence()},
          .weight = 3,
          .is_no_frame = true};
}

}  // namespace fieldproof::conformance
