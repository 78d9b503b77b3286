#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in what the PC meets: orders, their FIFO, what it is told, the DIP switches.
namespace fieldproof::conformance::host_seeded_faults {

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

// Gives all up with a part of a command.
class PartTakesTheFifo : public Host {
  using Host::Host;
  void on_part(Octets part, Time now) override {
    while (next_command()) {
    }
    Host::on_part(part, now);
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

// ---- what it remembers ----

class KindOfAnyAttempt : public Host {
  using Host::Host;
  void send(Time now) override {
    Host::send(now);
    if (exchange() && exchange()->attempt == 1) before_ = counted(last_id()).rejected;
  }
  void fail(HostErrorKind kind, Time now) override {
    Host::fail(counted(last_id()).rejected > before_ ? HostErrorKind::bad_response : kind, now);
  }
  std::uint64_t before_ = 0;
};

class OldDataOfAnyNode : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    last_ = response;
    Host::tell(response, now);
  }
  void tell_old(std::uint8_t id, Time now) override {
    if (known(id) && last_) Host::tell(HostResponse{id, last_->data0, last_->data1, true}, now);
  }
  using Host::tell;
  std::optional<HostResponse> last_;
};

class OldDataToldOnce : public Host {
  using Host::Host;
  void tell_old(std::uint8_t id, Time now) override {
    if (told_.insert(id).second) Host::tell_old(id, now);
  }
  std::set<std::uint8_t> told_;
};

class CountersOf8Bits : public Host {
  using Host::Host;
  HostCounters counters(std::uint8_t id) const override {
    constexpr std::uint64_t kOctet = 0xFF;
    const HostCounters all = Host::counters(id);
    return {all.timeouts & kOctet, all.rejected & kOctet, all.late & kOctet, all.retries & kOctet};
  }
};

// Adds what was counted before its supply was lost.
class CountersOverPowerLoss : public Host {
  using Host::Host;
  void set_power(bool is_on, Time now) override {
    if (!is_on)
      for (unsigned id = 0; id < kept_.size(); ++id)
        kept_[id] = counters(static_cast<std::uint8_t>(id)).timeouts;
    Host::set_power(is_on, now);
  }
  HostCounters counters(std::uint8_t id) const override {
    HostCounters all = Host::counters(id);
    all.timeouts += kept_.at(id);
    return all;
  }
  std::array<std::uint64_t, 256> kept_{};
};

class OverflowOverPowerLoss : public Host {
  using Host::Host;
  void set_power(bool is_on, Time now) override {
    had_overflowed_ = had_overflowed_ || has_overflowed();
    Host::set_power(is_on, now);
  }
  bool has_overflowed() const override { return had_overflowed_ || Host::has_overflowed(); }
  bool had_overflowed_ = false;
};

// Writes to each node what it wrote before its supply was lost.
class RefreshesOverPowerLoss : public Host {
  using Host::Host;
  void keep_write(const Command& command) override {
    kept_ = command;
    Host::keep_write(command);
  }
  void set_power(bool is_on, Time now) override {
    Host::set_power(is_on, now);
    if (is_on && kept_) write(std::array{kept_->id, kept_->command, kept_->data0, kept_->data1}, now);
  }
  std::optional<Command> kept_;
};

class EqualResponsesToldOnce : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    if (std::exchange(last_, response) != response) Host::tell(response, now);
  }
  using Host::tell;
  std::optional<HostResponse> last_;
};

class ZerosNotTold : public Host {
  using Host::Host;
  void tell(const HostResponse& response, Time now) override {
    if (response.data0 != 0 || response.data1 != 0) Host::tell(response, now);
  }
  using Host::tell;
};

class EqualWritesSentOnce : public Host {
  using Host::Host;
  std::optional<Command> next_command() override {
    const auto command = Host::next_command();
    const bool is_write = command && command->command == rules().write_command;
    if (is_write && std::exchange(last_, command) == command) return Host::next_command();
    return command;
  }
  std::optional<Command> last_;
};

class VerifiesRefreshes : public Host {
  using Host::Host;
  void send(Time now) override {
    const Command command = exchange()->command;
    const bool is_refresh = exchange()->purpose == Purpose::refresh;
    Host::send(now);
    if (is_refresh && configuration().verifies_writes)
      write(std::array{command.id, static_cast<std::uint8_t>(rules().read_command), command.data0,
                       command.data1},
            now);
  }
};

class RefreshesWhenIdle : public Host {
  using Host::Host;
  bool may_refresh(bool) const override { return !fifo().has_command(); }
};

class RefreshesGoFirst : public Host {
  using Host::Host;
  bool may_refresh(bool) const override { return true; }
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

}  // namespace fieldproof::conformance::host_seeded_faults
