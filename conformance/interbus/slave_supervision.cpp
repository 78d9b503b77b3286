#include <fmt/format.h>

#include "conformance/interbus/slave_scene.hpp"

// IS-27 to IS-29 and IS-48 to IS-50: silence on the line.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

kernel::Duration earliest_reset(const interbus::Rules& rules) {
  return rules.silence_limit - rules.silence_tolerance;
}
kernel::Duration latest_reset(const interbus::Rules& rules) {
  return rules.silence_limit + rules.silence_tolerance;
}

// Random, and with each of them at least these bits.
std::vector<std::uint16_t> words_with(SlaveBench& bench, std::uint16_t bits) {
  std::vector<std::uint16_t> words = bench.random_words();
  for (std::uint16_t& word : words) word |= bits;
  return words;
}

void send_signs_of_life(SlaveScene& scene, std::span<const std::uint16_t> after) {
  SlaveBench& bench = scene.bench;
  scene.words = words_with(bench, 0x8001);
  bench.data_cycle(scene.words, after);
  expect_outputs(bench, scene.judge, scene.words, "valid_cycle_rejected");
  if (!after.empty()) {
    scene.judge.expect(bench.remote().data_telegrams().size() == bench.in().data_telegrams().size(),
                       "interface_not_opened", "the data cycle goes out on OUT1", "it did not go out whole");
  }
  bench.status_telegrams(3);
  bench.terminals().forget_changes();
  const auto arrived = bench.in().telegrams();
  scene.last = arrived.empty() ? bench.now() : bench.in().end_of(arrived.back());
}

SlaveStep alive() {
  return {"a valid data cycle without a word of 0, three status telegrams", "its words are at the outputs",
          [](SlaveScene& scene) { send_signs_of_life(scene, {}); }};
}

SlaveStep alive_with_out1() {
  return {
      "an ID cycle switches OUT1 on, where a station is; a valid data cycle without a word of 0, three "
      "status telegrams",
      "the data cycle goes out on OUT1, its words are at the outputs", [](SlaveScene& scene) {
        scene.bench.id_cycle(scene.bench.rules().control_local_off);
        send_signs_of_life(scene, std::vector<std::uint16_t>(scene.bench.neighbour_words(false), 0xFFFF));
      }};
}

void short_silence(SlaveScene& scene) {
  const interbus::Rules& rules = scene.bench.rules();
  const kernel::Duration silence = earliest_reset(rules);
  scene.bench.segment().run_until(scene.last + silence);
  expect_no_change(scene.bench, scene.judge, "outputs_lost_before_limit",
                   fmt::format("the line was silent for {} only", kernel::describe(silence)));
}

SlaveStep reset_by_silence(std::string_view least, std::string_view most) {
  return {"silence",
          fmt::format("all outputs are 0 between {} and {} after the end of the last telegram", least, most),
          [](SlaveScene& scene) {
            const kernel::Duration earliest = earliest_reset(scene.bench.rules());
            const kernel::Duration latest = latest_reset(scene.bench.rules());
            scene.bench.segment().run_until(scene.last + latest);
            expect_outputs(scene.bench, scene.judge, std::vector<std::uint16_t>(scene.bench.words()),
                           "outputs_not_safe_after_limit");
            const auto& changes = scene.bench.changes();
            for (const auto& change : changes) {
              const kernel::Duration after = change.when - scene.last;
              const auto sighting = [&] {
                return Mismatch{
                    .expected = {fmt::format("outputs change {} to {} after the last telegram",
                                             kernel::describe(earliest), kernel::describe(latest))},
                    .actual = fmt::format("after {}", kernel::describe(after)),
                    .time = change.when};
              };
              scene.judge.expect(after >= earliest, "outputs_lost_before_limit", sighting);
              scene.judge.expect(after <= latest, "outputs_not_safe_after_limit", sighting);
            }
            if (changes.empty()) return;
            scene.judge.measure("silence until the safe state", "ms",
                                static_cast<double>((changes.back().when - scene.last).count()) / 1e9);
          }};
}

void drive_data_cycle(SlaveBench& bench) {
  line::Waveform wave{bench.now(), bench.rules().bit_rate, bench.direct_data_cycle(words_with(bench, 1), 2)};
  bench.drive_at_receiver(wave);
}

SlaveStep cycles_without_identification(std::string since) {
  return {"three valid data cycles", "no output changes", [since = std::move(since)](SlaveScene& scene) {
            for (unsigned n = 0; n < 3; ++n) drive_data_cycle(scene.bench);
            expect_no_change(scene.bench, scene.judge, "outputs_driven_before_identification",
                             "no ID cycle has been since " + since);
          }};
}

void cycles_that_end_here(SlaveBench& bench, CaseJudge& judge) {
  LineView& remote = bench.remote();
  for (unsigned n = 0; n < 3; ++n) {
    drive_data_cycle(bench);
    judge.expect(remote.waves().empty(), "interfaces_on_after_reset", [&] {
      return Mismatch{.expected = {"nothing leaves on OUT1: no ID cycle has been since the reset"},
                      .actual = fmt::format("{} telegrams left on OUT1", remote.telegrams().size()),
                      .time = remote.waves().front().start};
    });
    expect_all_telegrams(bench, judge);
  }
}

void returns_only(SlaveScene& scene) {
  SlaveBench& bench = scene.bench;
  const kernel::Time latest = scene.last + latest_reset(bench.rules());
  while (bench.now() + kernel::kMillisecond < latest) {
    TrainWriter writer(bench.rules());
    writer.status(3);
    line::Waveform wave{bench.now(), bench.rules().bit_rate, writer.levels()};
    bench.drive_return(false, wave);
    bench.silence(kernel::kMillisecond);
  }
  bench.segment().run_until(latest);
}

std::vector<SlaveCase> cases_of_out1() {
  const SlaveNeeds station_after_out1{.id_code = {}, .remote_neighbour = true};
  return {
      slave_case(
          "supervision/reset_switches_the_interfaces_off", "IS-48",
          "A reset switches the outgoing interfaces off, as at power-up, until an ID cycle switches them on.",
          sources::own("a reset is outputs 0 and interfaces off"),
          {{"reset_leaves_interfaces_on", "interfaces_on_after_reset"}},
          {{2, 10},
           {identified(), alive_with_out1(), silence("26 ms of silence", latest_reset),
            step("three valid data cycles", "they return from the slave itself, nothing leaves on OUT1",
                 cycles_that_end_here)}},
          {.only_for = for_remote(), .needs = station_after_out1}),
      slave_case("supervision/returns_are_no_sign_of_life", "IS-49",
                 "Supervised is the line from the master: what comes back from after an outgoing interface "
                 "is no sign of life.",
                 sources::own("silence is that of port 0"),
                 {{"kept_alive_by_returns", "outputs_not_safe_after_limit"}},
                 {.steps = {identified(),
                            alive_with_out1(),
                            {"26 ms of silence from the master's side, while status telegrams come back from "
                             "OUT1 each millisecond",
                             "", returns_only},
                            all_safe()}},
                 {.tags = {"timing"},
                  .only_for = for_all({for_outputs(), for_remote()}),
                  .needs = station_after_out1})};
}

SlaveCase other_limit_case() {
  return slave_case("supervision/another_silence_limit_counts", "IS-50",
                    "The limit of the silence is the one that the settings of the case say: 10 ms.",
                    sources::own("the silence limit is a setting"),
                    {{"silence_limit_hard_coded", "outputs_not_safe_after_limit"}},
                    {.steps = {identified(), alive(), reset_by_silence("9.0 ms", "11.0 ms")}},
                    {.tags = {"timing"},
                     .only_for = for_all({for_outputs(), for_other_settings()}),
                     .needs = {.change_rules = [](interbus::Rules& rules) {
                       rules.silence_limit = 10 * kernel::kMillisecond;
                     }}});
}

std::vector<SlaveCase> cases_of_outputs() {
  const judge::Reference away = sources::phoenix_maintenance("status telegrams away for more than 25 ms");
  return {slave_case("supervision/silence_of_24_ms_holds_outputs", "IS-27",
                     "Silence shorter than the supervision time of 25 ms changes nothing: outputs hold, and "
                     "the cycle after it is a normal one.",
                     away, {{"silence_limit_20_ms", "outputs_lost_before_limit"}},
                     {.steps = {identified(),
                                alive(),
                                {"24.0 ms of silence", "no output changes", short_silence},
                                good_cycle("cycle_after_short_silence_rejected")}},
                     {.details = {details::status_coding()}, .tags = {"timing"}, .only_for = for_outputs()}),
          slave_case("supervision/silence_of_26_ms_clears_outputs", "IS-28",
                     "When telegrams stay away for more than 25 ms, the slave takes the interruption for a "
                     "reset and its outputs go to the safe state. The tolerance of 1 ms, in both directions, "
                     "is this project's.",
                     away,
                     {{"silence_limit_250_ms", "outputs_not_safe_after_limit"},
                      {"safe_state_500_ms_late", "outputs_not_safe_after_limit"},
                      {"silence_limit_20_ms", "outputs_lost_before_limit"}},
                     {.steps = {identified(), alive(), reset_by_silence("24.0 ms", "26.0 ms")}},
                     {.details = {{sources::own("the tolerance of 1 ms"), {"outputs_not_safe_after_limit"}}},
                      .tags = {"timing"},
                      .only_for = for_outputs()}),
          slave_case("supervision/outputs_stay_safe_until_an_id_cycle", "IS-29",
                     "After power-up and after a reset, outputs stay in the safe state until an ID cycle has "
                     "shown the master what is in the ring.",
                     sources::own("data cycles count only after identification"),
                     {{"outputs_without_identification", "outputs_driven_before_identification"}},
                     {.rounds = {2, 10},
                      .steps = {identified(), alive(), silence("26 ms of silence", latest_reset), all_safe(),
                                cycles_without_identification("the silence"), identified(),
                                good_cycle("no_recovery")},
                      .first = {cycles_without_identification("power-up")}},
                     {.details = {details::status_coding()}, .only_for = for_outputs()})};
}

}  // namespace

std::vector<SlaveCase> slave_supervision_cases() {
  return joined({cases_of_outputs(), cases_of_out1(), {other_limit_case()}});
}

}  // namespace fieldproof::conformance
