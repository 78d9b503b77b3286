// What is counted of periodic and non-real-time intervals from packet to packet.
#pragma once

#include <cstdint>
#include <vector>

#include "protocols/bandwidth/window_traffic.hpp"

namespace fieldproof::papers {

class IntervalLedger {
 public:
  explicit IntervalLedger(kernel::Duration slot) : slot_(slot) {}

  void on_sent(const bandwidth::Sent& sent);

  // From a datum that begins an interval until its node is visited again.
  kernel::Duration longest_interval() const { return longest_; }
  // Non-real-time packets of a slot before its last datum.
  std::uint64_t most_packets() const { return most_; }
  // A non-real-time packet has gone in a periodic interval.
  bool has_sent_within() const { return has_sent_within_; }
  // A real-time packet has followed one of another kind in a visit.
  bool is_real_time_late() const { return is_real_time_late_; }

 private:
  void on_periodic(const bandwidth::Sent& sent);
  void on_non_real_time(const bandwidth::Sent& sent);

  kernel::Duration slot_;
  bool is_periodic_ = false;
  kernel::Time begin_{};
  kernel::Duration longest_{};
  std::int64_t of_slot_ = -1;
  std::uint64_t packets_ = 0, most_ = 0;
  std::vector<bandwidth::Sent> others_;
  bool has_sent_within_ = false;
  bool is_real_time_late_ = false;
  std::uint8_t node_ = 0;
  kernel::Time end_{};
  bandwidth::Packet last_ = bandwidth::Packet::none;
};

// Of so many slots in which the other queues send thus.
IntervalLedger ledger_of(const bandwidth::WindowTraffic& traffic, bandwidth::Load others, std::uint64_t slots,
                         std::uint64_t seed);

}  // namespace fieldproof::papers
