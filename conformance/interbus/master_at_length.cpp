#include <fmt/format.h>

#include "conformance/interbus/compared_master.hpp"
#include "conformance/interbus/master_scene.hpp"
#include "conformance/interbus/master_sequence.hpp"

// A master with more of everything: each of twelve stations, more words than an octet counts, more bad cycles
// in a row than four and eight bits count, cycles of seconds, orders that come twice, and rings that change.
namespace fieldproof::conformance {
namespace {

using namespace compared_master;
using namespace master_chart;
using interbus::FaultLocation;
using interbus::MasterState;

// ---- families of sequences ----

constexpr std::int64_t kStationsAtLength = 12;

// Each station has messages, marks a cycle, becomes another one, is cut off, and is not the one expected.
std::vector<MasterCommands> each_station_at_length() {
  std::vector<MasterCommands> all;
  for (std::int64_t station = 0; station < kStationsAtLength; ++station) {
    all.push_back({ring(kLongRing), order(MasterWord::messages, {{0, station}, {1, 3}}),
                   order(MasterWord::identify), cycles(2), order(MasterWord::stop),
                   order(MasterWord::start)});
    all.push_back({ring(kLongRing), order(MasterWord::marked, {{0, station}, {1, station}}), cycles(3)});
    all.push_back({ring(kLongRing), order(MasterWord::ring, {{0, 0}, {1, station}}),
                   order(MasterWord::identify), cycles(2)});
    all.push_back({ring(kLongRing), order(MasterWord::cut, {{0, station}})});
    all.push_back({order(MasterWord::power, {{0, kLongRing}, {1, kAnotherExpected + station}})});
  }
  return all;
}

constexpr unsigned kManyBadCycles = 20;

void stop_after_many(interbus::Rules& rules) {
  rules.stop_after_bad_cycles = kManyBadCycles;
}

std::vector<MasterCommands> many_bad_cycles() {
  const SequenceCommand one_less = order(MasterWord::bad, {{0, kManyBadCycles - 1}});
  return {{one_less, cycles(2), one_less, order(MasterWord::bad), order(MasterWord::start), one_less}};
}

constexpr unsigned kBadCyclesBeyondAnOctet = 300;

void stop_after_more_than_an_octet(interbus::Rules& rules) {
  rules.stop_after_bad_cycles = kBadCyclesBeyondAnOctet;
}

std::vector<MasterCommands> bad_cycles_beyond_an_octet() {
  return {{order(MasterWord::bad, {{0, kBadCyclesBeyondAnOctet - 1}}), cycles(1),
           order(MasterWord::bad, {{0, kBadCyclesBeyondAnOctet}})}};
}

// Slowly, so that few status telegrams fill a pause of seconds.
void be_slow(interbus::Rules& rules) {
  rules.bit_rate = 10'000;
  rules.software_time = 40 * kernel::kMillisecond;
}

// Beyond 2^32 ns.
std::vector<MasterCommands> cycle_times_of_seconds() {
  return {{order(MasterWord::power, {{0, 0}, {3, 4'400}}), cycles(1)}};
}

void take_wide_rings(interbus::Rules& rules) {
  rules.max_io_points = 16'384;
}

std::vector<MasterCommands> words_beyond_an_octet() {
  MasterCommands all{ring(kWideRing), order(MasterWord::outputs, {{0, 0x1234}, {1, 0x8765}}), cycles(1)};
  for (const std::int64_t word : {255, 256, 260, 319})
    all.push_back(order(MasterWord::output, {{0, word}, {1, 0x4000 + word}}));
  all.push_back(cycles(2));
  return {all};
}

std::vector<MasterCommands> id_cycles_asked_for_twice() {
  const SequenceCommand asked = order(MasterWord::identify);
  return {{asked, asked, cycles(4)}, {order(MasterWord::bad), asked, asked, cycles(4)}};
}

// ---- charts ----

MasterStep cycles_up_to_the_bus_stop(std::string reason) {
  return expected<RingScene>("it leaves run within the cycles that stop the bus", [reason](RingScene& scene) {
    const unsigned most = scene.bench.rules().stop_after_bad_cycles;
    for (unsigned n = 0; n < most + 2 && scene.bench.is_in_run(); ++n) scene.bench.run_cycle();
    scene.judge.expect(!scene.bench.is_in_run(), reason, "another state than run", "it is in run");
  });
}

Ring twelve_alike() {
  return interbus::line_of(kStationsAtLength, kOneWord, 1);
}

Ring with_another(std::size_t station) {
  Ring ring = twelve_alike();
  ring.at(station).id_code ^= 0x0040;
  return ring;
}

// 1 and 2 hang on the branch of 0, 5 on that of 4: before 3 and 6 in the ring is not what they hang on.
Ring twelve_with_branches() {
  Ring ring = twelve_alike();
  ring.at(1).on_branch = ring.at(5).on_branch = true;
  ring.at(3).before = 0;
  ring.at(6).before = 4;
  return ring;
}

// It stops at once, and looks for no fault: it has seen which station is another one.
void expect_no_search(RingScene& scene) {
  const std::uint64_t cycles = scene.bench.ring().cycle_count();
  bool has_searched = false;
  scene.bench.run_until(
      [&] {
        has_searched = has_searched || scene.bench.status().state == MasterState::locating;
        return has_searched;
      },
      4 * (scene.bench.rules().silence_limit + scene.bench.rules().silence_tolerance));
  scene.judge.expect(!has_searched && scene.bench.ring().cycle_count() == cycles, "another_ring_is_searched",
                     "bus stop without locating, and no cycle any more",
                     has_searched ? "it locates a fault" : "cycles");
}

void exchange_while_stopped(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.set_script([](const interbus::RingEmulator::CycleInfo&, interbus::CycleFaults& faults) {
    faults.flips = {{0, 0x01, false}};
  });
  const unsigned most = bench.rules().stop_after_bad_cycles;
  for (unsigned n = 0; n < most + 2 && bench.is_in_run(); ++n) bench.run_cycle();
  bench.set_script({});
  Ring ring = twelve_with_branches();
  ring.at(scene.round).id_code ^= 0x0040;
  bench.ring().replace_ring(std::move(ring));
}

void expect_exchange_located(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.run_until([&] { return bench.status().has_fault_location; }, kernel::kSecond);
  const interbus::MasterStatus status = bench.status();
  const FaultLocation right{twelve_with_branches().at(scene.round).before, static_cast<int>(scene.round)};
  scene.judge.expect(status.has_fault_location && status.fault_location == right, "exchange_not_located",
                     fmt::format("fault between {} and {}", right.from, right.to),
                     status.has_fault_location ? fmt::format("between {} and {}", status.fault_location.from,
                                                             status.fault_location.to)
                                               : "no location");
}

MasterStep twelve_stations() {
  return in_run("twelve stations", twelve_alike());
}

}  // namespace

std::vector<MasterCase> master_cases_at_length() {
  const judge::Reference from_page = master_sequence_role().test_case.reference;
  return {
      compared("each_of_twelve_stations",
               "Each of twelve stations has messages, marks a cycle, becomes another one, is cut off, and is "
               "another one than expected.",
               {{"looks_at_eight_stations", "report_wrong"}}, each_beside(each_station_at_length, 60)),
      compared("20_bad_cycles_in_a_row", "19 bad cycles, and 20, where 20 stop the bus.",
               {{"counts_bad_cycles_in_4_bits", "state_missing"}},
               each_beside(many_bad_cycles, 1, stop_after_many)),
      compared("300_bad_cycles_in_a_row", "299 bad cycles, and 300, where 300 stop the bus.",
               {{"counts_bad_cycles_in_8_bits", "state_missing"}},
               each_beside(bad_cycles_beyond_an_octet, 1, stop_after_more_than_an_octet)),
      compared("cycle_times_beyond_4_s", "A cycle time of 4.4 s is requested.",
               {{"cycle_time_in_32_bits", "cycle_time_wrong"}},
               each_beside(cycle_times_of_seconds, 1, be_slow)),
      compared("words_beyond_256", "A ring of 320 words, of which the application writes single ones.",
               {{"writes_256_words", "cycle_wrong"}}, each_beside(words_beyond_an_octet, 1, take_wide_rings)),
      compared("id_cycles_asked_for_twice", "Two orders for an ID cycle before one begins.",
               {{"orders_of_id_cycles_add_up", "cycle_wrong"}}, each_beside(id_cycles_asked_for_twice, 2)),
      master_case("ring_change/another_ring_is_not_searched", "IM-30",
                  "A ring with another station stops the bus, and no fault is looked for", from_page,
                  {"must"}, {{"changed_ring_ignored", "changed_ring_not_reported"}},
                  {.steps = {twelve_stations(), data_cycles(2),
                             stimulus<RingScene>("a station is another one of the same length",
                                                 [](RingScene& scene) {
                                                   scene.bench.ring().replace_ring(with_another(scene.round));
                                                   scene.bench.request_id_cycle();
                                                 }),
                             cycles_up_to_the_bus_stop("changed_ring_not_reported"),
                             expected<RingScene>("bus stop, and no fault is looked for", expect_no_search)},
                   .walk = each("each station", kStationsAtLength)}),
      master_case(
          "ring_change/exchanged_station_is_located", "IM-17",
          "After a bus stop the first station that is another one is the place", from_page, {"must"},
          {{"fault_not_searched", "exchange_not_located"}, {"place_in_ring_order", "exchange_not_located"}},
          {.steps = {in_run("twelve stations with two branches", twelve_with_branches()), data_cycles(2),
                     stimulus<RingScene>("bad cycles stop the bus, and a station is exchanged meanwhile",
                                         exchange_while_stopped),
                     expected<RingScene>("the place is between what it hangs on and it",
                                         expect_exchange_located)},
           .walk = each("each station", kStationsAtLength)})};
}

}  // namespace fieldproof::conformance
