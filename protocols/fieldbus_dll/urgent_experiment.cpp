#include "protocols/fieldbus_dll/urgent_experiment.hpp"

#include <algorithm>
#include <deque>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/traffic/batch_means.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "protocols/fieldbus_dll/ff_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using traffic::ms;

constexpr std::uint8_t kFirstPacketNode = 0x11;
// Queues begin empty, and those near what the token carries are long in filling.
constexpr kernel::Duration kShortestWarmUp = 3 * kernel::kSecond;
constexpr double kBatchesOfRun = 40;  // about
constexpr std::uint64_t kSmallestBatch = 5;

// Frames are 11 octets longer than their data, the silence after them is 51.
constexpr unsigned kSilence = 51;
constexpr std::size_t kUrgentData = 75 - 11 - kSilence;
constexpr std::size_t kAvailableData = 267 - 11 - kSilence;

// PT and RT of 10 and 7 octets with silences make a visit of 119 octets; 16 of them and a probe of 8, which
// nobody answers for V(MRD) x V(ST) = 88, make 2000 octets: 16 ms.
FfRules rules_of(const traffic::UrgentTraffic& traffic) {
  FfRules rules;
  rules.link.bit_rate = 1'000'000;
  rules.link.preamble_octets = 2;
  rules.link.slot_time_octets = 22;
  rules.link.inter_pdu_delay_octets = kSilence;
  rules.token_holding_octets = 600;
  rules.steers_by_three_steps = false;
  rules.returns_with_last_data = false;
  rules.target_rotation = traffic.target_rotation;
  rules.time_distribution_period = 55 * kernel::kSecond;
  return rules;
}

void check_experiment(const traffic::UrgentTraffic& traffic, kernel::Duration duration) {
  check(traffic);
  const traffic::UrgentTraffic paper = traffic::paper_traffic(0.1, 1, 1, traffic.target_rotation);
  if (traffic.urgent_queues != paper.urgent_queues || traffic.available_queues != paper.available_queues ||
      traffic.urgent_length != paper.urgent_length || traffic.available_length != paper.available_length ||
      traffic.empty_rotation != paper.empty_rotation) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "the experiment has the paper's 16 nodes, lengths and empty rotation");
  }
  if (traffic.load() >= 1) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "of a load of 1 or more a rotation of the experiment would never end");
  }
  if (duration < kernel::kSecond || duration > 86'400 * kernel::kSecond) {
    throw kernel::Error(kernel::ErrorKind::configuration, "the experiment takes between 1 s and a day");
  }
}

// Packets of one priority at one node. The station has at most the first of them.
class PacketQueue {
 public:
  PacketQueue(double per_ms, const kernel::Random& random) : arrivals_(per_ms, random) {}

  // Is there one that the station should get now?
  bool gives(kernel::Time now) {
    for (; arrivals_.next() <= now; arrivals_.draw()) waiting_.push_back(arrivals_.next());
    if (is_given_ || waiting_.empty()) return false;
    is_given_ = true;
    return true;
  }
  // The first is on the line. Gives when it had arrived.
  kernel::Time leave() {
    is_given_ = false;
    const kernel::Time arrived = waiting_.front();
    waiting_.pop_front();
    return arrived;
  }
  std::size_t size() const { return waiting_.size(); }

 private:
  traffic::PoissonArrivals arrivals_;
  std::deque<kernel::Time> waiting_;
  bool is_given_ = false;
};

// Of so many values as are expected.
std::uint64_t batch_of(double values) {
  return std::max(kSmallestBatch, static_cast<std::uint64_t>(values / kBatchesOfRun));
}

class Experiment {
 public:
  Experiment(const traffic::UrgentTraffic& traffic, kernel::Duration duration, std::uint64_t seed)
      : duration_(duration),
        rules_(rules_of(traffic)),
        link_(rules_, kernel::Random(seed).split("link")),
        delays_(batch_of(ms(duration) * kExperimentNodes * traffic.urgent_per_ms)),
        rotations_(batch_of(ms(duration) / (ms(traffic.empty_rotation) / (1 - traffic.load())))) {
    link_.on_driven([this](const FfDriven& one) { hear(one); });
    FfConfiguration scheduler{.rules = rules_, .node = kFirstPacketNode - 1};
    scheduler.begins_as_scheduler = true;
    link_.add_master(scheduler, nobody_);
    const kernel::Random random(seed);
    for (unsigned n = 0; n < kExperimentNodes; ++n) {
      link_.add_device({.rules = rules_, .node = static_cast<std::uint8_t>(kFirstPacketNode + n)}, nobody_);
      urgent_.emplace_back(traffic.urgent_per_ms, random.split("urgent").split(n));
      available_.emplace_back(traffic.available_per_ms, random.split("time-available").split(n));
    }
  }

  ExperimentFigures run() {
    const kernel::Time begin = kernel::kStart + std::max(kShortestWarmUp, duration_ / 2);
    link_.run_to(begin);
    counts_ = true;
    link_.run_to(begin + duration_);
    found_.urgent_packets = delays_.count();
    found_.mean_delay = delays_.mean();
    found_.standard_error = delays_.standard_error();
    found_.rotations = rotations_.count();
    found_.mean_rotation = rotations_.mean();
    found_.rotation_error = rotations_.standard_error();
    if (found_.rotations > 0)
      found_.priority_1 = static_cast<double>(with_all_data_) / static_cast<double>(found_.rotations);
    for (const PacketQueue& queue : available_)
      found_.longest_available = std::max<std::uint64_t>(found_.longest_available, queue.size());
    return found_;
  }

 private:
  void hear(const FfDriven& one) {
    if (one.dlpdu.type == FfType::pt) on_token(one);
    if (one.dlpdu.type == FfType::dt1 && one.node >= kFirstPacketNode) on_packet(one);
  }

  void on_token(const FfDriven& pt) {
    if (pt.dlpdu.begins_circulation) begin_rotation(pt);
    const unsigned n = pt.dlpdu.node - kFirstPacketNode;
    // A station looks at what waits when it may begin to send.
    const kernel::Time looks = pt.end + octets(rules_.link, kSilence);
    give(n, urgent_[n], Priority::urgent, kUrgentData, looks);
    give(n, available_[n], Priority::time_available, kAvailableData, looks);
  }

  void begin_rotation(const FfDriven& pt) {
    if (counts_ && rotation_began_ > kernel::kStart) {
      rotations_.add(ms(pt.begin - rotation_began_));
      if (pt.dlpdu.priority != Priority::urgent) ++with_all_data_;
    }
    rotation_began_ = pt.begin;
  }

  void give(unsigned n, PacketQueue& queue, Priority priority, std::size_t size, kernel::Time now) {
    if (!queue.gives(now)) return;
    const auto node = static_cast<std::uint8_t>(kFirstPacketNode + n);
    link_.submit(node, {priority, address_of(kFirstPacketNode - 1, 0x20), Octets(size, node)});
  }

  void on_packet(const FfDriven& dt1) {
    const unsigned n = dt1.node - kFirstPacketNode;
    if (dt1.dlpdu.priority != Priority::urgent) {
      available_[n].leave();
      return;
    }
    const kernel::Time arrived = urgent_[n].leave();
    if (counts_) delays_.add(ms(dt1.end + octets(rules_.link, kSilence) - arrived));
  }

  kernel::Duration duration_;
  FfRules rules_;
  FfSilentUser nobody_;
  FfLink link_;
  std::vector<PacketQueue> urgent_;
  std::vector<PacketQueue> available_;
  bool counts_ = false;
  kernel::Time rotation_began_ = kernel::kStart;
  traffic::BatchMeans delays_;
  traffic::BatchMeans rotations_;
  std::uint64_t with_all_data_ = 0;
  ExperimentFigures found_;
};

}  // namespace

ExperimentFigures run_urgent_experiment(const traffic::UrgentTraffic& traffic, kernel::Duration duration,
                                        std::uint64_t seed) {
  check_experiment(traffic, duration);
  return Experiment(traffic, duration, seed).run();
}

}  // namespace fieldproof::fieldbus_dll
