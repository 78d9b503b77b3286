// ID cycles of a recognition, with messages and with errors, and orders for them (IM-19, IM-31).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/interbus/master_scene.hpp"
#include "conformance/interbus/master_sequence.hpp"

namespace fieldproof::conformance {
namespace {

using namespace master_chart;
using interbus::CycleFaults;
using interbus::MasterState;
using interbus::MasterStatus;
using CycleInfo = interbus::RingEmulator::CycleInfo;

constexpr std::size_t kOfFour = 4;
constexpr kernel::Duration kLongestRecognition = 5 * kernel::kSecond;

Ring four_stations() {
  return interbus::line_of(kOfFour, kOneWord, 1);
}

// ---- bad cycles of a recognition ----

constexpr std::array kBadCycleLimits{10U, 2U, 33U};

void power_up_with_limit(RingScene& scene) {
  scene.bench.set_script({});
  scene.bench.rules().stop_after_bad_cycles = kBadCycleLimits.at(scene.round);
  scene.bench.power_up(four_stations());
  scene.bench.run_until([&scene] { return scene.bench.status().state == MasterState::identification; },
                        kLongestRecognition);
  scene.judge.expect(scene.bench.status().state == MasterState::identification, "no_identification",
                     "identification, when a station has answered", "it is not in identification");
}

// From now on so many bad cycles before each good one.
void spoil_in_rows(RingScene& scene) {
  const unsigned row = kBadCycleLimits.at(scene.round);
  scene.bench.set_script([row, n = 0U](const CycleInfo&, CycleFaults& faults) mutable {
    if (++n % row != 0) spoil(faults);
  });
}

void expect_run_after_rows(RingScene& scene) {
  scene.bench.run_until([&scene] { return scene.bench.is_in_run(); }, kLongestRecognition);
  scene.bench.set_script({});
  scene.judge.expect(scene.bench.is_in_run(), "bad_cycles_add_up",
                     fmt::format("run: no {} bad cycles came in a row", kBadCycleLimits.at(scene.round)),
                     "it is not in run");
}

void expect_counted_bus_stop(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.set_script([](const CycleInfo&, CycleFaults& faults) { spoil(faults); });
  const std::uint64_t before = bench.ring().cycle_count();
  bench.run_until([&bench] { return bench.status().state == MasterState::bus_stop; }, kLongestRecognition);
  const MasterStatus status = bench.status();
  scene.judge.expect(status.state == MasterState::bus_stop, "bus_stop_missing", "bus stop", "another state");
  scene.judge.expect_equal(bench.ring().cycle_count() - before, kBadCycleLimits.at(scene.round),
                           "bad_cycles_miscounted", "bad cycles up to the bus stop");
  scene.judge.expect(status.has_fault_location, "fault_not_located", "a bus stop with the place",
                     "no location");
}

MasterCase bad_cycles_case(const judge::Reference& from_page) {
  return master_case(
      "identification/bad_cycles_stop_a_recognition", "IM-19",
      "As many bad cycles in a row as stop the bus end a recognition; fewer before each good one do not",
      from_page, {"must"},
      {{"recognition_stops_late", "bad_cycles_miscounted"}, {"recognition_adds_up", "bad_cycles_add_up"}},
      {.steps = {stimulus<RingScene>("a recognition of four stations, one of which has answered",
                                     power_up_with_limit),
                 stimulus<RingScene>("before each good cycle come as many bad ones as do not stop it",
                                     spoil_in_rows),
                 expected<RingScene>("run", expect_run_after_rows),
                 stimulus<RingScene>("another recognition", power_up_with_limit),
                 expected<RingScene>("bad cycles only: exactly the limit, then bus stop with the place",
                                     expect_counted_bus_stop)},
       .walk = each("limits of 10, 2 and 33 bad cycles", kBadCycleLimits.size())});
}

// ---- messages of a recognition ----

void recognise_with_messages(RingScene& scene) {
  const interbus::Rules& rules = scene.bench.rules();
  scene.bench.set_script({});
  scene.bench.power_up(four_stations());
  scene.bench.ring().set_messages(scene.round,
                                  rules.message_peripheral_fault | rules.message_reconfiguration);
}

void expect_messages(RingScene& scene) {
  scene.judge.expect(scene.bench.wait_for_run(), "not_in_run", "the master runs", "it does not");
  scene.bench.run_data_cycles(scene.judge, 2);
  const MasterStatus status = scene.bench.status();
  const std::vector<int> right{static_cast<int>(scene.round)};
  scene.judge.expect(status.peripheral_faults == right && status.reconfigurations == right,
                     "messages_of_recognition_missed",
                     fmt::format("both messages of station {}", scene.round), "not these");
}

MasterCase messages_case(const judge::Reference& from_page) {
  return master_case(
      "ring_change/messages_of_a_recognition_are_reported", "IM-31",
      "What the last ID cycle of a recognition says of the stations is reported", from_page, {"must"},
      {{"messages_of_recognition_lost", "messages_of_recognition_missed"}},
      {.steps = {stimulus<RingScene>("a station has messages from the beginning", recognise_with_messages),
                 expected<RingScene>("they are reported in run", expect_messages)},
       .walk = each("each of four stations", kOfFour)});
}

// ---- orders for ID cycles ----

// A cycle begins a cycle time after the one before; an ID cycle of four stations lasts longer than 400 us.
void order_within_an_id_cycle(RingScene& scene) {
  MasterBench& bench = scene.bench;
  const kernel::Time begins = bench.ring().last_cycle().start + bench.cycle_time();
  bench.request_id_cycle();
  bench.run_for(std::max<kernel::Duration>(begins + 200 * kernel::kMicrosecond - bench.now(), {}));
  bench.request_id_cycle();
}

void expect_another_id_cycle(RingScene& scene) {
  constexpr unsigned kCycles = 4;
  std::string kinds;
  for (unsigned n = 0; n < kCycles && scene.bench.run_cycle(); ++n)
    kinds += scene.bench.finished().is_data ? " data" : " ID";
  scene.judge.expect(kinds == " ID ID data data", "order_in_id_cycle_lost", "cycles: ID ID data data",
                     "cycles:" + kinds);
}

MasterCase order_case(const judge::Reference& from_page) {
  return master_case(
      "identification/order_within_an_id_cycle_is_met_by_the_next", "IM-31",
      "An order that comes while an ID cycle is on the line is met by another one", from_page, {"must"},
      {{"order_in_id_cycle_lost", "order_in_id_cycle_lost"}},
      {.steps = {in_run("four stations", four_stations()), data_cycles(2),
                 stimulus<RingScene>("an order for an ID cycle, and another one when that has begun",
                                     order_within_an_id_cycle),
                 expected<RingScene>("two ID cycles, then data cycles", expect_another_id_cycle)}});
}

}  // namespace

std::vector<MasterCase> master_id_cycle_cases() {
  const judge::Reference from_page = master_sequence_role().test_case.reference;
  return {bad_cycles_case(from_page), messages_case(from_page), order_case(from_page)};
}

}  // namespace fieldproof::conformance
