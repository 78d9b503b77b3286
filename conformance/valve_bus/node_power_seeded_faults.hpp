#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

// A write that says what its valves stand by already.
class NotKeptAliveByEqualWrites : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    const bool is_equal = octets && fits(*octets) && is_meant((*octets)[0]) &&
                          (*octets)[1] == rules().write_command &&
                          valves_of(valve_bus::command_of(*octets)) == valves();
    if (is_equal) {
      collector().clear();
    } else {
      Node::on_frame(frame, now);
    }
  }
};

class NotKeptAliveByAnsweredWrites : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    const bool is_write =
        octets && fits(*octets) && is_meant((*octets)[0]) && (*octets)[1] == rules().write_command;
    if (is_write && rules().answers_writes) {
      actuate(valves_of(valve_bus::command_of(*octets)), now);
      answer_at({(*octets)[2], (*octets)[3]}, frame.busy_until + turnaround_time());
    } else {
      Node::on_frame(frame, now);
    }
  }
};

class ReadRestoresValves : public LettingGo {
  using LettingGo::LettingGo;
  void let_go(Time now) override {
    kept_ = valves();
    set(0, now);
  }
  Response response(Time now) override {
    if (const std::uint16_t kept = std::exchange(kept_, std::uint16_t{0}); kept != 0) set(kept, now);
    return LettingGo::response(now);
  }
  std::uint16_t kept_ = 0;
};

// Until the next write.
class SilentWithoutHost : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    is_written_ = command.command == rules().write_command;
    is_silent_ = is_silent_ && !is_written_;
    if (!is_silent_) Node::on_command(command, now);
    is_written_ = false;
  }
  void actuate(std::uint16_t valves, Time now) override {
    is_silent_ = !is_written_;
    Node::actuate(valves, now);
  }
  bool is_written_ = false;
  bool is_silent_ = false;
};

class EqualWriteNotDriven : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    const bool is_write = command.command == rules().write_command;
    const bool is_equal = is_write && last_ && *last_ == valves_of(command);
    if (is_write) last_ = valves_of(command);
    if (!is_equal) Node::on_command(command, now);
  }
  void on_power_up(Time) override { last_.reset(); }
  std::optional<std::uint16_t> last_;
};

class LetsGoInSilenceOnly : public LettingGo {
  using LettingGo::LettingGo;
  void let_go(Time now) override {
    if (state() != valve_bus::NodeState::collecting) set(0, now);
  }
};

class LetsGoAfterTheFirstPowerUpOnly : public LettingGo {
  using LettingGo::LettingGo;
  void on_power_up(Time) override { ++power_ups_; }
  void let_go(Time now) override {
    if (power_ups_ <= 1) set(0, now);
  }
  unsigned power_ups_ = 0;
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

class DrivesWithTheAnswer : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    pending_.reset();
    if (command.command == rules().write_command && rules().answers_writes) {
      pending_ = valves_of(command);
      answer_at({command.data0, command.data1}, now);
    } else {
      Node::on_command(command, now);
    }
  }
  void transmit(Octets octets, Time start) override {
    if (const auto pending = std::exchange(pending_, std::nullopt)) actuate(*pending, start);
    Node::transmit(octets, start);
  }
  std::optional<std::uint16_t> pending_;
};

class SkipsBreaks : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    if (!character.is_stop_missing || character.octet() != 0) Node::on_character(character);
  }
};

class AnswersWrongWrites : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    const bool is_wrong_write = octets && !fits(*octets) && is_meant((*octets)[0]) &&
                                (*octets)[1] == rules().write_command && rules().answers_writes;
    Node::on_frame(frame, now);
    if (is_wrong_write) answer_at({(*octets)[2], (*octets)[3]}, frame.busy_until + turnaround_time());
  }
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
