#pragma once

#include <optional>
#include <utility>

#include "conformance/interbus/master_seeded_faults.hpp"

// Masters whose fault shows at the ends of settings, in rings of many stations, or around a start.
namespace fieldproof::conformance::seeded_faults {

struct Guards6Bits final : Master {
  using Master::Master;
  std::int64_t guard_bits() const override { return 6; }
};

struct Receives1024Telegrams final : Master {
  using Master::Master;
  bool accepts_count(const ReturnedCycle& returned) const override {
    constexpr std::size_t kRoom = 1'024;
    return returned.count() <= kRoom && Master::accepts_count(returned);
  }
};

struct CycleTimeInMicroseconds final : Master {
  explicit CycleTimeInMicroseconds(MasterConfiguration configuration)
      : Master(cut(std::move(configuration))) {}

 private:
  static MasterConfiguration cut(MasterConfiguration configuration) {
    configuration.cycle_time -= configuration.cycle_time % kernel::kMicrosecond;
    return configuration;
  }
};

struct LowOctetAndLengthCompared final : Master {
  using Master::Master;
  bool is_same_id(std::uint16_t found, std::uint16_t configured) const override {
    return (found & 0xFF) == (configured & 0xFF) && words_of(found) == words_of(configured);
  }
};

struct StationBeforeIn8Bits final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    for (interbus::FoundStation& station : status.stations) {
      if (station.before >= 0) station.before &= 0xFF;
    }
    return status;
  }
};

struct LocatedByIdCode final : Master {
  using Master::Master;
  bool is_same_station(const interbus::FoundStation& found,
                       const interbus::FoundStation& configured) const override {
    return is_same_id(found.id_code, configured.id_code);
  }
};

struct RingDelayKept final : Master {
  using Master::Master;
  kernel::Duration shortest_cycle_time() const override {
    if (!first_) first_ = ring_delay();
    return Master::shortest_cycle_time() - ring_delay() + *first_;
  }
  mutable std::optional<kernel::Duration> first_;
};

struct CountersGoOn final : Master {
  using Master::Master;
  void start(kernel::Time now) override {
    const MasterStatus before = status();
    Master::start(now);
    if (Master::status().data_cycles == 0) before_ = before;
  }
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    status.data_cycles += before_.data_cycles;
    status.id_cycles += before_.id_cycles;
    status.rejected_cycles += before_.rejected_cycles;
    status.rejected_data_cycles += before_.rejected_data_cycles;
    return status;
  }
  MasterStatus before_;
};

// Shares what it knows of the silence of a bus stop after which it looks for a fault.
struct KnowsItsSilence : Master {
  using Master::Master;
  bool reaches_stop(unsigned consecutive) const override {
    const bool stops = Master::reaches_stop(consecutive);
    is_silent_ = stops && Master::status().state == interbus::MasterState::run;
    return stops;
  }
  void on_time(kernel::Time now) override {
    Master::on_time(now);
    if (Master::status().state == interbus::MasterState::locating) is_silent_ = false;
  }
  bool is_in_silence() const {
    return is_silent_ && Master::status().state == interbus::MasterState::bus_stop;
  }
  mutable bool is_silent_ = false;
};

struct LocatesAtOnce final : KnowsItsSilence {
  using KnowsItsSilence::KnowsItsSilence;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    if (is_in_silence()) status.state = interbus::MasterState::locating;
    return status;
  }
};

struct StartIgnoredInSilence final : KnowsItsSilence {
  using KnowsItsSilence::KnowsItsSilence;
  void start(kernel::Time now) override {
    if (!is_in_silence()) Master::start(now);
  }
};

// Of the outputs that are ordered at one end of a cycle.
struct LastOrderOnly final : Master {
  using Master::Master;
  void on_cycle_end(CycleHook hook) override {
    if (!hook) return Master::on_cycle_end({});
    Master::on_cycle_end([this, hook = std::move(hook)](kernel::Time now, bool is_data, bool is_accepted) {
      is_at_end_ = true;
      hook(now, is_data, is_accepted);
      is_at_end_ = false;
      before_.reset();
    });
  }
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    if (before_) Master::write_output(before_->first, before_->second, now);
    if (is_at_end_) before_ = {word, output(word)};
    Master::write_output(word, value, now);
  }
  bool is_at_end_ = false;
  std::optional<std::pair<unsigned, std::uint16_t>> before_;
};

// Sends an output that was written before it ran, once, and does not show it.
struct EarlyOutputSent final : Master {
  using Master::Master;
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    if (status().state != interbus::MasterState::run) kept_ = {word, value};
    Master::write_output(word, value, now);
  }
  void take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const override {
    Master::take_outputs(image, sent);
    if (kept_ && kept_->first < sent.size()) sent[kept_->first] = kept_->second;
    kept_.reset();
  }
  mutable std::optional<std::pair<unsigned, std::uint16_t>> kept_;
};

}  // namespace fieldproof::conformance::seeded_faults
