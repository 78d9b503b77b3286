#pragma once

#include <algorithm>

#include "conformance/interbus/master_seeded_faults.hpp"

// Masters whose fault shows only with more of something: stations, words, bad cycles, orders.
namespace fieldproof::conformance::seeded_faults {

struct LooksAtEightStations final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    for (std::vector<int>* list : {&status.peripheral_faults, &status.reconfigurations})
      std::erase_if(*list, [](int station) { return station >= 8; });
    return status;
  }
};

struct PlaceInRingOrder final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    if (status.has_fault_location && status.fault_location.to > 0)
      status.fault_location.from = status.fault_location.to - 1;
    return status;
  }
};

struct Writes256Words final : Master {
  using Master::Master;
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    Master::write_output(word & 0xFFU, value, now);
  }
};

struct CycleTimeIn32Bits final : Master {
  explicit CycleTimeIn32Bits(MasterConfiguration configuration) : Master(cut(std::move(configuration))) {}

 private:
  static MasterConfiguration cut(MasterConfiguration configuration) {
    configuration.cycle_time %= (std::int64_t{1} << 32) * kernel::kNanosecond;
    return configuration;
  }
};

// It meets each order by an ID cycle of its own.
struct OrdersOfIdCyclesAddUp final : Master {
  using Master::Master;
  void request_id_cycle(kernel::Time now) override {
    ++asked_;
    Master::request_id_cycle(now);
  }
  void run_copy_task() override {
    Master::run_copy_task();
    if (asked_ > 1) Master::request_id_cycle({});
    if (asked_ > 0) --asked_;
  }
  unsigned asked_ = 0;
};

}  // namespace fieldproof::conformance::seeded_faults
