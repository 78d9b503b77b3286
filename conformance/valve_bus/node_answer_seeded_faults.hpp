#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in when and how they drive the line.
namespace fieldproof::conformance::node_seeded_faults {

class AnswersTwice : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    Node::transmit(octets, start);
    Node::transmit(octets, start + 6 * valve_bus::character_time(rules()));
  }
};

// Its own command comes back in front of the answer.
class AnswerNotCancelled : public Node {
  using Node::Node;
  Response response(Time now) override { return waiting_.emplace(Node::response(now)); }
  void on_character(const UartCharacter& character) override {
    Node::on_character(character);
    if (waiting_) answer_at(*waiting_, character.busy_until + turnaround_time());
  }
  void transmit(Octets octets, Time start) override {
    waiting_.reset();
    Node::transmit(octets, start);
  }
  std::optional<Response> waiting_;
};

class AcknowledgesWhatItDrives : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    Command driven = command;
    if (command.command == rules().write_command && configuration().boards == 1) driven.data1 = 0;
    Node::on_command(driven, now);
  }
};

class AnswersWithEcho : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    std::vector<std::uint8_t> all{static_cast<std::uint8_t>(address()), 1};
    all.insert(all.end(), octets.begin(), octets.end());
    Node::transmit(all, start);
  }
};

class GapBetweenOctets : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    // The driver stays on: what the line carries in between is idle.
    line::Waveform wave;
    wave.rate = rules().bit_rate;
    wave.start = start - valve_bus::bits(rules(), rules().driver_on_bits);
    wave.levels.append_idle(rules().driver_on_bits);
    for (std::size_t n = 0; n < octets.size(); ++n) {
      if (n > 0) wave.levels.append_idle(20);
      codec().append(wave.levels, octets.subspan(n, 1));
    }
    line().drive(wave);
  }
};

// Does not wait for the delimiter.
class AnswersAtOnce : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    Node::on_character(character);
    if (collector().frame().whole(valve_bus::kCommandOctets)) end_frame(character.busy_until);
  }
  Duration turnaround_time() const override { return {}; }
};

// The first start bit that many hundredths of the least and of the greatest turn-round after the command.
class TurnsRoundEarly : public AnswersAtOnce {
 public:
  TurnsRoundEarly(const valve_bus::NodeConfiguration& configuration, int hundredths)
      : AnswersAtOnce(configuration), hundredths_(hundredths) {}

 private:
  Duration turnaround_time() const override { return valve_bus::delimiter(rules()) * hundredths_ / 100; }
  int hundredths_;
};

class TurnsRoundSlowly : public Node {
 public:
  TurnsRoundSlowly(const valve_bus::NodeConfiguration& configuration, int hundredths)
      : Node(configuration), hundredths_(hundredths) {}

 private:
  Duration turnaround_time() const override {
    return (valve_bus::delimiter(rules()) + turnaround_time_span(rules())) * hundredths_ / 100;
  }
  int hundredths_;
};

class TurnsRoundLate : public Node {
 public:
  TurnsRoundLate(const valve_bus::NodeConfiguration& configuration, Duration lateness)
      : Node(configuration), lateness_(lateness) {}

 private:
  Duration turnaround_time() const override {
    return valve_bus::delimiter(rules()) + turnaround_time_span(rules()) + lateness_;
  }
  Duration lateness_;
};

class TurnRoundDrifts : public Node {
  using Node::Node;
  Response response(Time now) override {
    drift_ += 150 * kernel::kMicrosecond;
    return Node::response(now);
  }
  Duration turnaround_time() const override { return Node::turnaround_time() + drift_; }
  Duration drift_{};
};

// The driver around the characters other than the rules have it.
class DriverOtherwise : public Node {
 public:
  DriverOtherwise(const valve_bus::NodeConfiguration& configuration, unsigned before, unsigned behind)
      : Node(configuration), before_(before), behind_(behind) {}

 private:
  void transmit(Octets octets, Time start) override {
    codec().drive(line(), octets, start, {before_, behind_});
  }
  unsigned before_;
  unsigned behind_;
};

class DrivesNowAndThen : public Node {
  using Node::Node;
  void on_command(const Command& command, Time now) override {
    Node::on_command(command, now);
    if (command.command == rules().write_command && ++writes_ % 5 == 0) {
      const std::uint8_t octet = 0xFF;
      transmit(std::span(&octet, 1), now + kernel::kMillisecond);
    }
  }
  unsigned writes_ = 0;
};

class FallsSilent : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    if (++answers_ <= 400) Node::transmit(octets, start);
  }
  unsigned answers_ = 0;
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

}  // namespace fieldproof::conformance::node_seeded_faults
