#include "conformance/token_bus/driven_frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::conformance {
namespace {

// Half bits of MAC symbols: IEEE 802.3 has a 1 rise in its middle, and a symbol is two of its bits.
constexpr std::string_view kOneHalves = "0110";
constexpr std::string_view kZeroHalves = "1001";
constexpr std::string_view kFirstNonData = "0101";
constexpr std::string_view kSecondNonData = "1010";
constexpr unsigned kOctetHalves = 32;
constexpr std::size_t kCrcOctets = 4;

std::string delimiter_text(bool is_end, bool more_follows, bool has_error) {
  const std::string_view mark = is_end ? kOneHalves : kZeroHalves;
  std::string text;
  for (unsigned n = 0; n < 2; ++n) text.append(kFirstNonData).append(kSecondNonData).append(mark);
  return text.append(more_follows ? kOneHalves : kZeroHalves).append(has_error ? kOneHalves : kZeroHalves);
}

const line::FrameCheck& crc_32() {
  static const line::FrameCheck check(line::frame_check_named("CRC-32/ISO-HDLC"));
  return check;
}

// The half bits of an octet, the first in bit 0.
constexpr std::uint32_t halves_of_octet(unsigned octet) {
  constexpr std::uint32_t kOne = 0b0110;
  constexpr std::uint32_t kZero = 0b1001;
  std::uint32_t halves = 0;
  for (unsigned bit = 0; bit < 8; ++bit) halves |= ((octet >> bit & 1U) != 0 ? kOne : kZero) << 4 * bit;
  return halves;
}

// Octets from a half bit on, until there is none. The second half bit of a symbol says which it would be.
Octets octets_from(const line::Levels& halves, std::size_t at) {
  Octets octets;
  for (; at + kOctetHalves <= halves.size(); at += kOctetHalves) {
    const auto window = static_cast<std::uint32_t>(halves.window(at));
    unsigned octet = 0;
    for (unsigned bit = 0; bit < 8; ++bit) octet |= (window >> (4 * bit + 1) & 1U) << bit;
    if (halves_of_octet(octet) != window) return octets;
    octets.push_back(static_cast<std::uint8_t>(octet));
  }
  return octets;
}

// Where the first start delimiter is.
std::optional<std::size_t> start_delimiter_in(const line::Levels& halves) {
  static const auto delimiter =
      static_cast<std::uint32_t>(line::Levels::of_text(delimiter_text(false, false, false)).window(0));
  for (std::size_t at = 0; at + kOctetHalves <= halves.size(); ++at)
    if (static_cast<std::uint32_t>(halves.window(at)) == delimiter) return at;
  return std::nullopt;
}

// Half bits are found in runs, so each may be a quarter too long: a transmission may not.
bool lasts(const line::Waveform& wave, std::size_t half_bits, std::int64_t rate) {
  const kernel::Duration right = kernel::levels_duration(static_cast<std::int64_t>(half_bits), rate);
  const kernel::Duration is = wave.end() - wave.start;
  const kernel::Duration stray = right / 1'000;
  return is >= right - stray && is <= right + stray;
}

constexpr std::array<std::pair<TokenControl, std::string_view>, 7> kControlNames{
    {{TokenControl::claim, "claim_token"},
     {TokenControl::solicit_1, "solicit_successor_1"},
     {TokenControl::solicit_2, "solicit_successor_2"},
     {TokenControl::who_follows, "who_follows"},
     {TokenControl::resolve, "resolve_contention"},
     {TokenControl::token, "token"},
     {TokenControl::set_successor, "set_successor"}}};

}  // namespace

bool DrivenFrame::is(TokenControl control_of) const {
  if (octets.empty() || octets[0] != static_cast<std::uint8_t>(control_of)) return false;
  if (is_data() || control_of == TokenControl::claim) return true;
  const bool has_address =
      control_of == TokenControl::who_follows || control_of == TokenControl::set_successor;
  return data().size() == (has_address ? address_octets : 0);
}

bool DrivenFrame::is_data() const {
  return !octets.empty() && (octets[0] & 0x03U) == 0x02;
}

// Its most significant bit goes first.
unsigned DrivenFrame::priority() const {
  return static_cast<unsigned>(line::reflect(control() >> 5U, 3));
}

std::uint64_t DrivenFrame::number(std::size_t at) const {
  std::uint64_t number = 0;
  for (std::size_t n = 0; n < address_octets && at + n < octets.size(); ++n)
    number |= std::uint64_t{octets[at + n]} << 8 * n;
  return number;
}

Octets DrivenFrame::data() const {
  const std::size_t head = 1 + 2 * std::size_t{address_octets};
  if (octets.size() <= head) return {};
  return {octets.begin() + static_cast<std::ptrdiff_t>(head), octets.end()};
}

std::string DrivenFrame::text() const {
  if (!is_well_formed) return fmt::format("{} octets in a frame that is none", octets.size());
  std::string name =
      is_data() ? fmt::format("data of priority {}", priority()) : fmt::format("{:02X}", control());
  for (const auto& [control_of, its_name] : kControlNames)
    if (is(control_of)) name = its_name;
  const unsigned digits = 2 * address_octets;
  std::string text = fmt::format("{} to {:0{}X} from {:0{}X}", name, destination(), digits, source(), digits);
  const Octets content = data();
  if (!content.empty()) {
    constexpr std::size_t kMostShown = 16;
    text += content.size() <= kMostShown ? fmt::format(": {:02X}", fmt::join(content, " "))
                                         : fmt::format(": {} octets", content.size());
  }
  return has_right_check ? text : text + " with a wrong check";
}

Octets with_crc_32(std::span<const std::uint8_t> octets) {
  Octets all(octets.begin(), octets.end());
  auto check = static_cast<std::uint32_t>(crc_32().compute(octets));
  for (std::size_t n = 0; n < kCrcOctets; ++n, check >>= 8) all.push_back(static_cast<std::uint8_t>(check));
  return all;
}

line::Levels half_bits_around(std::span<const std::uint8_t> octets, const FrameForm& form) {
  line::Levels levels;
  levels.make_room((form.preamble_octets + octets.size() + 2) * kOctetHalves);
  for (unsigned n = 0; n < form.preamble_octets; ++n) levels.append(halves_of_octet(0xFF), kOctetHalves);
  levels.append(line::Levels::of_text(delimiter_text(false, false, false)));
  for (const std::uint8_t octet : octets) levels.append(halves_of_octet(octet), kOctetHalves);
  levels.append(line::Levels::of_text(delimiter_text(true, form.more_follows, form.has_error)));
  return levels;
}

void DrivenFrames::on_wave(const line::Waveform& wave) {
  const line::Levels half_bits = line::half_bits_of(wave, phy_bit_rate_);
  DrivenFrame driven{.begin = wave.start, .end = wave.end(), .address_octets = address_octets_};
  const auto at = start_delimiter_in(half_bits);
  if (at && *at % kOctetHalves == 0) {
    driven.preamble_octets = static_cast<unsigned>(*at / kOctetHalves);
    driven.octets = octets_from(half_bits, *at + kOctetHalves);
    driven.is_well_formed =
        half_bits == half_bits_around(driven.octets, {.preamble_octets = driven.preamble_octets}) &&
        lasts(wave, half_bits.size(), 2 * phy_bit_rate_);
  }
  if (driven.octets.size() > kCrcOctets) {
    const std::span all(driven.octets);
    driven.has_right_check = with_crc_32(all.first(all.size() - kCrcOctets)) == driven.octets;
    driven.octets.resize(driven.octets.size() - kCrcOctets);
  }
  all_.push_back(std::move(driven));
}

}  // namespace fieldproof::conformance
