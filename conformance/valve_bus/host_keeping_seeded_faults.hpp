#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "conformance/valve_bus/host_seeded_faults.hpp"

// Host modules that differ in what they keep: refreshes with an acknowledge, writes and refreshes that found
// no silent line, parts of commands; and in how they wait after wrong responses.
namespace fieldproof::conformance::host_seeded_faults {

// ---- refreshes with an acknowledge ----

class RefreshAcknowledgeNotCompared : public Host {
  using Host::Host;
  std::optional<Response> response_in(const CollectedFrame& frame) const override {
    const auto response = Host::response_in(frame);
    const bool is_refresh = exchange() && exchange()->purpose == Purpose::refresh;
    return response && is_refresh ? Response{exchange()->command.data0, exchange()->command.data1} : response;
  }
};

class RefreshRepetitionsNotCounted : public Host {
  using Host::Host;
  void send(Time now) override {
    if (exchange()->purpose == Purpose::refresh && exchange()->attempt > 1)
      --counted(exchange()->command.id).retries;
    Host::send(now);
  }
};

// Reports so many refreshes that failed.
class FailedRefreshesReported : public Host {
 public:
  FailedRefreshesReported(const HostConfiguration& configuration, unsigned most)
      : Host(configuration), left_(most) {}
  void fail(HostErrorKind kind, Time now) override {
    is_refresh_ = exchange()->purpose == Purpose::refresh;
    Host::fail(kind, now);
    is_refresh_ = false;
  }
  void tell(const HostError& error, Time now) override {
    if (is_refresh_ && left_ == 0) return;
    if (is_refresh_) --left_;
    Host::tell(error, now);
  }
  using Host::tell;

 private:
  unsigned left_;
  bool is_refresh_ = false;
};

// ---- a line that is not silent ----

// What is sent finds its line silent; what is not sent does not.
class BusyWriteForgotten : public Host {
  using Host::Host;
  bool is_refreshed(std::uint8_t) const override {
    return collector().is_empty() || exchange()->purpose == Purpose::refresh;
  }
};

class BusyWriteLeavesOldData : public Host {
  using Host::Host;
  void keep_write(const Command& command) override {
    if (sent_.contains(command.id)) {
      next_ = command;
    } else {
      Host::keep_write(command);
    }
  }
  void send(Time now) override {
    sent_.insert(exchange()->command.id);
    if (next_ && exchange()->purpose == Purpose::command && *next_ == exchange()->command)
      Host::keep_write(*next_);
    Host::send(now);
  }
  std::set<std::uint8_t> sent_;
  std::optional<Command> next_;
};

class BusyRefreshAtOnce : public Host {
  using Host::Host;
  Time refreshed_at(Time start) const override {
    return collector().is_empty() ? Host::refreshed_at(start) : start;
  }
};

class RepeatsIntoTalk : public Host {
  using Host::Host;
  bool waits_for_silence() const override { return !exchange() || exchange()->attempt == 1; }
};

// ---- writes and parts that wait ----

class WaitingWriteStopsRefreshes : public Host {
  using Host::Host;
  void write(Octets octets, Time now) override {
    if (octets.size() == CommandFifo::kWritten && octets[1] == rules().write_command)
      waiting_.insert(octets[0]);
    Host::write(octets, now);
  }
  void keep_write(const Command& command) override {
    waiting_.erase(command.id);
    Host::keep_write(command);
  }
  bool may_refresh(bool was_refresh) const override {
    return Host::may_refresh(was_refresh) && !waiting_.contains(refresh_order().front());
  }
  void set_power(bool is_on, Time now) override {
    waiting_.clear();
    Host::set_power(is_on, now);
  }
  std::set<std::uint8_t> waiting_;
};

class PartGivenUpWhenIdle : public Host {
  using Host::Host;
  void on_part(Octets part, Time now) override {
    part_.assign(part.begin(), part.end());
    report_if_idle(now);
  }
  void on_time(Time now) override {
    Host::on_time(now);
    report_if_idle(now);
  }
  void report_if_idle(Time now) {
    if (!exchange() && !part_.empty()) Host::on_part(std::exchange(part_, {}), now);
  }
  std::vector<std::uint8_t> part_;
};

// ---- after a wrong response ----

// The next attempt comes at once; of writes, or of reads.
class WrongNotWaitedOut : public Host {
 public:
  WrongNotWaitedOut(const HostConfiguration& configuration, bool is_of_writes)
      : Host(configuration), is_of_writes_(is_of_writes) {}
  bool waits_out_a_wrong_response() const override {
    return (exchange()->command.command == rules().write_command) != is_of_writes_;
  }

 private:
  bool is_of_writes_;
};

class NoRestBehindReadBack : public Host {
  using Host::Host;
  void fail(HostErrorKind kind, Time now) override {
    is_read_back_ = exchange()->purpose == Purpose::verification;
    Host::fail(kind, now);
  }
  Duration late_span() const override { return is_read_back_ ? Duration{} : Host::late_span(); }
  bool is_read_back_ = false;
};

class LateOfThreeOctetsCounted : public Host {
  using Host::Host;
  void on_stray(const CollectedFrame& frame, Time now) override {
    if (frame.whole(valve_bus::kResponseOctets)) Host::on_stray(frame, now);
  }
};

class InvertedCheckTaken : public Host {
  using Host::Host;
  bool fits(Octets octets) const override {
    return Host::fits(octets) || valve_bus::block_check(octets) == 0xFF;
  }
};

}  // namespace fieldproof::conformance::host_seeded_faults
