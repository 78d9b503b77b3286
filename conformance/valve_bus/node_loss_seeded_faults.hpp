#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in what they take for a host that is gone, and in what they do without one.
namespace fieldproof::conformance::node_seeded_faults {

// ---- signs of life ----

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

// Does what some commands say, and takes them for no sign of life.
class NotKeptAlive : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) final {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    const bool is_right = octets && fits(*octets) && is_meant((*octets)[0]);
    if (!is_right || !is_left_out(valve_bus::command_of(*octets))) return Node::on_frame(frame, now);
    const Command command = valve_bus::command_of(*octets);
    const Time begin = frame.busy_until + turnaround_time();
    if (command.command == rules().read_command) answer_at(response(now), begin);
    if (command.command != rules().write_command) return;
    actuate(valves_of(command), now);
    if (rules().answers_writes) answer_at({command.data0, command.data1}, begin);
  }
  virtual bool is_left_out(const Command& command) const = 0;
};

class NotKeptAliveByReads : public NotKeptAlive {
  using NotKeptAlive::NotKeptAlive;
  bool is_left_out(const Command& command) const override { return command.command == rules().read_command; }
};

class NotKeptAliveByUndefinedCommands : public NotKeptAlive {
  using NotKeptAlive::NotKeptAlive;
  bool is_left_out(const Command& command) const override { return command.command > rules().read_command; }
};

// Writes that say what its valves stand by already.
class NotKeptAliveByEqualWrites : public NotKeptAlive {
  using NotKeptAlive::NotKeptAlive;
  bool is_left_out(const Command& command) const override {
    return command.command == rules().write_command && valves_of(command) == valves();
  }
};

class NotKeptAliveByAnsweredWrites : public NotKeptAlive {
  using NotKeptAlive::NotKeptAlive;
  bool is_left_out(const Command& command) const override {
    return command.command == rules().write_command && rules().answers_writes;
  }
};

// ---- what valves do without a host, and after it ----

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

}  // namespace fieldproof::conformance::node_seeded_faults
