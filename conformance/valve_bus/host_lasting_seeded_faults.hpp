#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in what lasts: what is written again and again, what survives the supply, and what
// is pending while the PC goes on.
namespace fieldproof::conformance::host_seeded_faults {

// ---- refreshes ----

class RefreshFromRest : public Host {
  using Host::Host;
  Time refreshed_at(Time start) const override {
    return Host::refreshed_at(start) + 5 * valve_bus::character_time(rules()) +
           valve_bus::delimiter(rules()) + rules().write_distance;
  }
};

class NewWriteRefreshedWithOld : public Host {
  using Host::Host;
  Time refreshed_at(Time start) const override {
    const bool is_new = exchange() && exchange()->purpose == Purpose::command;
    const auto& order = refresh_order();
    const bool has_old = is_new && std::ranges::find(order, last_id()) != order.end();
    return has_old ? std::max(start, kept_.at(last_id())) : kept_.at(last_id()) = Host::refreshed_at(start);
  }
  mutable std::array<Time, 256> kept_{};
};

// Compares with what a timer of 16 bits holds; it never reaches what is due after its end.
class MillisecondsOf16Bits : public Host {
  using Host::Host;
  Time refreshed_at(Time start) const override {
    constexpr std::int64_t kEnd = 0x10000;
    const Time due = Host::refreshed_at(start);
    return due >= Time{} + kEnd * kernel::kMillisecond ? kernel::kNever : due;
  }
};

class BusyRefreshIsTheLast : public Host {
  using Host::Host;
  void transmit(Octets octets, Time start) override {
    sent_ = start;
    Host::transmit(octets, start);
  }
  Time refreshed_at(Time start) const override {
    return start == sent_ ? Host::refreshed_at(start) : kernel::kNever;
  }
  Time sent_{};
};

class Refreshes64Nodes : public Host {
  using Host::Host;
  bool is_refreshed(std::uint8_t id) const override {
    constexpr std::size_t kPlaces = 64;
    if (!nodes_.contains(id) && nodes_.size() >= kPlaces) return false;
    nodes_.insert(id);
    return true;
  }
  mutable std::set<std::uint8_t> nodes_;
};

class RefreshesLowestFirst : public Host {
  using Host::Host;
  std::size_t next_refresh(Time now) const override {
    std::size_t lowest = 0;
    for (std::size_t n = 0; n < refresh_order().size() && refresh_due(refresh_order()[n]) <= now; ++n)
      if (refresh_order()[n] < refresh_order()[lowest]) lowest = n;
    return lowest;
  }
};

// ---- what survives the supply ----

class PartOverPowerLoss : public Host {
  using Host::Host;
  void write(Octets octets, Time now) override {
    part_.insert(part_.end(), octets.begin(), octets.end());
    part_.erase(part_.begin(), part_.end() - static_cast<std::ptrdiff_t>(part_.size() % kWritten));
    Host::write(octets, now);
  }
  void on_part(Octets part, Time now) override {
    part_.clear();
    Host::on_part(part, now);
  }
  void set_power(bool is_on, Time now) override {
    Host::set_power(is_on, now);
    if (is_on) Host::write(part_, now);
  }
  static constexpr std::size_t kWritten = CommandFifo::kWritten;
  std::vector<std::uint8_t> part_;
};

class VerificationOverPowerLoss : public Host {
  using Host::Host;
  void set_power(bool is_on, Time now) override {
    if (!is_on && exchange() && exchange()->purpose == Purpose::verification) pending_ = exchange()->command;
    Host::set_power(is_on, now);
    if (!is_on || !pending_) return;
    const Command read = *std::exchange(pending_, std::nullopt);
    Host::write(std::array{read.id, read.command, read.data0, read.data1}, now);
  }
  std::optional<Command> pending_;
};

class LateOverPowerLoss : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_late_ = kind == HostErrorKind::no_response;
    Host::fail(kind, now);
  }
  void send(Time now) override {
    is_late_ = false;
    Host::send(now);
  }
  void set_power(bool is_on, Time now) override {
    is_cycled_ = true;
    Host::set_power(is_on, now);
  }
  void on_stray(const CollectedFrame& frame, Time now) override {
    Host::on_stray(frame, now);
    if (is_late_ && is_cycled_) ++counted(last_id()).late;
  }
  bool is_late_ = false;
  bool is_cycled_ = false;
};

// ---- settings together ----

class AcknowledgedNotVerified : public Host {
  using Host::Host;
  bool is_read_back(const Exchange& write) const override {
    return !rules().answers_writes && Host::is_read_back(write);
  }
};

// Compares with what the PC wrote last to the node, sent or not.
class VerifiedAgainstNewest : public Host {
  using Host::Host;
  void write(Octets octets, Time now) override {
    if (octets.size() == CommandFifo::kWritten && octets[1] == rules().write_command)
      newest_.at(octets[0]) = {octets[2], octets[3]};
    Host::write(octets, now);
  }
  bool is_verified(const Command& written, const Response& read) const override {
    return read == newest_.at(written.id);
  }
  std::array<Response, 256> newest_{};
};

}  // namespace fieldproof::conformance::host_seeded_faults
