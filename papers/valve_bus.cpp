// The sections of Kim, Seo and Lee about the RS-485 valve bus. The paper prints no cycle time and no error
// figure: what stands here is what follows from its frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "emc/residual/block_check.hpp"
#include "emc/residual/block_check_count.hpp"
#include "emc/residual/residual_error.hpp"
#include "emc/resonance.hpp"
#include "harness/network/quiet_run.hpp"
#include "papers/sections.hpp"
#include "protocols/valve_bus/frame.hpp"
#include "protocols/valve_bus/running_network.hpp"
#include "protocols/valve_bus/timing.hpp"

namespace fieldproof::papers {
namespace {

using reports::PublishedRow;
using reports::PublishedSection;

constexpr double kLengthMetres = 1000;  // as published, without a repeater
constexpr std::size_t kCycles = 20;
constexpr kernel::Duration kQuickTurnRound = 200 * kernel::kMicrosecond;

double in_ms(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / 1e9;
}

// One bus of so many nodes: what the closed forms say, and what its stations do.
PublishedRow cycle_row(unsigned nodes, std::uint64_t seed) {
  const valve_bus::Rules rules;
  kernel::Duration least{};
  kernel::Duration reference{};
  for (unsigned n = 0; n < nodes; ++n) {
    const kernel::Duration distance = valve_bus::distance_of(rules, n, nodes, kLengthMetres);
    least += valve_bus::least_poll_time(rules, kQuickTurnRound, distance).total();
    reference += valve_bus::reference_poll_time(rules, distance).total();
  }
  valve_bus::NetworkDescription description = valve_bus::NetworkDescription::even(0, nodes, kLengthMetres);
  description.writes = false;
  valve_bus::RunningNetwork network(description, seed);
  const network::QuietRun run = network::run_quietly(network, kCycles, seed);
  const std::uint64_t errors = run.counts.detected + run.counts.retried + run.counts.accepted_wrong();
  const auto [shortest, longest] = std::ranges::minmax(run.cycles);
  const bool is_equal = std::chrono::abs(shortest - reference) <= nodes * kernel::kNanosecond &&
                        std::chrono::abs(longest - reference) <= nodes * kernel::kNanosecond;
  return {
      fmt::format("cycle over {} node{}, 375 kbit/s, {:g} m", nodes, nodes == 1 ? "" : "s", kLengthMetres),
      "",
      fmt::format("{:.4f} ms simulated, {} responses, {} errors", in_ms(longest), run.counts.sent, errors),
      fmt::format("closed form of these stations {:.4f} ms; {:.4f} ms if nodes turn round in 200 us and the "
                  "host is sure of silence at once",
                  in_ms(reference), in_ms(least)),
      is_equal && errors == 0};
}

struct CheckedFrameKind {
  std::string_view name;
  unsigned octets;
};
constexpr std::array kFrames = {CheckedFrameKind{"command", valve_bus::kCommandOctets},
                                CheckedFrameKind{"response", valve_bus::kResponseOctets}};

// Every pattern of so many flips tried, beside the exact number.
PublishedRow pattern_row(const CheckedFrameKind& frame) {
  constexpr unsigned kMostFlips = 6;
  const emc::BlockCheck check{frame.octets, false};
  const auto counted = emc::count_block_check_patterns(check, kMostFlips);
  const auto exact = emc::undetected_patterns(check, kMostFlips);
  bool is_equal = true;
  for (std::size_t k = 0; k <= kMostFlips; ++k) is_equal = is_equal && exact[k] == counted[k];
  return {fmt::format("{}: undetected patterns of 2, 4 and 6 flips", frame.name), "",
          fmt::format("{}, {}, {}", counted[2], counted[4], counted[6]),
          "all patterns of up to 6 flips tried; the exact numbers are the same", is_equal};
}

PublishedRow probability_row(const CheckedFrameKind& frame, double ber) {
  const emc::BlockCheck plain{frame.octets, false};
  const emc::BlockCheck with_parity{frame.octets, true};
  return {fmt::format("{}: taken although wrong, bit-error rate {:g}", frame.name, ber), "",
          fmt::format("{:.3g}", emc::undetected_error_probability(plain, ber)),
          fmt::format("{:.3g} with even parity per character",
                      emc::undetected_error_probability(with_parity, ber)),
          std::nullopt};
}

struct ScannedFormat {
  std::string_view name;
  line::CharacterFormat character;
  bool checks_parity;
};
constexpr std::array kScanned = {
    ScannedFormat{"P0, 11 bit", {8, line::Parity::mark, line::StopBits::one}, false},
    ScannedFormat{"P1, even parity", {8, line::Parity::even, line::StopBits::one}, true},
    ScannedFormat{"P2, 10 bit", {8, line::Parity::none, line::StopBits::one}, false},
};
constexpr kernel::Duration kWrongTime = 300 * kernel::kNanosecond;
constexpr std::uint64_t kFramesPerRate = 8'000;

double bits_of(const ScannedFormat& format) {
  return format.character.half_bits() / 2.0;
}

void add_resonances(const ScannedFormat& format, std::uint64_t seed, PublishedSection& section) {
  emc::CheckedFrameFormat frame;
  frame.character = format.character;
  frame.checks_parity = format.checks_parity;
  emc::PulseTrain pulses;
  pulses.effects = emc::pulse_effects(emc::ForcedLevel::drawn, kWrongTime);
  const emc::ResonanceScan scan =
      emc::resonance_scan(frame, pulses, {.from_hz = 80'000, .to_hz = 120'000, .step_hz = 250},
                          kFramesPerRate, kernel::Random(seed).split(format.name));
  std::uint64_t corrupted = 0;
  std::uint64_t undetected = 0;
  for (const emc::FrameCounts& rate : scan.rates) {
    corrupted += rate.corrupted;
    undetected += rate.undetected;
  }
  section.rows.push_back({fmt::format("{}: commands under 100 kHz, all rates within 20 %", format.name), "",
                          fmt::format("{} of {} corrupted ones taken ({:.2g})", undetected, corrupted,
                                      static_cast<double>(undetected) /
                                          static_cast<double>(std::max<std::uint64_t>(1, corrupted))),
                          "", std::nullopt});
  for (const std::size_t peak : scan.peaks) {
    const emc::FrameCounts& at = scan.rates[peak];
    section.rows.push_back({fmt::format("{}: in step at {:.2f} kHz", format.name, at.rate_hz / 1000), "",
                            fmt::format("{:.3f} of the corrupted commands taken", at.undetected_share()),
                            fmt::format("{:.2f} pulses a character", at.rate_hz * bits_of(format) / 375'000),
                            std::nullopt});
  }
}

}  // namespace

PublishedSection valve_bus_cycle_times(const Settings& settings) {
  PublishedSection section;
  section.heading = "Cycle time over the number of nodes";
  section.note =
      "The paper names 375 kbit/s over 1000 m without a repeater and prints no time. The simulation has "
      "propagation "
      "only: that it shows no error says nothing about attenuation.";
  for (const unsigned nodes : {1U, 8U, 16U, 31U, 62U, 99U}) {
    section.rows.push_back(cycle_row(nodes, settings.seed));
  }
  section.rows.push_back(
      {"nodes in a network", "256, and ID 1 to 99", "99 can be addressed",
       "the paper contradicts itself; a segment bears 31 nodes and the host, the paper says 32",
       std::nullopt});
  return section;
}

PublishedSection valve_bus_block_check(const Settings&) {
  PublishedSection section;
  section.heading = "What the block check does not see";
  section.note = "The paper gives no error figures. The formulas are those of the binary symmetric channel.";
  for (const CheckedFrameKind& frame : kFrames) section.rows.push_back(pattern_row(frame));
  for (const double ber : {1e-2, 1e-3, 1e-4, 1e-5}) {
    for (const CheckedFrameKind& frame : kFrames) section.rows.push_back(probability_row(frame, ber));
  }
  return section;
}

PublishedSection valve_bus_resonance(const Settings& settings) {
  PublishedSection section;
  section.heading = "Burst pulses in step with the characters: 80 to 120 kHz, 375 kbit/s";
  section.note =
      "The paper says that wrong data are very improbable. Under bursts of 100 kHz they are not: pulses that "
      "come "
      "each third of a character hit one column of several octets. Each pulse makes the line wrong for 300 "
      "ns, one "
      "way or the other; uncalibrated.";
  for (const ScannedFormat& format : kScanned) add_resonances(format, settings.seed, section);
  return section;
}

}  // namespace fieldproof::papers
