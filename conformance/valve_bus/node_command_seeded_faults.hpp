#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in what they take for a command to them.
namespace fieldproof::conformance::node_seeded_faults {

// ---- block check ----

class CheckWithoutCommand : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return (o[0] ^ o[2] ^ o[3]) == o[4]; }
};

class CheckIsSum : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return static_cast<std::uint8_t>(o[0] + o[1] + o[2] + o[3]) == o[4]; }
};

class CheckIsParity : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return std::popcount(valve_bus::block_check(o)) % 2 == 0; }
};

class CheckIsCrc : public Node {
  using Node::Node;
  bool fits(Octets o) const override {
    unsigned crc = 0;  // x^8 + x^2 + x + 1
    for (const std::uint8_t octet : o.first(4)) {
      crc ^= octet;
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0 ? (crc << 1 ^ 0x107U) : crc << 1;
    }
    return crc == o[4];
  }
};

class ReadNotChecked : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return o[1] == rules().read_command || Node::fits(o); }
};

class WriteNotChecked : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return o[1] == rules().write_command || Node::fits(o); }
};

class CheckOrComplement : public Node {
  using Node::Node;
  bool fits(Octets o) const override { return Node::fits(o) || valve_bus::block_check(o) == 0xFF; }
};

class OneBoardChecksFourOctets : public Node {
  using Node::Node;
  bool fits(Octets o) const override {
    return configuration().boards == 1 ? (o[0] ^ o[1] ^ o[2]) == o[4] : Node::fits(o);
  }
};

class ValvesOffOnWrongCheck : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    if ((!octets || !fits(*octets)) && valves() != 0) actuate(0, now);
    Node::on_frame(frame, now);
  }
};

class ResponseCheckWithId : public Node {
  using Node::Node;
  std::uint8_t response_check(const Response& response) const override {
    return static_cast<std::uint8_t>(Node::response_check(response) ^ address());
  }
};

// ---- address and command ----

class AnswersAddressZero : public Node {
  using Node::Node;
  bool is_meant(std::uint8_t id) const override { return Node::is_meant(id) || (id == 0 && address() != 0); }
};

class AddressModulo128 : public Node {
  using Node::Node;
  bool is_meant(std::uint8_t id) const override { return address() != 0 && (id & 0x7FU) == address(); }
};

class AddressLowNibble : public Node {
  using Node::Node;
  bool is_meant(std::uint8_t id) const override {
    return address() != 0 && (id & 0xFU) == (address() & 0xFU);
  }
};

class AddressSwitchesBinary : public Node {
  using Node::Node;
  unsigned address_of(unsigned tens, unsigned units) const override { return tens << 4 | units; }
};

class DigitsAboveNine : public Node {
 public:
  DigitsAboveNine(const valve_bus::NodeConfiguration& configuration, unsigned modulus)
      : Node(configuration), modulus_(modulus) {}

 private:
  unsigned address_of(unsigned tens, unsigned units) const override {
    return 10 * (tens % modulus_) + units % modulus_;
  }
  unsigned modulus_;
};

class AddressZeroIsOne : public Node {
  using Node::Node;
  unsigned address_of(unsigned tens, unsigned units) const override {
    return std::max(1U, Node::address_of(tens, units));
  }
};

class AnyCommandReads : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    Command taken = command;
    if (taken.command != 0) taken.command = 1;
    Node::on_command(taken, now);
  }
};

class ReadDrivesValves : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    if (command.command == rules().read_command) actuate(valves_of(command), now);
    Node::on_command(command, now);
  }
};

}  // namespace fieldproof::conformance::node_seeded_faults
