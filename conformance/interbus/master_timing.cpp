// Chapter timing: the cycle time and the telegrams of a cycle (IM-08, IM-09, IM-27, IM-36 to IM-38).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/master_cases.hpp"
#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::conformance {

namespace {

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

void expect_cycle_time(MasterBench& bench, CaseJudge& judge, std::size_t stations, unsigned words,
                       std::uint8_t code) {
  bench.bring_up(judge, interbus::line_of(stations, static_cast<std::uint16_t>(code << 8 | 3), words));
  const double octets = 2.0 * words * static_cast<double>(stations);
  const double formula =
      formula_us(6 + octets + bench.rules().end_telegrams, static_cast<double>(stations), 450);
  judge.expect_between(fmt::format("cycle time, n = {}, m = {}", octets, stations), "us",
                       measured_us(bench, judge, 4), formula * (1 - kTolerance), formula * (1 + kTolerance),
                       "cycle_time_off");
}

void cycle_time(MasterBench& bench, CaseJudge& judge) {
  expect_cycle_time(bench, judge, 1, 2, 0x02);  // 755.0 us
  bench.rules().end_telegrams = 2;
  expect_cycle_time(bench, judge, 1, 2, 0x02);  // 814.8 us
  bench.rules().end_telegrams = 0;
  expect_cycle_time(bench, judge, 12, 0, 0x00);
  expect_cycle_time(bench, judge, 2, 8, 0x06);
  if (bench.volume(0, 1) == 0) return;
  for (const std::size_t stations : {1U, 4U, 16U, 64U}) {
    expect_cycle_time(bench, judge, stations, 1, 0x01);
    expect_cycle_time(bench, judge, stations, 4, 0x04);
  }
}

void jitter(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  bench.ring().forget_statistics();
  bench.run_data_cycles(judge, bench.volume<std::uint64_t>(20, 100'000));
  const auto& seen = bench.ring().statistics();
  judge.expect_between("cycle jitter, peak to peak", "us", in_us(seen.longest_cycle - seen.shortest_cycle), 0,
                       0.01 * in_us(seen.longest_cycle), "jitter");
}

constexpr std::string_view kBelowMinimum = "request_below_minimum";

void requested_time(MasterBench& bench, CaseJudge& judge) {
  bench.configuration().cycle_time = 400 * kernel::kMicrosecond;
  const double shortest = formula_us(10, 1, 450);
  bench.power_up(interbus::line_of(1, 0x0203, 2));
  judge.use_decode([&bench] { return bench.ring().describe_last(6); });
  if (bench.wait_for_run()) {
    judge.expect_between("cycle time with a request of 400 us", "us", measured_us(bench, judge, 4),
                         shortest * (1 - kTolerance), shortest * (1 + kTolerance), "cycle_below_minimum");
    judge.expect(bench.may_answer(kBelowMinimum, "clipped"), "request_not_refused",
                 "as declared, the request is refused", "it is clipped");
  } else {
    judge.expect(!bench.status().configuration_error.empty(), "request_not_answered",
                 "the request is clipped, or refused with a configuration error", "neither");
    judge.expect(bench.may_answer(kBelowMinimum, "refused"), "request_not_clipped",
                 "as declared, the request is clipped", "it is refused");
  }
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
  judge.use_decode([&bench] { return bench.ring().describe_last(6); });
  judge.expect(bench.wait_for_run(), "long_ring_not_in_run", "the master runs with the longest ring",
               "it does not");
  const double formula = formula_us(6, static_cast<double>(stations), 450) + cable_us;
  judge.expect_between("cycle time with the ring delay", "us", measured_us(bench, judge, 4), formula * 0.98,
                       formula * 1.02, "cycle_time_off");
  judge.expect(bench.status().rejected_data_cycles == 0, "long_ring_rejected", "no cycle rejected",
               "cycles are rejected");
}

void clock_tolerance(MasterBench& bench, CaseJudge& judge) {
  for (const int per_mille : {-10, 10}) {
    bench.bring_up(judge, interbus::line_of(4, 0x0603, 8));
    bench.ring().set_rate_error(per_mille);
    const std::uint64_t before = bench.status().rejected_cycles;
    for (std::uint64_t n = bench.volume<std::uint64_t>(5, 500); n > 0; --n) {
      bench.ring().set_input(0, static_cast<std::uint16_t>(bench.random().next()));
      judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
    }
    judge.expect(bench.status().rejected_cycles == before, "clock_tolerance", [&] {
      return Mismatch{{fmt::format("a return line at {:+} per mille is received", per_mille)},
                      "cycles are rejected"};
    });
  }
}

void telegram_pitch(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, interbus::line_of(4, 0x0603, 8));
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

// What is judged is the monitor of the bench.
void transmissions_do_not_overlap(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  bench.run_data_cycles(judge, bench.volume<std::uint64_t>(10, 1000));
}

}  // namespace

std::vector<MasterCase> master_timing_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus, std::string_view expected,
                            std::vector<std::string> tags, std::vector<MustCatch> catches, auto procedure) {
    TestCase test_case;
    test_case.id = fmt::format("interbus/master/timing/{}", words);
    test_case.purpose = purpose;
    test_case.requirement = requirement;
    test_case.reference = std::move(reference);
    test_case.stimulus = stimulus;
    test_case.expected = expected;
    test_case.tags = std::move(tags);
    test_case.catches = std::move(catches);
    cases.push_back({std::move(test_case), procedure});
  };
  // The factor of 1.15 is printed with 8 + n telegrams; with 6 + n it is not.
  const judge::Reference formula{"Park 2004, section 2.2; Phoenix Contact manuals from memory",
                                 "cycle-time formula; 6 + n telegrams in it", Standing::memory};
  add("cycle_time_equals_the_formula", "IM-08",
      "The cycle time is that of the formula, with the count of telegrams that is selected", formula,
      "rings of several lengths, with 6 + n and with 8 + n telegrams",
      "755.0 us, 814.8 us and the others within 2 %", {"must", "timing"},
      {{"cycle_time_without_ring_delay", "cycle_time_off"}}, cycle_time);
  add("cycles_start_without_jitter", "IM-09", "Cycles start at equal distances",
      {"this project", "at most 1 % of the cycle time", Standing::own}, "1e5 data cycles without errors",
      "peak-to-peak jitter at most 1 % of the cycle time", {"timing", "long"},
      {{"cycle_start_wanders", "jitter"}}, jitter);
  add("request_below_the_minimum_is_clipped", "IM-27",
      "A requested cycle time below the shortest possible is not taken: clipped or refused, as declared",
      {"Park 2004, section 3", "the tool accepts only values above the minimum", Standing::seed},
      "requests of 400 us and 1 ms where 755 us are needed", "755 us or a configuration error; 1 ms",
      {"timing"}, {{"request_taken_as_it_is", "cycle_below_minimum"}}, requested_time);
  add("longest_ring_works", "IM-36",
      "The delay of the longest ring is waited for, and is part of the cycle time", formula,
      "512 stations with 3 bit each and 128 us of cable", "no cycle rejected; cycle time by the formula",
      {"timing", "long"},
      {{"cycle_time_without_ring_delay", "cycle_time_off"}, {"first_cycles_rejected", "long_ring_rejected"}},
      long_ring);
  add("return_clock_within_one_percent_is_received", "IM-37", "Stations with their own clocks are received",
      {"this project", "+-1 %", Standing::own}, "a return line 1 % slower and 1 % faster",
      "no cycle rejected", {"timing"}, {{"no_clock_tolerance", "clock_tolerance"}}, clock_tolerance);
  add("telegrams_have_their_gap", "IM-38", "The mean pitch of the telegrams of a cycle is 1.15 times 13 bit",
      {"this project; Park 2004, section 2.2", "a gap after each telegram, for the factor of 1.15",
       Standing::own},
      "a data cycle with 64 user octets", "14.95 bit within 5 %", {"timing"},
      {{"telegrams_without_gap", "pitch_off"}}, telegram_pitch);
  add("transmissions_do_not_overlap", "monitor",
      "A master begins a transmission when the one before it has left",
      {"follows from Park 2004", "one telegram after the other on a segment", Standing::derived},
      "recognition, then data cycles",
      "the monitor of the master's line sees no overlap; it judges every other case too", {"must", "timing"},
      {{"drives_over_itself", "transmissions_overlap"}}, transmissions_do_not_overlap);
  return cases;
}

}  // namespace fieldproof::conformance
