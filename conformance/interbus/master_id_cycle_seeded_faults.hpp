#pragma once

#include "conformance/interbus/master_seeded_faults.hpp"

// Masters whose fault is in their recognition, or in when they take an order for an ID cycle.
namespace fieldproof::conformance::seeded_faults {

struct RecognitionStopsLate final : Master {
  using Master::Master;
  bool reaches_stop(unsigned consecutive) const override {
    const bool is_recognising = status().state == interbus::MasterState::identification;
    return Master::reaches_stop(consecutive - (is_recognising ? 1 : 0));
  }
};

struct RecognitionAddsUp final : Master {
  using Master::Master;
  bool clears_consecutive() const override { return status().state != interbus::MasterState::identification; }
};

struct MessagesOfRecognitionLost final : Master {
  using Master::Master;
  bool reports_peripheral_fault() const override { return status().state == interbus::MasterState::run; }
};

// Takes the one on the line for the one that is asked for.
struct OrderInIdCycleLost final : Master {
  using Master::Master;
  std::uint8_t id_select() const override {
    is_id_cycle_ = true;
    return Master::id_select();
  }
  void take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const override {
    is_id_cycle_ = false;
    Master::take_outputs(image, sent);
  }
  void request_id_cycle(kernel::Time now) override {
    if (!is_id_cycle_) Master::request_id_cycle(now);
  }
  mutable bool is_id_cycle_ = false;
};

}  // namespace fieldproof::conformance::seeded_faults
