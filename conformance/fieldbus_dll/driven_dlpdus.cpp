#include "conformance/fieldbus_dll/driven_dlpdus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kHeader = 3;
constexpr std::size_t kCheck = 2;

// 1 falls in the middle of the bit; N+ stays high, N- low.
constexpr std::string_view kPreambleOctet = "1001100110011001";
constexpr std::string_view kStartDelimiter = "1011001001001101";
constexpr std::string_view kEndDelimiter = "1011001100100110";

const line::FrameCheck& frame_check() {
  static const line::FrameCheck check(line::frame_check_named("CRC-16/PROFIBUS"));
  return check;
}

// Follows exactly, with any of the lengths that a preamble may have?
bool is_exact(const line::Levels& half_bits, std::span<const std::uint8_t> octets) {
  const std::size_t without_preamble = half_bits_of_frame(octets, 0).size();
  if (half_bits.size() <= without_preamble) return false;
  const std::size_t preamble = (half_bits.size() - without_preamble) / kPreambleOctet.size();
  return preamble >= 1 && preamble <= line::kMostPreambleOctets &&
         half_bits == half_bits_of_frame(octets, static_cast<unsigned>(preamble));
}

// Both ends of what is long: the recording has it whole.
std::string octets_text(const Octets& octets) {
  constexpr std::ptrdiff_t kFirst = 16;
  constexpr std::ptrdiff_t kLast = 4;
  constexpr std::size_t kMost = 32;
  if (octets.size() <= kMost) return fmt::format("{:02X}", fmt::join(octets, " "));
  return fmt::format("{:02X} ... {:02X}, {} octets", fmt::join(octets.begin(), octets.begin() + kFirst, " "),
                     fmt::join(octets.end() - kLast, octets.end(), " "), octets.size());
}

}  // namespace

Octets DrivenDlpdu::rest() const {
  if (octets.size() <= kHeader) return {};
  return {octets.begin() + kHeader, octets.end()};
}

std::string DrivenDlpdu::text() const {
  std::string text = octets_text(octets);
  if (!is_well_formed) return text + " in a frame that is none";
  return has_right_check ? text : text + " with a wrong check";
}

Octets with_frame_check(std::span<const std::uint8_t> octets) {
  Octets all(octets.begin(), octets.end());
  const auto check = static_cast<unsigned>(frame_check().compute(octets));
  all.push_back(static_cast<std::uint8_t>(check >> 8));
  all.push_back(static_cast<std::uint8_t>(check & 0xFF));
  return all;
}

line::Levels half_bits_of_frame(std::span<const std::uint8_t> octets, unsigned preamble_octets) {
  static const line::Levels preamble = line::Levels::of_text(kPreambleOctet);
  static const line::Levels start = line::Levels::of_text(kStartDelimiter);
  static const line::Levels end = line::Levels::of_text(kEndDelimiter);
  // The first half of a bit is what it is, the second one the opposite; the first level in bit 0.
  constexpr std::uint64_t kOne = 0b01;
  constexpr std::uint64_t kZero = 0b10;
  line::Levels levels;
  for (unsigned n = 0; n < preamble_octets; ++n) levels.append(preamble);
  levels.append(start);
  for (const std::uint8_t octet : octets) {
    for (unsigned bit = 8; bit-- > 0;) levels.append((octet >> bit & 1) != 0 ? kOne : kZero, 2);
  }
  levels.append(end);
  return levels;
}

void DrivenDlpdus::on_wave(const line::Waveform& wave) {
  const line::Levels half_bits = line::half_bits_of(wave, bit_rate_);
  const std::vector<line::DelimitedFrame> frames = line::delimited_frames_in(wave, bit_rate_);
  // Of several frames in a transmission each is received; a station may send one only.
  std::size_t taken = 0;
  for (const line::DelimitedFrame& frame : frames) {
    const bool is_whole = frame.end == line::FrameEnd::whole;
    if (frames.size() > 1 && !is_whole) continue;
    DrivenDlpdu driven{wave.start, wave.end(), false, false, frame.octets};
    driven.is_well_formed = frames.size() == 1 && is_whole && is_exact(half_bits, frame.octets);
    if (driven.octets.size() > kCheck) {
      const std::span all(driven.octets);
      driven.has_right_check = with_frame_check(all.first(all.size() - kCheck)) == driven.octets;
      driven.octets.resize(driven.octets.size() - kCheck);
    }
    all_.push_back(std::move(driven));
    ++taken;
  }
  if (taken == 0) all_.push_back({wave.start, wave.end(), false, false, {}});
}

}  // namespace fieldproof::conformance
