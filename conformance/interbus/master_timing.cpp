// Chapter timing: the cycle time and the telegrams of a cycle (IM-08, IM-09, IM-27, IM-36 to IM-38).
#include <fmt/format.h>

#include <array>
#include <utility>

#include "conformance/interbus/master_scene.hpp"
#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::SeenCycle;
using judge::Standing;

double in_us(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / static_cast<double>(kernel::kMicrosecond.count());
}

constexpr double kTolerance = 0.02;

// 13 bits with a factor of 1.15 for each telegram, 3 bits for each station. The source counts 8 + n telegrams
// in its formula and 6 + n in its text; a master is given one of the two readings and held against it.
double formula_us(double telegrams, double stations, double software_us) {
  return (1.15 * 13 * telegrams + 3 * stations) * 2 + software_us;
}

double measured_us(MasterBench& bench, CaseJudge& judge, std::uint64_t cycles) {
  bench.ring().forget_statistics();
  bench.run_data_cycles(judge, cycles + 1);
  return in_us(bench.ring().statistics().longest_cycle);
}

struct RingOfWords {
  std::size_t stations;
  unsigned words;
  std::uint8_t length_code;
  unsigned end_telegrams = 0;
};

// The first ones take 755.0 us and 814.8 us. After them 1, 4, 16 and 64 stations of one and of four words.
RingOfWords timed_ring(unsigned n) {
  constexpr std::array<RingOfWords, 4> kFirst{{{1, 2, 2}, {1, 2, 2, 2}, {12, 0, 0}, {2, 8, 6}}};
  if (n < kFirst.size()) return kFirst.at(n);
  const std::uint8_t words = n % 2 == 0 ? 1 : 4;
  return {std::size_t{1} << 2 * ((n - kFirst.size()) / 2), words, words};
}

void expect_cycle_time(RingScene& scene) {
  MasterBench& bench = scene.bench;
  const auto& [stations, words, code, end_telegrams] = timed_ring(scene.round);
  bench.rules().end_telegrams = end_telegrams;
  bench.bring_up(scene.judge, interbus::line_of(stations, static_cast<std::uint16_t>(code << 8 | 3), words));
  const double octets = 2.0 * words * static_cast<double>(stations);
  const double formula = formula_us(6 + octets + end_telegrams, static_cast<double>(stations), 450);
  scene.judge.expect_between(fmt::format("cycle time, n = {}, m = {}", octets, stations), "us",
                             measured_us(bench, scene.judge, 4), formula * (1 - kTolerance),
                             formula * (1 + kTolerance), "cycle_time_off");
}

void expect_no_jitter(MasterBench& bench, CaseJudge& judge) {
  bench.ring().forget_statistics();
  bench.run_data_cycles(judge, bench.volume<std::uint64_t>(20, 100'000));
  const auto& seen = bench.ring().statistics();
  judge.expect_between("cycle jitter, peak to peak", "us", in_us(seen.longest_cycle - seen.shortest_cycle), 0,
                       0.01 * in_us(seen.longest_cycle), "jitter");
}

constexpr std::string_view kRequestBelowMinimum = "request_below_minimum";

void request_too_short(MasterBench& bench, CaseJudge& judge) {
  bench.configuration().cycle_time = 400 * kernel::kMicrosecond;
  const double shortest = formula_us(10, 1, 450);
  bench.power_up(interbus::line_of(1, 0x0203, 2));
  if (bench.wait_for_run()) {
    judge.expect_between("cycle time with a request of 400 us", "us", measured_us(bench, judge, 4),
                         shortest * (1 - kTolerance), shortest * (1 + kTolerance), "cycle_below_minimum");
    judge.expect(bench.may_answer(kRequestBelowMinimum, "clipped"), "request_not_refused",
                 "as declared, the request is refused", "it is clipped");
  } else {
    judge.expect(!bench.status().configuration_error.empty(), "request_not_answered",
                 "the request is clipped, or refused with a configuration error", "neither");
    judge.expect(bench.may_answer(kRequestBelowMinimum, "refused"), "request_not_clipped",
                 "as declared, the request is clipped", "it is refused");
  }
}

void request_possible(MasterBench& bench, CaseJudge& judge) {
  bench.configuration().cycle_time = kernel::kMillisecond;
  bench.bring_up(judge, interbus::line_of(1, 0x0203, 2));
  judge.expect_between("cycle time with a request of 1 ms", "us", measured_us(bench, judge, 4),
                       1000 * (1 - kTolerance), 1000 * (1 + kTolerance), "request_not_kept");
}

void long_ring(MasterBench& bench, CaseJudge& judge) {
  const std::size_t stations = bench.volume<std::size_t>(6, 512);
  const double cable_us = 128;
  bench.power_up(interbus::line_of(stations, 0x0003, 0));
  bench.ring().set_extra_delay(128 * kernel::kMicrosecond);
  judge.expect(bench.wait_for_run(), "long_ring_not_in_run", "the master runs with the longest ring",
               "it does not");
  const double formula = formula_us(6, static_cast<double>(stations), 450) + cable_us;
  judge.expect_between("cycle time with the ring delay", "us", measured_us(bench, judge, 4), formula * 0.98,
                       formula * 1.02, "cycle_time_off");
  judge.expect(bench.status().rejected_data_cycles == 0, "long_ring_rejected", "no cycle rejected",
               "cycles are rejected");
}

void receive_rate(RingScene& scene) {
  MasterBench& bench = scene.bench;
  const int per_mille = scene.round == 0 ? -10 : 10;
  bench.ring().set_rate_error(per_mille);
  const std::uint64_t before = bench.status().rejected_cycles;
  for (std::uint64_t n = bench.volume<std::uint64_t>(5, 500); n > 0; --n) {
    bench.ring().set_input(0, static_cast<std::uint16_t>(bench.random().next()));
    expect_next_cycle(bench, scene.judge);
  }
  scene.judge.expect(bench.status().rejected_cycles == before, "clock_tolerance",
                     fmt::format("a return line at {:+} per mille is received", per_mille),
                     "cycles are rejected");
}

void expect_pitch(MasterBench& bench, CaseJudge& judge) {
  bench.run_data_cycles(judge, 1);  // the one before may just have begun
  const SeenCycle& seen = bench.ring().last_cycle();
  const kernel::Duration bit = kernel::levels_duration(1, bench.rules().bit_rate);
  const kernel::Duration last_start = seen.end - seen.start - line::kDataTelegramLevels * bit;
  const double pitch =
      static_cast<double>(last_start.count()) /
      static_cast<double>(bit.count() *
                          static_cast<std::int64_t>(seen.transfer_octets + interbus::kTrailerOctets - 1));
  judge.expect_between("mean pitch of telegrams", "bit", pitch, 13 * 1.15 * 0.95, 13 * 1.15 * 1.05,
                       "pitch_off");
  judge.expect(bench.ring().statistics().longest_silence < bench.rules().silence_limit, "silence_too_long",
               "no silence above 25 ms", "a longer one");
}

MasterStep run_on_64_octets() {
  return in_run("a ring with 64 user octets", interbus::line_of(4, 0x0603, 8));
}

std::vector<MasterCase> cases_of_the_cycle_time() {
  // The factor of 1.15 is printed with 8 + n telegrams; with 6 + n it is not.
  const judge::Reference formula{"Park 2004, section 2.2; Phoenix Contact manuals from memory",
                                 "cycle-time formula; 6 + n telegrams in it", Standing::memory};
  return {
      master_case(
          "timing/cycle_time_equals_the_formula", "IM-08",
          "The cycle time is that of the formula, with the count of telegrams that is selected", formula,
          {"must", "timing"}, {{"cycle_time_without_ring_delay", "cycle_time_off"}},
          {.steps = {{"data cycles", "755.0 us, 814.8 us and the others within 2 %", expect_cycle_time}},
           .walk = {"rings of several lengths, with 6 + n and with 8 + n telegrams",
                    [](RingScene& scene) { return scene.bench.volume<std::size_t>(4, 12); }}}),
      master_case(
          "timing/request_below_the_minimum_is_clipped", "IM-27",
          "A requested cycle time below the shortest possible is not taken: clipped or refused, as declared",
          {"Park 2004, section 3", "the tool accepts only values above the minimum", Standing::seed},
          {"timing"}, {{"request_taken_as_it_is", "cycle_below_minimum"}},
          {.steps = {step("a request of 400 us where 755 us are needed", "755 us or a configuration error",
                          request_too_short),
                     step("a request of 1 ms", "1 ms", request_possible)}}),
      master_case("timing/longest_ring_works", "IM-36",
                  "The delay of the longest ring is waited for, and is part of the cycle time", formula,
                  {"timing", "long"},
                  {{"cycle_time_without_ring_delay", "cycle_time_off"},
                   {"first_cycles_rejected", "long_ring_rejected"}},
                  {.steps = {step("512 stations with 3 bit each and 128 us of cable",
                                  "no cycle rejected; cycle time by the formula", long_ring)}})};
}

}  // namespace

std::vector<MasterCase> master_timing_cases() {
  std::vector<MasterCase> cases = cases_of_the_cycle_time();
  cases.push_back(master_case(
      "timing/cycles_start_without_jitter", "IM-09", "Cycles start at equal distances",
      {"this project", "at most 1 % of the cycle time", Standing::own}, {"timing", "long"},
      {{"cycle_start_wanders", "jitter"}},
      {.steps = {in_run(), step("100 000 data cycles", "peak-to-peak jitter at most 1 % of the cycle time",
                                expect_no_jitter)}}));
  cases.push_back(master_case(
      "timing/return_clock_within_one_percent_is_received", "IM-37",
      "Stations with their own clocks are received", {"this project", "+-1 %", Standing::own}, {"timing"},
      {{"no_clock_tolerance", "clock_tolerance"}},
      {.steps = {run_on_64_octets(),
                 {"500 cycles from a return line of that clock", "no cycle rejected", receive_rate}},
       .walk = each("1 % slower and 1 % faster", 2)}));
  cases.push_back(
      master_case("timing/telegrams_have_their_gap", "IM-38",
                  "The mean pitch of the telegrams of a cycle is 1.15 times 13 bit",
                  {"this project; Park 2004, section 2.2",
                   "a gap after each telegram, for the factor of 1.15", Standing::own},
                  {"timing"}, {{"telegrams_without_gap", "pitch_off"}},
                  {.steps = {run_on_64_octets(),
                             step("a data cycle", "a mean pitch of 14.95 bit within 5 %", expect_pitch)}}));
  cases.push_back(master_case(
      "timing/transmissions_do_not_overlap", "monitor",
      "A master begins a transmission when the one before it has left; the monitor of its line judges every "
      "other case too",
      {"follows from Park 2004", "one telegram after the other on a segment", Standing::derived},
      {"must", "timing"}, {{"drives_over_itself", "transmissions_overlap"}},
      {.steps = {in_run(), step("1000 data cycles", "the monitor of the master's line sees no overlap",
                                [](MasterBench& bench, CaseJudge& judge) {
                                  bench.run_data_cycles(judge, bench.volume<std::uint64_t>(10, 1000));
                                })}}));
  return cases;
}

}  // namespace fieldproof::conformance
