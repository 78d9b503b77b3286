#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/measure/time_course.hpp"
#include "harness/network/exchange_statistics.hpp"

// When the errors of an immunity run came: what its sums forget.
namespace fieldproof::emc {

// Contract: the time in which bursts come is cut into equal windows, and what follows it, until the
// installation is well again, is one more. Each exchange of data counts to the window in which it ended, so
// the windows add up to the statistics of the run.
class ImmunityCourse {
 public:
  static constexpr std::int64_t kWindows = 60;

  struct Window {
    std::uint64_t exchanges = 0;
    std::uint64_t rejected = 0;
    std::uint64_t accepted_wrong = 0;
    std::uint64_t stops = 0;
  };

  ImmunityCourse() = default;
  // Bursts may come from here on for so long.
  ImmunityCourse(kernel::Time on, kernel::Duration length)
      : on_(on), length_(length), windows_(kWindows + 1) {}

  // What has been counted since the last call came then.
  void take(const network::ErrorStatistics& counts, kernel::Time when);
  void note_stop(kernel::Time when) { ++at(when).stops; }
  void set_bursts(std::vector<measure::Band> bursts) { bursts_ = std::move(bursts); }

  kernel::Duration length() const { return length_; }
  // The last one is the recovery; none where no run was made.
  const std::vector<Window>& windows() const { return windows_; }
  // Since the first instant; those that are too near to each other are one.
  const std::vector<measure::Band>& bursts() const { return bursts_; }

 private:
  Window& at(kernel::Time when);

  kernel::Time on_{};
  kernel::Duration length_{1};
  std::vector<Window> windows_;
  std::vector<measure::Band> bursts_;
  network::ErrorStatistics before_;
};

}  // namespace fieldproof::emc
