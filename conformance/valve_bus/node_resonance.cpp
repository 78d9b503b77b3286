#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "conformance/valve_bus/blind_check.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// Pulses in step with the characters. Where some pulses last as long as a character, they hit the same bit of
// every character of a frame, and an exclusive or cannot see what they do to a column. The tester writes the
// pulses into what it drives: each forces the line low, as one polarity of a burst does.
//
// Low is what a column of zeros is, and the exclusive or of zeros fits: a write whose column is hit is taken,
// with that column 0. A node that refuses it has another check or takes its bits elsewhere; one that takes
// most of what is hit out of step does not check.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;

constexpr std::int64_t kLevelsPerBit = 64;
constexpr std::uint8_t kAllOn = 0xFF;
// Covers the three samples of a receiver, and a sixteenth of a bit on both sides by which its clock is late.
constexpr double kPulseBits = 0.25;
constexpr double kPulsesInStep = 3;  // a character

// 80 to 120 kHz at 375 kbit/s; at other rates the pulses come as often in a bit.
constexpr double kScannedBitsPerMillisecond = 375;
constexpr double kFromKilohertz = 80;
constexpr double kToKilohertz = 120;
// The flank of a maximum is that wide: there pulses drift by a fifth of a bit a character, as wide as they
// are.
constexpr double kFlankKilohertz = 2;

struct Pulses {
  double first_bits = 0;  // the begin of one of them, from the first start bit on
  double pitch_bits = 0;
};

double bits_of_character(const NodeBench& bench) {
  return character_format(bench.rules()).half_bits() / 2.0;
}

// All pulses from the first start bit to the last stop bit.
void force_low(line::Levels& levels, const Pulses& pulses) {
  const auto level = [](double bits) { return std::int64_t{std::llround(bits * kLevelsPerBit)}; };
  const auto size = static_cast<std::int64_t>(levels.size());
  for (double n = -std::ceil(pulses.first_bits / pulses.pitch_bits);; ++n) {
    const double begin_bits = pulses.first_bits + n * pulses.pitch_bits;
    const std::int64_t begin = std::max<std::int64_t>(0, level(begin_bits));
    if (begin >= size) return;
    const std::int64_t end = std::min(size, level(begin_bits + kPulseBits));
    if (begin < end) levels.fill(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), false);
  }
}

// Every valve is off, and under these pulses comes the write that switches all of them on. What the valves
// are then: off where it was refused. DATA0 and DATA1 are equal, so that hits are hidden by each other only
// where they come a character apart; other data would be hidden at half of that pitch, too.
std::uint16_t valves_under(NodeBench& bench, const Pulses& pulses) {
  bench.write(0, 0);
  bench.await_response_window();
  const auto frame = octets_of(valve_bus::Command{
      bench.address(), static_cast<std::uint8_t>(bench.rules().write_command), kAllOn, kAllOn});
  line::Waveform wave;
  wave.rate = bench.rules().bit_rate * kLevelsPerBit;
  for (const std::uint8_t octet : frame) wave.levels.append_stretched(bench.levels_of(octet), kLevelsPerBit);
  force_low(wave.levels, pulses);
  bench.drive(wave);
  bench.await_response_window();
  return bench.valves();
}

// ---- in step ----

struct Column {
  unsigned bit;  // of the octets
  Pulses pulses;
};

// A pulse late in a stop bit is a start bit that comes too early.
bool leaves_stop_bits(const Pulses& pulses, double character_bits) {
  for (unsigned n = 0; n < kPulsesInStep; ++n) {
    const double end = std::fmod(pulses.first_bits + n * pulses.pitch_bits + kPulseBits, character_bits);
    if (end > character_bits - 0.5 || end < kPulseBits) return false;
  }
  return true;
}

// The columns that pulses in step can hit while the node is still meant: its address has a 0 there.
std::vector<Column> columns_of(const NodeBench& bench) {
  std::vector<Column> columns;
  const double character_bits = bits_of_character(bench);
  for (unsigned bit = 0; bit < 8; ++bit) {
    const double middle = 1 + bit + 0.5;  // behind the start bit
    const Pulses pulses{middle - kPulseBits / 2, character_bits / kPulsesInStep};
    const bool is_meant = (bench.address() >> bit & 1U) == 0;
    if (is_meant && leaves_stop_bits(pulses, character_bits)) columns.push_back({bit, pulses});
  }
  return columns;
}

// Writes that were not taken as sent, and of them those with wrong data.
struct HitWrites {
  unsigned hit = 0;
  unsigned taken = 0;
};

// Each bit is taken in its middle: a pulse there takes a column, the two others of a character nothing.
HitWrites expect_columns_lost(NodeBench& bench, CaseJudge& judge) {
  std::vector<std::pair<unsigned, std::uint16_t>> seen;
  for (const Column& column : columns_of(bench))
    seen.emplace_back(column.bit, valves_under(bench, column.pulses));
  const std::uint16_t sent = bench.valves_of(kAllOn, kAllOn);
  if (std::ranges::all_of(seen, [&](const auto& one) { return one.second == sent; })) {
    judge.inconclusive("nothing_was_hit", {{"pulses of a quarter of a bit change bits"}, "none was changed"});
  }
  // What was taken otherwise says more than what was refused.
  std::ranges::stable_partition(seen, [](const auto& one) { return one.second != 0; });
  for (const auto& [bit, valves] : seen) {
    const auto left = static_cast<std::uint8_t>(~(1U << bit));
    const std::uint16_t wanted = bench.valves_of(left, left);
    judge.expect(valves == wanted, valves == 0 ? "in_step_refused" : "hit_elsewhere", [&] {
      return Mismatch{
          {fmt::format("{}: bit {} of each octet is 0, and the check fits", valves_text(wanted), bit)},
          valves_text(valves)};
    });
  }
  const auto all = static_cast<unsigned>(seen.size());
  return {all, all};
}

// ---- the scan ----

struct PitchCounts {
  double kilohertz = 0;
  HitWrites writes;
};

// The phases of the pulses are spread over a pitch, so that each place in a bit is met.
PitchCounts counts_at(NodeBench& bench, double kilohertz, unsigned writes) {
  PitchCounts counts{kilohertz, {}};
  const double pitch_bits = kScannedBitsPerMillisecond / kilohertz;
  for (unsigned n = 0; n < writes; ++n) {
    const double phase = (n + bench.random().uniform()) / writes;
    const std::uint16_t valves = valves_under(bench, {phase * pitch_bits, pitch_bits});
    if (valves == bench.valves_of(kAllOn, kAllOn)) continue;
    ++counts.writes.hit;
    if (valves != 0) ++counts.writes.taken;
  }
  return counts;
}

// In step the address loses its ones, too, and then the write is another node's. With many of them the most
// writes are taken a little out of step, where the address just stays.
bool can_be_scanned(std::uint8_t address) {
  constexpr int kMostOnes = 3;
  return std::popcount(address) <= kMostOnes;
}

bool takes_less(const PitchCounts& a, const PitchCounts& b) {
  return a.writes.taken < b.writes.taken;
}

void judge_scan(const PitchCounts& peak, const PitchCounts& other, double in_step, CaseJudge& judge) {
  judge.measure("maximum in step", "kHz", peak.kilohertz);
  judge.measure("writes taken with wrong data there", "", peak.writes.taken);
  judge.measure("of writes that were hit there", "", peak.writes.hit);
  judge.measure("most writes taken with wrong data elsewhere", "", other.writes.taken);
  judge.expect(peak.writes.taken >= other.writes.taken, "maximum_elsewhere", [&] {
    return Mismatch{
        {fmt::format("most writes are taken with wrong data at {:.1f} kHz, where three pulses last "
                     "a character",
                     in_step)},
        fmt::format("{} of {} there, {} of {} at {:.1f} kHz", peak.writes.taken, peak.writes.hit,
                    other.writes.taken, other.writes.hit, other.kilohertz)};
  });
}

HitWrites scan_pitches(NodeBench& bench, CaseJudge& judge) {
  const double in_step = kPulsesInStep * kScannedBitsPerMillisecond / bits_of_character(bench);
  const double step = bench.volume(0.5, 0.25);
  std::vector<PitchCounts> near;
  std::vector<PitchCounts> far;
  for (double kilohertz = kFromKilohertz; kilohertz <= kToKilohertz; kilohertz += step) {
    const double distance = std::abs(kilohertz - in_step);
    if (distance > step && distance < kFlankKilohertz) continue;
    (distance > step ? far : near).push_back(counts_at(bench, kilohertz, bench.volume(24U, 120U)));
  }
  PitchCounts peak = *std::ranges::max_element(near, takes_less);
  PitchCounts other = *std::ranges::max_element(far, takes_less);
  if (other.writes.taken >= peak.writes.taken) {  // by chance, or not: the phases are drawn
    constexpr unsigned kCloserLook = 480;
    peak = counts_at(bench, peak.kilohertz, kCloserLook);
    other = counts_at(bench, other.kilohertz, kCloserLook);
  }
  judge_scan(peak, other, in_step, judge);
  return peak.writes;
}

void pulses_in_step_pass_the_check(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::process_side);
  expect_serves(bench, judge);
  HitWrites in_step = expect_columns_lost(bench, judge);
  if (can_be_scanned(bench.address())) {
    const HitWrites scanned = scan_pitches(bench, judge);
    in_step.hit += scanned.hit;
    in_step.taken += scanned.taken;
  } else {
    judge.measure("pitches that were scanned at this address", "", 0);
  }
  expect_serves(bench, judge);
  warn_of_blind_check(judge, in_step.taken, in_step.hit, "hit writes in step were taken with wrong data");
}

NodeCase resonance_case(std::string_view length, CharacterProfile characters, std::string_view kilohertz) {
  return {
      {.id = fmt::format("valve_bus/node/immunity/pulses_in_step_with_{}_bits_pass_the_check", length),
       .purpose = "RN-40",
       .requirement = "Pulses of which three last a character hit one column of all octets, which the "
                      "block check cannot see: the write is taken without that column. No other pitch from "
                      "80 to 120 kHz makes a node take more wrong writes.",
       .reference = valve_sources::calculated("three pulses a character hit one column of every octet"),
       .details = {{valve_sources::derived("a bit is sampled in its middle"), {"hit_elsewhere"}}},
       .stimulus =
           "Writes under pulses that force the line low for a quarter of a bit: three a character, in "
           "the middle of each data bit; then each pitch of a scan, at all phases.",
       .expected = fmt::format("In step the column is 0 and nothing else is wrong; the most wrong writes are "
                               "taken at {} kHz, as at 375 kbit/s.",
                               kilohertz),
       .tags = {"must"},
       .catches = {{"samples_bits_early", "hit_elsewhere"},
                   {"samples_bits_late", "hit_elsewhere"},
                   {"write_not_checked", "maximum_elsewhere"}},
       .not_applicable = for_characters(std::string(text_of(characters)))},
      pulses_in_step_pass_the_check,
      {.characters = characters}};
}

}  // namespace

std::vector<NodeCase> node_resonance_cases() {
  return {resonance_case("eleven", CharacterProfile::ninth_bit_one, "102.3"),
          resonance_case("ten", CharacterProfile::eight_bits, "112.5")};
}

}  // namespace fieldproof::conformance
