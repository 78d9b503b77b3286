#pragma once

#include <utility>
#include <vector>

#include "conformance/interbus/master_seeded_faults.hpp"

// Masters whose fault shows only in a sequence: each does with any single command what it should. They are
// for `check`; no case of the catalogue names them.
namespace fieldproof::conformance::seeded_faults {

struct SecondMarkAccepted final : Master {
  using Master::Master;
  bool accepts_status(std::uint16_t status) const override {
    const bool is_clean = Master::accepts_status(status);
    return std::exchange(was_marked_, !is_clean) || is_clean;
  }
  mutable bool was_marked_ = false;
};

struct StopOneEarlyAfterRestart final : Master {
  using Master::Master;
  void stop(kernel::Time now) override {
    Master::stop(now);
    was_stopped_ = true;
  }
  bool reaches_stop(unsigned consecutive) const override {
    return Master::reaches_stop(consecutive + (was_stopped_ ? 1U : 0U));
  }
  bool was_stopped_ = false;
};

struct InputsStaleAfterIdCycle final : Master {
  using Master::Master;
  void request_id_cycle(kernel::Time now) override {
    Master::request_id_cycle(now);
    was_asked_ = true;
  }
  void run_copy_task() override {
    if (std::exchange(was_asked_, false) && before_.size() == inputs().size()) inputs() = before_;
    before_ = inputs();
    Master::run_copy_task();
  }
  bool was_asked_ = false;
  std::vector<std::uint16_t> before_;
};

struct OutputAfterErrorLost final : Master {
  using Master::Master;
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    if (supervision().consecutive_bad() == 0) Master::write_output(word, value, now);
  }
};

struct FirstFaultReportedOnly final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    if (status.peripheral_faults.size() > 1) status.peripheral_faults.resize(1);
    return status;
  }
};

struct CopySkippedAfterError final : Master {
  using Master::Master;
  void on_rejected_inputs(std::span<const std::uint16_t> brought) override {
    Master::on_rejected_inputs(brought);
    has_rejected_ = true;
  }
  void run_copy_task() override {
    if (!std::exchange(has_rejected_, false)) Master::run_copy_task();
  }
  bool has_rejected_ = false;
};

}  // namespace fieldproof::conformance::seeded_faults
