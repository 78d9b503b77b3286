#include "fuzz/link_line.hpp"

#include <utility>

#include "fuzz/script.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/random.hpp"
#include "harness/line/delimited_frame.hpp"

namespace fieldproof::fuzz {
namespace {

constexpr std::size_t kLinkCheckOctets = 2;

// Bit by bit, the most significant bit of each octet first.
std::uint16_t link_check(std::span<const std::uint8_t> octets) {
  constexpr unsigned kPolynomial = 0x1DCF;
  unsigned check = 0xFFFF;
  for (const std::uint8_t octet : octets) {
    check ^= static_cast<unsigned>(octet) << 8;
    for (int bit = 0; bit < 8; ++bit) {
      check = (check & 0x8000U) != 0 ? (check << 1 ^ kPolynomial) & 0xFFFFU : check << 1 & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(~check & 0xFFFFU);
}

}  // namespace

std::vector<LinkOctets> link_frames_in(const line::Waveform& wave, const fieldbus_dll::LinkRules& rules) {
  std::vector<LinkOctets> good;
  for (line::DelimitedFrame& frame : line::delimited_frames_in(wave, rules.bit_rate)) {
    if (frame.end != line::FrameEnd::whole || frame.octets.size() <= kLinkCheckOctets) continue;
    const std::size_t size = frame.octets.size() - kLinkCheckOctets;
    const unsigned check = link_check(std::span(frame.octets).first(size));
    if (frame.octets[size] != check >> 8 || frame.octets[size + 1] != (check & 0xFFU)) continue;
    frame.octets.resize(size);
    good.push_back(std::move(frame.octets));
  }
  return good;
}

void append_link_frame(line::Levels& levels, std::span<const std::uint8_t> octets, unsigned preamble_octets) {
  LinkOctets all(octets.begin(), octets.end());
  const unsigned check = link_check(octets);
  all.push_back(static_cast<std::uint8_t>(check >> 8));
  all.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  line::DelimitedFrameCode().append(levels, all, preamble_octets);
}

void LinkEar::on_wave(const line::Waveform& wave) {
  const auto frames = link_frames_in(wave, rules_);
  FIELDPROOF_CHECK(frames.size() == 1, "a station drives whole frames with a right check, one at a time");
  said_.push_back({wave.start, frames.front()});
}

LinkLine::LinkLine(const fieldbus_dll::LinkRules& rules, std::uint8_t seed)
    : link_(rules),
      medium_(segment_, "line", segment::ContentionRule::noise, kernel::Random(seed)),
      place_of_tester_(&medium_.attach("tester/in", segment_.attach(tester_, "tester"), 0, {})) {}

void LinkLine::pass(kernel::Duration duration) {
  segment_.run_for(duration);
  follow(segment_.now());
}

void LinkLine::drive(line::Levels levels, std::int64_t rate, std::uint8_t flip) {
  if (levels.empty()) return;
  flip_level(levels, flip);
  line::Waveform wave{segment_.now(), rate, std::move(levels)};
  const kernel::Time end = wave.end();
  on_begin(segment_.now());
  place_of_tester_->drive(wave);
  segment_.run_until(end);
  follow(end);
}

void LinkLine::send(std::span<const std::uint8_t> octets, std::uint8_t flip, unsigned preamble_octets) {
  line::Levels levels;
  append_link_frame(levels, octets, preamble_octets);
  drive(std::move(levels), 2 * link_.bit_rate, flip);
}

void LinkLine::send_together(OctetReader& input, std::uint8_t flip) {
  line::Levels levels;
  const unsigned count = input.octet() % 3U + 1;
  for (unsigned n = 0; n < count; ++n) {
    const std::uint8_t shape = input.octet();
    append_link_frame(levels, input.take(shape % 16U), (shape >> 4) % line::kMostPreambleOctets + 1U);
  }
  drive(std::move(levels), 2 * link_.bit_rate, flip);
}

void LinkLine::levels(OctetReader& input, std::int64_t rate, std::uint8_t flip) {
  line::Levels levels;
  append_levels(input, levels);
  drive(std::move(levels), rate, flip);
}

}  // namespace fieldproof::fuzz
