#pragma once

#include <algorithm>
#include <cstdint>

#include "conformance/valve_bus/node_loss_seeded_faults.hpp"
#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes in which one thing that ends or begins spoils another that is going on.
namespace fieldproof::conformance::node_seeded_faults {

class LossDropsTheFrame : public LettingGo {
  using LettingGo::LettingGo;
  void let_go(Time now) override {
    collector().clear();
    set(0, now);
  }
};

// Knows when the time without a host is over.
class AnswersUntilLoss : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) final {
    last_ = now;
    Node::on_command(command, now);
  }
  Time last_{};

 protected:
  bool has_limit() const { return rules().loss_limit > Duration{}; }
  Time loss() const { return last_ + rules().loss_limit; }
};

// What has begun by then is sent, and no more.
class LossCutsAnswers : public AnswersUntilLoss {
  using AnswersUntilLoss::AnswersUntilLoss;
  void transmit(Octets octets, Time start) override {
    std::size_t count = octets.size();
    if (has_limit() && loss() >= start) {
      const auto begun = static_cast<std::size_t>((loss() - start) / valve_bus::character_time(rules()));
      count = std::min(count, begun + 1);
    }
    Node::transmit(octets.first(count), start);
  }
};

class LossCancelsAnswers : public AnswersUntilLoss {
  using AnswersUntilLoss::AnswersUntilLoss;
  Duration turnaround_time() const override {
    return valve_bus::delimiter(rules()) + valve_bus::turnaround_time_span(rules());
  }
  void transmit(Octets octets, Time start) override {
    if (!has_limit() || loss() >= start) Node::transmit(octets, start);
  }
};

// Takes what is a command but for one thing for a sign of life, and does not do what it says.
class KeptAliveBySpoiltFrames : public Node {
 public:
  enum class Why : std::uint8_t { octet_more, octet_less, gap, wrong_character };
  KeptAliveBySpoiltFrames(const valve_bus::NodeConfiguration& configuration, Why why)
      : Node(configuration), why_(why) {}

 private:
  void on_character(const UartCharacter& character) override {
    is_wrong_ = (is_wrong_ && !collector().is_empty()) || !character.is_good();
    Node::on_character(character);
  }
  void on_frame(const CollectedFrame& frame, Time now) override {
    CollectedFrame taken = frame;
    taken.count = valve_bus::kCommandOctets;
    taken.is_spoilt = false;
    if (why_ == Why::octet_less) taken.octets[4] = valve_bus::block_check(Octets(frame.octets).first(4));
    is_command_ = !is_spoilt_so(frame);
    Node::on_frame(is_command_ ? frame : taken, now);
  }
  bool is_spoilt_so(const CollectedFrame& frame) const {
    switch (why_) {
      case Why::octet_more:
        return !frame.is_spoilt && frame.count == valve_bus::kCommandOctets + 1;
      case Why::octet_less:
        return !frame.is_spoilt && frame.count == valve_bus::kCommandOctets - 1;
      case Why::gap:
        return frame.is_spoilt && !is_wrong_ && frame.count == valve_bus::kCommandOctets;
      case Why::wrong_character:
        return frame.is_spoilt && is_wrong_ && frame.count == valve_bus::kCommandOctets;
    }
    return false;
  }
  void on_command(const Command& command, Time now) override {
    if (is_command_) Node::on_command(command, now);
  }
  Why why_;
  bool is_wrong_ = false;
  bool is_command_ = true;
};

// As if its receiver were off while it drives: what is behind begins anew.
class TakesWhatGoesOnBehindAnswers : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    if (character.start >= driving_until_) Node::on_character(character);
  }
  void transmit(Octets octets, Time start) override {
    driving_until_ = start + valve_bus::half_characters(rules(), 2 * static_cast<unsigned>(octets.size()));
    Node::transmit(octets, start);
  }
  Time driving_until_{};
};

// ---- answers of nodes that are set otherwise ----

class AnswersUndefinedCommands : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    Node::on_command(command, now);
    const bool is_undefined =
        command.command != rules().write_command && command.command != rules().read_command;
    if (is_undefined && rules().answers_writes) answer_at({command.data0, command.data1}, now);
  }
};

// From when it is sure of the command: too late where a character is long, and not yet the limit.
class TurnsRoundIn1900Microseconds : public Node {
  using Node::Node;
  Duration turnaround_time() const override {
    return valve_bus::delimiter(rules()) + valve_bus::character_notice(rules()) +
           1'900 * kernel::kMicrosecond;
  }
};

}  // namespace fieldproof::conformance::node_seeded_faults
