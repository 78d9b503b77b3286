#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in what they send to the nodes.
namespace fieldproof::conformance::host_seeded_faults {

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

// Takes three octets for a response as soon as it has them, and sends at once after it.
class DelimiterMissing : public Host {
  using Host::Host;
  Duration silence() const override { return {}; }
  void on_character(const UartCharacter& character) override {
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

}  // namespace fieldproof::conformance::host_seeded_faults
