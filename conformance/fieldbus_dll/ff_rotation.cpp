#include <array>
#include <cmath>
#include <vector>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "harness/traffic/token_rotation.hpp"

// The token among the sixteen nodes of the paper: how long a rotation takes, and how often it admits all
// data.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;
using kernel::kMicrosecond;

constexpr std::uint8_t kFirstOfNodes = 0x11;
constexpr std::size_t kPaperNodes = 16;
constexpr double kLoad = 0.2;

// A packet takes the line for its frame and the silence after it: 600 and 2136 us of the paper. Frames are
// 10 octets longer than their data, the silence is 8.
constexpr std::size_t kUrgentData = 57;
constexpr std::size_t kAvailableData = 249;

// A visit takes 248 us of frames and silences; this much more makes the empty rotation 16 ms, with a probe of
// 312 us in it. IDLE keeps the token: three of them with silences between.
constexpr std::array kSilences{196, 196, 196};
constexpr std::array kSilencesOfLast{198, 199, 199};

template <std::int64_t target_microseconds>
void paper_nodes(FfConfiguration& configuration) {
  configuration.rules.link.bit_rate = 1'000'000;
  configuration.rules.token_holding_octets = 600;
  configuration.rules.steers_by_three_steps = false;
  configuration.rules.target_rotation = target_microseconds * kMicrosecond;
  configuration.rules.time_distribution_period = 55 * kernel::kSecond;
  for (std::size_t n = 0; n < kPaperNodes; ++n)
    configuration.live.push_back(static_cast<std::uint8_t>(kFirstOfNodes + n));
}

// What waits at one node in one priority.
class PaperQueue {
 public:
  PaperQueue(double per_ms, const kernel::Random& random) : arrivals_(per_ms, random) {}

  // One that has arrived by then leaves.
  bool take(kernel::Time now) {
    for (; arrivals_.next() <= now; arrivals_.draw()) ++waiting_;
    if (waiting_ == 0) return false;
    --waiting_;
    return true;
  }

 private:
  traffic::PoissonArrivals arrivals_;
  std::uint64_t waiting_ = 0;
};

class PaperNodes {
 public:
  PaperNodes(FfBench& bench, const traffic::UrgentTraffic& traffic) : bench_(bench) {
    for (std::size_t n = 0; n < kPaperNodes; ++n) {
      urgent_.emplace_back(traffic.urgent_per_ms, bench.random().split(2 * n));
      available_.emplace_back(traffic.available_per_ms, bench.random().split(2 * n + 1));
    }
  }

  // All that the holder of this token says, to the end of its RT.
  void use(const DrivenDlpdu& pt) {
    const auto node = static_cast<std::size_t>(pt.octet(1) - kFirstOfNodes);
    if (node >= kPaperNodes) return;
    kernel::Time at = pt.end + bench_.least_gap();
    for (const int silence : node + 1 == kPaperNodes ? kSilencesOfLast : kSilences)
      at = bench_.send_at(at, {bench_.rules().codes.idle}) + silence * kMicrosecond;
    if (urgent_[node].take(at)) at = send(pt, Priority::urgent, kUrgentData, at);
    if (priority_in(pt) != Priority::urgent && available_[node].take(at))
      at = send(pt, Priority::time_available, kAvailableData, at);
    bench_.run_until(bench_.send_at(at, {bench_.rules().codes.rt}));
  }

 private:
  // Gives when the next one may begin.
  kernel::Time send(const DrivenDlpdu& pt, Priority priority, std::size_t size, kernel::Time at) {
    const auto own = fieldbus_dll::address_of(pt.octet(1), 1);
    return bench_.send_at(at, bench_.dt1(priority, 0x1030, own, Octets(size, 0x55))) + bench_.least_gap();
  }

  FfBench& bench_;
  std::vector<PaperQueue> urgent_;
  std::vector<PaperQueue> available_;
};

struct Rotations {
  std::uint64_t count = 0;
  double mean = 0;  // ms
  double share_of_all_data = 0;
};

Rotations rotate(FfBench& bench, CaseJudge& judge, const traffic::UrgentTraffic& traffic,
                 std::uint64_t circulations) {
  constexpr std::uint64_t kWarmUp = 50;
  PaperNodes nodes(bench, traffic);
  Rotations found;
  std::uint64_t begun = 0;
  std::uint64_t with_all_data = 0;
  kernel::Time first{};
  kernel::Time last{};
  // A visit takes at most 1 ms and both packets.
  const kernel::Duration longest =
      traffic.empty_rotation + 16 * (traffic.urgent_length + traffic.available_length);
  const kernel::Time end = bench.now() + static_cast<std::int64_t>(kWarmUp + circulations) * longest;
  while (begun < kWarmUp + circulations) {
    judge.expect(bench.now() < end, "no_token", "circulations, marked as such", "none in time");
    const auto one = bench.next(bench.now() + bench.octets(1'000));
    judge.expect(one.has_value(), "no_token", "tokens", "silence");
    if (!is_pt(bench, *one)) continue;
    if (has_final_use(*one) && ++begun >= kWarmUp) {
      if (begun == kWarmUp) first = one->begin;
      last = one->begin;
      if (begun > kWarmUp && priority_in(*one) != Priority::urgent) ++with_all_data;
    }
    nodes.use(*one);
  }
  found.count = circulations;
  found.mean = traffic::ms(last - first) / static_cast<double>(circulations);
  found.share_of_all_data = static_cast<double>(with_all_data) / static_cast<double>(circulations);
  return found;
}

void rotations_are_as_computed(FfBench& bench, CaseJudge& judge) {
  const auto traffic = traffic::paper_traffic(kLoad, 1, 1, bench.rules().target_rotation);
  const Rotations found = rotate(bench, judge, traffic, bench.volume<std::uint64_t>(300, 5'000));
  // Every packet that comes is sent, so a rotation takes R / (1 - U) in the mean, whatever is admitted when.
  const double mean = traffic::ms(traffic.empty_rotation) / (1 - kLoad);
  judge.expect_between("mean rotation", "ms", found.mean, 0.97 * mean, 1.03 * mean, "rotation_wrong");
  // Another simulation, without frames.
  const traffic::TokenFigures wanted = traffic::rotate_token(traffic, {.seed = 1, .urgent_packets = 100'000});
  const double share = wanted.priority_1;
  const double error = std::sqrt(share * (1 - share) / static_cast<double>(found.count));
  const double tolerance = 0.02 + 5 * error;
  judge.measure("share of rotations that admit all data, in a simulation without frames", "", share);
  judge.expect_between("share of rotations that admit all data", "", found.share_of_all_data,
                       share - tolerance, share + tolerance, "share_of_priority_wrong");
}

FfCase at_target(const std::string& name, void (*change)(FfConfiguration&), std::vector<MustCatch> catches) {
  return {
      {.id = "fieldbus_dll/ff_las/rotation/sixteen_nodes_at_" + name,
       .purpose = "FF-22",
       .requirement = "Rotations of the token and its priority follow the rule of ATRT and TTRT.",
       .reference = link_sources::ff_paper("sixteen nodes at 1 Mbit/s, U = 0.2"),
       .details = {{link_sources::calculated("R / (1 - U), and a simulation of the same rules"),
                    {"rotation_wrong", "share_of_priority_wrong"}}},
       .stimulus = "Sixteen nodes with urgent and time-available packets of the paper, at random; V(TTRT) " +
                   name + ".",
       .expected = "The mean rotation within 3 % of 20 ms; the share of rotations that admit all data within "
                   "0.02 and five standard errors of the simulation.",
       .tags = {"timing"},
       .catches = std::move(catches)},
      rotations_are_as_computed,
      {.change = change}};
}

}  // namespace

std::vector<FfCase> ff_rotation_cases() {
  return {at_target("16_6_ms", paper_nodes<16'600>,
                    {{"equal_rotation_is_fast", "share_of_priority_wrong"},
                     {"steers_the_wrong_way", "share_of_priority_wrong"}}),
          at_target("34_8_ms", paper_nodes<34'816>, {{"rotation_counted_twice", "share_of_priority_wrong"}})};
}

}  // namespace fieldproof::conformance
