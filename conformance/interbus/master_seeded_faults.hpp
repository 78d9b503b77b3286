#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "protocols/interbus/master.hpp"

// The mutant masters, each an override of one decision. They exist for the suite only.
namespace fieldproof::conformance::seeded_faults {

using interbus::FaultLocation;
using interbus::Master;
using interbus::MasterConfiguration;
using interbus::MasterStatus;
using interbus::ReturnedCycle;

struct LoopbackNotCompared final : Master {
  using Master::Master;
  bool accepts_loopback(const ReturnedCycle&, std::size_t) const override { return true; }
};

struct LoopbackPositionNotCompared final : Master {
  using Master::Master;
  bool accepts_loopback(const ReturnedCycle& returned, std::size_t octet) const override {
    if (Master::accepts_loopback(returned, octet)) return true;
    std::uint32_t bits = 0;
    for (const std::uint8_t next : returned.transfer()) {
      bits = bits << 8 | next;
      for (unsigned shift = 0; shift < 8; ++shift) {
        if (((bits >> shift) & 0xFFFF) == rules().loopback_word) return true;
      }
    }
    return false;
  }
};

struct OwnCheckIgnored final : Master {
  using Master::Master;
  bool accepts_check(const ReturnedCycle&) const override { return true; }
};

struct StatusWordIgnored final : Master {
  using Master::Master;
  bool accepts_status(std::uint16_t) const override { return true; }
};

struct InputsTakenBeforeCheck final : Master {
  using Master::Master;
  void on_rejected_inputs(std::span<const std::uint16_t> brought) override {
    std::ranges::copy(brought, inputs().begin());
  }
};

struct InputsZeroedOnError final : Master {
  using Master::Master;
  void on_rejected_inputs(std::span<const std::uint16_t>) override {
    std::ranges::fill(inputs(), std::uint16_t{0});
  }
};

struct NoIdCycleAfterError final : Master {
  using Master::Master;
  bool needs_id_cycle_after_error() const override { return false; }
};

struct ConsecutiveNeverCleared final : Master {
  using Master::Master;
  bool clears_consecutive() const override { return false; }
};

struct FirstStationFirst final : Master {
  using Master::Master;
  std::vector<unsigned> output_order() const override {
    std::vector<unsigned> order = shift_order();
    std::ranges::sort(order);
    return order;
  }
};

struct LengthCodeBinary final : Master {
  using Master::Master;
  std::optional<unsigned> words_of(std::uint16_t id_code) const override { return (id_code >> 8) & 0x1FU; }
};

struct CheckOmitsLoopback final : Master {
  using Master::Master;
  std::uint16_t check_of(std::span<const std::uint8_t> sent, interbus::CycleHeaders headers) const override {
    return Master::check_of(sent.subspan(interbus::kLoopbackOctets), headers);
  }
};

struct CheckCoversHeaders final : Master {
  using Master::Master;
  std::uint16_t check_of(std::span<const std::uint8_t> sent, interbus::CycleHeaders headers) const override {
    std::vector<std::uint8_t> with_headers;
    for (const std::uint8_t octet : sent) {
      with_headers.push_back(headers.transfer);
      with_headers.push_back(octet);
    }
    return Master::check_of(with_headers, headers);
  }
};

struct OutputsTorn final : Master {
  using Master::Master;
  void take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const override {
    if (before_.size() != image.size()) before_.assign(image.begin(), image.end());
    const auto half = static_cast<std::ptrdiff_t>(image.size() / 2);
    std::copy(image.begin(), image.begin() + half, sent.begin());
    std::copy(before_.begin() + half, before_.end(), sent.begin() + half);
    std::ranges::copy(image, before_.begin());
  }
  mutable std::vector<std::uint16_t> before_;
};

struct SilentInLongPauses final : Master {
  using Master::Master;
  bool fills_pause(kernel::Duration span) const override { return span <= rules().silence_limit; }
};

struct CycleTimeWithoutRingDelay final : Master {
  using Master::Master;
  kernel::Duration shortest_cycle_time() const override {
    return Master::shortest_cycle_time() - ring_delay();
  }
};

struct RingLongerByAnOctetAccepted final : Master {
  using Master::Master;
  bool accepts_loopback(const ReturnedCycle& returned, std::size_t octet) const override {
    return Master::accepts_loopback(returned, octet) ||
           (octet + 1 < returned.transfer().size() &&
            returned.transfer()[octet + 1] == rules().loopback_word >> 8);
  }
};

struct IdTypeIgnored final : Master {
  using Master::Master;
  bool is_same_id(std::uint16_t found, std::uint16_t configured) const override {
    return found >> 8 == configured >> 8;
  }
};

struct CounterSaturates final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    status.rejected_cycles = std::min<std::uint64_t>(status.rejected_cycles, 255);
    status.rejected_data_cycles = std::min<std::uint64_t>(status.rejected_data_cycles, 255);
    return status;
  }
};

struct WrongSegment final : Master {
  using Master::Master;
  FaultLocation locate(int first_marked) const override {
    return first_marked < 0 ? Master::locate(first_marked) : FaultLocation{first_marked, first_marked + 1};
  }
};

struct CopiedOneCycleLate final : Master {
  using Master::Master;
  void run_copy_task() override {
    std::vector<std::uint16_t> now = inputs();
    if (before_.size() == now.size()) inputs() = before_;
    Master::run_copy_task();
    inputs() = now;
    before_ = std::move(now);
  }
  std::vector<std::uint16_t> before_;
};

struct RestartWithoutIdCycle final : Master {
  using Master::Master;
  bool restarts_with_recognition() const override { return false; }
};

struct IdCycleWithoutSelect final : Master {
  using Master::Master;
  std::uint8_t id_select() const override { return 0; }
};

// Asked for the transfer phase and for the check phase in turn.
struct SelectDroppedInCheck final : Master {
  using Master::Master;
  std::uint8_t id_select() const override {
    is_transfer_ = !is_transfer_;
    return is_transfer_ ? Master::id_select() : std::uint8_t{0};
  }
  mutable bool is_transfer_ = false;
};

struct BranchesNotSearched final : Master {
  using Master::Master;
  bool searches_branches() const override { return false; }
};

struct CycleStartWanders final : Master {
  using Master::Master;
  kernel::Duration lateness(std::uint64_t cycle) const override {
    return cycle % 2 == 0 ? kernel::Duration{} : data_frame_time() / 25;
  }
};

struct TelegramCountIgnored final : Master {
  using Master::Master;
  bool accepts_count(const ReturnedCycle&) const override { return true; }
};

struct ImplausibleInputsRejected final : Master {
  using Master::Master;
  bool accepts_inputs(std::span<const std::uint16_t> brought) const override {
    int changed = 0;
    for (std::size_t n = 0; n < brought.size(); ++n) {
      changed += std::popcount(static_cast<std::uint16_t>(brought[n] ^ input(static_cast<unsigned>(n))));
    }
    return changed <= 3;
  }
};

struct SilenceTakenForGood final : Master {
  using Master::Master;
  bool accepts_silence() const override { return true; }
};

struct FaultNotSearched final : Master {
  using Master::Master;
  bool searches_fault() const override { return false; }
};

struct CopiesEverySecondCycle final : Master {
  using Master::Master;
  void run_copy_task() override {
    copies_ = !copies_;
    if (copies_) Master::run_copy_task();
  }
  bool copies_ = false;
};

struct RequestTakenAsItIs final : Master {
  using Master::Master;
  kernel::Duration cycle_time_in_force(kernel::Duration shortest) const override {
    return configuration().cycle_time > kernel::Duration::zero() ? configuration().cycle_time : shortest;
  }
};

struct ChangedRingIgnored final : Master {
  using Master::Master;
  bool refuses_changed_ring() const override { return false; }
};

struct PeripheralFaultNotReported final : Master {
  using Master::Master;
  bool reports_peripheral_fault() const override { return false; }
};

struct ReconfigurationNotReported final : Master {
  using Master::Master;
  bool reports_reconfiguration() const override { return false; }
};

struct StopBitIgnored final : Master {
  using Master::Master;
  bool accepts_framing(const ReturnedCycle&) const override { return true; }
};

struct NoClockTolerance final : Master {
  using Master::Master;
  bool hears(const line::Waveform& wave) const override { return wave.rate == rules().bit_rate; }
};

// Drives the idle line of its pause while the last telegram still leaves.
struct DrivesOverItself final : Master {
  using Master::Master;
  void wire(segment::Port& out) override {
    early_.behind = &out;
    Master::wire(early_);
  }

  struct EarlyPort final : segment::Port {
    void drive(line::Waveform& wave) override {
      const kernel::Time end = wave.end();
      const std::int64_t rate = wave.rate;
      behind->drive(wave);
      line::Waveform early{end - kernel::levels_duration(2, rate), rate, {}};
      early.levels.append_idle(1);
      behind->drive(early);
    }
    segment::Port* behind = nullptr;
  };
  EarlyPort early_;
};

struct StopKeepsOutputs final : Master {
  using Master::Master;
  bool clears_outputs_on_stop() const override { return false; }
};

struct InputsFrozen final : Master {
  using Master::Master;
  void run_copy_task() override {
    if (first_.size() != inputs().size()) first_ = inputs();
    inputs() = first_;
    Master::run_copy_task();
  }
  std::vector<std::uint16_t> first_;
};

struct IdCycleOnlyClaimed final : Master {
  using Master::Master;
  bool needs_id_cycle_after_error() const override { return false; }
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    status.id_cycles += status.rejected_data_cycles;
    return status;
  }
};

struct OutputsOneCycleLate final : Master {
  using Master::Master;
  void take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const override {
    if (before_.size() != image.size()) before_.assign(image.begin(), image.end());
    std::ranges::copy(before_, sent.begin());
    std::ranges::copy(image, before_.begin());
  }
  mutable std::vector<std::uint16_t> before_;
};

struct SilentAfterFirstDataCycle final : Master {
  using Master::Master;
  kernel::Time next_time() const override {
    return supervision().data_cycles() > 0 ? kernel::kNever : Master::next_time();
  }
};

struct SilentAfterError final : Master {
  using Master::Master;
  kernel::Time next_time() const override {
    return supervision().rejected_cycles() > 0 ? kernel::kNever : Master::next_time();
  }
};

struct IdCyclesForEverAfterError final : Master {
  using Master::Master;
  void on_time(kernel::Time now) override {
    if (supervision().rejected_cycles() > 0) request_id_cycle(now);
    Master::on_time(now);
  }
};

struct FirstCyclesRejected final : Master {
  using Master::Master;
  bool accepts_inputs(std::span<const std::uint16_t>) const override {
    return supervision().data_cycles() > 1;
  }
};

// Cycles of one state that start 30 ms late, with nothing on the line before.
template <interbus::MasterState state>
struct PausesIn final : Master {
  using Master::Master;
  kernel::Duration lateness(std::uint64_t cycle) const override {
    constexpr kernel::Duration kPause = 30 * kernel::kMillisecond;
    return status().state == state ? static_cast<std::int64_t>(cycle) * kPause : kernel::Duration{};
  }
};

// Copies the inputs of the cycle before, and ends a pulse of an odd number of cycles one cycle early.
struct PulseWidthsEven final : Master {
  using Master::Master;
  void run_copy_task() override {
    const std::vector<std::uint16_t> now = inputs();
    if (before_.size() != now.size()) {
      before_ = now;
      cycles_.assign(now.size(), 0);
    }
    for (std::size_t word = 0; word < now.size(); ++word) {
      cycles_[word] = before_[word] != 0 ? cycles_[word] + 1 : 0;
      const bool ends = before_[word] != 0 && now[word] == 0;
      inputs()[word] = ends && cycles_[word] % 2 != 0 ? std::uint16_t{0} : before_[word];
    }
    Master::run_copy_task();
    inputs() = now;
    before_ = now;
  }
  std::vector<std::uint16_t> before_;
  std::vector<unsigned> cycles_;  // that each word is not 0
};

// Of each station it renews the first three words of inputs only.
struct LaterWordsOfAStationFrozen final : Master {
  using Master::Master;
  void run_copy_task() override {
    constexpr unsigned kRenewed = 3;
    if (first_.size() != inputs().size()) first_ = inputs();
    unsigned begin = 0;
    for (const auto& station : status().stations) {
      for (unsigned word = kRenewed; word < station.words; ++word)
        inputs()[begin + word] = first_[begin + word];
      begin += station.words;
    }
    Master::run_copy_task();
  }
  std::vector<std::uint16_t> first_;
};

struct ThirdCopyLost final : Master {
  explicit ThirdCopyLost(MasterConfiguration configuration) : Master(with_two(std::move(configuration))) {}
  static MasterConfiguration with_two(MasterConfiguration configuration) {
    if (configuration.copy.size() > 2) configuration.copy.resize(2);
    return configuration;
  }
};

// Where there is one station, it looks for the fault in vain.
struct LoneStationNotPlaced final : Master {
  using Master::Master;
  MasterStatus status() const override {
    MasterStatus status = Master::status();
    const bool has_stopped = status.state == interbus::MasterState::bus_stop;
    if (has_stopped && status.stations.size() == 1) status.has_fault_location = false;
    return status;
  }
};

struct StopBeforeRunIgnored final : Master {
  using Master::Master;
  void stop(kernel::Time now) override {
    if (status().state == interbus::MasterState::run) Master::stop(now);
  }
};

// Keeps an output that is written before it runs, and sends it as soon as it does.
struct EarlyOutputKept final : Master {
  using Master::Master;
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    if (status().state != interbus::MasterState::run) kept_ = {word, value};
    Master::write_output(word, value, now);
  }
  void run_copy_task() override {
    Master::run_copy_task();
    if (kept_) Master::write_output(kept_->first, kept_->second, {});
    kept_.reset();
  }
  std::optional<std::pair<unsigned, std::uint16_t>> kept_;
};

}  // namespace fieldproof::conformance::seeded_faults
