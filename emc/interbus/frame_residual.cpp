#include "emc/interbus/frame_residual.hpp"

#include <cmath>

#include "emc/residual/residual_error.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kAssumedBer = 1e-2;
constexpr int kRatesInADecade = 32;

// The largest share at any bit-error rate, looked for in equal ratios from where hardly any cycle has two
// flips up to a half. It is flat around its maximum.
void find_worst(const DualWeights& dual, FrameResidual& residual) {
  const double ratio = std::pow(10.0, 1.0 / kRatesInADecade);
  for (double ber = kGreatestBer; ber > 1e-2 / residual.bits; ber /= ratio) {
    const double share = undetected_share_of_corrupted(dual, ber);
    if (share <= residual.worst_share) continue;
    residual.worst_share = share;
    residual.worst_ber = ber;
  }
}

}  // namespace

FrameResidual frame_residual(const interbus::NetworkDescription& network, kernel::Duration cycle_time) {
  const line::FrameCheckParameters* check = line::find_frame_check(network.rules.frame_check);
  FIELDPROOF_CHECK(check != nullptr && check->width <= 16, "the network has a frame check of up to 16 bits");
  constexpr unsigned kLoopbackBits = 16;
  FrameResidual residual;
  residual.frame_check = network.rules.frame_check;
  residual.bits = kLoopbackBits + 8 * interbus::timing_input(network).user_octets + check->width;
  const DualWeights dual = dual_weights(*check, residual.bits);
  find_worst(dual, residual);
  residual.probability_at_one_in_100 = undetected_error_probability(dual, kAssumedBer);
  if (cycle_time > kernel::Duration{}) {
    const double cycles_per_hour = 3600e12 / static_cast<double>(cycle_time.count());
    residual.rate_per_hour =
        residual_error_rate_per_hour(residual.probability_at_one_in_100, cycles_per_hour, 1);
  }
  return residual;
}

}  // namespace fieldproof::emc
