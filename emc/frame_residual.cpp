#include "emc/frame_residual.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "emc/residual/block_check.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kAssumedBer = 1e-2;
constexpr int kRatesInADecade = 32;
constexpr double kHour = 3600e12;  // ps

// The largest share at any bit-error rate, looked for in equal ratios from where hardly any frame has two
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

DualWeights dual_weights_of(const network::ProtectedFrame& frame) {
  if (frame.frame_check.empty()) return dual_weights(BlockCheck{frame.bits / 8, false});
  const line::FrameCheckParameters& check = line::frame_check_named(frame.frame_check);
  FIELDPROOF_CHECK(check.width <= 16, "the network has a frame check of up to 16 bits");
  return dual_weights(check, frame.bits);
}

}  // namespace

FrameResidual frame_residual(const network::ProtectedFrame& frame) {
  FrameResidual residual;
  residual.frame_check = frame.frame_check.empty() ? "exclusive or of octets" : frame.frame_check;
  residual.bits = frame.bits;
  const DualWeights dual = dual_weights_of(frame);
  find_worst(dual, residual);
  residual.probability_at_one_in_100 = undetected_error_probability(dual, kAssumedBer);
  if (frame.distance > kernel::Duration{}) {
    residual.rate_per_hour = residual_error_rate_per_hour(
        residual.probability_at_one_in_100, kHour / static_cast<double>(frame.distance.count()), 1);
  }
  return residual;
}

double undetected_share_at(const network::ProtectedFrame& frame, double ber) {
  return undetected_share_of_corrupted(dual_weights_of(frame), ber);
}

// The incomplete gamma function is the sum of the distribution's upper tail.
double chance_of_at_least(std::uint64_t counted, double expected) {
  if (counted == 0) return 1;
  return boost::math::gamma_p(static_cast<double>(counted), expected);
}

}  // namespace fieldproof::emc
