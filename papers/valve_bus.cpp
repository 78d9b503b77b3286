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
  const kernel::Duration farthest = reference - shortest > longest - reference ? shortest : longest;
  return {
      fmt::format("cycle over {} node{}, 375 kbit/s, {:g} m", nodes, nodes == 1 ? "" : "s", kLengthMetres),
      "",
      fmt::format("{:.4f} ms simulated, {} responses, {} errors", in_ms(longest), run.counts.sent, errors),
      fmt::format("closed form of these stations {:.4f} ms; {:.4f} ms if nodes turn round in 200 us and the "
                  "host is sure of silence at once",
                  in_ms(reference), in_ms(least)),
      reports::own(
          reports::within(in_ms(reference), nodes * in_ms(kernel::kNanosecond), in_ms(farthest), "ms"))};
}

// What both ends of a bus of TIA-485-A and the cylinders of the paper have.
constexpr unsigned kUnitLoads = 32;
constexpr unsigned kSolenoids = 8;
constexpr unsigned kCylinders = 8;

// The share of the single bit errors of a command that the check sees and that hit the ID.
double wrong_ids_of_single_errors() {
  const auto sent = octets_of(valve_bus::Command{.id = 7, .command = 0, .data0 = 0xA5, .data1 = 0x3C});
  unsigned seen = 0;
  unsigned of_id = 0;
  for (std::size_t bit = 0; bit < 8 * sent.size(); ++bit) {
    auto received = sent;
    received[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    if (valve_bus::block_check(received) == 0) continue;
    ++seen;
    if (received[0] != sent[0]) ++of_id;
  }
  return static_cast<double>(of_id) / seen;
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
  unsigned unlike = 0;
  for (std::size_t k = 0; k <= kMostFlips; ++k) unlike += exact[k] == counted[k] ? 0U : 1U;
  return {fmt::format("{}: undetected patterns of 2, 4 and 6 flips", frame.name), "",
          fmt::format("{}, {}, {}", counted[2], counted[4], counted[6]),
          "all patterns of up to 6 flips tried, beside the exact numbers",
          reports::own(reports::within(0, 0, unlike, "unlike"))};
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

// The largest share of corrupted commands that are taken at one rate.
double add_resonances(const ScannedFormat& format, std::uint64_t seed, PublishedSection& section) {
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
  double largest = 0;
  for (const std::size_t peak : scan.peaks) {
    const emc::FrameCounts& at = scan.rates[peak];
    largest = std::max(largest, at.undetected_share());
    section.rows.push_back({fmt::format("{}: in step at {:.2f} kHz", format.name, at.rate_hz / 1000), "",
                            fmt::format("{:.3f} of the corrupted commands taken", at.undetected_share()),
                            fmt::format("{:.2f} pulses a character", at.rate_hz * bits_of(format) / 375'000),
                            std::nullopt});
  }
  return largest;
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
  return section;
}

PublishedSection valve_bus_sentences(const Settings&) {
  PublishedSection section;
  section.heading = "What the paper says of its frames and nodes, beside its own numbers";
  section.note = "Where a sentence contradicts an address, a frame or a check of the same paper, it DIFFERS.";
  const valve_bus::Rules rules;
  const unsigned addresses = rules.last_address - rules.first_address + 1;
  const double wrong_ids = wrong_ids_of_single_errors();
  section.rows = {
      {"nodes in a network", "256", fmt::format("{} can be addressed", addresses), "ID 1 to 99",
       reports::within(256, 0, addresses, "nodes")},
      {"nodes of a segment", "32", fmt::format("{}, and the host", kUnitLoads - 1),
       "32 unit loads, of which the host is one", reports::within(32, 0, kUnitLoads - 1, "nodes")},
      {"\"ID and COMMAND are set to 0\"", "ID 0", fmt::format("ID {} is the least", rules.first_address),
       "ID 0 is nobody's; read as COMMAND 0", reports::within(0, 0, rules.first_address, "ID")},
      {"octets of data for 8 solenoids", "2", "1", "a bit for each; read as two drive boards",
       reports::within(2, 0, kSolenoids / 8, "octets")},
      {"bits for switches at both ends of 8 cylinders", "8", fmt::format("{}", 2 * kCylinders),
       "a bit for each; read as two octets", reports::within(8, 0, 2 * kCylinders, "bits")},
      {"who retransmits after a wrong block check", "the node that is meant",
       fmt::format("the ID is wrong as well in {:.0f} % of single errors", 100 * wrong_ids),
       "a receiver cannot know who is meant; the host polls and refreshes",
       reports::at_most(0, 100 * wrong_ids, "%")}};
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
  double largest = 0;
  for (const ScannedFormat& format : kScanned)
    largest = std::max(largest, add_resonances(format, settings.seed, section));
  section.rows.push_back({"wrong data that are taken", "very improbable",
                          fmt::format("{:.1f} % of the corrupted commands, in step", 100 * largest),
                          "very improbable is read as 1 % of what is corrupted",
                          reports::at_most(1, 100 * largest, "%")});
  return section;
}

}  // namespace fieldproof::papers
