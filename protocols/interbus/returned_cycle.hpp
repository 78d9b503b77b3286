#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram.hpp"
#include "protocols/interbus/cycle_frame.hpp"

// What came back of one cycle: the octets of the data telegrams in order, and how their headers differ from
// those that were expected. Only data telegrams count; the status telegrams of the pauses are left out by
// whoever collects.
namespace fieldproof::interbus {

class ReturnedCycle {
 public:
  // A cycle of `count` telegrams, the first `transfer` of them (with the loopback word) in the transfer
  // phase.
  void begin(std::size_t count, std::size_t transfer, bool is_id_cycle) {
    if (octets_.size() < count) octets_.resize(count);
    headers_ = cycle_headers(is_id_cycle);
    expected_ = count;
    transfer_ = transfer;
    count_ = extra_ = 0;
    differences_ = 0;
  }

  // Gives true for the last expected one. Telegrams beyond it are counted only.
  bool add(const line::Telegram& telegram) {
    if (count_ == expected_) {
      ++extra_;
      return false;
    }
    octets_[count_] = telegram.data;
    const std::uint8_t header = count_ < transfer_ ? headers_.transfer : headers_.check;
    differences_ |= static_cast<std::uint8_t>(telegram.header ^ header);
    return ++count_ == expected_;
  }
  void add_broken() { differences_ |= line::kStopMissing; }

  // Octets that did not come are 0 from here on.
  void finish() {
    if (count_ < expected_)
      std::fill_n(octets_.begin() + static_cast<std::ptrdiff_t>(count_), expected_ - count_, 0);
  }

  std::size_t count() const { return count_ + extra_; }
  std::size_t expected() const { return expected_; }
  bool has_exact_count() const { return count_ == expected_ && extra_ == 0; }
  bool is_stop_missing() const { return (differences_ & line::kStopMissing) != 0; }
  bool is_in_phase() const { return (differences_ & (line::kSelect | line::kControl)) == 0; }

  // The octets of the transfer phase, loopback word included.
  std::span<const std::uint8_t> transfer() const { return {octets_.data(), transfer_}; }
  std::uint16_t word(std::size_t octet) const {
    return static_cast<std::uint16_t>(octets_[octet] << 8 | octets_[octet + 1]);
  }
  std::uint16_t check() const { return word(transfer_); }
  std::uint16_t status() const { return word(transfer_ + 2); }

 private:
  std::vector<std::uint8_t> octets_;
  CycleHeaders headers_;
  std::size_t expected_ = 0;
  std::size_t transfer_ = 0;
  std::size_t count_ = 0;
  std::size_t extra_ = 0;
  std::uint8_t differences_ = 0;
};

}  // namespace fieldproof::interbus
