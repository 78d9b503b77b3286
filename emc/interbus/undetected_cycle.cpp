#include "emc/interbus/undetected_cycle.hpp"

#include <array>

#include "emc/residual/residual_error.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/frame_check_16.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::emc {
namespace {

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
    // The octet that would have to be the last one of the data, and the check that is sent after it; the
    // second octet of that is where the status word begins.
    const auto sent = check.check_octets(check.update_octet(before, right[0]));
    if (sent[0] == right[1] && sent[1] == status_high) ++fitting;
  }
  const double share = static_cast<double>(fitting) / kPrefixes;
  return {share / 256, is_status_whole_when_late ? share : 0};
}

}  // namespace fieldproof::emc
