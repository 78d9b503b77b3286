#include "emc/interbus/frame_residual.hpp"

#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "emc/residual/residual_error.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/frame_check_16.hpp"
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

const line::FrameCheckParameters& frame_check_of(const interbus::NetworkDescription& network) {
  const line::FrameCheckParameters& check = line::frame_check_named(network.rules.frame_check);
  FIELDPROOF_CHECK(check.width <= 16, "the network has a frame check of up to 16 bits");
  return check;
}

unsigned protected_bits(const interbus::NetworkDescription& network) {
  constexpr unsigned kLoopbackBits = 16;
  return kLoopbackBits + 8 * interbus::timing_input(network).user_octets + frame_check_of(network).width;
}

DualWeights dual_weights_of(const interbus::NetworkDescription& network) {
  return dual_weights(frame_check_of(network), protected_bits(network));
}

}  // namespace

FrameResidual frame_residual(const interbus::NetworkDescription& network, kernel::Duration cycle_time) {
  FrameResidual residual;
  residual.frame_check = network.rules.frame_check;
  residual.bits = protected_bits(network);
  const DualWeights dual = dual_weights_of(network);
  find_worst(dual, residual);
  residual.probability_at_one_in_100 = undetected_error_probability(dual, kAssumedBer);
  if (cycle_time > kernel::Duration{}) {
    const double cycles_per_hour = 3600e12 / static_cast<double>(cycle_time.count());
    residual.rate_per_hour =
        residual_error_rate_per_hour(residual.probability_at_one_in_100, cycles_per_hour, 1);
  }
  return residual;
}

UndetectedCycle undetected_cycle(const interbus::NetworkDescription& network, double flip_probability) {
  // Start, flag, and the idle level in front of a telegram: a flip of one loses it or begins one too many.
  constexpr double kFramingLevels = 3;
  constexpr double kFitsByChance = 1.0 / 0x10000;
  const double telegrams = (protected_bits(network) + 16) / 8.0;  // with those of the status word
  const PassingShifts shifts = passing_shifts(network);
  return {undetected_error_probability(dual_weights_of(network), flip_probability),
          flip_probability * (shifts.early_check + shifts.late_check),
          flip_probability * kFramingLevels * telegrams * kFitsByChance};
}

// Two octets bring the register to each of its values once, so they stand for any data.
PassingShifts passing_shifts(const interbus::NetworkDescription& network) {
  const line::FrameCheck16& check = line::shared_frame_check_16(network.rules.frame_check);
  const unsigned status_high = network.rules.status_clean >> 8;
  const unsigned status_low = network.rules.status_clean & 0xFF;
  constexpr unsigned kPrefixes = 0x10000;
  constexpr unsigned kEndOctet = 0;
  const bool is_status_whole_when_late =
      network.rules.end_telegrams > 0 && status_low == status_high && kEndOctet == status_low;
  unsigned fitting = 0;
  for (unsigned prefix = 0; prefix < kPrefixes; ++prefix) {
    const std::array<std::uint8_t, 2> octets = {static_cast<std::uint8_t>(prefix >> 8),
                                                static_cast<std::uint8_t>(prefix & 0xFF)};
    const auto before = check.update(check.start(), octets);
    const auto right = check.check_octets(before);
    // The octet that would have to be the last one of the data, and the check that is sent behind it; the
    // second octet of that is where the status word begins.
    const auto sent = check.check_octets(check.update_octet(before, right[0]));
    if (sent[0] == right[1] && sent[1] == status_high) ++fitting;
  }
  const double share = static_cast<double>(fitting) / kPrefixes;
  return {share / 256, is_status_whole_when_late ? share : 0};
}

// The incomplete gamma function is the sum of the distribution's upper tail.
double chance_of_at_least(std::uint64_t counted, double expected) {
  if (counted == 0) return 1;
  return boost::math::gamma_p(static_cast<double>(counted), expected);
}

}  // namespace fieldproof::emc
