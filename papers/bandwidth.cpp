// Section 5 of Hong and others: the bandwidth of a fieldbus allocated to control loops, real-time and
// non-real-time data. The paper prints rules, formulas and pictures of intervals, and no number: each of its
// statements stands next to what simulated lines do. Bounds, packets and nodes are chosen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/traffic/milliseconds.hpp"
#include "papers/sections.hpp"
#include "papers/window_loop.hpp"
#include "protocols/bandwidth/proof.hpp"
#include "protocols/bandwidth/sample_plans.hpp"
#include "protocols/bandwidth/stability.hpp"
#include "protocols/bandwidth/window_link.hpp"

namespace fieldproof::papers {
namespace {

using bandwidth::Allocation;
using bandwidth::Demand;
using bandwidth::Load;
using bandwidth::Packet;
using bandwidth::Proof;
using bandwidth::Sent;
using bandwidth::WindowFigures;
using bandwidth::WindowRun;
using bandwidth::WindowTraffic;
using kernel::Duration;
using reports::PublishedCurves;
using reports::PublishedRow;
using reports::PublishedSection;
using traffic::ms;

constexpr std::uint64_t kFewestSlots = 50'000;
constexpr std::uint64_t kMostSlots = 500'000;

std::uint64_t slots_of(const Settings& settings, Duration slot) {
  return std::clamp(static_cast<std::uint64_t>(settings.duration / slot), kFewestSlots, kMostSlots);
}

std::int64_t microseconds_of(Duration duration) {
  return duration / kernel::kMicrosecond;
}

// Beside periodic data three real-time queues.
Demand with_real_time() {
  Demand demand = bandwidth::fractional_density();
  demand.real_time_queues = 3;
  demand.real_time_packet = 200 * kernel::kMicrosecond;
  return demand;
}

WindowTraffic safe_traffic(const Demand& demand) {
  return bandwidth::traffic_of(demand, microseconds_of(allocate(demand).longest_safe));
}

std::string told_longest(const WindowFigures& figures) {
  return fmt::format("longest {:.3f} ms, {} over T_1 in {} slots", ms(figures.longest()), figures.over_slot(),
                     figures.slots);
}

std::string told_samplings(const WindowFigures& figures) {
  const double each = 1e3 / static_cast<double>(figures.samplings());
  return fmt::format("{} vacant and {} lost; of 1000 samplings {:.1f} and {:.1f}", figures.vacant(),
                     figures.lost(), each * static_cast<double>(figures.vacant()),
                     each * static_cast<double>(figures.lost()));
}

// ---- the line as the figures show it ----

// The events of some slots of stations that send frames.
std::vector<Sent> frames_of(const WindowTraffic& traffic, const bandwidth::WindowLineRules& rules,
                            Load others, const Settings& settings) {
  WindowRun run{.seed = settings.seed, .slots = 8, .real_time = others, .non_real_time = others};
  return run_window_link(traffic, rules, run).sent;
}

struct Span {
  std::uint64_t first_slot;
  double slots;
};

// Each packet as a step to the number of its node and back to none.
PublishedCurves figure_of_packets(std::string name, const std::vector<Sent>& sent, Duration slot,
                                  const Span& span) {
  PublishedCurves figure{std::move(name), "time, ms", "node", {}};
  const double from = static_cast<double>(span.first_slot) * ms(slot);
  const double to = from + span.slots * ms(slot);
  for (const Packet packet : {Packet::periodic, Packet::real_time, Packet::non_real_time}) {
    PublishedCurves::Curve curve{name_of(packet), {}};
    for (const Sent& one : sent) {
      const double begin = ms(one.begin - kernel::kStart);
      const double end = ms(one.end - kernel::kStart);
      if (one.packet != packet || begin < from || end > to) continue;
      const double node = one.node + 1.0;
      for (const auto& [x, y] : {std::pair{begin, 0.0}, {begin, node}, {end, node}, {end, 0.0}})
        curve.points.push_back({x, y});
    }
    if (!curve.points.empty()) figure.curves.push_back(std::move(curve));
  }
  return figure;
}

bandwidth::WindowLineRules line_rules() {
  return {.real_time_octets = 12, .non_real_time_octets = 250};
}

WindowTraffic on_real_line(const Demand& demand) {
  return on_line(bandwidth::traffic_of(demand, 1), line_rules());
}

// ---- what is counted from packet to packet ----

class IntervalLedger {
 public:
  explicit IntervalLedger(Duration slot) : slot_(slot) {}

  void on_sent(const Sent& sent) {
    if (sent.packet == Packet::periodic) on_periodic(sent);
    if (sent.packet == Packet::non_real_time) on_non_real_time(sent);
    is_real_time_late_ |= sent.node == node_ && sent.begin == end_ && sent.packet == Packet::real_time &&
                          last_ != Packet::real_time && last_ != Packet::none;
    node_ = sent.node;
    end_ = sent.end;
    last_ = sent.packet;
  }

  Duration longest_interval() const { return longest_; }
  std::uint64_t most_packets() const { return most_; }
  bool has_sent_within() const { return has_sent_within_; }
  // A real-time packet has followed one of another kind in a visit.
  bool is_real_time_late() const { return is_real_time_late_; }

 private:
  void on_periodic(const Sent& sent) {
    // Who has begun an interval ends it when it is visited again, and may begin the next one at once.
    if (is_periodic_ && sent.byte.is_of(sent.node)) longest_ = std::max(longest_, sent.begin - begin_);
    if (!is_periodic_ || sent.byte.is_of(sent.node)) begin_ = sent.begin;
    is_periodic_ = true;
    const std::int64_t slot = (sent.generated - kernel::kStart) / slot_;
    if (slot != of_slot_) {
      of_slot_ = slot;

      packets_ = static_cast<std::uint64_t>(
          std::ranges::count_if(others_, [&](const Sent& one) { return one.end > sent.generated; }));
      others_.clear();
    }
    most_ = std::max(most_, packets_);
  }
  void on_non_real_time(const Sent& sent) {
    has_sent_within_ |= sent.byte.is_periodic();
    // The interval has ended with the visit of who has begun it.
    if (is_periodic_) longest_ = std::max(longest_, sent.begin - begin_);
    is_periodic_ = false;
    others_.push_back(sent);
  }

  Duration slot_;
  bool is_periodic_ = false;
  kernel::Time begin_{};
  Duration longest_{};
  std::int64_t of_slot_ = -1;
  std::uint64_t packets_ = 0, most_ = 0;
  std::vector<Sent> others_;
  bool has_sent_within_ = false;
  bool is_real_time_late_ = false;
  std::uint8_t node_ = 0;
  kernel::Time end_{};
  Packet last_ = Packet::none;
};

IntervalLedger ledger_of(const WindowTraffic& traffic, Load others, std::uint64_t slots, std::uint64_t seed) {
  IntervalLedger ledger(traffic.slot);
  WindowRun run{.seed = seed, .slots = slots, .real_time = others, .non_real_time = others};
  run.on_sent = [&](const Sent& sent) { ledger.on_sent(sent); };
  run_windows(traffic, run);
  return ledger;
}

PublishedRow row_of_proof(std::string what, const WindowTraffic& traffic, const Settings& settings) {
  const Proof proof = prove(traffic, settings.seed, slots_of(settings, traffic.slot));
  std::uint64_t late = 0;
  std::string story;
  for (const bandwidth::ProofRun& run : proof.runs) {
    late += run.figures.over_slot();
    if (story.empty() && run.figures.first_late) story = "; the first: " + story_of_late(run);
  }
  return {
      std::move(what), "no datum over T_1",
      fmt::format("longest {:.3f} ms, {} over T_1 of {:.0f} ms", ms(proof.longest()), late, ms(traffic.slot)),
      fmt::format("{} slots against other queues that send always, by chance and at the worst instants; in "
                  "closed form {:.3f} ms in the worst order of nodes{}",
                  proof.slots(), ms(proof.slowest_of_all), story),
      late == 0};
}

PublishedRow row_of_packets(std::string what, const Demand& demand, const Settings& settings) {
  const Allocation allocation = allocate(demand);
  const unsigned printed = demand.nodes - allocation.windows + 1;
  const WindowTraffic traffic = safe_traffic(demand);
  std::uint64_t most = 0;
  for (const WindowTraffic& one : {traffic, bandwidth::worst_order(traffic)}) {
    for (const Load load : {Load::saturated, Load::just_late}) {
      most = std::max(most, ledger_of(one, load, slots_of(settings, one.slot), settings.seed).most_packets());
    }
  }
  return {std::move(what), fmt::format("N - gamma + 1 = {}", printed), fmt::format("{}", most),
          fmt::format("slots have {} to {} data; with g data N - g + 1 packets go before the first of them",
                      allocation.fewest, allocation.windows),
          most == printed};
}

PublishedRow row_of_balance(std::string what, const WindowTraffic& traffic, const Demand& demand,
                            const Settings& settings) {
  const double formula = stability(traffic, allocate(demand)).saturated_packets;
  const WindowFigures figures = run_windows(
      traffic,
      {.seed = settings.seed, .slots = slots_of(settings, traffic.slot), .non_real_time = Load::saturated});
  const double sent = static_cast<double>(figures.non_real_time.sent) / static_cast<double>(figures.slots) /
                      static_cast<double>(traffic.non_real_time.size());
  return {std::move(what), "", fmt::format("{:.5f} packets of a queue in T_1", sent),
          fmt::format("from the balance of a slot {:.5f} ({:+.3f} %); more must not arrive", formula,
                      100 * (sent / formula - 1)),
          std::abs(sent / formula - 1) <= 6e-4};
}

// Does a demand keep its data, with windows just as long as T_1 allows, and a microsecond longer?
PublishedRow row_of_stable_periodic(Demand demand, const Settings& settings) {
  const auto lost_of = [&](Duration packet) {
    demand.periodic_packet = packet;
    WindowTraffic traffic = bandwidth::traffic_of(demand, 0);
    const WindowFigures figures =
        run_windows(traffic, {.seed = settings.seed, .slots = kFewestSlots, .non_real_time = Load::none});
    return figures.lost() + figures.over_slot();
  };
  const Allocation allocation = allocate(demand);
  const Duration fits = (allocation.slot - allocation.rotation) / std::int64_t{allocation.windows} /
                        kernel::kMicrosecond * kernel::kMicrosecond;
  const std::uint64_t within = lost_of(fits);
  const std::uint64_t beyond = lost_of(fits + 100 * kernel::kMicrosecond);
  return {"periodic data are sent while gamma L_p + R <= T_1", "and lost beyond",
          fmt::format("{} late or lost with L_p {:.3f} ms, {} with 0.1 ms more", within, ms(fits), beyond),
          fmt::format("{} windows and a rotation of {:.0f} ms in {:.0f} ms", allocation.windows,
                      ms(allocation.rotation), ms(allocation.slot)),
          within == 0 && beyond > 0};
}

std::uint64_t most_data_of_a_slot(const WindowTraffic& traffic, const Settings& settings) {
  std::map<std::int64_t, std::uint64_t> data;
  WindowRun run{.seed = settings.seed, .slots = 1'000, .real_time = Load::none, .non_real_time = Load::none};
  run.on_sent = [&](const Sent& sent) { ++data[(sent.generated - kernel::kStart) / traffic.slot]; };
  run_windows(traffic, run);
  std::uint64_t most = 0;
  for (const auto& [slot, count] : data) most = std::max(most, count);
  return most;
}

PublishedRow row_of_course(std::string what, const LoopCourse& course) {
  return {std::move(what), "",
          fmt::format("error {:.2f} %s, actuator travel {:.0f} %", course.absolute_error, course.travel),
          fmt::format("{} samplings of the controller, {} vacant, {} samples lost", course.samplings,
                      course.vacant, course.lost),
          std::nullopt};
}

PublishedRow sentence(std::string what, std::string published, double with, double without) {
  return {std::move(what), std::move(published), fmt::format("{:+.0f} %", 100 * (with / without - 1)),
          "the same process, controller, packets and line", with > without};
}

PublishedCurves::Curve curve_of(std::string name, const LoopCourse& course, double LoopCourse::Point::* value,
                                std::size_t points) {
  PublishedCurves::Curve curve{std::move(name), {}};
  for (const LoopCourse::Point& point : course.points) {
    if (curve.points.size() < points) curve.points.push_back({point.time_s, point.*value});
  }
  return curve;
}

}  // namespace

PublishedSection bandwidth_periodic(const Settings& settings) {
  PublishedSection section;
  section.heading = "5.1 and figure 5: windows for control loops, bounds of 60, 100, 180 and 340 ms";
  section.note =
      "T_1 is a third of the least bound, each T_i the largest 2^n T_1 with 2 T_i + T_1 <= bound: the paper "
      "refers to its author's algorithm for both and prints none. Ten nodes, L_p 0.4 ms, the server 0.1 ms "
      "at "
      "a node. The figure has the frames of stations at 1 Mbit/s.";
  const Demand demand = bandwidth::fractional_density();
  const Allocation allocation = allocate(demand);
  const WindowTraffic traffic = safe_traffic(demand);
  const std::uint64_t slots = slots_of(settings, traffic.slot);
  const WindowFigures alone = run_windows(
      traffic, {.seed = settings.seed, .slots = slots, .real_time = Load::none, .non_real_time = Load::none});
  const std::uint64_t most = most_data_of_a_slot(traffic, settings);
  section.rows.push_back({"data that come in T_1", "at most gamma", fmt::format("{} at most", most),
                          fmt::format("gamma {}, {:g} data in the mean; offsets spread them",
                                      allocation.windows, allocation.mean_load()),
                          most <= allocation.windows});
  section.rows.push_back({"data that come in T_1 are sent within it", "all", told_longest(alone),
                          "nothing but periodic data", alone.over_slot() == 0});
  section.rows.push_back({"(C1) data loss and vacant sampling", "none", told_samplings(alone),
                          "sensors and controllers sample at begins of slots",
                          alone.lost() + alone.vacant() == 0});
  WindowTraffic skewed = traffic;
  for (bandwidth::LoopTraffic& loop : skewed.loops) loop.skew = skewed.slot / 8;
  const WindowFigures uneven = run_windows(
      skewed,
      {.seed = settings.seed, .slots = slots, .real_time = Load::none, .non_real_time = Load::random});
  section.rows.push_back(
      {"(C1) holds where no delay is over T_i", "i.e.", told_samplings(uneven),
       fmt::format(
           "controllers sample T_1 / 8 after the slots begin, beside other packets; longest delay {:.3f} "
           "of {:.0f} ms: it also needs one grid for all",
           ms(uneven.longest()), ms(skewed.slot)),
       uneven.lost() + uneven.vacant() == 0});
  std::string loops;
  bool keeps_bounds = true;
  const Proof proof = prove(traffic, settings.seed, slots);
  for (std::size_t n = 0; n < demand.bounds.size(); ++n) {
    loops += fmt::format("{}{:.1f}", n == 0 ? "" : ", ", ms(proof.longest_loop_delays[n]));
    keeps_bounds &= proof.longest_loop_delays[n] <= demand.bounds[n];
  }
  section.rows.push_back({"(C2) loop delays", "within their bounds", loops + " ms",
                          "the longest of each, against all adversaries", keeps_bounds});
  section.figures.push_back(figure_of_packets(
      "Figure 5: windows of three slots", frames_of(on_real_line(demand), line_rules(), Load::none, settings),
      traffic.slot, {24, 3}));
  return section;
}

PublishedSection bandwidth_non_real_time(const Settings& settings) {
  PublishedSection section;
  section.heading = "5.2 and figures 6 and 7: periodic and non-real-time data";
  section.note =
      "A density (sum of 2 / k) of 6 and one of 3.75 data in a slot. N_p non-real-time queues is a misprint "
      "of "
      "N_n, and the N of R and of the bound that of the nodes. The bound as printed supposes that each slot "
      "has "
      "gamma data: with fewer, more packets go before them. The safe one is its least over all numbers of "
      "data "
      "that slots have.";
  const Demand whole = bandwidth::whole_density();
  const Demand fraction = bandwidth::fractional_density();
  const Allocation allocation = allocate(fraction);
  const WindowTraffic traffic = safe_traffic(fraction);
  const IntervalLedger ledger =
      ledger_of(traffic, Load::saturated, slots_of(settings, traffic.slot), settings.seed);
  section.rows.push_back(row_of_stable_periodic(whole, settings));
  section.rows.push_back({"a periodic interval", "at most gamma L_p + R",
                          fmt::format("{:.3f} ms at most", ms(ledger.longest_interval())),
                          fmt::format("gamma L_p + R = {:.3f} ms; from the bit that is set until its node is "
                                      "visited again",
                                      ms(allocation.periodic_interval)),
                          ledger.longest_interval() == allocation.periodic_interval});
  section.rows.push_back({"non-real-time packets of a periodic interval", "none",
                          ledger.has_sent_within() ? "some" : "none",
                          "the bit is in each frame of the server", !ledger.has_sent_within()});
  section.rows.push_back(row_of_packets("non-real-time packets before data, density 6", whole, settings));
  section.rows.push_back(row_of_packets("the same, density 3.75", fraction, settings));
  section.rows.push_back(
      row_of_proof("L_n as printed, density 6",
                   bandwidth::traffic_of(whole, microseconds_of(allocate(whole).longest_printed)), settings));
  section.rows.push_back(
      row_of_proof("L_n as printed, density 3.75",
                   bandwidth::traffic_of(fraction, microseconds_of(allocation.longest_printed)), settings));
  PublishedRow safe = row_of_proof("L_n by the safe bound, density 3.75", traffic, settings);
  safe.published.clear();
  section.rows.push_back(std::move(safe));
  section.rows.push_back(
      row_of_balance("what saturated queues send, density 6", safe_traffic(whole), whole, settings));
  section.rows.push_back(row_of_balance("the same, density 3.75", traffic, fraction, settings));
  const std::vector<Sent> frames = frames_of(on_real_line(fraction), line_rules(), Load::saturated, settings);
  section.figures.push_back(figure_of_packets("Figure 6: periodic and non-real-time intervals of two slots",
                                              frames, traffic.slot, {26, 2}));
  section.figures.push_back(
      figure_of_packets("Figure 7: a periodic interval", frames, traffic.slot, {26, 0.6}));
  return section;
}

PublishedSection bandwidth_real_time(const Settings& settings) {
  PublishedSection section;
  section.heading = "5.3 and figure 8: real-time data as well, from three nodes, 0.2 ms each";
  section.note =
      "A real-time packet goes as soon as the server is there. The paper gives the same bound for periodic "
      "and "
      "real-time delays; it holds for real-time data only where a rotation without periodic data takes less "
      "than "
      "T_1, which asks for shorter packets.";
  const Demand demand = with_real_time();
  const Allocation allocation = allocate(demand);
  WindowTraffic traffic = safe_traffic(demand);
  for (bandwidth::QueueTraffic& queue : traffic.real_time) queue.mean_gap = 7 * traffic.slot;
  const std::uint64_t slots = slots_of(settings, traffic.slot);
  const IntervalLedger ledger = ledger_of(traffic, Load::saturated, slots, settings.seed);
  section.rows.push_back(
      {"a periodic interval", "at most gamma L_p + N_c L_c + R",
       fmt::format("{:.3f} ms at most", ms(ledger.longest_interval())),
       fmt::format("gamma L_p + N_c L_c + R = {:.3f} ms", ms(allocation.periodic_interval)),
       ledger.longest_interval() == allocation.periodic_interval});
  section.rows.push_back({"real-time packets of a visit", "before the others",
                          ledger.is_real_time_late() ? "after some" : "before all", "",
                          !ledger.is_real_time_late()});
  section.rows.push_back(
      row_of_proof("L_n as printed",
                   bandwidth::traffic_of(demand, microseconds_of(allocation.longest_printed)), settings));
  PublishedRow safe = row_of_proof("L_n by the safe bound", traffic, settings);
  safe.published.clear();
  section.rows.push_back(std::move(safe));
  const auto wait_with = [&](Duration packet, const WindowTraffic& like) {
    WindowTraffic tried = like;
    tried.non_real_time_packet = packet;
    return run_windows(tried, {.seed = settings.seed, .slots = slots, .non_real_time = Load::saturated})
        .real_time.longest;
  };
  const WindowTraffic worst = bandwidth::worst_order(traffic);
  const Duration printed =
      std::max(wait_with(allocation.longest_printed, traffic), wait_with(allocation.longest_printed, worst));
  const Duration shorter = std::max(wait_with(allocation.longest_for_real_time, traffic),
                                    wait_with(allocation.longest_for_real_time, worst));
  section.rows.push_back({"real-time delays with L_n as printed", "within T_1",
                          fmt::format("{:.3f} ms at most", ms(printed)),
                          fmt::format("T_1 is {:.0f} ms", ms(traffic.slot)), printed <= traffic.slot});
  section.rows.push_back({fmt::format("real-time delays with L_n <= (T_1 - N_c L_c - R) / N = {:.3f} ms",
                                      ms(allocation.longest_for_real_time)),
                          "", fmt::format("{:.3f} ms at most", ms(shorter)),
                          "a rotation full of packets fits T_1", shorter <= traffic.slot});
  section.rows.push_back(
      row_of_balance("what saturated non-real-time queues send", traffic, demand, settings));
  section.figures.push_back(figure_of_packets(
      "Figure 8: real-time, periodic and non-real-time data of two slots",
      frames_of(on_real_line(demand), line_rules(), Load::saturated, settings), traffic.slot, {26, 2}));
  return section;
}

PublishedSection bandwidth_loop(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 3 and 4: a control loop with and without the scheme, T 20 ms";
  section.note =
      "The paper shows a picture and names no process. Here: two lags of 80 and 32 ms, a PID, three other "
      "loops, "
      "files of all nodes. Without the scheme the same server visits the same nodes and loops sample at the "
      "same "
      "instants, but it has no periodic byte, and packets of files are three times as long.";
  const WindowTraffic with = safe_traffic(bandwidth::fractional_density());
  WindowTraffic without = with;
  without.has_periodic_byte = false;
  without.non_real_time_packet *= 3;
  const auto periods =
      static_cast<unsigned>(std::clamp<std::int64_t>(settings.duration / with.slot, 120, 20'000));
  const LoopCourse alone = run_window_loop(with, Load::none, periods, settings.seed);
  const LoopCourse planned = run_window_loop(with, Load::saturated, periods, settings.seed);
  const LoopCourse cyclic = run_window_loop(without, Load::random, periods, settings.seed);
  section.rows.push_back(row_of_course("without other data", alone));
  section.rows.push_back(row_of_course("with the scheme, other queues always full", planned));
  section.rows.push_back(row_of_course("without it", cyclic));
  section.rows.push_back({"with the scheme: samples lost and vacant sampling", "none",
                          fmt::format("{} and {}", planned.lost, planned.vacant), "",
                          planned.lost + planned.vacant == 0});
  section.rows.push_back(sentence("loss and vacant sampling: error of the loop",
                                  "they lower performance much", cyclic.absolute_error,
                                  planned.absolute_error));
  section.rows.push_back(sentence("loss and vacant sampling: travel of the actuator", "jitter wears it",
                                  cyclic.travel, planned.travel));
  const std::size_t points = std::min<std::size_t>(1'200, cyclic.points.size());
  PublishedCurves process{"Figure 4: the process", "time, s", "per cent", {}};
  PublishedCurves actuator{"Figure 4: the actuator", "time, s", "per cent", {}};
  for (const auto& [name, course] :
       {std::pair{"without the scheme", &cyclic}, {"with the scheme", &planned}}) {
    process.curves.push_back(curve_of(name, *course, &LoopCourse::Point::process, points));
    actuator.curves.push_back(curve_of(name, *course, &LoopCourse::Point::actuator, points));
  }
  process.curves.push_back(curve_of("setpoint", planned, &LoopCourse::Point::setpoint, points));
  section.figures = {std::move(process), std::move(actuator)};
  return section;
}

PublishedSection bandwidth_stations(const Settings& settings) {
  PublishedSection section;
  section.heading = "The same as stations that send frames, at 1 Mbit/s";
  section.note =
      "The paper: the scheme fits every cyclic service, polling and token alike. Each station sends real "
      "frames "
      "with the periodic byte; somebody on the line reads them.";
  for (const bool is_polled : {false, true}) {
    bandwidth::WindowLineRules rules = line_rules();
    rules.is_polled = is_polled;
    const Demand demand = with_real_time();
    const WindowTraffic traffic = on_line(bandwidth::traffic_of(demand, 1), rules);
    for (const Load load : {Load::saturated, Load::just_late}) {
      WindowRun run{.seed = settings.seed, .slots = 200, .real_time = load, .non_real_time = load};
      const bandwidth::LinkRun link = run_window_link(traffic, rules, run);
      std::vector<Sent> sent;
      run.on_sent = [&](const Sent& one) { sent.push_back(one); };
      const WindowFigures figures = run_windows(traffic, run);
      const std::size_t both = std::min(sent.size(), link.sent.size());
      const Duration before = link.origin - kernel::kStart;
      std::size_t equal = 0;
      while (equal < both && sent[equal].node == link.sent[equal].node &&
             sent[equal].packet == link.sent[equal].packet &&
             sent[equal].end + before == link.sent[equal].end)
        ++equal;
      section.rows.push_back(
          {fmt::format("{}, other queues send {}", is_polled ? "polling" : "token", name_of(load)),
           "no datum over T_1", told_longest(figures),
           fmt::format("{} of {} packets end at the picosecond of the simulation without frames", equal,
                       both),
           equal == both && figures.over_slot() == 0});
    }
  }
  return section;
}

}  // namespace fieldproof::papers
