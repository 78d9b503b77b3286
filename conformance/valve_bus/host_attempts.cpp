#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// What attempts that fail leave behind: the rest after them, what is counted late, what the PC is told.
namespace fieldproof::conformance {
namespace {

using valve_bus::HostCounters;
using valve_bus::HostErrorKind;
using Octets = std::vector<std::uint8_t>;

HostStep wrong_acknowledge() {
  return host_chart::answer("the node acknowledges other data", host_chart::written_data(false));
}

HostStep wrong_check() {
  return host_chart::answer("the node answers with a wrong check", [](HostScene& scene) {
    Octets octets = host_chart::right_octets(scene);
    octets.back() ^= 0x20;
    return octets;
  });
}

// Of three octets and of five by turns, one after the other, with a silence that ends each.
void say_frames(HostScene& scene, unsigned count) {
  const Octets octets = host_chart::right_octets(scene);
  for (unsigned n = 0; n < count; ++n) {
    Octets frame = octets;
    if (n % 2 == 1) frame.insert(frame.end(), {octets[0], octets[1]});
    scene.bench.say(frame);
    scene.bench.wait(scene.bench.characters(6));
  }
}

void expect_other_after_the_rest(HostScene& scene, HostErrorKind kind) {
  HostBench& bench = scene.bench;
  bench.order(bench.read_of(scene.other));
  expect_error(bench, scene.judge, {scene.command.id, kind});
  expect_old_if_known(bench, scene.judge, scene.command.id);
  const HostFrame next = expect_request(bench, scene.judge, bench.read_of(scene.other));
  const kernel::Duration least = bench.time_out() + bench.time_out_tolerance() * 4 / 5;
  scene.judge.expect(next.start - scene.poll.end >= least, "rest_too_short", [&] {
    return Mismatch{{fmt::format("the next request {} or more after the last attempt: the time-out, and 5 % "
                                 "of it, less 1 %",
                                 kernel::describe(least))},
                    kernel::describe(next.start - scene.poll.end),
                    next.start};
  });
  const valve_bus::Response response = bench.random_response();
  bench.answer(response);
  expect_response(bench, scene.judge, scene.other, response);
}

// How much later is open: at slow rates what came early, and its end, last longer than the time-out.
void repeated_after_time_out(HostScene& scene) {
  HostBench& bench = scene.bench;
  const HostFrame again = expect_retry(bench, scene.judge, scene.request);
  const kernel::Duration least = earliest_repetition(bench);
  scene.judge.expect(again.start - scene.request.end >= least, "time_out_too_short", [&] {
    return Mismatch{
        {fmt::format("the next attempt {} or more after the one before", kernel::describe(least))},
        kernel::describe(again.start - scene.request.end),
        again.start};
  });
}

void read_back_in_vain(HostScene& scene) {
  const auto [id, command, data0, data1] = scene.command;
  scene.request = expect_request(scene.bench, scene.judge, scene.bench.read_of(id, data0, data1));
  for (unsigned n = 1; n < scene.bench.rules().read_attempts; ++n)
    scene.poll = expect_retry(scene.bench, scene.judge, scene.request);
}

// Where it has been read before, what is known of it follows.
HostStep silent_until_error() {
  return expected("after three attempts the PC gets an error: no response", [](HostScene& scene) {
    for (unsigned n = 1; n < scene.bench.rules().read_attempts; ++n)
      expect_retry(scene.bench, scene.judge, scene.request);
    expect_error(scene.bench, scene.judge, {scene.id, HostErrorKind::no_response});
    expect_old_if_known(scene.bench, scene.judge, scene.id);
  });
}

HostStep other_served() {
  return {"a read of another node is served", "the PC gets its data",
          [](HostScene& scene) { expect_read_served(scene.bench, scene.judge, scene.other); }};
}

void talk_with_a_read_waiting(HostScene& scene) {
  HostBench& bench = scene.bench;
  const auto count = 5 * bench.time_out() / bench.characters(1) + 20;
  bench.answer(Octets(static_cast<std::size_t>(count), 0x55), {});
  bench.wait(bench.characters(3));
  scene.order(bench.read_of(scene.id));
}

kernel::Duration just_in_time(HostScene& scene) {
  return earliest_repetition(scene.bench);
}

std::vector<HostCase> cases_of_late_frames() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("what is counted of a node");
  return {
      on_chart({.id = "valve_bus/host/attempts/each_late_frame_is_counted",
                .purpose = "RH-09",
                .requirement = "Each frame that comes after the time-out of a silent attempt is counted "
                               "late, until the next request; none after it.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"first_late_counted", "counters_wrong"},
                            {"late_of_three_octets_counted", "counters_wrong"},
                            {"late_counted_for_ever", "counters_wrong"}}},
               {{3, 60},
                {read(), silent_until_error(),
                 stimulus("two frames come, of three octets and of five",
                          [](HostScene& scene) { say_frames(scene, 2); }),
                 counted(&HostCounters::late, 2, "late frames"), other_served(),
                 stimulus("another frame comes", [](HostScene& scene) { say_frames(scene, 1); }),
                 counted(&HostCounters::late, 2, "late frames")}}),
      on_chart({.id = "valve_bus/host/attempts/late_frames_beyond_8_bits",
                .purpose = "RH-37",
                .requirement = "Late frames are counted, hundreds of them.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"late_counter_of_8_bits", "counters_wrong"}}},
               {{1, 3},
                {read(), silent_until_error(),
                 stimulus("260 frames come", [](HostScene& scene) { say_frames(scene, 260); }),
                 counted(&HostCounters::late, 260, "late frames")}}),
      on_chart({.id = "valve_bus/host/attempts/nothing_is_late_after_a_wrong_response",
                .purpose = "RH-17",
                .requirement = "An attempt that was answered wrongly has its response: what comes after its "
                               "time-out is not counted late.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"late_behind_wrong", "counters_wrong"}}},
               {{2, 40},
                {read(), wrong_check(), polled_again(), wrong_check(), polled_again(), wrong_check(),
                 expected("the PC gets an error: bad response",
                          [](HostScene& scene) {
                            expect_error(scene.bench, scene.judge, {scene.id, HostErrorKind::bad_response});
                            expect_old_if_known(scene.bench, scene.judge, scene.id);
                          }),
                 stimulus("a frame comes", [](HostScene& scene) { say_frames(scene, 1); }),
                 counted(&HostCounters::late, 0, "late frames")}}),
  };
}

std::vector<HostCase> cases_of_failed_attempts() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("time-out and attempts");
  return {
      on_chart(
          {.id = "valve_bus/host/attempts/rest_follows_wrong_responses",
           .purpose = "RH-17",
           .requirement = "The rest of 5 % of the time-out follows the last attempt also when it was "
                          "answered wrongly.",
           .reference = own,
           .tags = {"must", "timing"},
           .catches = {{"no_rest_behind_wrong", "rest_too_short"}}},
          {{2, 40},
           {read(),
            wrong_check(),
            polled_again(),
            wrong_check(),
            polled_again(),
            wrong_check(),
            {"the PC orders a read of another node",
             "it begins 1.05 times the time-out after the last attempt, less 1 % of it, or later",
             [](HostScene& scene) { expect_other_after_the_rest(scene, HostErrorKind::bad_response); }}}}),
      on_chart(
          {.id = "valve_bus/host/attempts/rest_follows_a_failed_read_back",
           .purpose = "RH-31",
           .requirement = "The rest of 5 % of the time-out follows the last attempt also when a write was "
                          "to be read back.",
           .reference = own,
           .tags = {"must", "option", "timing"},
           .catches = {{"no_rest_behind_read_back", "rest_too_short"}},
           .not_applicable = for_both(for_switched_power(), for_quick_frames(20))},
          {{2, 20},
           {power_cycled(),
            write(),
            expected("it is read back, three times as nobody answers", read_back_in_vain),
            {"the PC orders a read of another node",
             "it begins 1.05 times the time-out after the last attempt, less 1 % of it, or later",
             [](HostScene& scene) { expect_other_after_the_rest(scene, HostErrorKind::no_response); }}}},
          {.acknowledged_writes = false, .verifies_writes = true}),
      on_chart({.id = "valve_bus/host/attempts/early_response_is_waited_out",
                .purpose = "RH-10",
                .requirement = "A response that comes too early is a wrong attempt: the next one begins "
                               "after the time-out, as after each other.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"wrong_response_not_waited_out", "time_out_too_short"}}},
               {{2, 40},
                {read(),
                 answer("the node answers after a character", right_octets,
                        [](HostScene& scene) { return scene.bench.characters(1); }),
                 expected("the host polls it again after the time-out, not before", repeated_after_time_out),
                 response(), reported()}}),
      on_chart({.id = "valve_bus/host/attempts/repetition_waits_for_silence",
                .purpose = "RH-30",
                .requirement = "An attempt that follows octets without end begins 3.5 characters after them.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"repeats_into_talk", "no_delimiter"}}},
               {{2, 40},
                {read(),
                 answer("octets come for one time-out and a half",
                        [](HostScene& scene) {
                          const auto count = scene.bench.time_out() * 3 / 2 / scene.bench.characters(1);
                          return Octets(static_cast<std::size_t>(count), 0x55);
                        }),
                 polled_again(), response(), reported()}}),
      on_chart({.id = "valve_bus/host/attempts/busy_line_leaves_what_was_known",
                .purpose = "RH-40",
                .requirement = "A read that finds no silent line fails like any other: what was known of the "
                               "node follows the error, marked as old.",
                .reference = valve_sources::own("the PC is never left without an answer"),
                .tags = {"must", "timing"},
                .catches = {{"old_forgotten_when_busy", "old_data_not_told"}}},
               {{2, 20},
                {served_read(),
                 stimulus("octets follow each other for five time-outs, and the PC orders a read of the node",
                          talk_with_a_read_waiting),
                 error(HostErrorKind::line_busy), old_data(), recovers()}}),
      on_chart({.id = "valve_bus/host/attempts/just_in_time_at_each_bit_rate",
                .purpose = "RH-30",
                .requirement = "At every bit rate a response that begins 5 % before the time-out is taken.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"time_out_cut", "response_not_told"}},
                .not_applicable = for_settable_dip()},
               {{dip_positions(), 4 * dip_positions()},
                {powered_up_at_each_position(), read(),
                 answer("the node answers rightly at 0.95 times the time-out", right_octets, just_in_time),
                 reported()}}),
      on_chart({.id = "valve_bus/host/attempts/wrong_acknowledges_are_none",
                .purpose = "RH-18",
                .requirement = "With the option, a write that is acknowledged with other data three times "
                               "was not acknowledged.",
                .reference = valve_sources::own("option: nodes acknowledge writes"),
                .tags = {"must", "option"},
                .catches = {{"wrong_acknowledge_told_as_wrong", "error_wrong"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
               {{2, 20},
                {power_cycled(), write(), wrong_acknowledge(), polled_again(), wrong_acknowledge(),
                 polled_again(), wrong_acknowledge(), error(HostErrorKind::not_acknowledged)}},
               {.acknowledged_writes = true, .verifies_writes = false}),
  };
}

}  // namespace

std::vector<HostCase> host_attempt_cases() {
  auto all = cases_of_late_frames();
  std::ranges::move(cases_of_failed_attempts(), std::back_inserter(all));
  return all;
}

}  // namespace fieldproof::conformance
