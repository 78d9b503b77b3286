#include "emc/pulse_picture.hpp"

#include <algorithm>
#include <cmath>

namespace fieldproof::emc {
namespace {

constexpr double kLeft = 0.01;
constexpr kernel::Duration kFinest = kernel::kNanosecond;

// How many steps are shown: up to the last one that is more than what may be left.
std::size_t steps_shown(const std::vector<double>& volts, const WrongOutput& wrong) {
  double peak = 0;
  for (const double one : volts) peak = std::max(peak, std::abs(one));
  std::size_t last = volts.size();
  while (last > 1 && std::abs(volts[last - 1]) < kLeft * peak) --last;
  const auto until_right = static_cast<std::size_t>(wrong.hull().to / LineResponse::kStep);
  return std::max(last, until_right);
}

}  // namespace

PulsePicture picture_of(const LineResponse& response, double open_circuit_volts, Polarity polarity) {
  PulsePicture picture{
      open_circuit_volts, polarity, kFinest, {}, {}, response.wrong_output(open_circuit_volts, polarity)};
  const std::vector<double> volts = response.receiver_volts(open_circuit_volts, polarity);
  const kernel::Duration shown =
      static_cast<std::int64_t>(steps_shown(volts, picture.wrong)) * LineResponse::kStep;
  // Whole steps of the finest, so that there are not too many.
  picture.step = kFinest * (1 + shown / (kFinest * static_cast<std::int64_t>(kMostValues)));
  const Pulse pulse(response.coupling().pulse);
  for (kernel::Duration at{}; at <= shown; at += picture.step) {
    const double seconds = static_cast<double>(at.count()) / static_cast<double>(kernel::kSecond.count());
    const auto n = static_cast<std::size_t>(at / LineResponse::kStep);
    picture.generator_v.push_back(static_cast<double>(polarity) * open_circuit_volts * pulse.at(seconds));
    picture.receiver_v.push_back(n < volts.size() ? volts[n] : 0);
  }
  return picture;
}

}  // namespace fieldproof::emc
