#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "protocols/valve_bus/host.hpp"

// Host modules that differ from the reference in one decision each; host_deviations.cpp names and describes
// them. A decision that is a number is changed in the rules there, without a class.
namespace fieldproof::conformance::host_deviants {

using kernel::Duration;
using kernel::Time;
using valve_bus::CollectedFrame;
using valve_bus::Command;
using valve_bus::CommandFifo;
using valve_bus::HeardCharacter;
using valve_bus::Host;
using valve_bus::HostConfiguration;
using valve_bus::HostError;
using valve_bus::HostErrorKind;
using valve_bus::HostResponse;
using valve_bus::Response;
using Octets = std::span<const std::uint8_t>;

// ---- what the PC wants ----

class AddressesFrom : public Host {
 public:
  AddressesFrom(const HostConfiguration& configuration, unsigned first, unsigned last)
      : Host(configuration), first_(first), last_(last) {}

 private:
  bool is_address(std::uint8_t id) const override { return id >= first_ && id <= last_; }
  unsigned first_;
  unsigned last_;
};

class RefusesSilently : public Host {
  using Host::Host;
  void refuse(const HostError&, Time) override {}
};

class SendsAnyCommand : public Host {
  using Host::Host;
  bool is_command(std::uint8_t) const override { return true; }
};

class LosesCommands : public Host {
  using Host::Host;
  std::optional<Command> next_command() override {
    if (++taken_ % 50 == 0) Host::next_command();
    return Host::next_command();
  }
  unsigned taken_ = 0;
};

class DoublesCommands : public Host {
  using Host::Host;
  std::optional<Command> next_command() override {
    if (again_) return std::exchange(again_, std::nullopt);
    const auto command = Host::next_command();
    if (++taken_ % 50 == 0) again_ = command;
    return command;
  }
  unsigned taken_ = 0;
  std::optional<Command> again_;
};

class OverflowNotTold : public Host {
  using Host::Host;
  void on_lost_command(std::uint8_t, Time) override {}
  bool has_overflowed() const override { return false; }
};

// Sends what it has of a command of which the rest does not come.
class PartSent : public Host {
  using Host::Host;
  void on_part(Octets part, Time now) override {
    if (part.empty()) return;
    std::vector<std::uint8_t> octets(part.begin(), part.end());
    octets.push_back(valve_bus::block_check(part));
    transmit(octets, now + valve_bus::bits(rules(), rules().driver_on_bits));
  }
};

class DataExchanged : public Host {
  using Host::Host;
  Command sent(const Command& command) const override {
    return {command.id, command.command, command.data1, command.data0};
  }
};

// ---- the FIFO ----

template <typename Fifo>
class HostOfFifo : public Host {
 public:
  explicit HostOfFifo(const HostConfiguration& configuration)
      : Host(configuration, std::make_unique<Fifo>(configuration.rules)) {}
};

// What is written skips the last place of the ring each time round.
class WrapsOneEarly : public CommandFifo {
  using CommandFifo::CommandFifo;
  std::size_t behind_written(std::size_t position) const override {
    return (position + 1) % (capacity() - 1);
  }
};

class DropsOldest : public CommandFifo {
  using CommandFifo::CommandFifo;
  bool on_overflow() override {
    set_overflowed();
    drop_oldest();
    return true;
  }
};

class LosesPartsOfCommands : public CommandFifo {
  using CommandFifo::CommandFifo;
  bool loses_whole_commands() const override { return false; }
};

// ---- requests ----

class RequestCheckWithoutId : public Host {
  using Host::Host;
  std::uint8_t request_check(const Command& c) const override {
    return static_cast<std::uint8_t>(c.command ^ c.data0 ^ c.data1);
  }
};

class RequestCheckIsSum : public Host {
  using Host::Host;
  std::uint8_t request_check(const Command& c) const override {
    return static_cast<std::uint8_t>(c.id + c.command + c.data0 + c.data1);
  }
};

class GapInRequest : public Host {
  using Host::Host;
  void transmit(Octets octets, Time start) override {
    // The driver stays on: what the line carries in between is idle.
    line::Waveform wave;
    wave.rate = rules().bit_rate;
    wave.start = start - valve_bus::bits(rules(), rules().driver_on_bits);
    wave.levels.append_idle(rules().driver_on_bits);
    for (std::size_t n = 0; n < octets.size(); ++n) {
      if (n == 2) wave.levels.append_idle(20);
      codec().append(wave.levels, octets.subspan(n, 1));
    }
    line().drive(wave);
  }
};

// The driver around the characters other than the rules have it.
class RequestDriver : public Host {
 public:
  RequestDriver(const HostConfiguration& configuration, unsigned before, unsigned behind)
      : Host(configuration), before_(before), behind_(behind) {}

 private:
  void transmit(Octets octets, Time start) override {
    codec().drive(line(), octets, start, {before_, behind_});
  }
  unsigned before_;
  unsigned behind_;
};

// The stop bit of the last character is what the idle line makes of it.
class DriverCutsStopBit : public Host {
  using Host::Host;
  void transmit(Octets octets, Time start) override {
    line::Waveform wave;
    wave.rate = rules().bit_rate;
    wave.start = start - valve_bus::bits(rules(), rules().driver_on_bits);
    wave.levels.append_idle(rules().driver_on_bits);
    codec().append(wave.levels, octets);
    wave.levels.resize(wave.levels.size() - 1);
    line().drive(wave);
  }
};

// Takes three octets for a response as soon as it has them, and sends at once behind it.
class DelimiterMissing : public Host {
  using Host::Host;
  Duration silence() const override { return {}; }
  void on_character(const HeardCharacter& character) override {
    Host::on_character(character);
    if (collector().frame().whole(valve_bus::kResponseOctets)) end_frame(character.busy_until);
  }
};

class RequestsLateInTurns : public Host {
  using Host::Host;
  void send(Time now) override {
    Host::send(now);
    if (++sent_ % 7 == 0) leave_silent_until(now + 4 * kernel::kMillisecond);
  }
  unsigned sent_ = 0;
};

// ---- writes ----

class WriteWaitsForAnswer : public Host {
  using Host::Host;
  bool awaits_response(const Exchange&) const override { return true; }
  bool may_repeat(const Exchange& exchange) const override {
    return exchange.command.command == rules().write_command || Host::may_repeat(exchange);
  }
};

class AcknowledgeNotAwaited : public Host {
  using Host::Host;
  bool awaits_response(const Exchange& exchange) const override {
    return exchange.command.command == rules().read_command;
  }
};

// What was written first to a node is refreshed for ever.
class RefreshesFirstData : public Host {
  using Host::Host;
  void keep_write(const Command& command) override {
    if (!std::exchange(has_written_.at(command.id), true)) Host::keep_write(command);
  }
  std::array<bool, 256> has_written_{};
};

class VerificationNotCompared : public Host {
  using Host::Host;
  bool is_verified(const Command&, const Response&) const override { return true; }
};

// ---- waiting ----

class TimeOutOtherwise : public Host {
 public:
  TimeOutOtherwise(const HostConfiguration& configuration, Duration time_out, unsigned percent)
      : Host(configuration), time_out_(time_out), percent_(percent) {}

 private:
  Duration time_out() const override {
    return time_out_ == Duration{} ? Host::time_out() * static_cast<int>(percent_) / 100 : time_out_;
  }
  Duration time_out_;
  unsigned percent_;
};

class BadResponseNotRepeated : public Host {
  using Host::Host;
  std::optional<Response> response_in(const CollectedFrame& frame) const override {
    const auto response = Host::response_in(frame);
    is_bad_ = !response;
    return response;
  }
  bool may_repeat(const Exchange& exchange) const override {
    return !std::exchange(is_bad_, false) && Host::may_repeat(exchange);
  }
  mutable bool is_bad_ = false;
};

// What came too late for one read is the response to the next.
class TakesLateResponse : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    if (const auto response = response_in(frame)) late_ = response;
  }
  void send(Time now) override {
    const bool is_read = exchange()->command.command == rules().read_command;
    Host::send(now);
    if (is_read && late_) accept(*std::exchange(late_, std::nullopt), now);
  }
  std::optional<Response> late_;
};

class LateNotCounted : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame&, Time) override {}
};

class TakesEarlyResponse : public Host {
  using Host::Host;
  Duration shortest_turn_round() const override { return {}; }
};

class WaitsLongBehindErrors : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    Host::fail(kind, now);
    leave_silent_until(now + 20 * kernel::kMillisecond);
  }
};

class WaitsForSilence : public Host {
  using Host::Host;
  Duration longest_talk() const override { return 1000 * kernel::kSecond; }
};

// ---- responses ----

class ResponseNotChecked : public Host {
  using Host::Host;
  bool fits(Octets) const override { return true; }
};

class ResponseCheckWithId : public Host {
  using Host::Host;
  bool fits(Octets o) const override { return (valve_bus::block_check(o) ^ last_id()) == 0; }
};

class ResponseCheckIsParity : public Host {
  using Host::Host;
  bool fits(Octets o) const override { return std::popcount(valve_bus::block_check(o)) % 2 == 0; }
};

// Looks at the bits of both octets, too.
class ResponseCheckTooStrict : public Host {
  using Host::Host;
  bool fits(Octets o) const override { return Host::fits(o) && o[0] != o[1]; }
};

// Makes a response of a frame of another length.
class TakesOtherResponses : public Host {
 public:
  enum class Which : std::uint8_t { two_octets, first_three, last_three };
  TakesOtherResponses(const HostConfiguration& configuration, Which which)
      : Host(configuration), which_(which) {}

 private:
  std::optional<Response> response_in(const CollectedFrame& frame) const override {
    const bool is_long = frame.count > 3 && frame.count <= CollectedFrame::kMostOctets && !frame.is_spoilt;
    CollectedFrame taken = frame;
    if (which_ == Which::two_octets && frame.count == 2 && !frame.is_spoilt) {
      return Response{frame.octets[0], frame.octets[1]};
    }
    if (which_ != Which::two_octets && is_long) taken.count = 3;
    if (which_ == Which::last_three && is_long) {
      std::copy_n(frame.octets.begin() + static_cast<std::ptrdiff_t>(frame.count - 3), 3,
                  taken.octets.begin());
    }
    return Host::response_in(taken);
  }
  Which which_;
};

// Hears itself, and takes the first three octets that fit.
class TakesEcho : public Host {
  using Host::Host;
  bool is_own(const HeardCharacter&) const override { return false; }
  void send(Time now) override {
    echo_.clear();
    Host::send(now);
  }
  void on_character(const HeardCharacter& character) override {
    echo_.push_back(character.octet());
    const bool is_response = echo_.size() == 3 && fits(echo_) && exchange();
    if (is_response && state() == valve_bus::HostState::awaiting) {
      accept({echo_[0], echo_[1]}, character.busy_until);
    }
    if (echo_.size() > valve_bus::kCommandOctets) Host::on_character(character);
  }
  std::vector<std::uint8_t> echo_;
};

// What was drained stands in front of what is heard next.
class KeepsStrayOctets : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    is_shifted_ = true;
  }
  std::optional<Response> response_in(const CollectedFrame& frame) const override {
    return std::exchange(is_shifted_, false) ? std::nullopt : Host::response_in(frame);
  }
  mutable bool is_shifted_ = false;
};

class StrayToldAsResponse : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    const auto response = response_in(frame);
    if (response) tell(HostResponse{last_id(), response->data0, response->data1}, now);
  }
};

// ---- what the PC is told ----

class ToldTwice : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    Host::tell(response, now);
    Host::tell(response, now);
  }
  using Host::tell;
};

class ToldOfNodeBefore : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    HostResponse told = response;
    told.id = std::exchange(before_, response.id);
    Host::tell(told, now);
  }
  using Host::tell;
  std::uint8_t before_ = 0;
};

class ResponseExchanged : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    Host::tell(HostResponse{response.id, response.data1, response.data0, response.is_old}, now);
  }
  using Host::tell;
};

class OldToldAsNew : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    Host::tell(HostResponse{response.id, response.data0, response.data1}, now);
  }
  using Host::tell;
};

class OldForgotten : public Host {
  using Host::Host;
  void tell_old(std::uint8_t, Time) override {}
};

class SilenceToldAsData : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    const std::uint8_t id = exchange()->command.id;
    Host::fail(kind, now);
    if (kind == HostErrorKind::no_response) tell(HostResponse{id, 0xFF, 0xFF}, now);
  }
};

class CountersShared : public Host {
  using Host::Host;
  std::size_t counters_place(std::uint8_t) const override { return 0; }
};

// ---- DIP switches ----

class DipOffByOne : public Host {
  using Host::Host;
  std::int64_t bit_rate_of(unsigned dip) const override { return Host::bit_rate_of(dip + 1); }
};

class ClockOffByOnePercent : public Host {
  using Host::Host;
  std::int64_t bit_rate_of(unsigned dip) const override { return Host::bit_rate_of(dip) * 101 / 100; }
};

class DipReadInOperation : public Host {
  using Host::Host;
  void set_dip(unsigned position) override {
    Host::set_dip(position);
    read_dip();
  }
};

}  // namespace fieldproof::conformance::host_deviants
