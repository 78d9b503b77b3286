#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in what they make of failed attempts, and of a PC that writes during a request or
// a time-out.
namespace fieldproof::conformance::host_seeded_faults {

// ---- what went wrong before ----

// Of a command that did not fit it waits for the rest, and reports the part.
class LostPartReported : public Host {
  using Host::Host;
  void on_lost_command(std::uint8_t id, Time now) override {
    Host::on_lost_command(id, now);
    lost_ = id;
    due_ = now + rules().partial_command_limit;
  }
  void on_time(Time now) override {
    if (lost_ && due_ <= now) {
      tell(HostError{*lost_, HostErrorKind::part_of_command}, now);
      lost_.reset();
    }
    Host::on_time(now);
  }
  Time next_time() const override { return lost_ ? std::min(due_, Host::next_time()) : Host::next_time(); }
  using Host::tell;
  std::optional<std::uint8_t> lost_;
  Time due_{};
};

class OverflowIdOf7Bits : public Host {
  using Host::Host;
  void on_lost_command(std::uint8_t id, Time now) override {
    Host::on_lost_command(static_cast<std::uint8_t>(id & 0x7F), now);
  }
};

class NoPartOfId0 : public Host {
  using Host::Host;
  void on_part(Octets part, Time now) override {
    if (part.empty() || part.front() != 0) Host::on_part(part, now);
  }
};

class AttemptsOverPowerLoss : public Host {
  using Host::Host;
  void set_power(bool is_on, Time now) override {
    if (!is_on) spent_ = exchange() ? exchange()->attempt : 0;
    Host::set_power(is_on, now);
  }
  bool may_repeat(const Exchange& repeated) const override {
    return repeated.attempt + spent_ < rules().read_attempts;
  }
  void fail(HostErrorKind kind, Time now) override {
    Host::fail(kind, now);
    spent_ = 0;
  }
  unsigned spent_ = 0;
};

// Gives up a write with its last attempt, and with it the refreshes of it.
class NoRefreshAfterError4 : public Host {
  using Host::Host;
  Time refreshed_at(Time start) const override {
    constexpr Duration kNotAnyMore = 1000 * kernel::kSecond;
    const bool is_last = exchange() && exchange()->attempt >= rules().read_attempts;
    return Host::refreshed_at(start) + (is_last ? kNotAnyMore : Duration{});
  }
};

class WaitsThreeTimeOutsForSilence : public Host {
  using Host::Host;
  Duration longest_talk() const override { return 3 * time_out(); }
};

// ---- failed attempts ----

class NoRestBehindWrong : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_wrong_ = kind == HostErrorKind::bad_response;
    Host::fail(kind, now);
  }
  Duration late_span() const override { return is_wrong_ ? Duration{} : Host::late_span(); }
  bool is_wrong_ = false;
};

class LateBehindWrong : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_wrong_ = kind == HostErrorKind::bad_response;
    Host::fail(kind, now);
  }
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    if (is_wrong_ && state() != valve_bus::HostState::awaiting) ++counted(last_id()).late;
  }
  bool is_wrong_ = false;
};

class WrongAcknowledgeToldAsWrong : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_wrong_ = kind == HostErrorKind::bad_response;
    Host::fail(kind, now);
  }
  void tell(const HostError& error, Time now) override {
    const bool is_wrong = is_wrong_ && error.kind == HostErrorKind::not_acknowledged;
    Host::tell(HostError{error.id, is_wrong ? HostErrorKind::bad_response : error.kind}, now);
  }
  using Host::tell;
  bool is_wrong_ = false;
};

class FirstLateCounted : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    const auto before = counted(last_id()).late;
    if (is_counted_) return;
    Host::on_stray(frame, now);
    is_counted_ = counted(last_id()).late > before;
  }
  void send(Time now) override {
    is_counted_ = false;
    Host::send(now);
  }
  bool is_counted_ = false;
};

class LateCountedForEver : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    if (kind == HostErrorKind::no_response) silent_ = exchange()->command.id;
    Host::fail(kind, now);
  }
  void on_stray(const CollectedFrame& frame, Time now) override {
    const bool is_another = silent_ != 0 && silent_ != last_id();
    is_another ? static_cast<void>(++counted(silent_).late) : Host::on_stray(frame, now);
  }
  std::uint8_t silent_ = 0;
};

class LateCounterOf8Bits : public Host {
  using Host::Host;
  valve_bus::HostCounters counters(std::uint8_t id) const override {
    valve_bus::HostCounters all = Host::counters(id);
    all.late &= 0xFFU;
    return all;
  }
};

class OldForgottenWhenBusy : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_busy_ = kind == HostErrorKind::line_busy;
    Host::fail(kind, now);
  }
  void tell_old(std::uint8_t id, Time now) override {
    if (!is_busy_) Host::tell_old(id, now);
  }
  bool is_busy_ = false;
};

// What a slow bit rate needs for a character is cut to whole milliseconds.
class TimeOutCut : public Host {
  using Host::Host;
  Duration time_out() const override {
    const Duration silence = valve_bus::delimiter(rules());
    return silence + (Host::time_out() - silence) / kernel::kMillisecond * kernel::kMillisecond;
  }
};

// ---- a PC that writes meanwhile ----

// Sends its characters one by one, each a little later when the PC has written.
class PcDelaysCharacters : public Host {
  using Host::Host;
  void transmit(Octets octets, Time start) override {
    rest_.assign(octets.begin(), octets.end());
    is_delayed_ = false;
    next_ = start - valve_bus::bits(rules(), rules().driver_on_bits);
    drive_next(rules().driver_on_bits);
  }
  void write(Octets octets, Time now) override {
    Host::write(octets, now);
    is_delayed_ = true;
  }
  void set_power(bool is_on, Time now) override {
    rest_.clear();
    Host::set_power(is_on, now);
  }
  void on_time(Time now) override {
    while (!rest_.empty() && next_ <= now) drive_next(is_delayed_ ? kPause : 0);
    Host::on_time(now);
  }
  Time next_time() const override {
    return std::min(Host::next_time(), rest_.empty() ? kernel::kNever : next_);
  }
  void drive_next(unsigned idle_bits) {
    line::Waveform wave;
    wave.rate = rules().bit_rate;
    wave.start = next_;
    wave.levels.append_idle(idle_bits);
    codec().append(wave.levels, Octets(rest_).first(1));
    rest_.erase(rest_.begin());
    is_delayed_ = false;
    next_ = wave.end();
    line().drive(wave);
  }
  static constexpr unsigned kPause = 20;
  std::vector<std::uint8_t> rest_;
  Time next_{};
  bool is_delayed_ = false;
};

class PcRestartsTimeOut : public Host {
  using Host::Host;
  void write(Octets octets, Time now) override {
    Host::write(octets, now);
    held_until_ = now + time_out();
  }
  void on_time(Time now) override {
    if (!is_held() || held_until_ <= now) Host::on_time(now);
  }
  Time next_time() const override {
    return is_held() ? std::max(Host::next_time(), held_until_) : Host::next_time();
  }
  bool is_held() const { return state() == valve_bus::HostState::awaiting && collector().is_empty(); }
  Time held_until_{};
};

// Reads a repetition again from where it stood in the ring, whatever stands there now.
class RepeatsFromTheRing : public Host {
  using Host::Host;
  void write(Octets octets, Time now) override {
    const std::size_t fitting = std::min(octets.size(), fifo_room());
    for (const std::uint8_t octet : octets.first(fitting)) ring_.at(written_++ % ring_.size()) = octet;
    Host::write(octets, now);
  }
  void on_part(Octets part, Time now) override {
    written_ -= part.size();
    Host::on_part(part, now);
  }
  std::optional<Command> next_command() override {
    const auto command = Host::next_command();
    slot_ = read_;
    if (command) read_ += CommandFifo::kWritten;
    return command;
  }
  Command sent(const Command& command) const override {
    if (exchange()->attempt == 1 || exchange()->purpose != Purpose::command) return command;
    const auto at = [this](std::size_t place) { return ring_.at((slot_ + place) % ring_.size()); };
    return {at(0), at(1), at(2), at(3)};
  }
  void set_power(bool is_on, Time now) override {
    written_ = read_ = slot_ = 0;
    Host::set_power(is_on, now);
  }
  std::vector<std::uint8_t> ring_ = std::vector<std::uint8_t>(512);
  std::size_t written_ = 0;
  std::size_t read_ = 0;
  std::size_t slot_ = 0;
};

// What is right at 375 kbit/s.
class EarliestResponseFixed : public Host {
  using Host::Host;
  Duration shortest_turnaround_time() const override { return 44 * kernel::kMicrosecond; }
};

class ReadsBackAfterError4 : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    const Command failed = exchange()->command;
    const bool is_write = failed.command == rules().write_command;
    Host::fail(kind, now);
    if (!is_write || !configuration().verifies_writes) return;
    write(std::array{failed.id, static_cast<std::uint8_t>(rules().read_command), failed.data0, failed.data1},
          now);
  }
};

// Writes do not end it.
class LateUntilARead : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    if (kind == HostErrorKind::no_response) silent_ = exchange()->command.id;
    Host::fail(kind, now);
  }
  bool awaits_response(const Exchange& exchange) const override {
    if (Host::awaits_response(exchange)) silent_.reset();
    return Host::awaits_response(exchange);
  }
  void on_stray(const valve_bus::CollectedFrame& frame, Time now) override {
    if (!silent_) return Host::on_stray(frame, now);
    const auto before = counted(*silent_).late;
    Host::on_stray(frame, now);
    counted(*silent_).late = before + 1;
  }
  mutable std::optional<std::uint8_t> silent_;
};

}  // namespace fieldproof::conformance::host_seeded_faults
