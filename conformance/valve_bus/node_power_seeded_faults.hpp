#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in what the supply does to them.
namespace fieldproof::conformance::node_seeded_faults {

class ValvesSetAtPowerUp : public Node {
  using Node::Node;
  void on_power_up(Time now) override { actuate(0x0001, now); }
};

class WorksWithoutSupply : public Node {
  using Node::Node;
  void set_power(bool is_on, Time now) override {
    is_on_ = is_on;
    if (is_on) Node::set_power(true, now);
  }
  // The driver does not.
  void transmit(Octets octets, Time start) override {
    if (is_on_) Node::transmit(octets, start);
  }
  bool is_on_ = false;
};

class SpeaksAtPowerUp : public Node {
  using Node::Node;
  void on_power_up(Time now) override {
    const std::array<std::uint8_t, 3> hello{0, 0, 0};
    transmit(hello, now + 10 * kernel::kMillisecond);
  }
};

class KeepsOctetsOverPowerLoss : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    Node::on_character(character);
    kept_.push_back(character);
  }
  void on_frame(const CollectedFrame& frame, Time now) override {
    kept_.clear();
    Node::on_frame(frame, now);
  }
  void on_power_up(Time now) override {
    const auto kept = std::exchange(kept_, {});
    for (UartCharacter character : kept) {
      // As if the time without power had not been.
      const Duration lost = now - kept.back().busy_until;
      character.start += lost;
      character.busy_until += lost;
      Node::on_character(character);
    }
  }
  std::vector<UartCharacter> kept_;
};

class KeepsValvesOverPowerLoss : public Node {
  using Node::Node;
  void actuate(std::uint16_t valves, Time now) override {
    kept_ = valves;
    Node::actuate(valves, now);
  }
  void on_power_up(Time now) override {
    if (kept_ != 0) Node::actuate(kept_, now);
  }
  std::uint16_t kept_ = 0;
};

class DeafAfterPowerLostInAnAnswer : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    constexpr unsigned kAnswerHalfCharacters = 6;
    answering_until_ = start + half_characters(rules(), kAnswerHalfCharacters);
    Node::transmit(octets, start);
  }
  void set_power(bool is_on, Time now) override {
    if (!is_on) is_deaf_ = now < answering_until_;
    Node::set_power(is_on, now);
  }
  bool fits(Octets octets) const override { return !is_deaf_ && Node::fits(octets); }
  Time answering_until_{};
  bool is_deaf_ = false;
};

class AnswersWritesOnce : public Node {
  using Node::Node;
  void on_power_up(Time) override { ++power_ups_; }
  void on_command(const Command& command, Time now) override {
    if (power_ups_ > 1 && command.command == rules().write_command) {
      actuate(valves_of(command), now);
    } else {
      Node::on_command(command, now);
    }
  }
  unsigned power_ups_ = 0;
};

}  // namespace fieldproof::conformance::node_seeded_faults
