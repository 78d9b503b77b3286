#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/comparison/twin_line.hpp"
#include "conformance/decoded_lines.hpp"
#include "conformance/line_bench.hpp"
#include "conformance/valve_bus/arrived_frames.hpp"
#include "conformance/valve_bus/declarations.hpp"
#include "conformance/valve_bus/driven_line.hpp"
#include "conformance/valve_bus/valve_ledger.hpp"
#include "harness/judge/pics.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/valve_block.hpp"

// The bench of one case for a local node of the valve bus: a line with the implementation under test (IUT),
// the lower tester in the place of the host module and of all other nodes, and the upper tester at the IUT's
// boards.
//
// The lower tester drives what the case says, character by character, and hears what the IUT drives as it
// leaves it. Verdicts rest on that and on the valves. Each case begins with a node that has been powered for
// a while and holds all valves off.
namespace fieldproof::conformance {

// What a case needs around the IUT.
struct NodeNeeds {
  std::optional<unsigned> tens{};  // of the address switches; absent: those of the PICS
  std::optional<unsigned> units{};
  std::optional<unsigned> boards{};
  std::optional<valve_bus::CharacterProfile> characters{};
  std::optional<std::int64_t> bit_rate{};
  std::optional<bool> answers_writes{};
  std::optional<kernel::Duration> loss_limit{};
  kernel::Duration distance{};  // propagation between tester and IUT
  bool is_powered = true;       // when the case begins
};

// Without a maker the reference plays.
using NodeSetting = PlannedSetting<valve_bus::NodeDevice, valve_bus::NodeConfiguration>;

// The configuration of the IUT under these needs; `pics` has an answer to each item.
valve_bus::NodeConfiguration node_configuration(const NodeNeeds& needs, const judge::Pics& pics);
// Throws kernel::Error(configuration) for a node that cases cannot judge.
void expect_judgeable(const valve_bus::NodeConfiguration& node);

// The instants that a case has judged.
struct InstantLedger {
  std::uint64_t sure = 0;
  std::uint64_t in_doubt = 0;           // closer to a limit than they are known
  kernel::Duration greatest_doubt{};    // of all of them
  kernel::Duration least_doubt_open{};  // of those in doubt
};

class NodeBench final : public LineBench {
 public:
  using Octets = std::vector<std::uint8_t>;

  NodeBench(const NodeNeeds& needs, const NodeSetting& setting);

  const valve_bus::Rules& rules() const { return configuration_.rules; }
  const valve_bus::NodeConfiguration& configuration() const { return configuration_; }
  const judge::Pics& pics() const { return pics_; }
  std::uint8_t address() const;
  kernel::Duration bits(std::int64_t count) const { return valve_bus::bits(rules(), count); }
  kernel::Duration characters(double count) const;
  kernel::Duration delimiter() const { return valve_bus::delimiter(rules()); }
  // How much later what is driven reaches the IUT.
  kernel::Duration distance() const { return distance_; }

  // What the bench can do with this IUT; the case does not apply where it cannot do what is required.
  iut::Capabilities capabilities() const { return node_->capabilities(); }
  void require(bool iut::Capabilities::* what) const;

  // ---- upper tester ----
  valve_bus::ValveBlock& boards() { return boards_; }
  std::uint16_t valves() { return boards_.output_at(0, now()); }
  // What the valves were told and what they did, up to now.
  const ValveLedger& ledger();
  // The valves that DATA0 and DATA1 drive at this node.
  std::uint16_t valves_of(std::uint8_t data0, std::uint8_t data1) const;
  void set_power(bool is_on);
  // Power comes, and the node has had the time to start that it declares.
  void power_up();

  // ---- lower tester ----
  // The octets without a gap, from now on, and runs until they are over. Gives that instant.
  kernel::Time send(std::span<const std::uint8_t> octets);
  kernel::Time send(std::initializer_list<std::uint8_t> octets) {
    return send(std::span(octets.begin(), octets.size()));
  }
  kernel::Time send(const valve_bus::Command& command) { return send(octets_of(command)); }
  // The octets of a write that moves every valve.
  std::array<std::uint8_t, valve_bus::kCommandOctets> telling_write();
  // A valid command for the IUT.
  kernel::Time write(std::uint8_t data0, std::uint8_t data1);
  kernel::Time read();
  // A read, and the time for its answer.
  void ask();
  // As long as the IUT may take to act on what it has heard, and to have said it.
  void await_response_window();
  // Silence after a write until the next frame may come: a delimiter, or the whole answer of a node that
  // answers writes and a delimiter after it.
  void wait_after_write();
  // Levels as they are, from now on, at any rate; runs until they are over.
  void drive(line::Waveform& wave);
  // The character as levels, one a bit.
  line::Levels levels_of(std::uint8_t octet) const;
  // Other sender's clock: the rate of characters that are sent from now on; 1 is nominal.
  void set_clock(double factor) { clock_ = factor; }
  // Gives a character to the line while the IUT may be driving; does not run.
  void interject(std::span<const std::uint8_t> octets, kernel::Time start);

  // What the IUT has driven since `forget`.
  std::vector<Transmission> answers() { return driven_.transmissions(); }
  bool has_driven() const { return !driven_.empty(); }
  // How uncertain the instants of an answer and of the last moves of the valves are.
  iut::TimingUncertainty doubt_of(const Transmission& answer) const {
    return node_->uncertainty_of_answer(answer.driver_on);
  }
  iut::TimingUncertainty uncertainty_of_valves() const { return node_->uncertainty_of_valves(); }
  // An instant that a case looked at could be judged, or lay closer to its limit than it is known.
  void note_instant(bool is_sure, const iut::TimingUncertainty& doubt);
  const InstantLedger& instants() const { return instants_; }
  void keep_instants(const InstantLedger& ledger) { instants_ = ledger; }
  // What has arrived at the IUT since then.
  std::span<const ArrivedFrame> arrived() const { return arrived_.frames(); }
  void clear_observations();
  // Passes on each reception of the IUT when it is over.
  PassingTap& arrivals() { return arrivals_; }

  // ---- stress ----
  void begin_stress(const fault::Stress& stress) {
    begin_stress_at(stress, place(), rules().bit_rate, now());
  }

  // The case is over. What the IUT does then is still its verdict.
  void finish() { node_->end(); }
  // The last transmissions of the tester and of the IUT and the last moves of the valves, in words.
  std::vector<std::string> decode_lines();

 private:
  NodeBench(const NodeNeeds& needs, const NodeSetting& setting, judge::Pics pics);
  void keep_writes();

  judge::Pics pics_;
  valve_bus::NodeConfiguration configuration_;
  DecodedLines supply_;
  kernel::Duration distance_;
  valve_bus::CharacterCodec codec_;
  valve_bus::ValveBlock boards_;
  ValveLedger ledger_;
  std::unique_ptr<valve_bus::NodeDevice> node_;
  DrivenLine driven_;
  DrivenLine sent_;  // by the tester; the last of it
  ArrivedFrames arrived_;
  PassingTap arrivals_;
  kernel::Duration settling_;
  double clock_ = 1.0;
  InstantLedger instants_;
};

}  // namespace fieldproof::conformance
