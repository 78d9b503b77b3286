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

}  // namespace fieldproof::conformance::node_seeded_faults
