// Settings at the ends of their ranges, and rings with more stations than an octet counts (IM-03, IM-06,
// IM-27, IM-30, IM-34, IM-36, IM-39).
#include <fmt/format.h>

#include <array>
#include <bit>

#include "conformance/interbus/master_scene.hpp"
#include "conformance/interbus/master_sequence.hpp"

namespace fieldproof::conformance {
namespace {

using namespace master_chart;
using interbus::CycleFaults;
using interbus::MasterStatus;
using interbus::Rules;
using interbus::SeenCycle;

// ---- telegrams ----

constexpr std::array kLateGaps{6U, 9U, 12U};

void send_late_telegram(RingScene& scene, CycleFaults& faults) {
  faults.trailing_telegram = true;
  faults.trailing_gap_bits = kLateGaps.at(scene.round);
}

constexpr std::array kEndTelegrams{300U, 1'000U};
constexpr unsigned kTwelve = 12;

void run_with_end_telegrams(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.rules().end_telegrams = kEndTelegrams.at(scene.round);
  bench.bring_up(scene.judge, interbus::line_of(kTwelve, kOneWord, 1));
  for (unsigned word = 0; word < kTwelve; ++word) {
    bench.write_output(word, static_cast<std::uint16_t>(0x4001 + word));
    bench.ring().set_input(word, static_cast<std::uint16_t>(0x8100 + word));
  }
  bench.run_data_cycles(scene.judge, 3);
}

void expect_long_cycles(RingScene& scene) {
  MasterBench& bench = scene.bench;
  scene.judge.expect_equal(bench.ring().cycle(bench.ring().cycle_count() - 2).octets.size(),
                           6 + 2 * kTwelve + kEndTelegrams.at(scene.round), "telegram_count",
                           "telegrams of a data cycle");
  scene.judge.expect(bench.status().rejected_cycles == 0, "right_cycle_rejected", "no cycle is rejected",
                     fmt::format("{} are", bench.status().rejected_cycles));
  for (unsigned word = 0; word < kTwelve; ++word) {
    scene.judge.expect(bench.master().input(word) == 0x8100 + word, "new_inputs_missed",
                       fmt::format("input word {} is {:04X}h", word, 0x8100 + word),
                       fmt::format("{:04X}h", bench.master().input(word)));
    scene.judge.expect(bench.ring().output(word) == 0x4001 + word, "outputs_not_sent",
                       fmt::format("output word {} is {:04X}h", word, 0x4001 + word),
                       fmt::format("{:04X}h", bench.ring().output(word)));
  }
}

// ---- delays and times ----

constexpr std::size_t kDelayed = 3;

// Of the stations, then of the cable: there and back.
void run_with_delay(RingScene& scene) {
  MasterBench& bench = scene.bench;
  const Rules usual = bench.rules();
  kernel::Duration of_cable{};
  if (scene.round == 0) {
    bench.rules().forward_delay_half_bits = bench.rules().return_delay_half_bits = 1'000;
  } else {
    bench.rules().max_cable_m = 1'000'000;
    of_cable =
        kernel::Duration{2 * std::int64_t{bench.rules().max_cable_m} * bench.rules().cable_delay_ps_per_m};
  }
  bench.power_up(interbus::line_of(kDelayed, kNoWord, 0));
  bench.ring().set_extra_delay(of_cable);
  scene.judge.expect(bench.wait_for_run(), "late_return_not_awaited", "the master runs", "it does not");
  scene.judge.expect(bench.status().rejected_cycles == 0, "late_return_not_awaited",
                     "each cycle is waited for, and none is rejected",
                     fmt::format("{} are rejected", bench.status().rejected_cycles));
  expect_cycle_time_without_words(bench, scene.judge, kDelayed, of_cable, "cycle_time_off");
  bench.rules() = usual;
}

constexpr kernel::Duration kOddTime = 2'000'700 * kernel::kNanosecond;

void request_odd_time(MasterBench& bench) {
  bench.configuration().cycle_time = kOddTime;
}

// Over so many that what lacks of one adds up to several bits.
void expect_odd_time(MasterBench& bench, CaseJudge& judge) {
  constexpr std::uint64_t kCycles = 40;
  bench.run_data_cycles(judge, 1);
  const SeenCycle first = bench.ring().last_cycle();
  bench.run_data_cycles(judge, kCycles);
  const SeenCycle& last = bench.ring().last_cycle();
  const kernel::Duration right = static_cast<std::int64_t>(last.number - first.number) * kOddTime;
  const kernel::Duration bit = kernel::levels_duration(1, bench.rules().bit_rate);
  const kernel::Duration seen = last.start - first.start;
  judge.expect(right - bit <= seen && seen <= right + bit, "request_not_kept",
               fmt::format("{} cycles in {}, to a bit", last.number - first.number, kernel::describe(right)),
               kernel::describe(seen));
}

void be_silent_for_seconds(MasterBench& bench) {
  bench.rules().silence_limit = 5 * kernel::kSecond;
}

void stop_and_start(MasterBench& bench, CaseJudge& judge) {
  bench.stop();
  bench.run_for(10 * kernel::kMillisecond);
  bench.run_for(bench.said_ahead());
  const kernel::Duration least = bench.rules().silence_limit + bench.rules().silence_tolerance;
  const std::uint64_t cycles = bench.ring().cycle_count();
  bench.ring().forget_statistics();
  bench.start();
  bench.run_until([&] { return bench.ring().cycle_count() > cycles; }, 2 * least);
  judge.expect(bench.ring().cycle_count() > cycles, "no_restart", "cycles after the start", "none");
  const kernel::Duration seen = bench.ring().statistics().longest_silence;
  judge.expect(seen >= least, "silence_too_short",
               fmt::format("{} of silence before the ring is recognised", kernel::describe(least)),
               kernel::describe(seen));
}

// ---- the recognition ----

constexpr unsigned kCodeBits = 13;
constexpr unsigned kLengthCodesThere = 0x20;

void expect_code(RingScene& scene, std::uint16_t code) {
  Rules& rules = scene.bench.rules();
  // Each of one word: only the code tells two stations apart.
  rules.length_codes.clear();
  for (unsigned length = 0; length < kLengthCodesThere; ++length)
    rules.length_codes.push_back({static_cast<std::uint8_t>(length), 1});
  scene.bench.configuration().expected = {{code, 1, -1, false}};
  scene.bench.power_up(interbus::line_of(1, kOneWord, 1));
}

void expect_the_same(RingScene& scene) {
  expect_code(scene, kOneWord);
  scene.judge.expect(scene.bench.wait_for_run(), "not_in_run", "the master runs with what is expected",
                     "it does not");
}

void expect_another(RingScene& scene) {
  expect_code(scene, static_cast<std::uint16_t>(kOneWord ^ 1U << scene.round));
  const bool is_running = scene.bench.wait_for_run();
  scene.judge.expect(!is_running && !scene.bench.status().configuration_error.empty(), "id_code_not_compared",
                     fmt::format("a configuration error: {:04X}h is expected, {:04X}h is there",
                                 kOneWord ^ 1U << scene.round, kOneWord),
                     is_running ? "the master runs" : "no configuration error");
}

// Two couplers with a branch each.
Ring two_branches() {
  return {{0x0008, 0, -1, false}, {0x01BE, 1, 0, true}, {kOneWord, 1, 0, false},
          {0x0008, 0, 2, false},  {0x01BE, 1, 3, true}, {kOneWord, 1, 3, false}};
}

// An ID cycle has a word for each station that is known, that of the first one last, and in front of them one
// for the station that it may find. By station: the interfaces that are on.
std::vector<unsigned> switched_on(const SeenCycle& cycle, unsigned interfaces) {
  std::vector<unsigned> on;
  for (std::size_t octet = cycle.transfer_octets; octet > 2; octet -= 2)
    on.push_back(~unsigned{cycle.word(octet - 2).value_or(0)} & interfaces);
  return on;
}

constexpr std::array<std::array<std::uint16_t, 2>, 2> kOffBits{{{0x0001, 0x0200}, {0x0400, 0x0002}}};

void recognise_with_off_bits(RingScene& scene) {
  MasterBench& bench = scene.bench;
  bench.rules().control_remote_off = kOffBits.at(scene.round)[0];
  bench.rules().control_local_off = kOffBits.at(scene.round)[1];
  const unsigned interfaces = kOffBits.at(scene.round)[0] | kOffBits.at(scene.round)[1];
  std::vector<unsigned> before;
  int most = 0;
  bool is_unknown_off = true;
  bench.on_cycle([&] {
    const SeenCycle& cycle = bench.ring().last_cycle();
    if (!cycle.is_id_cycle) return;
    const std::vector<unsigned> on = switched_on(cycle, interfaces);
    if (on.empty()) return;
    is_unknown_off = is_unknown_off && on.back() == 0;
    before.resize(on.size());
    int count = 0;
    for (std::size_t n = 0; n < on.size(); ++n) count += std::popcount(on[n] & ~before[n]);
    most = std::max(most, count);
    before = on;
  });
  bench.power_up(two_branches());
  const bool is_running = bench.wait_for_run();
  bench.on_cycle(nullptr);
  scene.judge.expect(most <= 1, "several_interfaces_switched",
                     "an ID cycle of a recognition switches on one interface", fmt::format("{}", most));
  scene.judge.expect(is_unknown_off, "unknown_station_switched",
                     "the control word for a station that is not known has both interfaces off",
                     "one of them is on");
  scene.judge.expect(is_running, "not_in_run", "the master runs", "it does not");
}

constexpr std::size_t kStationsBeyondAnOctet = 260;

void expect_all_found(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, interbus::line_of(kStationsBeyondAnOctet, kNoWord, 0));
  const MasterStatus status = bench.status();
  judge.expect_equal(status.stations.size(), kStationsBeyondAnOctet, "configuration_differs",
                     "stations that are found");
  for (std::size_t n = 0; n < status.stations.size(); ++n) {
    const int before = static_cast<int>(n) - 1;
    judge.expect(status.stations[n].before == before, "configuration_differs",
                 fmt::format("station {} hangs on station {}", n, before),
                 fmt::format("on station {}", status.stations[n].before));
  }
}

}  // namespace

std::vector<MasterCase> master_cases_of_telegrams_at_ends() {
  const judge::Reference from_page = master_sequence_role().test_case.reference;
  return {
      master_case("rejection/late_telegram_too_many_is_rejected", "IM-34",
                  "A telegram that begins within 13 bits after the end of the last one is one too many",
                  from_page, {"must"}, {{"guards_6_bits", "extra_telegram_accepted"}},
                  {.steps = {rejected("one more telegram behind the last", "extra_telegram_accepted",
                                      send_late_telegram)},
                   .first = {in_run()},
                   .walk = each("gaps of 6, 9 and 12 bits", kLateGaps.size())}),
      master_case(
          "data_cycle/long_cycles_are_sent_and_received", "IM-06",
          "A cycle has as many end telegrams as are set, and is received however long it is", from_page,
          {"must"},
          {{"receives_1024_telegrams", "not_in_run"}, {"end_telegrams_in_8_bits", "telegram_count"}},
          {.steps = {stimulus<RingScene>("3 data cycles of twelve stations", run_with_end_telegrams),
                     expected<RingScene>("each has its telegrams, and is accepted", expect_long_cycles)},
           .walk = each("300 and 1000 end telegrams", kEndTelegrams.size())}),
      master_case("timing/longest_delays_are_awaited", "IM-36",
                  "A return is late by the delays of all stations and twice the longest cable, as set; that "
                  "is waited for from the first cycle on",
                  from_page, {"timing"},
                  {{"waits_for_usual_stations", "late_return_not_awaited"},
                   {"waits_for_usual_cable", "late_return_not_awaited"}},
                  {.steps = {{"power up with three stations",
                              "run without a rejected cycle, and its cycle time", run_with_delay}},
                   .walk = each("delays of 1000 bits a station, and 1000 km of cable", 2)}),
      master_case(
          "timing/cycle_time_with_a_part_of_a_microsecond", "IM-27",
          "The cycle time is the one requested, to less than a microsecond", from_page, {"timing"},
          {{"cycle_time_in_us", "request_not_kept"}},
          {.steps = {in_run(request_odd_time),
                     step("a request of 2000.7 us", "40 cycles take 40 times that", expect_odd_time)}}),
      master_case("supervision/silences_beyond_4_s", "IM-39",
                  "The silence of a start lasts as long as is set, also for seconds", from_page, {"timing"},
                  {{"silence_in_32_bits", "silence_too_short"}},
                  {.steps = {in_run(be_silent_for_seconds), step("stop and start with a silence of 5 s",
                                                                 "so long no telegram", stop_and_start)}})};
}

std::vector<MasterCase> master_cases_of_rings_at_ends() {
  const judge::Reference from_page = master_sequence_role().test_case.reference;
  return {master_case(
              "identification/expected_id_code_is_compared_whole", "IM-30",
              "A station whose ID code differs from the expected one in any bit is another one", from_page,
              {"must"}, {{"low_octet_and_length_compared", "id_code_not_compared"}},
              {.steps = {{"another code is expected", "a configuration error and no run", expect_another}},
               .first = {{"a station is expected that is there, and each length code means one word", "run",
                          expect_the_same}},
               .walk = each("each of the 13 bits of an ID code", kCodeBits)}),
          master_case(
              "identification/one_interface_is_switched_on_at_a_time", "IM-03",
              "An ID cycle of a recognition switches on one interface, and none of a station that is not "
              "known, by the bits that are set",
              from_page, {"must"}, {{"local_off_bit_kept", "unknown_station_switched"}},
              {.steps = {{"power up with two branches", "one interface in each ID cycle at most, then run",
                          recognise_with_off_bits}},
               .walk = each("two other codings of the bits that switch interfaces off", kOffBits.size())}),
          master_case("identification/configuration_of_260_stations", "IM-03",
                      "The place of each station is right where an octet does not count them", from_page, {},
                      {{"station_before_in_8_bits", "configuration_differs"}},
                      {.steps = {step("power up with 260 stations in a row", "each hangs on the one before",
                                      expect_all_found)}})};
}

}  // namespace fieldproof::conformance
