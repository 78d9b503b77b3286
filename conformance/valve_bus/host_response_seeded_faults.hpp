#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in how long they wait for a response, and in what they take for one.
namespace fieldproof::conformance::host_seeded_faults {

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
  Duration shortest_turnaround_time() const override { return {}; }
};

class WaitsLongBehindErrors : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    Host::fail(kind, now);
    leave_silent_until(now + 20 * kernel::kMillisecond);
  }
};

class WantsADelimiterBeforeResponses : public Host {
  using Host::Host;
  Duration shortest_turnaround_time() const override { return 3 * valve_bus::character_time(rules()); }
};

class BusyToldAsSilence : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    Host::fail(kind == HostErrorKind::line_busy ? HostErrorKind::no_response : kind, now);
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
    const bool is_long = frame.count > 3 && frame.count <= frame.octets.size() && !frame.is_spoilt;
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
  bool is_own(const UartCharacter&) const override { return false; }
  void send(Time now) override {
    echo_.clear();
    Host::send(now);
  }
  void on_character(const UartCharacter& character) override {
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

// What answers a write is made to be what was written.
class AnyAcknowledgeTaken : public Host {
  using Host::Host;
  std::optional<Response> response_in(const CollectedFrame& frame) const override {
    const auto response = Host::response_in(frame);
    const bool is_write = exchange() && exchange()->command.command == rules().write_command;
    return response && is_write ? Response{exchange()->command.data0, exchange()->command.data1} : response;
  }
};

class RightAfterWrongTaken : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    const auto response = response_in(frame);
    if (response && state() == valve_bus::HostState::awaiting) {
      accept(*response, now);
    } else {
      Host::on_stray(frame, now);
    }
  }
};

class StrayToldAsResponse : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    const auto response = response_in(frame);
    if (response) tell(HostResponse{last_id(), response->data0, response->data1}, now);
  }
};

}  // namespace fieldproof::conformance::host_seeded_faults
