#pragma once

#include <cstdint>

#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/traffic/milliseconds.hpp"

// Instants at which packets come, independent of each other.
namespace fieldproof::traffic {

class PoissonArrivals {
 public:
  PoissonArrivals(double per_ms, const kernel::Random& random)
      : mean_gap_(per_ms > 0 ? kPicosecondsPerMs / per_ms : 0), random_(random) {
    draw();
  }
  kernel::Time next() const { return next_; }
  void draw() {
    if (mean_gap_ == 0) {
      next_ = kernel::kNever;
      return;
    }
    const double gap = -mean_gap_ * kernel::portable_log(1 - random_.uniform());
    next_ += kernel::Duration{static_cast<std::int64_t>(gap)};
  }

 private:
  double mean_gap_;
  kernel::Random random_;
  kernel::Time next_ = kernel::kStart;
};

}  // namespace fieldproof::traffic
