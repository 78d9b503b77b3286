#pragma once

#include <map>
#include <optional>
#include <utility>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules whose fault shows only in a sequence: each does with any single order what it should. They are
// for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::host_seeded_faults {

class RepeatedReadNotSent : public Host {
  using Host::Host;
  std::optional<Command> next_command() override {
    auto command = Host::next_command();
    if (command && command->command == rules().read_command && last_read_ == command->id) {
      Host::tell(valve_bus::HostResponse{last_->id, last_->data0, last_->data1}, now_);
      return Host::next_command();
    }
    return command;
  }
  void tell(const valve_bus::HostResponse& response, Time now) override {
    Host::tell(response, now);
    last_ = response;
    last_read_ = response.id;
    now_ = now;
  }
  void tell(const valve_bus::HostError& error, Time now) override {
    Host::tell(error, now);
    last_read_.reset();
  }
  std::optional<std::uint8_t> last_read_;
  std::optional<valve_bus::HostResponse> last_;
  Time now_{};
};

class OneRetryLessBehindError : public Host {
  using Host::Host;
  bool may_repeat(const Exchange& exchange) const override {
    return has_failed_ ? exchange.attempt + 1 < rules().read_attempts : Host::may_repeat(exchange);
  }
  void fail(valve_bus::HostErrorKind kind, Time now) override {
    Host::fail(kind, now);
    has_failed_ = true;
  }
  void tell(const valve_bus::HostResponse& response, Time now) override {
    Host::tell(response, now);
    has_failed_ = has_failed_ && response.is_old;
  }
  using Host::tell;
  bool has_failed_ = false;
};

class OldDataSurvivePower : public Host {
  using Host::Host;
  void tell(const valve_bus::HostResponse& response, Time now) override {
    Host::tell(response, now);
    last_[response.id] = response;
  }
  using Host::tell;
  void tell_old(std::uint8_t id, Time now) override {
    const auto old = last_.find(id);
    if (known(id) || old == last_.end()) return Host::tell_old(id, now);
    tell(valve_bus::HostResponse{id, old->second.data0, old->second.data1, true}, now);
  }
  std::map<std::uint8_t, valve_bus::HostResponse> last_;
};

class RejectedResponseKept : public Host {
  using Host::Host;
  std::optional<valve_bus::Response> response_in(const CollectedFrame& frame) const override {
    auto response = Host::response_in(frame);
    const auto kept = std::exchange(kept_, std::nullopt);
    if (response && kept) response->data0 = *kept;
    if (!response && frame.count > 0) kept_ = frame.octets[0];
    return response;
  }
  mutable std::optional<std::uint8_t> kept_;
};

class RefusedCommandCostsNext : public Host {
  using Host::Host;
  void refuse(const valve_bus::HostError& error, Time now) override {
    Host::refuse(error, now);
    has_refused_ = true;
  }
  std::optional<Command> next_command() override {
    auto command = Host::next_command();
    return command && std::exchange(has_refused_, false) ? Host::next_command() : command;
  }
  bool has_refused_ = false;
};

class WriteBehindErrorExchanged : public Host {
  using Host::Host;
  void fail(valve_bus::HostErrorKind kind, Time now) override {
    Host::fail(kind, now);
    is_behind_error_ = true;
  }
  std::optional<Command> next_command() override {
    auto command = Host::next_command();
    const bool is_write = command && command->command == rules().write_command;
    if (command && std::exchange(is_behind_error_, false) && is_write)
      std::swap(command->data0, command->data1);
    return command;
  }
  bool is_behind_error_ = false;
};

}  // namespace fieldproof::conformance::host_seeded_faults
