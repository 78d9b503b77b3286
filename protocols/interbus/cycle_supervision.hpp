#pragma once

#include <cstdint>
#include <vector>

#include "protocols/interbus/rules.hpp"

// The counters of a master and what they decide: bad cycles in a row, and the quality bit over a sliding
// window of data cycles. The window needs only the numbers of the last `quality_bad_cycles` rejected data
// cycles.
namespace fieldproof::interbus {

class CycleSupervision {
 public:
  explicit CycleSupervision(const Rules& rules)
      : window_(rules.quality_window_cycles), last_bad_(rules.quality_bad_cycles) {}

  void count_data_cycle(bool accepted) {
    ++data_cycles_;
    if (accepted) return;
    ++rejected_cycles_;
    if (!last_bad_.empty()) last_bad_[rejected_data_cycles_ % last_bad_.size()] = data_cycles_;
    ++rejected_data_cycles_;
  }
  void count_id_cycle(bool accepted) {
    ++id_cycles_;
    if (!accepted) ++rejected_cycles_;
  }
  void count_consecutive() { ++consecutive_bad_; }
  void clear_consecutive() { consecutive_bad_ = 0; }

  std::uint64_t data_cycles() const { return data_cycles_; }
  std::uint64_t id_cycles() const { return id_cycles_; }
  std::uint64_t rejected_cycles() const { return rejected_cycles_; }
  std::uint64_t rejected_data_cycles() const { return rejected_data_cycles_; }
  unsigned consecutive_bad() const { return consecutive_bad_; }

  // At least `quality_bad_cycles` of the last `quality_window_cycles` data cycles were rejected.
  bool quality_bit() const {
    if (last_bad_.empty() || rejected_data_cycles_ < last_bad_.size()) return false;
    const std::uint64_t oldest = last_bad_[rejected_data_cycles_ % last_bad_.size()];
    return data_cycles_ - oldest < window_;
  }

 private:
  std::uint64_t window_;
  std::vector<std::uint64_t> last_bad_;  // numbers of data cycles, a ring
  std::uint64_t data_cycles_ = 0;
  std::uint64_t id_cycles_ = 0;
  std::uint64_t rejected_cycles_ = 0;
  std::uint64_t rejected_data_cycles_ = 0;
  unsigned consecutive_bad_ = 0;
};

}  // namespace fieldproof::interbus
