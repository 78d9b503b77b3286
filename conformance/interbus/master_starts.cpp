// What a start begins anew, and what is ordered or has changed around one (IM-08, IM-17, IM-18, IM-23,
// IM-39).
#include <fmt/format.h>

#include <array>
#include <utility>

#include "conformance/interbus/master_scene.hpp"
#include "conformance/interbus/master_sequence.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::conformance {
namespace {

using namespace master_chart;
using interbus::CycleFaults;
using interbus::FaultLocation;
using interbus::MasterState;
using interbus::MasterStatus;

void stop_cycles(MasterBench& bench) {
  bench.stop();
  bench.run_until([&] { return bench.status().state == MasterState::off; }, kernel::kSecond);
  bench.run_for(kernel::kMillisecond);
}

// ---- a start begins anew ----

void run_with_bad_cycles(MasterBench& bench, CaseJudge& judge) {
  bench.set_script([n = 0](const auto&, CycleFaults& faults) mutable {
    if (++n % 5 == 0) spoil(faults);
  });
  bench.run_data_cycles(judge, 20);
  bench.set_script({});
}

void expect_new_counts(MasterBench& bench, CaseJudge& judge) {
  stop_cycles(bench);
  const auto before = bench.finished();
  bench.start();
  judge.expect(bench.wait_for_run(), "not_in_run", "the master runs again", "it does not");
  bench.run_data_cycles(judge, 3);
  const MasterStatus status = bench.status();
  const std::uint64_t data = bench.finished().data_count - before.data_count;
  const std::string since = " since the start";
  judge.expect_equal(status.data_cycles, data, "counter_goes_on", "data cycles" + since);
  judge.expect_equal(status.id_cycles, bench.finished().count - before.count - data, "counter_goes_on",
                     "ID cycles" + since);
  const std::uint64_t rejected = bench.finished().rejected_count - before.rejected_count;
  judge.expect_equal(status.rejected_cycles, rejected, "counter_goes_on", "rejected cycles" + since);
  judge.expect(status.rejected_data_cycles <= rejected, "counter_goes_on", "rejected data cycles" + since,
               "more than rejected cycles of both kinds");
}

constexpr std::size_t kManyStations = 30;
Ring without_words(std::size_t stations) {
  return interbus::line_of(stations, kNoWord, 0);
}

// The first one is shorter, then longer.
std::array<std::size_t, 2> stations_in_turn(const RingScene& scene) {
  return scene.round == 0 ? std::array<std::size_t, 2>{1, kManyStations}
                          : std::array<std::size_t, 2>{kManyStations, 1};
}

void run_on_first_ring(RingScene& scene) {
  scene.bench.bring_up(scene.judge, without_words(stations_in_turn(scene)[0]));
  scene.bench.run_data_cycles(scene.judge, 2);
}

void start_on_second_ring(RingScene& scene) {
  stop_cycles(scene.bench);
  scene.bench.ring().replace_ring(without_words(stations_in_turn(scene)[1]));
  scene.bench.start();
  scene.judge.expect(scene.bench.wait_for_run(), "not_in_run", "the master runs on the other ring",
                     "it does not");
}

void expect_new_cycle_time(RingScene& scene) {
  expect_cycle_time_without_words(scene.bench, scene.judge, stations_in_turn(scene)[1], {},
                                  "delay_of_another_ring");
}

// ---- bus stop ----

void cut_up_to_the_bus_stop(MasterBench& bench, CaseJudge& judge) {
  bench.ring().cut_after(-1);
  for (unsigned n = 0; n < bench.rules().stop_after_bad_cycles + 2 && bench.is_in_run(); ++n)
    judge.expect(bench.run_cycle(), "no_data_cycle", "cycles up to the bus stop", "no cycle ends any more");
  bench.ring().mend();
}

// As long as no telegram has come after the last cycle, the silence is not over.
void expect_bus_stop_in_silence(RingScene& scene) {
  MasterBench& bench = scene.bench;
  const auto expect_bus_stop = [&] {
    const MasterState state = bench.status().state;
    scene.judge.expect(state == MasterState::bus_stop, "bus_stop_left_in_silence",
                       "bus stop, as long as the silence lasts", interbus::name(state));
  };
  expect_bus_stop();
  constexpr std::array kInSilence{kernel::kMillisecond, 10 * kernel::kMillisecond, 20 * kernel::kMillisecond};
  bench.run_for(kInSilence.at(scene.round));
  expect_bus_stop();
}

void start_in_silence(MasterBench& bench, CaseJudge& judge) {
  bench.start();
  bool has_searched = false;
  bench.run_until(
      [&] {
        has_searched = has_searched || bench.status().state == MasterState::locating;
        return has_searched || bench.is_in_run();
      },
      kernel::kSecond);
  judge.expect(bench.is_in_run(), "start_ignored_in_silence", "the ring is recognised, and the master runs",
               has_searched ? "it looks for the fault" : "it does not run");
}

constexpr std::size_t kFour = 4;

Ring four_in_a_row() {
  return interbus::line_of(kFour, kOneWord, 1);
}

// The order of the ring, all codes and all lengths stay.
void move_while_stopped(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.ring().cut_after(-1);
  for (unsigned n = 0; n < bench.rules().stop_after_bad_cycles + 2 && bench.is_in_run(); ++n)
    bench.run_cycle();
  bench.ring().mend();
  Ring ring = four_in_a_row();
  ring.at(scene.round + 1).on_branch = true;
  bench.ring().replace_ring(std::move(ring));
}

void expect_moved_located(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.run_until([&] { return bench.status().has_fault_location; }, kernel::kSecond);
  const MasterStatus status = bench.status();
  const int moved = static_cast<int>(scene.round) + 1;
  scene.judge.expect(status.has_fault_location && status.fault_location == FaultLocation{moved - 1, moved},
                     "moved_station_not_located", fmt::format("fault between {} and {}", moved - 1, moved),
                     status.has_fault_location ? fmt::format("between {} and {}", status.fault_location.from,
                                                             status.fault_location.to)
                                               : "no location");
}

// ---- orders ----

constexpr std::uint16_t kFirstWord = 0x1111;
constexpr std::uint16_t kSecondWord = 0x2222;

// In each order, so that each of the three is the last one once.
void order_three_at_once(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bool is_ordered = false;
  bench.on_cycle([&] {
    if (std::exchange(is_ordered, true)) return;
    for (unsigned n = 0; n < 3; ++n) {
      const unsigned which = (scene.round + n) % 3;
      if (which == 0) bench.write_output(0, kFirstWord);
      if (which == 1) bench.write_output(1, kSecondWord);
      if (which == 2) bench.request_id_cycle();
    }
  });
  bench.run_cycle();
  bench.on_cycle(nullptr);
}

// A cycle that has begun in the call in which the one before ended does not have them.
void expect_three_obeyed(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bool has_identified = false;
  for (int n = 0; n < 4 && bench.run_cycle(); ++n)
    has_identified = has_identified || !bench.finished().is_data;
  scene.judge.expect(has_identified, "orders_of_one_cycle_end_lost", "an ID cycle within four cycles",
                     "data cycles only");
  for (const auto& [word, value] : {std::pair{0U, kFirstWord}, std::pair{1U, kSecondWord}}) {
    scene.judge.expect(bench.ring().output(word) == value, "orders_of_one_cycle_end_lost",
                       fmt::format("output word {} is {:04X}h within four cycles", word, value),
                       fmt::format("{:04X}h", bench.ring().output(word)));
  }
}

MasterStep two_stations() {
  return in_run("two stations", interbus::line_of(2, kOneWord, 1));
}

}  // namespace

std::vector<MasterCase> master_cases_of_starts() {
  const judge::Reference from_page = master_sequence_role().test_case.reference;
  return {
      master_case("supervision/counters_begin_anew_with_a_start", "IM-18",
                  "Cycles are counted since the last start", from_page, {"must"},
                  {{"counters_go_on", "counter_goes_on"}},
                  {.steps = {two_stations(), step("20 data cycles, some cycles bad", "", run_with_bad_cycles),
                             step("stop, start and 3 data cycles", "the counters are those since the start",
                                  expect_new_counts)}}),
      master_case("timing/ring_delay_is_measured_at_each_start", "IM-08",
                  "The delay of the ring is that of the ring that the last recognition has found", from_page,
                  {"timing"}, {{"ring_delay_kept", "delay_of_another_ring"}},
                  {.steps = {stimulus<RingScene>("run and 2 data cycles", run_on_first_ring),
                             stimulus<RingScene>("stop, another ring, start", start_on_second_ring),
                             expected<RingScene>("its cycle time", expect_new_cycle_time)},
                   .walk = each("1 station and 30 after them, 30 and 1 after them", 2)}),
      master_case(
          "supervision/start_in_the_silence_of_a_bus_stop", "IM-39",
          "The silence belongs to the bus stop, and a start counts in it", from_page, {"must"},
          {{"locates_at_once", "bus_stop_left_in_silence"},
           {"start_ignored_in_silence", "start_ignored_in_silence"}},
          {.steps = {two_stations(),
                     step("the ring is cut up to the bus stop, and closed again", "", cut_up_to_the_bus_stop),
                     expected<RingScene>("bus stop up to that instant", expect_bus_stop_in_silence),
                     step("start", "run, and no fault is looked for", start_in_silence)},
           .walk = each("1, 10 and 20 ms of the silence", 3)}),
      master_case("ring_change/moved_station_is_located", "IM-17",
                  "A station that hangs on another interface is another one", from_page, {"must"},
                  {{"located_by_id_code", "moved_station_not_located"}},
                  {.steps = {in_run("four stations", four_in_a_row()), data_cycles(2),
                             stimulus<RingScene>(
                                 "a bus stop, and a station is moved to OUT2 of the one before meanwhile",
                                 move_while_stopped),
                             expected<RingScene>("the place is in front of it", expect_moved_located)},
                   .walk = each("each station but the first", kFour - 1)}),
      master_case(
          "application/orders_of_one_cycle_end_are_all_obeyed", "IM-23",
          "Each of several orders at the end of a cycle is carried out", from_page, {"must"},
          {{"last_order_only", "orders_of_one_cycle_end_lost"}},
          {.steps = {two_stations(), data_cycles(2),
                     stimulus<RingScene>("two outputs and an ID cycle are ordered at one end of a cycle",
                                         order_three_at_once),
                     expected<RingScene>("both outputs and an ID cycle", expect_three_obeyed)},
           .walk = each("three orders of them", 3)})};
}

}  // namespace fieldproof::conformance
