#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/line/telegram.hpp"
#include "harness/network/network.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"
#include "protocols/interbus/skew.hpp"

// A network that runs: the master of a description and the slaves on their cables, in a segment of its own.
//
// An exchange is one cycle; its end and whether its data were taken the application of the master is told, by
// the master. Whether data cycles run a lower tester on the master's output decides: a master that only
// reports it does not exchange data. Stopped is a network in whose master's output no cycle has begun for
// longer than two of them take; while it comes up, for longer than a recognition pauses.
//
// Signals: for each word of the process image the output, from the master to its station, then the input.
// Exposed are the cables of the remote bus, in both directions; local buses lie in no clamp.
namespace fieldproof::interbus {

// Who plays; null: the references.
struct RunningStations {
  std::function<std::unique_ptr<MasterDevice>(const MasterConfiguration&)> make_master{};
  Ring::MakeSlave make_slave{};
  // Of the reference slaves, and of the closed forms.
  LatchModel latch = LatchModel::frame_edges;

  bool are_references() const { return make_master == nullptr && make_slave == nullptr; }
};

class RunningNetwork final : public network::Network {
 public:
  // The master is configured by `configured` where that differs from what is built.
  explicit RunningNetwork(const NetworkDescription& built, const RunningStations& stations = {},
                          const NetworkDescription* configured = nullptr);

  const std::string& name() const override { return description_.name; }
  segment::Segment& segment() override { return segment_; }
  MasterDevice& master() { return *master_; }
  Ring& ring() { return ring_; }
  MasterStatus status() const { return master_->status(); }

  void start() override;
  void stop() override;
  network::State state() const override;
  kernel::Duration bring_up_limit() const override;
  std::string complaint() const override { return status().configuration_error; }
  bool reports_poor_quality() const override { return status().quality_bit; }

  std::span<const network::Place> places() const override { return places_; }
  std::span<const network::CycleKind> cycles() const override { return cycles_; }
  network::AcceptanceRules acceptance() const override;
  network::RecoveryLimit recovery_limit() const override;
  network::ExchangeWords exchange_words() const override {
    return {"data cycles", "ID cycles", "rejected cycles"};
  }
  std::vector<measure::Condition> conditions() const override;
  std::vector<network::ProtectedFrame> protected_frames() const override;
  std::shared_ptr<const trace::Dissector> dissector() const override;

  std::span<const network::Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override;
  void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) override;
  std::uint16_t image(std::size_t signal) const override;
  std::vector<network::CopiedPath> paths() const override;
  void watch(network::ExchangeWatcher& watcher) override { watcher_ = &watcher; }
  void end() override;

  // Starts until data cycles run; false when the network does not get there within its limit.
  bool bring_up();

  // The application of the master besides the watcher: called first.
  void on_cycle_end(MasterDevice::CycleHook hook) { hook_ = std::move(hook); }

  // Of data cycles on the master's output since `keep_starts` was called last.
  const std::vector<kernel::Time>& data_cycle_starts() const { return output_.starts; }
  void keep_starts() {
    output_.starts.clear();
    output_.keeps_starts = true;
  }

 private:
  // The lower tester at the master's output.
  struct Output final : segment::Tap {
    Output(RunningNetwork& its, const Rules& rules)
        : network(its), code(line::shared_telegram_code(rules.telegram)) {}
    void on_wave(const line::Waveform& wave) override;

    RunningNetwork& network;
    const line::TelegramCode& code;
    std::uint8_t phase = 0;  // header of the data telegram before
    bool keeps_starts = false;
    std::vector<kernel::Time> starts;
    std::optional<kernel::Time> last_cycle{};  // of either kind, since the last start
    bool has_data_cycle = false;               // since then
  };
  struct WordPlace {
    int position = 0;
    unsigned word = 0;  // of the station
  };

  void find_places(bool are_references);
  void find_signals();
  void finish_cycle(kernel::Time now, bool is_data, bool accepted);

  NetworkDescription description_;
  LatchModel latch_;
  segment::Segment segment_;
  std::unique_ptr<MasterDevice> master_;
  std::size_t master_seat_;
  Ring ring_;
  Output output_;
  kernel::Duration longest_cycle_;  // of either kind
  kernel::Time started_{};
  std::vector<network::Place> places_;
  std::vector<network::CycleKind> cycles_;
  std::vector<network::Signal> signals_;
  std::vector<WordPlace> words_;  // of the image
  network::ExchangeWatcher* watcher_ = nullptr;
  MasterDevice::CycleHook hook_;
};

// "M2", and what it means.
std::string_view name(LatchModel model);
std::string_view describe(LatchModel model);

// From the sample at the start of a frame at one station to the latch at the end of the frame at another, by
// their positions from 1 on; and the delay of an edge on that way, by the latch model.
kernel::Duration frame_between(const NetworkDescription& network, int from, int to);
EdgeDelay path_delay(const NetworkDescription& network, int from, int to, LatchModel model);

// The data cycle time that the structure gives, or the requested one where that is longer.
kernel::Duration cycle_time_in_force(const NetworkDescription& network);

}  // namespace fieldproof::interbus
