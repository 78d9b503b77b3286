// One pulse as an oscilloscope would show it: as the generator makes it, and at the input of a receiver.
#pragma once

#include <cstddef>
#include <vector>

#include "emc/coupling.hpp"

namespace fieldproof::emc {

struct PulsePicture {
  double open_circuit_volts = 0;
  Polarity polarity = Polarity::positive;
  kernel::Duration step{};          // from value to value; the first is the begin of the pulse
  std::vector<double> generator_v;  // of the open-circuit setting
  // What is added to the line's own levels at the receiver, after its filter.
  std::vector<double> receiver_v;
  WrongOutput wrong;  // of the receiver, while either level is driven
};

// Until a hundredth of the receiver's peak is left and its output is right again; at most kMostValues values.
PulsePicture picture_of(const LineResponse& response, double open_circuit_volts, Polarity polarity);

inline constexpr std::size_t kMostValues = 1'000;

}  // namespace fieldproof::emc
