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

// ---- without a host ----

class KeptAliveByOthers : public Node {
  using Node::Node;
  bool is_meant(std::uint8_t id) const override {
    is_own_ = Node::is_meant(id);
    return true;
  }
  void on_command(const Command& command, Time now) override {
    if (is_own_) Node::on_command(command, now);
  }
  mutable bool is_own_ = false;
};

class KeptAliveByWrongFrames : public Node {
  using Node::Node;
  bool fits(Octets octets) const override {
    is_right_ = Node::fits(octets);
    return true;
  }
  void on_command(const Command& command, Time now) override {
    if (is_right_) Node::on_command(command, now);
  }
  mutable bool is_right_ = false;
};

class NotKeptAliveByReads : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    const bool is_read =
        octets && fits(*octets) && is_meant((*octets)[0]) && (*octets)[1] == rules().read_command;
    if (is_read) {
      answer_at(response(now), frame.busy_until + turnaround_time());
    } else {
      Node::on_frame(frame, now);
    }
  }
};

class NotKeptAliveByUndefinedCommands : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    if (!octets || (*octets)[1] <= rules().read_command) Node::on_frame(frame, now);
  }
};

// Knows whether a command moves its valves.
class LettingGo : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) final {
    is_commanded_ = true;
    Node::on_command(command, now);
    is_commanded_ = false;
  }
  void actuate(std::uint16_t valves, Time now) final {
    if (is_commanded_) {
      Node::actuate(valves, now);
    } else {
      let_go(now);
    }
  }
  virtual void let_go(Time now) = 0;
  bool is_commanded_ = false;

 protected:
  void set(std::uint16_t valves, Time now) { Node::actuate(valves, now); }
};

class LetsGoOnce : public LettingGo {
  using LettingGo::LettingGo;
  void let_go(Time now) override {
    if (!std::exchange(has_let_go_, true)) set(0, now);
  }
  bool has_let_go_ = false;
};

class LetsGoOfOneBoard : public LettingGo {
  using LettingGo::LettingGo;
  void let_go(Time now) override { set(valves() & 0xFF00U, now); }
};

}  // namespace fieldproof::conformance::node_seeded_faults
