#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/interbus/master_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/line_watch.hpp"
#include "conformance/mutant_table.hpp"
#include "conformance/stressed_receiver.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/plan.hpp"
#include "harness/network/exchange_statistics.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"
#include "protocols/interbus/running_network.hpp"

// A whole network under test: the master and the slaves of a network description on their cables, with the
// declared faults of a plan on every receiver. The lower tester listens to the master's output; the upper
// tester is at the terminals of all slaves and at the master's application interface.
namespace fieldproof::conformance {

// What a mutant changes of a network of references.
struct NetworkParts {
  MasterBench::MakeMaster make_master;   // null: the reference
  interbus::Ring::MakeSlave make_slave;  // null: references
  // Changes the network that is built, not the one that the cases hold it against.
  std::function<void(interbus::NetworkDescription&)> change_network;
};

struct NetworkSetting {
  interbus::NetworkDescription network;
  NetworkParts parts;
  std::uint64_t seed = 1;
  Volume volume = Volume::full;
  fault::Plan plan{};
  std::span<const fault::Stress> stresses{};
  // Makes the recorder of the bench's trace; null: nothing is recorded. It must outlive the bench.
  std::function<trace::Recorder*(const trace::Trace&, const interbus::Rules&)> make_recorder{};
};

class NetworkBench final : private network::ExchangeWatcher {
 public:
  NetworkBench(const NoNeeds&, const NetworkSetting& setting);

  // As the description says, whatever a mutant built.
  const interbus::NetworkDescription& network() const { return network_; }
  const std::vector<interbus::RingPlace>& places() const { return places_; }
  template <typename Count>
  Count volume(Count quick, Count full) const {
    return volume_ == Volume::quick ? quick : full;
  }
  // The same for cycles: no more of them than a minute has, but some.
  std::int64_t cycle_volume(std::int64_t quick, std::int64_t full) const {
    const std::int64_t in_a_minute =
        60 * kernel::kSecond / std::max(status().cycle_time, kernel::kMicrosecond);
    return std::min(volume(quick, full), std::max<std::int64_t>(in_a_minute, 5));
  }
  kernel::Random& random() { return random_; }
  segment::Segment& segment() { return running_.segment(); }
  interbus::RunningNetwork& running() { return running_; }
  interbus::MasterDevice& master() { return running_.master(); }
  interbus::Ring& ring() { return running_.ring(); }
  // The case is over. What the stations do then is still their verdict.
  void finish() { running_.end(); }
  // What every station drives.
  const LineWatch& line_watch() const { return line_watch_; }
  interbus::MasterStatus status() const { return running_.status(); }

  // Powers up and waits until data cycles run; false when the network does not get there in the time that its
  // size allows.
  bool bring_up();
  void run_cycles(std::int64_t count) { segment().run_for(status().cycle_time * count); }

  // To 200 us after the start of a data cycle, when every station has sampled its inputs: what changes then
  // has just missed the cycle.
  void run_behind_sampling();

  // A stress on all cables of the remote bus, from now on; the n-th of a case has the n-th disturbances, and
  // all cables the same ones.
  std::span<const fault::Stress> stresses() const { return stresses_; }
  void begin_stress(const fault::Stress& stress);
  void end_stress();
  std::uint64_t stressed_transmissions() const;
  // From now on random words go through the network at each cycle, and what comes out of it is judged.
  network::ExchangeStatistics& begin_exchange();

  // Starts of the data cycles on the master's output since `keep_starts`, as the lower tester decoded them.
  const std::vector<kernel::Time>& data_cycle_starts() const { return running_.data_cycle_starts(); }
  void keep_starts() { running_.keep_starts(); }

  std::vector<std::uint64_t> planned_hits() const {
    return plan_ ? plan_->hits_of_parts() : std::vector<std::uint64_t>{};
  }

 private:
  void install(const fault::Plan& plan);
  void on_exchange(const network::Exchange& exchange) override;
  void on_shown(std::size_t signal, std::uint16_t word, kernel::Time when) override;
  void on_cycle_begin(std::size_t, kernel::Time) override {}

  interbus::NetworkDescription network_;
  interbus::NetworkDescription built_;
  std::vector<interbus::RingPlace> places_;
  Volume volume_;
  kernel::Random random_;
  interbus::RunningNetwork running_;
  std::unique_ptr<fault::InstalledPlan> plan_;
  LineWatch line_watch_;
  std::span<const fault::Stress> stresses_;
  std::deque<StressedReceiver> stressed_;  // of each remote link
  std::uint64_t stress_number_ = 0;
  std::optional<network::ExchangeStatistics> exchange_;
  std::uint64_t changed_before_ = 0;  // at the end of the cycle before
};

using NetworkCase = BenchCase<NetworkBench, NoNeeds>;

const std::vector<NetworkCase>& network_cases();
std::vector<NetworkCase> network_immunity_cases();  // a part of them

// The parts of a network of so many stations.
using NetworkMutants = MutantTable<NetworkParts, std::size_t>;
const NetworkMutants& network_mutants();

}  // namespace fieldproof::conformance
