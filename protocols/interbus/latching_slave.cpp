#include "protocols/interbus/latching_slave.hpp"

#include <algorithm>

namespace fieldproof::interbus {

LatchingSlave::LatchingSlave(const SlaveConfiguration& configuration, LatchModel model,
                             kernel::Duration sample_to_latch)
    : Slave(configuration),
      model_(model),
      sample_to_latch_(sample_to_latch),
      sampled_(2 * std::size_t{configuration.words}) {}

void LatchingSlave::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  switch (model_) {
    case LatchModel::same_instant:
      return Slave::sample_inputs(when + sample_to_latch_, octets);
    case LatchModel::frame_edges:
      return Slave::sample_inputs(when, octets);
    case LatchModel::previous_frame:
      std::ranges::copy(sampled_, octets.begin());
  }
}

void LatchingSlave::on_cycle_end(kernel::Time when) {
  if (model_ == LatchModel::previous_frame) Slave::sample_inputs(when, sampled_);
}

}  // namespace fieldproof::interbus
