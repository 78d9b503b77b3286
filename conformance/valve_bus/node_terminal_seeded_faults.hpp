#pragma once

#include <cstdint>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in what they do to their valves, and in what they tell of their limit switches.
namespace fieldproof::conformance::node_seeded_faults {

class ValvesBeforeCheck : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    Node::on_character(character);
    const CollectedFrame& frame = collector().frame();
    const bool is_own_write = frame.octets[0] == address() && frame.octets[1] == rules().write_command;
    if (frame.count == 3 && is_own_write) {
      const auto second_board = static_cast<std::uint16_t>(valves() & 0xFF00);
      actuate(static_cast<std::uint16_t>(second_board | frame.octets[2]), character.busy_until);
    }
  }
};

class ValvesLate : public Node {
  using Node::Node;
  void actuate(std::uint16_t valves, Time now) override {
    Node::actuate(valves, now + 2300 * kernel::kMicrosecond);
  }
};

class DataSwapped : public Node {
  using Node::Node;
  std::uint16_t valves_of(const Command& command) const override {
    return Node::valves_of({command.id, command.command, command.data1, command.data0});
  }
};

class BitsReversed : public Node {
  using Node::Node;
  std::uint16_t valves_of(const Command& command) const override {
    return Node::valves_of({command.id, command.command, reversed(command.data0), reversed(command.data1)});
  }
  static std::uint8_t reversed(std::uint8_t octet) {
    unsigned result = 0;
    for (unsigned n = 0; n < 8; ++n) result |= (octet >> n & 1U) << (7 - n);
    return static_cast<std::uint8_t>(result);
  }
};

class ValvesOneByOne : public Node {
  using Node::Node;
  void actuate(std::uint16_t wanted, Time now) override {
    unsigned step = 0;
    for (unsigned n = 0; n < 16; ++n) {
      const unsigned mask = 1U << n;
      if (((valves() ^ wanted) & mask) == 0) continue;
      Node::actuate(static_cast<std::uint16_t>(valves() ^ mask), now + step++ * 2 * kernel::kMicrosecond);
    }
  }
};

class GlitchesOnWrite : public Node {
  using Node::Node;
  void actuate(std::uint16_t wanted, Time now) override {
    Node::actuate(0, now);
    Node::actuate(wanted, now + 2 * kernel::kMicrosecond);
  }
};

class OneBoardDrivesBoth : public Node {
  using Node::Node;
  std::uint16_t valves_of(const Command& command) const override {
    return static_cast<std::uint16_t>(command.data0 | command.data1 << 8);
  }
};

class OneBoardAnswersBoth : public Node {
  using Node::Node;
  Response response(Time now) override {
    const std::uint16_t switches = limit_switches(now);
    return {static_cast<std::uint8_t>(switches & 0xFF), static_cast<std::uint8_t>(switches >> 8)};
  }
};

class SwitchesLatchedAtPowerUp : public Node {
  using Node::Node;
  void on_power_up(Time now) override { latched_ = Node::response(now); }
  Response response(Time) override { return latched_; }
  Response latched_;
};

class SwitchBitStuck : public Node {
  using Node::Node;
  Response response(Time now) override {
    const Response right = Node::response(now);
    return {static_cast<std::uint8_t>(right.data0 | 0x08U), right.data1};
  }
};

class TearsSwitches : public Node {
  using Node::Node;
  Response response(Time now) override {
    const Response first = Node::response(now);
    return {first.data0, Node::response(now + 4 * kernel::kMicrosecond).data1};
  }
};

}  // namespace fieldproof::conformance::node_seeded_faults
