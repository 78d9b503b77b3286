#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "protocols/valve_bus/node.hpp"

// Local nodes that differ from the reference in one decision each; node_deviations.cpp names and describes
// them. A decision that is a number is changed in the rules there, without a class.
namespace fieldproof::conformance::node_deviants {

using kernel::Duration;
using kernel::Time;
using valve_bus::CollectedFrame;
using valve_bus::Command;
using valve_bus::HeardCharacter;
using valve_bus::Node;
using valve_bus::Response;
using Octets = std::span<const std::uint8_t>;

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

// ---- valves and switches ----

class ValvesBeforeCheck : public Node {
  using Node::Node;
  void on_character(const HeardCharacter& character) override {
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

// ---- answers ----

class AnswersTwice : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    Node::transmit(octets, start);
    Node::transmit(octets, start + 6 * valve_bus::character_time(rules()));
  }
};

// Its own command comes back in front of the answer.
class AnswersWithEcho : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    std::vector<std::uint8_t> all{static_cast<std::uint8_t>(address()), 1};
    all.insert(all.end(), octets.begin(), octets.end());
    Node::transmit(all, start);
  }
};

class SendsNinthBit0 : public Node {
  using Node::Node;
  void transmit(Octets octets, Time start) override {
    const line::CharacterCode code(valve_bus::character_format(rules()));
    line::Waveform wave;
    wave.rate = rules().bit_rate;
    wave.start = start - valve_bus::bits(rules(), rules().driver_on_bits);
    wave.levels.append_idle(rules().driver_on_bits);
    for (const std::uint8_t octet : octets) code.append(wave.levels, octet);
    line().drive(wave);
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
  void on_character(const HeardCharacter& character) override {
    Node::on_character(character);
    if (collector().frame().whole(valve_bus::kCommandOctets)) end_frame(character.busy_until);
  }
  Duration turn_round() const override { return {}; }
};

// The first start bit that many hundredths of the least and of the greatest turn-round behind the command.
class TurnsRoundEarly : public AnswersAtOnce {
 public:
  TurnsRoundEarly(const valve_bus::NodeConfiguration& configuration, int hundredths)
      : AnswersAtOnce(configuration), hundredths_(hundredths) {}

 private:
  Duration turn_round() const override { return valve_bus::delimiter(rules()) * hundredths_ / 100; }
  int hundredths_;
};

class TurnsRoundSlowly : public Node {
 public:
  TurnsRoundSlowly(const valve_bus::NodeConfiguration& configuration, int hundredths)
      : Node(configuration), hundredths_(hundredths) {}

 private:
  Duration turn_round() const override {
    return (valve_bus::delimiter(rules()) + turn_round_span(rules())) * hundredths_ / 100;
  }
  int hundredths_;
};

class TurnsRoundLate : public Node {
 public:
  TurnsRoundLate(const valve_bus::NodeConfiguration& configuration, Duration lateness)
      : Node(configuration), lateness_(lateness) {}

 private:
  Duration turn_round() const override {
    return valve_bus::delimiter(rules()) + turn_round_span(rules()) + lateness_;
  }
  Duration lateness_;
};

class TurnRoundDrifts : public Node {
  using Node::Node;
  Response response(Time now) override {
    drift_ += 150 * kernel::kMicrosecond;
    return Node::response(now);
  }
  Duration turn_round() const override { return Node::turn_round() + drift_; }
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

// ---- frames ----

// A frame is five octets, whatever silence there is.
class CountsOctetsOnly : public Node {
  using Node::Node;
  void on_character(const HeardCharacter& character) override {
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
  void on_character(const HeardCharacter& character) override {
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

// Hears nothing for a while behind what it has just heard.
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
  HeardCharacter judged(const HeardCharacter& character) const override {
    HeardCharacter taken = character;
    if (valve_bus::character_format(rules()).parity != line::Parity::none) {
      taken.is_parity_wrong = !character.is_parity_wrong;
    }
    return taken;
  }
};

class LocksUpAfterBreak : public Node {
  using Node::Node;
  void on_character(const HeardCharacter& character) override {
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
  HeardCharacter judged(const HeardCharacter& character) const override {
    const line::CharacterCode code(valve_bus::character_format(rules()));
    std::uint32_t bits = 0;
    for (unsigned bit = 1; bit <= code.format().bits_before_stop(); ++bit) {
      const Time when = line::Sampling::instant(character.start, bit, sixteenth_, rules().bit_rate);
      bits |= std::uint32_t{wave_->at(when)} << bit;
    }
    const line::Character sampled = code.from_bits(bits);
    HeardCharacter taken = character;
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
  HeardCharacter judged(const HeardCharacter& character) const override { return character; }
  void on_character(const HeardCharacter& character) override {
    HeardCharacter heard = character;
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
  void on_character(const HeardCharacter& character) override {
    if (character.start < driving_until_) has_given_up_ = true;
    Node::on_character(character);
  }
  Time driving_until_{};
  bool has_given_up_ = false;
};

// ---- power ----

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
  void on_character(const HeardCharacter& character) override {
    Node::on_character(character);
    kept_.push_back(character);
  }
  void on_frame(const CollectedFrame& frame, Time now) override {
    kept_.clear();
    Node::on_frame(frame, now);
  }
  void on_power_up(Time now) override {
    const auto kept = std::exchange(kept_, {});
    for (HeardCharacter character : kept) {
      // As if the time without power had not been.
      const Duration lost = now - kept.back().busy_until;
      character.start += lost;
      character.busy_until += lost;
      Node::on_character(character);
    }
  }
  std::vector<HeardCharacter> kept_;
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

}  // namespace fieldproof::conformance::node_deviants
