// Chapter supervision: status telegrams, counters, bus stop and stop command (IM-01, IM-18 to IM-20, IM-39).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/interbus/master_cases.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::CycleFaults;
using interbus::MasterState;
using interbus::SeenCycle;
using judge::Standing;
using CycleInfo = interbus::RingEmulator::CycleInfo;

// A bit of the first input word changed after the last station.
void spoil(CycleFaults& faults) {
  faults.flips = {{0, 0x01, false}};
}

void expect_no_silence(MasterBench& bench, CaseJudge& judge, std::string_view state) {
  const kernel::Duration longest =
      std::max(bench.ring().statistics().longest_silence, bench.ring().silence_until(bench.now()));
  judge.expect(longest <= bench.rules().silence_limit, "silence_too_long", [&] {
    return Mismatch{{fmt::format("never more than {} without a telegram in {}",
                                 kernel::describe(bench.rules().silence_limit), state)},
                    kernel::describe(longest)};
  });
}

// A master that gives up the bus may be silent until the stations are in reset; once it looks for the fault
// it is not. Whether it looks is another case's question.
void search_fills_pauses(MasterBench& bench, CaseJudge& judge) {
  const auto is_locating = [&bench] { return bench.status().state == MasterState::locating; };
  bench.ring().cut_after(1);
  if (!bench.run_until(is_locating, 2 * kernel::kSecond)) return;
  bench.ring().forget_statistics();
  bench.run_until([&] { return !is_locating(); }, kernel::kSecond);
  expect_no_silence(bench, judge, "locating");
}

void status_fills_pauses(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(paper_ring());
  bench.ring().cut_after(-1);
  bench.run_for(bench.volume(100, 1200) * kernel::kMillisecond);
  judge.expect(bench.ring().statistics().first_telegram <= kernel::kStart + kernel::kSecond,
               "no_sign_of_life", "status telegrams within 1 s", "none");
  expect_no_silence(bench, judge, "ready");
  bench.power_up(paper_ring());
  const bool is_running = bench.wait_for_run();
  expect_no_silence(bench, judge, "identification");
  judge.expect(is_running, "not_in_run", "the master recognises the ring and runs", "it does not");
  bench.configuration().cycle_time = 40 * kernel::kMillisecond;
  bench.bring_up(judge, paper_ring());
  bench.run_for(130 * kernel::kMillisecond);
  expect_no_silence(bench, judge, "run");
  judge.expect(bench.is_in_run(), "no_data_cycle", "the master runs with a long cycle time", "it does not");
  search_fills_pauses(bench, judge);
}

void quality_bit(MasterBench& bench, CaseJudge& judge) {
  auto& rules = bench.rules();
  // The case is about the ratio; a window of the printed length takes a million cycles.
  rules.quality_window_cycles = bench.volume(1'000U, rules.quality_window_cycles);
  rules.software_time = 10 * kernel::kMicrosecond;
  const unsigned limit = rules.quality_bad_cycles;
  const std::uint64_t spacing = rules.quality_window_cycles / (limit - 1) + 1;
  bench.bring_up(judge, interbus::line_of(1, 0x0103, 1));
  const std::uint64_t first = bench.ring().statistics().data_cycles + 1;
  bench.set_script([first, spacing](const CycleInfo& info, CycleFaults& faults) {
    if (!info.is_id_cycle && info.data_number >= first && (info.data_number - first) % spacing == 0)
      spoil(faults);
  });
  const std::uint64_t until = bench.finished().data_count + (limit - 1) * spacing + 2;
  while (bench.finished().data_count < until) {
    judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
  }
  auto status = bench.status();
  judge.expect_equal(status.rejected_data_cycles, limit, "counter_wrong", "rejected data cycles");
  judge.expect(!status.quality_bit, "quality_bit_early", "no quality bit with 19 bad cycles in the window",
               "it is set");
  // One more right away: now the window holds as many as the limit.
  bench.set_script({});
  CycleFaults faults;
  spoil(faults);
  bench.suffer(judge, std::move(faults));
  status = bench.status();
  judge.expect(status.quality_bit, "quality_bit_missing", "quality bit with 20 bad cycles in the window",
               "it is not set");
  judge.expect(status.state == MasterState::run, "stopped_without_cause", "the bus runs", "it has stopped");
}

void counters(MasterBench& bench, CaseJudge& judge) {
  bench.rules().software_time = 10 * kernel::kMicrosecond;
  bench.bring_up(judge, interbus::line_of(1, 0x0103, 1));
  std::uint64_t spoilt = 0;
  bench.set_script([&spoilt](const CycleInfo& info, CycleFaults& faults) {
    if (info.is_id_cycle || info.data_number % 2 != 0) return;
    spoil(faults);
    ++spoilt;
  });
  const std::uint64_t bad = bench.volume<std::uint64_t>(300, 70'000);
  while (spoilt < bad) judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
  bench.set_script({});
  bench.run_data_cycles(judge, 1);
  const auto status = bench.status();
  judge.expect_equal(status.rejected_data_cycles, spoilt, "counter_wrong", "rejected data cycles");
  judge.expect_equal(status.data_cycles, bench.ring().statistics().data_cycles, "counter_wrong",
                     "data cycles");
}

// Gives how many cycles end while all are spoilt, at most `count`.
unsigned spoil_in_a_row(MasterBench& bench, unsigned count) {
  bench.set_script([](const CycleInfo&, CycleFaults& faults) { spoil(faults); });
  unsigned cycles = 0;
  while (cycles < count && bench.is_in_run() && bench.run_cycle()) ++cycles;
  bench.set_script({});
  return cycles;
}

void consecutive_bad_cycles(MasterBench& bench, CaseJudge& judge) {
  const unsigned limit = bench.rules().stop_after_bad_cycles;
  bench.bring_up(judge, paper_ring());
  bench.run_data_cycles(judge, 2);
  spoil_in_a_row(bench, limit - 1);
  judge.expect(bench.is_in_run(), "stop_at_wrong_count", "9 bad cycles in a row do not stop the bus",
               "the bus has stopped");
  bench.run_data_cycles(judge, 2);
  judge.expect(bench.finished().is_accepted, "stop_at_wrong_count", "good cycles again", "none");
  spoil_in_a_row(bench, limit);
  judge.expect(!bench.is_in_run(), "stop_at_wrong_count", "10 bad cycles in a row stop the bus",
               "it runs on");
}

void alternating(MasterBench& bench, CaseJudge& judge) {
  bench.rules().software_time = 10 * kernel::kMicrosecond;
  bench.bring_up(judge, interbus::line_of(1, 0x0103, 1));
  const std::uint64_t rounds = bench.volume<std::uint64_t>(60, 100'000) / 2;
  const std::uint64_t before = bench.status().rejected_data_cycles;
  const std::uint64_t first = bench.ring().statistics().data_cycles;
  bench.set_script([first](const CycleInfo& info, CycleFaults& faults) {
    if (!info.is_id_cycle && (info.data_number - first) % 2 == 0) spoil(faults);
  });
  const std::uint64_t until = bench.finished().data_count + 2 * rounds;
  while (bench.finished().data_count < until && bench.run_cycle()) {
  }
  const auto status = bench.status();
  judge.expect(status.state == MasterState::run, "stopped_without_cause",
               "bad and good data cycles in turn never stop the bus", "it has stopped");
  const std::uint64_t counted = status.rejected_data_cycles - before;
  judge.expect(counted == rounds || counted + 1 == rounds, "counter_wrong", [&] {
    return Mismatch{{fmt::format("{} rejected data cycles", rounds)}, fmt::format("{}", counted)};
  });
}

// After a stop the line is silent or carries status telegrams without a gap, and no cycles.
void expect_quiet(MasterBench& bench, CaseJudge& judge) {
  const std::uint64_t cycles = bench.ring().cycle_count();
  bench.ring().forget_statistics();
  bench.run_for(50 * kernel::kMillisecond);
  const auto& seen = bench.ring().statistics();
  judge.expect_equal(bench.ring().cycle_count() - cycles, 0U, "not_silent", "cycles after the stop");
  const bool is_silent = seen.status_telegrams == 0;
  const bool is_filled =
      std::max(seen.longest_silence, bench.ring().silence_until(bench.now())) <= bench.rules().silence_limit;
  judge.expect((is_silent && bench.may_answer("line_after_stop", "silent")) ||
                   (is_filled && bench.may_answer("line_after_stop", "status_telegrams")),
               "not_silent", "as declared, silence or status telegrams without a gap after the stop",
               is_silent   ? "silence"
               : is_filled ? "status telegrams"
                           : "status telegrams with gaps");
}

void stop_command(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, paper_ring());
  bench.write_output(1, 0x5AA5);
  bench.run_data_cycles(judge, 2);
  judge.expect(bench.ring().output(1) == 0x5AA5, "outputs_not_sent", "the outputs of the application",
               "other outputs");
  bench.stop();
  bench.run_for(10 * kernel::kMillisecond);
  const SeenCycle& last = bench.ring().last_cycle();
  judge.expect(!last.is_id_cycle && bench.ring().output(1) == 0, "outputs_not_cleared",
               "a last data cycle with outputs 0", "the outputs stay");
  const std::uint64_t cycles = bench.ring().cycle_count();
  expect_quiet(bench, judge);
  bench.start();
  bench.run_until([&] { return bench.ring().cycle_count() > cycles; }, kernel::kSecond);
  judge.expect(bench.ring().has_cycle(cycles), "no_restart", "cycles after the start", "none");
  judge.expect(bench.ring().cycle(cycles).is_id_cycle, "restart_without_id_cycle", "an ID cycle first",
               "a data cycle first");
}

}  // namespace

std::vector<MasterCase> master_supervision_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus, std::string_view expected,
                            std::vector<std::string> tags, std::vector<MustCatch> catches, auto procedure) {
    TestCase test_case;
    test_case.id = fmt::format("interbus/master/supervision/{}", words);
    test_case.purpose = purpose;
    test_case.requirement = requirement;
    test_case.reference = std::move(reference);
    test_case.stimulus = stimulus;
    test_case.expected = expected;
    test_case.tags = std::move(tags);
    test_case.catches = std::move(catches);
    cases.push_back({std::move(test_case), procedure});
  };
  const judge::Reference quality{"literature from memory", "20 bad of a million data cycles",
                                 Standing::memory};
  add("status_telegrams_fill_every_pause", "IM-01",
      "Status telegrams fill every pause; only when it stops is a master silent for more than 25 ms",
      {"Phoenix Contact UK, operation and maintenance", "status telegrams", Standing::searched},
      "power up on an open ring; identification; run with a cycle time of 40 ms; the search after a cut "
      "cable",
      "telegrams within 1 s and never a silence above 25 ms", {"must", "timing"},
      {{"silent_in_long_pauses", "silence_too_long"},
       {"pauses_in_identification", "silence_too_long"},
       {"pauses_in_locating", "silence_too_long"}},
      status_fills_pauses);
  add("quality_bit_at_twenty_in_a_million", "IM-18",
      "The quality bit is set at 20 rejected data cycles among a million, not at 19", quality,
      "single bad cycles, such that the window holds 19; then one more",
      "no quality bit, then the quality bit; no bus stop", {"long"},
      {{"quality_window_too_short", "quality_bit_missing"}, {"quality_bit_early", "quality_bit_early"}},
      quality_bit);
  add("error_counters_are_exact", "IM-18", "Every rejected cycle is counted, once", quality,
      "every second data cycle spoilt", "the counters equal what was done on the line", {"long"},
      {{"counter_saturates", "counter_wrong"}}, counters);
  add("bus_stop_after_bad_cycles_in_a_row", "IM-19",
      "The bus stops after the declared number of bad cycles in a row, not before",
      {"this project", "10 bad cycles, parameter 3 to 100", Standing::own},
      "9 bad cycles in a row, good ones, 10 bad cycles in a row", "runs on; then stops", {},
      {{"stop_one_late", "stop_at_wrong_count"}}, consecutive_bad_cycles);
  add("bad_and_good_in_turn_never_stop", "IM-20", "A good data cycle clears the count of bad ones in a row",
      {"this project", "10 bad cycles in a row", Standing::own}, "bad and good data cycles in turn, 1e5",
      "no stop; half of them counted", {"long"}, {{"consecutive_never_cleared", "stopped_without_cause"}},
      alternating);
  add("stop_clears_outputs_and_restart_identifies", "IM-39",
      "A stop sets the outputs to 0, then the line is silent or carries status telegrams, as declared; a "
      "restart begins with an ID cycle",
      {"literature from memory", "stop and start", Standing::memory}, "stop, wait 60 ms, start",
      "outputs 0, no cycles, then an ID cycle first", {"must"},
      {{"stop_keeps_outputs", "outputs_not_cleared"},
       {"restart_without_id_cycle", "restart_without_id_cycle"}},
      stop_command);
  return cases;
}

}  // namespace fieldproof::conformance
