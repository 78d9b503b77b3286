#pragma once

#include <optional>
#include <utility>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Local nodes whose fault shows only in a sequence: each does with any single command what it should. They
// are for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::node_seeded_faults {

// What a node with a fault in its memory needs to know of frames and commands.
class RememberingNode : public Node {
  using Node::Node;

 protected:
  bool is_refused(const CollectedFrame& frame) const {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    return !octets || !fits(*octets);
  }
  bool is_write(const Command& command) const { return command.command == rules().write_command; }
  bool is_read(const Command& command) const { return command.command == rules().read_command; }
};

// ---- what a frame that was refused leaves behind ----

class RefusedWriteKept : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    if (octets && !fits(*octets) && is_meant((*octets)[0]) && (*octets)[1] == rules().write_command) {
      kept_ = valves_of(valve_bus::command_of(*octets));
    }
    Node::on_frame(frame, now);
  }
  void on_command(const Command& command, Time now) override {
    if (const auto kept = std::exchange(kept_, std::nullopt)) {
      if (is_read(command)) actuate(*kept, now);
    }
    Node::on_command(command, now);
  }
  std::optional<std::uint16_t> kept_;
};

class CheckNotReset : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_frame(const CollectedFrame& frame, Time now) override {
    CollectedFrame taken = frame;
    taken.octets[4] ^= std::exchange(left_, std::uint8_t{0});
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    if (octets) left_ = valve_bus::block_check(*octets);
    Node::on_frame(taken, now);
  }
  std::uint8_t left_ = 0;
};

class CheckSkippedBehindError : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_frame(const CollectedFrame& frame, Time now) override {
    CollectedFrame taken = frame;
    const auto octets = frame.whole(valve_bus::kCommandOctets);
    if (std::exchange(is_skipped_, is_refused(frame)) && octets) {
      taken.octets[4] = valve_bus::block_check(octets->first(4));
    }
    Node::on_frame(taken, now);
  }
  bool is_skipped_ = false;
};

class DeafAfterErrors : public RememberingNode {
 public:
  DeafAfterErrors(const valve_bus::NodeConfiguration& configuration, unsigned most)
      : RememberingNode(configuration), most_(most) {}

 private:
  void on_frame(const CollectedFrame& frame, Time now) override {
    if (errors_ == most_) return;
    errors_ = is_refused(frame) ? errors_ + 1 : 0;
    Node::on_frame(frame, now);
  }
  void on_power_up(Time) override { errors_ = 0; }
  unsigned most_;
  unsigned errors_ = 0;
};

class LongFrameCostsNext : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_frame(const CollectedFrame& frame, Time now) override {
    if (!std::exchange(is_long_, frame.count > valve_bus::kCommandOctets)) Node::on_frame(frame, now);
  }
  bool is_long_ = false;
};

// ---- what a command leaves behind ----

class ThirdWriteLost : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    const bool is_lost = std::exchange(is_repeated_, is_write(command) && command == last_);
    last_ = command;
    if (!(is_lost && is_write(command))) Node::on_command(command, now);
  }
  Command last_{0xFF, 0xFF, 0, 0};
  bool is_repeated_ = false;
};

class WriteBehindWriteLate : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    if (const auto held = std::exchange(held_, std::nullopt)) Node::on_command(*held, now);
    const bool is_second = std::exchange(is_behind_write_, is_write(command)) && is_write(command);
    if (is_second) {
      held_ = command;
    } else {
      Node::on_command(command, now);
    }
  }
  bool is_behind_write_ = false;
  std::optional<Command> held_;
};

class LosesEachFourthCommand : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    if (++commands_ % 4 != 0) Node::on_command(command, now);
  }
  unsigned commands_ = 0;
};

class UnknownCommandKept : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    const bool is_known = is_write(command) || is_read(command);
    Command taken = command;
    if (std::exchange(is_unknown_, !is_known) && is_write(command)) {
      taken.command = static_cast<std::uint8_t>(rules().read_command);
    }
    Node::on_command(taken, now);
  }
  bool is_unknown_ = false;
};

class SecondBoardSkipped : public RememberingNode {
  using RememberingNode::RememberingNode;
  std::uint16_t valves_of(const Command& command) const override {
    const std::uint16_t wanted = Node::valves_of(command);
    const bool is_first_equal = command.data0 != 0 && ((wanted ^ valves()) & 0xFFU) == 0;
    return is_first_equal ? valves() : wanted;
  }
};

// ---- answers that come from something before ----

class ReadAnswersWrite : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    Node::on_command(command, now);
    if (is_write(command)) {
      written_ = Response{command.data0, command.data1};
    } else {
      written_.reset();
    }
  }
  Response response(Time now) override { return written_.value_or(Node::response(now)); }
  std::optional<Response> written_;
};

class SwitchesOldBehindWrite : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    if (is_write(command)) {
      Node::on_command(command, now);
      old_ = Node::response(now);
      return;
    }
    Node::on_command(command, now);
    old_.reset();
  }
  Response response(Time now) override { return old_.value_or(Node::response(now)); }
  std::optional<Response> old_;
};

class RepeatedReadAnswersOld : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_command(const Command& command, Time now) override {
    if (!is_read(command)) old_.reset();
    Node::on_command(command, now);
  }
  Response response(Time now) override {
    if (!old_) old_ = Node::response(now);
    return *old_;
  }
  std::optional<Response> old_;
};

class TwiceBehindResponse : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_frame(const CollectedFrame& frame, Time now) override {
    is_behind_response_ = std::exchange(was_response_, frame.count == valve_bus::kResponseOctets);
    Node::on_frame(frame, now);
  }
  void transmit(Octets octets, Time start) override {
    Node::transmit(octets, start);
    if (is_behind_response_) Node::transmit(octets, start + 8 * valve_bus::character_time(rules()));
  }
  bool was_response_ = false;
  bool is_behind_response_ = false;
};

class SilentAfterPowerLoss : public RememberingNode {
  using RememberingNode::RememberingNode;
  void on_power_up(Time) override { is_silent_ = ++power_ups_ > 1; }
  void transmit(Octets octets, Time start) override {
    if (!std::exchange(is_silent_, false)) Node::transmit(octets, start);
  }
  unsigned power_ups_ = 0;
  bool is_silent_ = false;
};

}  // namespace fieldproof::conformance::node_seeded_faults
