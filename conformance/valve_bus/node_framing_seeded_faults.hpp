#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "conformance/valve_bus/node_seeded_faults.hpp"

// Nodes that differ in what they hear: frames, and the characters of which these are.
namespace fieldproof::conformance::node_seeded_faults {

// ---- frames ----

// A frame is five octets, whatever silence there is.
class CountsOctetsOnly : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    if (!character.is_good()) return;
    frame_.octets.at(frame_.count++) = character.octet();
    frame_.busy_until = character.busy_until;
    if (frame_.count < valve_bus::kCommandOctets) return;
    const CollectedFrame whole = std::exchange(frame_, {});
    on_frame(whole, character.busy_until);
  }
  CollectedFrame frame_;
};

// What an error leaves in the buffer is in front of all that follows.
class BufferNotCleared : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    if (is_shifted_) return;
    is_shifted_ = !frame.whole(valve_bus::kCommandOctets);
    Node::on_frame(frame, now);
  }
  void on_power_up(Time) override { is_shifted_ = false; }
  bool is_shifted_ = false;
};

// Makes a whole frame of one that is none.
class TakesOtherLengths : public Node {
 public:
  enum class Which : std::uint8_t { four_octets, first_five, last_five };
  TakesOtherLengths(const valve_bus::NodeConfiguration& configuration, Which which)
      : Node(configuration), which_(which) {}

 private:
  void on_character(const UartCharacter& character) override {
    Node::on_character(character);
    std::rotate(last_.begin(), last_.begin() + 1, last_.end());
    last_.back() = character.octet();
  }
  void on_frame(const CollectedFrame& frame, Time now) override {
    CollectedFrame taken = frame;
    if (which_ == Which::four_octets && frame.count == 4) {
      taken.octets[4] = valve_bus::block_check(std::span(frame.octets).first(4));
      taken.count = 5;
    } else if (which_ != Which::four_octets && frame.count > 5) {
      taken.count = 5;
      if (which_ == Which::last_five) std::copy(last_.begin(), last_.end(), taken.octets.begin());
    }
    Node::on_frame(taken, now);
  }
  Which which_;
  std::array<std::uint8_t, 5> last_{};
};

// Hears nothing for a while after what it has just heard.
class GapTimerOf16Bits : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    constexpr Duration kPeriod = 65'536 * kernel::kMicrosecond;
    const Duration gap = character.start - last_.busy_until;
    if (gap >= kPeriod && gap % kPeriod <= valve_bus::longest_gap(rules())) {
      for (UartCharacter one : frame_) {
        one.start += gap - gap % kPeriod;
        one.busy_until += gap - gap % kPeriod;
        Node::on_character(one);
      }
    } else if (gap > valve_bus::longest_gap(rules())) {
      frame_.clear();
    }
    frame_.push_back(character);
    last_ = character;
    Node::on_character(character);
  }
  UartCharacter last_{};
  std::vector<UartCharacter> frame_;
};

class DeafAfterAMinute : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    is_deaf_ = is_deaf_ || (last_ > Time{} && character.start - last_ > 60 * kernel::kSecond);
    last_ = character.busy_until;
    if (!is_deaf_) Node::on_character(character);
  }
  void on_power_up(Time) override { is_deaf_ = false; }
  Time last_{};
  bool is_deaf_ = false;
};

class DeafBehindResponse : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    const bool is_deaf = std::exchange(is_deaf_, frame.count == valve_bus::kResponseOctets);
    if (!is_deaf) Node::on_frame(frame, now);
  }
  bool is_deaf_ = false;
};

class DeafBehindWrite : public Node {
  using Node::Node;
  void on_frame(const CollectedFrame& frame, Time now) override {
    if (frame.start < deaf_until_) return;
    Node::on_frame(frame, now);
  }
  void actuate(std::uint16_t valves, Time now) override {
    Node::actuate(valves, now);
    deaf_until_ = now + kernel::kMillisecond;
  }
  Time deaf_until_{};
};

// ---- characters ----

class ParityInverted : public Node {
  using Node::Node;
  UartCharacter judged(const UartCharacter& character) const override {
    UartCharacter taken = character;
    if (valve_bus::character_format(rules()).parity != line::Parity::none) {
      taken.is_parity_wrong = !character.is_parity_wrong;
    }
    return taken;
  }
};

class LocksUpAfterBreak : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    constexpr unsigned kCharacters = 3;  // of low line, more than a character can have
    if (character.busy_until - character.start > kCharacters * valve_bus::character_time(rules())) {
      is_locked_ = true;
    }
    if (!is_locked_) Node::on_character(character);
  }
  bool is_locked_ = false;
};

// Any falling edge is a start bit: the first sample is not looked at.
class StartBitNotValidated : public Node {
  using Node::Node;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    line::Waveform widened = reception;
    const std::int64_t per_bit = std::max<std::int64_t>(1, reception.rate / rules().bit_rate);
    const std::size_t edge = line::falling_edge(widened.levels, 0);
    if (per_bit > 1 && edge < widened.levels.size()) {
      const auto bit = static_cast<std::size_t>(per_bit);
      if (widened.levels.size() < edge + bit) widened.levels.resize(edge + bit);
      widened.levels.fill(edge, edge + bit, false);
    }
    Node::receive(port, widened);
  }
};

// Takes every bit but the start bit at another sixteenth than in its middle.
class SamplesElsewhere : public Node {
 public:
  SamplesElsewhere(const valve_bus::NodeConfiguration& configuration, unsigned sixteenth)
      : Node(configuration), sixteenth_(sixteenth) {}

 private:
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    wave_ = &reception;
    Node::receive(port, reception);
  }
  UartCharacter judged(const UartCharacter& character) const override {
    const line::CharacterCode code(valve_bus::character_format(rules()));
    std::uint32_t bits = 0;
    for (unsigned bit = 1; bit <= code.format().bits_before_stop(); ++bit) {
      const Time when = line::Sampling::instant(character.start, bit, sixteenth_, rules().bit_rate);
      bits |= std::uint32_t{wave_->at(when)} << bit;
    }
    const line::Character sampled = code.from_bits(bits);
    UartCharacter taken = character;
    taken.data = sampled.data;
    taken.is_parity_wrong = sampled.is_parity_wrong;
    taken.is_stop_missing = sampled.is_stop_missing;
    return taken;
  }
  unsigned sixteenth_;
  const line::Waveform* wave_ = nullptr;  // that is being received
};

class FollowsAnyRate : public Node {
  using Node::Node;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    line::Waveform heard = reception;
    // What begins with exactly a bit at another rate is taken at that rate.
    heard.rate = rules().bit_rate;
    heard.start =
        reception.end() - kernel::levels_duration(static_cast<std::int64_t>(heard.levels.size()), heard.rate);
    Node::receive(port, heard);
  }
};

class HearsWhileDriving : public Node {
  using Node::Node;
  UartCharacter judged(const UartCharacter& character) const override { return character; }
  void on_character(const UartCharacter& character) override {
    UartCharacter heard = character;
    heard.is_stop_missing = false;
    Node::on_character(heard);
  }
};

class GivesUpOnCollision : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    if (has_given_up_) return;
    driving_until_ = start + 4 * valve_bus::character_time(rules());
    Node::transmit(octets, start);
  }
  void on_character(const UartCharacter& character) override {
    if (character.start < driving_until_) has_given_up_ = true;
    Node::on_character(character);
  }
  Time driving_until_{};
  bool has_given_up_ = false;
};

// Looks at the silence in front of a frame as at one within it, with a timer that wraps.
class DelimiterTimerOf16Bits : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    constexpr Duration kWrap = 65'536 * kernel::kMicrosecond;
    UartCharacter heard = character;
    const Duration shown = (character.start - last_) % kWrap;
    const bool is_between = shown > longest_gap(rules()) && shown < delimiter(rules());
    if (state() != valve_bus::NodeState::collecting && is_between) heard.is_stop_missing = true;
    last_ = character.busy_until;
    Node::on_character(heard);
  }
  Time last_{};
};

class StopBitIgnoredWithParity : public Node {
  using Node::Node;
  UartCharacter judged(const UartCharacter& character) const override {
    UartCharacter heard = Node::judged(character);
    if (rules().characters == valve_bus::CharacterProfile::even_parity) heard.is_stop_missing = false;
    return heard;
  }
};

class SkipsBreaks : public Node {
  using Node::Node;
  void on_character(const UartCharacter& character) override {
    if (!character.is_stop_missing || character.octet() != 0) Node::on_character(character);
  }
};

}  // namespace fieldproof::conformance::node_seeded_faults
