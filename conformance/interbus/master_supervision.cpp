// Chapter supervision: status telegrams, counters, bus stop and stop command (IM-01, IM-18 to IM-20, IM-39).
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::CycleFaults;
using interbus::MasterState;
using judge::Standing;
using CycleInfo = interbus::RingEmulator::CycleInfo;

void expect_no_silence(MasterBench& bench, CaseJudge& judge, std::string_view state) {
  const kernel::Duration limit = bench.rules().silence_limit;
  const kernel::Duration longest =
      std::max(bench.ring().statistics().longest_silence, bench.ring().silence_until(bench.now()));
  judge.expect(longest <= limit, "silence_too_long",
               fmt::format("never more than {} without a telegram in {}", kernel::describe(limit), state),
               kernel::describe(longest));
}

void wait_on_open_ring(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(paper_ring());
  bench.ring().cut_after(-1);
  bench.run_for(bench.volume(100, 1200) * kernel::kMillisecond);
  judge.expect(bench.ring().statistics().first_telegram <= kernel::kStart + kernel::kSecond,
               "no_sign_of_life", "status telegrams within 1 s", "none");
  expect_no_silence(bench, judge, "ready");
}

void identify_ring(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(paper_ring());
  const bool is_running = bench.wait_for_run();
  expect_no_silence(bench, judge, "identification");
  judge.expect(is_running, "not_in_run", "the master recognises the ring and runs", "it does not");
}

void run_with_long_cycles(MasterBench& bench, CaseJudge& judge) {
  bench.run_for(130 * kernel::kMillisecond);
  expect_no_silence(bench, judge, "run");
  judge.expect(bench.is_in_run(), "no_data_cycle", "the master runs with a long cycle time", "it does not");
}

// A master that gives up the bus may be silent until the stations are in reset; once it looks for the fault
// it is not. Whether it looks is another case's question.
void search_fills_pauses(MasterBench& bench, CaseJudge& judge) {
  const auto is_locating = [&bench] { return bench.status().state == MasterState::locating; };
  bench.ring().cut_after(1);
  if (!bench.run_until(is_locating, 2 * kernel::kSecond)) return;
  // The silence before its first telegram belongs to the bus stop, which ends with it.
  const auto cycles = bench.ring().cycle_count();
  bench.run_until([&] { return bench.ring().cycle_count() > cycles || !is_locating(); }, kernel::kSecond);
  bench.ring().forget_statistics();
  bench.run_until([&] { return !is_locating(); }, kernel::kSecond);
  expect_no_silence(bench, judge, "locating");
}

void request_long_cycles(MasterBench& bench) {
  bench.configuration().cycle_time = 40 * kernel::kMillisecond;
}

MasterChart pauses_chart() {
  const std::string filled = "never a silence above 25 ms";
  return {
      .steps = {step("power up on an open ring", "telegrams within 1 s, " + filled, wait_on_open_ring),
                step("power up on a closed ring", filled, identify_ring), in_run(request_long_cycles),
                step("130 ms with a cycle time of 40 ms", filled, run_with_long_cycles),
                step("a cut cable", "as long as the master looks for it, " + filled, search_fills_pauses)}};
}

MasterStep fast_ring(Prepare prepare = nullptr) {
  return in_run(
      "one station, with a software time of 10 us", interbus::line_of(1, kOneWord, 1),
      prepare != nullptr ? prepare : [](MasterBench& bench) {
        bench.rules().software_time = 10 * kernel::kMicrosecond;
      });
}

// The n-th data cycle from now on is spoilt when n is a multiple; `spoilt` counts them.
void spoil_every(MasterBench& bench, std::uint64_t multiple, std::uint64_t& spoilt) {
  const std::uint64_t first = bench.ring().statistics().data_cycles + 1;
  bench.set_script([first, multiple, &spoilt](const CycleInfo& info, CycleFaults& faults) {
    if (info.is_id_cycle || info.data_number < first || (info.data_number - first) % multiple != 0) return;
    spoil(faults);
    ++spoilt;
  });
}

// The case is about the ratio; a window of the printed length takes a million cycles.
void shorten_window(MasterBench& bench) {
  bench.rules().quality_window_cycles = bench.volume(1'000U, bench.rules().quality_window_cycles);
  bench.rules().software_time = 10 * kernel::kMicrosecond;
}

void spoil_below_limit(MasterBench& bench, CaseJudge& judge) {
  const unsigned limit = bench.rules().quality_bad_cycles;
  const std::uint64_t spacing = bench.rules().quality_window_cycles / (limit - 1) + 1;
  std::uint64_t spoilt = 0;
  spoil_every(bench, spacing, spoilt);
  const std::uint64_t until = bench.finished().data_count + (limit - 1) * spacing + 2;
  while (bench.finished().data_count < until) expect_next_cycle(bench, judge);
  bench.set_script({});
  judge.expect_equal(bench.status().rejected_data_cycles, limit, "counter_wrong", "rejected data cycles");
  judge.expect(!bench.status().quality_bit, "quality_bit_early",
               "no quality bit with 19 bad cycles in the window", "it is set");
}

// Right away: now the window holds as many as the limit.
void spoil_one_more(MasterBench& bench, CaseJudge& judge) {
  CycleFaults faults;
  spoil(faults);
  bench.suffer(judge, std::move(faults));
  const auto status = bench.status();
  judge.expect(status.quality_bit, "quality_bit_missing", "quality bit with 20 bad cycles in the window",
               "it is not set");
  judge.expect(status.state == MasterState::run, "stopped_without_cause", "the bus runs", "it has stopped");
}

void count_spoilt(MasterBench& bench, CaseJudge& judge) {
  std::uint64_t spoilt = 0;
  spoil_every(bench, 2, spoilt);
  while (spoilt < bench.volume<std::uint64_t>(300, 70'000)) expect_next_cycle(bench, judge);
  bench.set_script({});
  bench.run_data_cycles(judge, 1);
  const auto status = bench.status();
  judge.expect_equal(status.rejected_data_cycles, spoilt, "counter_wrong", "rejected data cycles");
  judge.expect_equal(status.data_cycles, bench.ring().statistics().data_cycles, "counter_wrong",
                     "data cycles");
}

void spoil_in_turn(MasterBench& bench, CaseJudge& judge) {
  const std::uint64_t rounds = bench.volume<std::uint64_t>(60, 100'000) / 2;
  const std::uint64_t before = bench.status().rejected_data_cycles;
  std::uint64_t spoilt = 0;
  spoil_every(bench, 2, spoilt);
  const std::uint64_t until = bench.finished().data_count + 2 * rounds;
  while (bench.finished().data_count < until && bench.run_cycle()) {
  }
  bench.set_script({});
  const auto status = bench.status();
  judge.expect(status.state == MasterState::run, "stopped_without_cause",
               "bad and good data cycles in turn never stop the bus", "it has stopped");
  const std::uint64_t counted = status.rejected_data_cycles - before;
  judge.expect(counted == rounds || counted + 1 == rounds, "counter_wrong",
               fmt::format("{} rejected data cycles", rounds), fmt::format("{}", counted));
}

// So many fewer than stop the bus; all are spoilt.
MasterStep bad_cycles(unsigned fewer, std::string text, std::string outcome, bool runs_on) {
  return {text, outcome, [=](RingScene& scene) {
            MasterBench& bench = scene.bench;
            bench.set_script([](const CycleInfo&, CycleFaults& faults) { spoil(faults); });
            for (unsigned n = bench.rules().stop_after_bad_cycles - fewer; n > 0 && bench.is_in_run(); --n) {
              if (!bench.run_cycle()) break;
            }
            bench.set_script({});
            scene.judge.expect(bench.is_in_run() == runs_on, "stop_at_wrong_count", text + ": " + outcome,
                               runs_on ? "the bus has stopped" : "it runs on");
          }};
}

void good_again(MasterBench& bench, CaseJudge& judge) {
  bench.run_data_cycles(judge, 2);
  judge.expect(bench.finished().is_accepted, "stop_at_wrong_count", "good cycles again", "none");
}

// ---- stop command ----

void set_outputs(MasterBench& bench, CaseJudge& judge) {
  bench.write_output(1, 0x5AA5);
  bench.run_data_cycles(judge, 2);
  judge.expect(bench.ring().output(1) == 0x5AA5, "outputs_not_sent", "the outputs of the application",
               "other outputs");
}

void stop(MasterBench& bench, CaseJudge& judge) {
  bench.stop();
  bench.run_for(10 * kernel::kMillisecond);
  bench.run_for(bench.said_ahead());
  judge.expect(!bench.ring().last_cycle().is_id_cycle && bench.ring().output(1) == 0, "outputs_not_cleared",
               "a last data cycle with outputs 0", "the outputs stay");
}

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

void restart(MasterBench& bench, CaseJudge& judge) {
  const std::uint64_t cycles = bench.ring().cycle_count();
  bench.start();
  bench.run_until([&] { return bench.ring().cycle_count() > cycles; }, kernel::kSecond);
  judge.expect(bench.ring().has_cycle(cycles), "no_restart", "cycles after the start", "none");
  judge.expect(bench.ring().cycle(cycles).is_id_cycle, "restart_without_id_cycle", "an ID cycle first",
               "a data cycle first");
}

}  // namespace

std::vector<MasterCase> master_supervision_cases() {
  const judge::Reference quality{"literature from memory", "20 bad of a million data cycles",
                                 Standing::memory};
  return {
      master_case(
          "supervision/status_telegrams_fill_every_pause", "IM-01",
          "Status telegrams fill every pause; only when it stops is a master silent for more than 25 ms",
          {"Phoenix Contact UK, operation and maintenance", "status telegrams", Standing::searched},
          {"must", "timing"},
          {{"silent_in_long_pauses", "silence_too_long"},
           {"pauses_in_identification", "silence_too_long"},
           {"pauses_in_locating", "silence_too_long"}},
          pauses_chart()),
      master_case(
          "supervision/quality_bit_at_twenty_in_a_million", "IM-18",
          "The quality bit is set at 20 rejected data cycles among a million, not at 19", quality, {"long"},
          {{"quality_window_too_short", "quality_bit_missing"}, {"quality_bit_early", "quality_bit_early"}},
          {.steps = {fast_ring(shorten_window),
                     step("single bad cycles, such that the window of a million holds 19", "no quality bit",
                          spoil_below_limit),
                     step("one more", "the quality bit; the bus runs on", spoil_one_more)}}),
      master_case(
          "supervision/error_counters_are_exact", "IM-18", "Every rejected cycle is counted, once", quality,
          {"long"}, {{"counter_saturates", "counter_wrong"}},
          {.steps = {fast_ring(), step("every second data cycle spoilt, 70 000 of them",
                                       "the counters equal what was done on the line", count_spoilt)}}),
      master_case("supervision/bus_stop_after_bad_cycles_in_a_row", "IM-19",
                  "The bus stops after the declared number of bad cycles in a row, not before",
                  {"this project", "10 bad cycles, parameter 3 to 100", Standing::own}, {},
                  {{"stop_one_late", "stop_at_wrong_count"}},
                  {.steps = {in_run(), data_cycles(2),
                             bad_cycles(1, "9 bad cycles in a row", "the bus runs on", true),
                             step("2 good data cycles", "they are accepted", good_again),
                             bad_cycles(0, "10 bad cycles in a row", "the bus stops", false)}}),
      master_case("supervision/bad_and_good_in_turn_never_stop", "IM-20",
                  "A good data cycle clears the count of bad ones in a row",
                  {"this project", "10 bad cycles in a row", Standing::own}, {"long"},
                  {{"consecutive_never_cleared", "stopped_without_cause"}},
                  {.steps = {fast_ring(), step("bad and good data cycles in turn, 100 000",
                                               "no stop; half of them counted", spoil_in_turn)}}),
      master_case(
          "supervision/stop_clears_outputs_and_restart_identifies", "IM-39",
          "A stop sets the outputs to 0, then the line is silent or carries status telegrams, as declared; a "
          "restart begins with an ID cycle",
          {"literature from memory", "stop and start", Standing::memory}, {"must"},
          {{"stop_keeps_outputs", "outputs_not_cleared"},
           {"restart_without_id_cycle", "restart_without_id_cycle"}},
          {.steps = {in_run(), step("the application writes an output", "it is sent", set_outputs),
                     step("stop", "a last data cycle with outputs 0", stop),
                     step("60 ms", "no cycles; silence or status telegrams without a gap, as declared",
                          expect_quiet),
                     step("start", "cycles again, an ID cycle first", restart)}})};
}

}  // namespace fieldproof::conformance
