// Section 5 of Hong and others: the bandwidth of a fieldbus allocated to control loops, real-time and
// non-real-time data. The paper prints rules, formulas and pictures of intervals, and no number: each of its
// statements stands next to what simulated lines do. Bounds, packets and nodes are chosen.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/traffic/milliseconds.hpp"
#include "papers/bandwidth_lines.hpp"
#include "papers/interval_ledger.hpp"
#include "protocols/bandwidth/proof.hpp"
#include "protocols/bandwidth/sample_plans.hpp"
#include "protocols/bandwidth/stability.hpp"

namespace fieldproof::papers {
namespace {

using bandwidth::Allocation;
using bandwidth::Demand;
using bandwidth::Load;
using bandwidth::Proof;
using bandwidth::Sent;
using bandwidth::WindowFigures;
using bandwidth::WindowRun;
using bandwidth::WindowTraffic;
using kernel::Duration;
using reports::PublishedRow;
using reports::PublishedSection;
using traffic::ms;

constexpr std::uint64_t kFewestSlots = 50'000;
constexpr std::uint64_t kMostSlots = 500'000;

std::uint64_t slots_of(const Settings& settings, Duration slot) {
  return std::clamp(static_cast<std::uint64_t>(settings.duration / slot), kFewestSlots, kMostSlots);
}

std::string told_samplings(const WindowFigures& figures) {
  const double each = 1e3 / static_cast<double>(figures.samplings());
  return fmt::format("{} vacant and {} lost; of 1000 samplings {:.1f} and {:.1f}", figures.vacant(),
                     figures.lost(), each * static_cast<double>(figures.vacant()),
                     each * static_cast<double>(figures.lost()));
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
      reports::at_most(0, static_cast<double>(late), "late")};
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
          reports::within(printed, 0, static_cast<double>(most), "packets")};
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
          reports::own(reports::within(formula, 6e-4 * formula, sent, "packets"))};
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
  return {"periodic data are sent while gamma L_p + R <= T_1", "all",
          fmt::format("{} late or lost with L_p {:.3f} ms, {} with 0.1 ms more", within, ms(fits), beyond),
          fmt::format("{} windows and a rotation of {:.0f} ms in {:.0f} ms", allocation.windows,
                      ms(allocation.rotation), ms(allocation.slot)),
          reports::at_most(0, static_cast<double>(within), "late or lost")};
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
                          reports::at_most(allocation.windows, static_cast<double>(most), "data")});
  section.rows.push_back({"data that come in T_1 are sent within it", "all", told_longest(alone),
                          "nothing but periodic data",
                          reports::at_most(0, static_cast<double>(alone.over_slot()), "late")});
  section.rows.push_back({"(C1) data loss and vacant sampling", "none", told_samplings(alone),
                          "sensors and controllers sample at begins of slots",
                          reports::at_most(0, static_cast<double>(alone.lost() + alone.vacant()))});
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
       reports::at_most(0, static_cast<double>(uneven.lost() + uneven.vacant()))});
  std::string loops;
  double fullest = 0;
  const Proof proof = prove(traffic, settings.seed, slots);
  for (std::size_t n = 0; n < demand.bounds.size(); ++n) {
    loops += fmt::format("{}{:.1f}", n == 0 ? "" : ", ", ms(proof.longest_loop_delays[n]));
    fullest = std::max(fullest, 100 * ms(proof.longest_loop_delays[n]) / ms(demand.bounds[n]));
  }
  section.rows.push_back({"(C2) loop delays", "within their bounds", loops + " ms",
                          "the longest of each, against all adversaries",
                          reports::at_most(100, fullest, "% of a bound")});
  section.figures.push_back(
      figure_of_packets("Figure 5: windows of three slots", demand, Load::none, {24, 3}, settings));
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
  section.rows.push_back(
      {"a periodic interval", "at most gamma L_p + R",
       fmt::format("{:.3f} ms at most", ms(ledger.longest_interval())),
       fmt::format("gamma L_p + R = {:.3f} ms; from the bit that is set until its node is "
                   "visited again",
                   ms(allocation.periodic_interval)),
       reports::at_most(ms(allocation.periodic_interval), ms(ledger.longest_interval()), "ms")});
  section.rows.push_back(
      {"non-real-time packets of a periodic interval", "none", ledger.has_sent_within() ? "some" : "none",
       "the bit is in each frame of the server", reports::at_most(0, ledger.has_sent_within() ? 1 : 0)});
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
  safe.compared = reports::own(*safe.compared);
  section.rows.push_back(std::move(safe));
  section.rows.push_back(
      row_of_balance("what saturated queues send, density 6", safe_traffic(whole), whole, settings));
  section.rows.push_back(row_of_balance("the same, density 3.75", traffic, fraction, settings));
  section.figures.push_back(figure_of_packets("Figure 6: periodic and non-real-time intervals of two slots",
                                              fraction, Load::saturated, {26, 2}, settings));
  section.figures.push_back(
      figure_of_packets("Figure 7: a periodic interval", fraction, Load::saturated, {26, 0.6}, settings));
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
       reports::at_most(ms(allocation.periodic_interval), ms(ledger.longest_interval()), "ms")});
  section.rows.push_back({"real-time packets of a visit", "before the others",
                          ledger.is_real_time_late() ? "after some" : "before all", "",
                          reports::at_most(0, ledger.is_real_time_late() ? 1 : 0)});
  section.rows.push_back(
      row_of_proof("L_n as printed",
                   bandwidth::traffic_of(demand, microseconds_of(allocation.longest_printed)), settings));
  PublishedRow safe = row_of_proof("L_n by the safe bound", traffic, settings);
  safe.published.clear();
  safe.compared = reports::own(*safe.compared);
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
                          fmt::format("T_1 is {:.0f} ms", ms(traffic.slot)),
                          reports::at_most(ms(traffic.slot), ms(printed), "ms")});
  section.rows.push_back({fmt::format("real-time delays with L_n <= (T_1 - N_c L_c - R) / N = {:.3f} ms",
                                      ms(allocation.longest_for_real_time)),
                          "", fmt::format("{:.3f} ms at most", ms(shorter)),
                          "a rotation full of packets fits T_1",
                          reports::own(reports::at_most(ms(traffic.slot), ms(shorter), "ms"))});
  section.rows.push_back(
      row_of_balance("what saturated non-real-time queues send", traffic, demand, settings));
  section.figures.push_back(
      figure_of_packets("Figure 8: real-time, periodic and non-real-time data of two slots", demand,
                        Load::saturated, {26, 2}, settings));
  return section;
}

}  // namespace fieldproof::papers
