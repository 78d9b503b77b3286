#pragma once

#include <map>

#include "conformance/interbus/master_seeded_faults.hpp"

// Masters whose fault is in what a stop or a start leaves, or in what stands at the end of a cycle or a list.
namespace fieldproof::conformance::seeded_faults {

struct InputsClearedByStop final : Master {
  using Master::Master;
  std::uint16_t input(unsigned word) const override {
    return status().state == interbus::MasterState::off ? 0 : Master::input(word);
  }
};

struct OutputAfterStopKept final : Master {
  using Master::Master;
  void start(kernel::Time now) override {
    written_.clear();
    is_stopping_ = false;
    Master::start(now);
  }
  void stop(kernel::Time now) override {
    is_stopping_ = true;
    Master::stop(now);
  }
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    if (is_stopping_) written_[word] = value;
    Master::write_output(word, value, now);
  }
  std::uint16_t output(unsigned word) const override {
    const auto written = written_.find(word);
    const bool is_off = status().state == interbus::MasterState::off;
    return is_off && written != written_.end() ? written->second : Master::output(word);
  }
  bool is_stopping_ = false;
  std::map<unsigned, std::uint16_t> written_;
};

struct BadStopCycleRepeated final : Master {
  using Master::Master;
  bool ends_stop(bool is_accepted) const override { return is_accepted; }
};

struct StartBeginsAgain final : Master {
  using Master::Master;
  void start(kernel::Time now) override {
    if (status().state == interbus::MasterState::identification) Master::stop(now);
    Master::start(now);
  }
};

struct LastEndTelegramNotCounted final : Master {
  using Master::Master;
  bool accepts_count(const interbus::ReturnedCycle& returned) const override {
    const bool is_one_short = rules().end_telegrams > 0 && returned.count() + 1 == returned.expected();
    return is_one_short || Master::accepts_count(returned);
  }
};

struct CopiesZeroForNoWord final : Master {
  using Master::Master;
  void run_copy_task() override {
    Master::run_copy_task();
    for (const auto& [from, to] : configuration().copy)
      if (from >= inputs().size() && to < outputs().size()) outputs()[to] = 0;
  }
};

}  // namespace fieldproof::conformance::seeded_faults
