#pragma once

#include <vector>

#include "protocols/interbus/skew.hpp"
#include "protocols/interbus/slave.hpp"

// The reference slave with another instant at which it samples its inputs; the outputs are latched at the end
// of the frame in each. Sources do not say which instant a station takes, so a measurement declares it.
//
//   frame_edges     M2, the reference: at the start of the frame
//   previous_frame  M3: at the end of the frame before; when that one broke off, at the end of the last whole
//   one same_instant    M1: the value that the input will have when the outputs of this frame are latched
//
// No station can be built like M1: its inputs travel in the frame at whose end they are taken. It is the
// bound that underlies the published worst case of two cycle times, and here it only works because a signal
// of the bench is known ahead.
namespace fieldproof::interbus {

class LatchingSlave final : public Slave {
 public:
  // `sample_to_latch`: see station_timing.hpp.
  LatchingSlave(const SlaveConfiguration& configuration, LatchModel model, kernel::Duration sample_to_latch);

 protected:
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override;
  void on_cycle_end(kernel::Time when) override;

 private:
  LatchModel model_;
  kernel::Duration sample_to_latch_;
  std::vector<std::uint8_t> sampled_;  // M3: at the end of the frame before
};

}  // namespace fieldproof::interbus
