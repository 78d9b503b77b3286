#include <array>
#include <variant>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// What follows something that went wrong: a command that was lost, a part of one, an attempt that the supply
// has cut, a line that was not silent, a write that nobody acknowledged.
namespace fieldproof::conformance {
namespace {

using valve_bus::HostError;
using valve_bus::HostErrorKind;

// One read is on the line, and the FIFO is full of others.
void fill_up(HostScene& scene) {
  HostBench& bench = scene.bench;
  scene.order(bench.read_of(scene.id));
  scene.expect_sent();
  for (unsigned n = 0; n < bench.rules().fifo_octets / 4; ++n)
    bench.write(octets_for(bench.read_of(scene.other)));
}

HostStep full() {
  return {"the PC orders a read, which is not answered, and fills the FIFO with reads",
          "the first one is sent", fill_up};
}

// The ID alone of a command that does not fit.
HostStep begun_and_lost(std::uint8_t id) {
  return {"the PC gives the first octet of another command", "it is lost: error 7 with its ID",
          [id](HostScene& scene) {
            scene.bench.write({id});
            expect_error(scene.bench, scene.judge, {id, HostErrorKind::fifo_overflow});
          }};
}

// Until nothing is sent any more.
void expect_no_part_told(HostScene& scene) {
  HostBench& bench = scene.bench;
  const kernel::Duration patience = 2 * bench.rules().partial_command_limit;
  while (const auto told = bench.next_told(patience)) {
    const auto* error = std::get_if<HostError>(&told->what);
    scene.judge.expect(error == nullptr || error->kind != HostErrorKind::part_of_command,
                       "lost_command_told_as_part",
                       "nothing is reported of the rest of a command that was lost", text_of(*told));
  }
  bench.clear_observations();
}

HostStep drained() {
  return {"no node answers, and 200 ms more pass",
          "each read ends in an error; nothing is reported of a part", expect_no_part_told};
}

HostStep lost_with_each_id() {
  return {"the PC orders whole commands to 200, 128 and 0", "each is lost: error 7 with its ID",
          [](HostScene& scene) {
            for (const std::uint8_t id : std::to_array<std::uint8_t>({200, 128, 0})) {
              scene.bench.write(octets_for(scene.bench.read_of(id)));
              expect_error(scene.bench, scene.judge, {id, HostErrorKind::fifo_overflow});
            }
          }};
}

HostStep part_of_each_id() {
  return {"the PC gives one or two octets of a command to 0, 255, 128 and 1, and 100 ms pass after each",
          "error 8 with the ID each time", [](HostScene& scene) {
            std::size_t count = 0;
            for (const std::uint8_t id : std::to_array<std::uint8_t>({0x00, 0xFF, 0x80, 0x01})) {
              const auto octets = octets_for(scene.bench.read_of(id));
              scene.bench.write(std::span(octets).first(1 + count++ % 2));
              scene.bench.wait(scene.bench.rules().partial_command_limit * 11 / 10);
              expect_error(scene.bench, scene.judge, {id, HostErrorKind::part_of_command});
            }
          }};
}

// The line is not silent from before the order on for one time-out and a half.
HostStep write_on_a_busy_line() {
  return {"the line is not silent for one time-out and a half, and the PC orders a write",
          "error 6 before the line is silent", [](HostScene& scene) {
            HostBench& bench = scene.bench;
            const auto count = bench.time_out() * 3 / 2 / bench.characters(1) + 4;
            const kernel::Time end =
                bench.answer(std::vector<std::uint8_t>(static_cast<std::size_t>(count), 0x55), {});
            bench.wait(bench.characters(3));
            scene.order(bench.write_to(3));
            bench.note_write(scene.command);  // it is refreshed
            const auto told = bench.next_told(end - bench.now());
            const auto* error = told ? std::get_if<HostError>(&told->what) : nullptr;
            scene.judge.expect(
                error != nullptr && *error == HostError{3, HostErrorKind::line_busy}, "busy_line_told_late",
                "error 6 of ID 03: after one time-out",
                told ? text_of(*told) : std::string("nothing was reported before the line was silent"));
          }};
}

HostStep silent_again() {
  return stimulus("the line is silent", [](HostScene& scene) {
    scene.bench.wait(2 * scene.bench.time_out());
    scene.bench.clear_observations();
  });
}

HostStep refreshed_after_error() {
  return expected("the write is sent again within two times of a refresh", [](HostScene& scene) {
    const auto frame = scene.bench.next_frame(2 * scene.bench.rules().refresh);
    scene.judge.expect(frame && frame->command() == scene.command, "no_refresh",
                       "the write that was not acknowledged is refreshed",
                       frame ? std::string("another frame was sent") : std::string("nothing was sent"));
  });
}

HostStep octets_follow() {
  return stimulus("three octets follow it, and another one", [](HostScene& scene) {
    for (const std::size_t octets : {std::size_t{3}, std::size_t{1}}) {
      scene.bench.wait(scene.bench.delimiter());
      scene.bench.say(std::vector<std::uint8_t>(octets, 0x55));
    }
    scene.bench.wait(2 * scene.bench.delimiter());
  });
}

HostStep not_read_back() {
  return expected("no read follows for two time-outs", [](HostScene& scene) {
    expect_no_request(scene.bench, scene.judge, 2 * scene.bench.time_out(), "read_back_after_error",
                      "the write has ended in error 4");
  });
}

}  // namespace

std::vector<HostCase> host_corner_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("a command that does not fit is lost as a whole");
  const judge::Reference busy = valve_sources::own("a line that is not silent for a time-out");
  return {
      on_chart(
          {.id = "valve_bus/host/fifo/lost_command_leaves_nothing",
           .purpose = "RH-25",
           .requirement = "Of a command that was lost with its first octet nothing is left: no error 8, no "
                          "octets of the next command, also after a loss of supply.",
           .reference = own,
           .tags = {"must", "long"},
           .catches = {{"lost_part_reported", "lost_command_told_as_part"}},
           .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
          {{1, 2},
           {full(), begun_and_lost(7), drained(), served_read(), full(), begun_and_lost(9), power_cycled(),
            served_read()}}),
      on_chart({.id = "valve_bus/host/fifo/errors_name_each_id",
                .purpose = "RH-25",
                .requirement = "Errors 7 and 8 have the first octet of the command as ID, whatever it is.",
                .reference = own,
                .tags = {"must"},
                .catches = {{"overflow_id_of_7_bits", "error_wrong"}, {"no_part_of_id_0", "error_not_told"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
               {{1, 2}, {part_of_each_id(), full(), lost_with_each_id(), power_cycled()}}),
      on_chart({.id = "valve_bus/host/supply/takes_an_attempt",
                .purpose = "RH-38",
                .requirement =
                    "A read after power-up has all of its attempts, however many the supply has cut before.",
                .reference = valve_sources::own("power-up is the only reset"),
                .tags = {"must"},
                .catches = {{"attempts_over_power_loss", "no_retry"}},
                .not_applicable = for_switched_power()},
               {{2, 10},
                {read(), polled_again(), power_cycled(), read(), polled_again(), polled_again(),
                 error(HostErrorKind::no_response)}}),
      on_chart(
          {.id = "valve_bus/host/line/busy_line_ends_a_write",
           .purpose = "RH-20",
           .requirement =
               "A line that is not silent for one time-out is error 6 of a write, not after several.",
           .reference = busy,
           .tags = {"must", "timing"},
           .catches = {{"waits_three_time_outs_for_silence", "busy_line_told_late"}},
           .not_applicable = for_switched_power()},
          {{1, 10}, {power_cycled(), served_read(), write_on_a_busy_line(), silent_again(), power_cycled()}}),
      on_chart({.id = "valve_bus/host/cycle/unacknowledged_write_is_refreshed",
                .purpose = "RH-29",
                .requirement = "A write that nobody has acknowledged is refreshed as each other one.",
                .reference = valve_sources::own("a write to each node again"),
                .tags = {"must", "option"},
                .catches = {{"no_refresh_after_error_4", "no_refresh"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
               {{1, 5},
                {power_cycled(), write(), polled_again(), polled_again(),
                 error(HostErrorKind::not_acknowledged), refreshed_after_error(), power_cycled()}},
               {.acknowledged_writes = true, .verifies_writes = false}),
      on_chart({.id = "valve_bus/host/cycle/unacknowledged_write_is_not_read_back",
                .purpose = "RH-29",
                .requirement = "A write that nobody has acknowledged is not read back.",
                .reference = valve_sources::own("none follows error 4"),
                .tags = {"must", "option"},
                .catches = {{"reads_back_after_error_4", "read_back_after_error"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
               {{1, 5},
                {power_cycled(), write(), polled_again(), polled_again(),
                 error(HostErrorKind::not_acknowledged), not_read_back(), power_cycled()}},
               {.acknowledged_writes = true, .verifies_writes = true}),
      on_chart({.id = "valve_bus/host/retry/late_frames_are_counted_until_a_write",
                .purpose = "RH-09",
                .requirement = "Late frames are those of the node whose last attempt nothing answered, until "
                               "the next request, which a write to another node is, too.",
                .reference = valve_sources::own("late frames are counted until the next request"),
                .tags = {"must"},
                .catches = {{"late_until_a_read", "late_counted_after_a_request"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(6))},
               {{2, 20},
                {power_cycled(), read(), polled_again(), polled_again(), error(HostErrorKind::no_response),
                 write(), octets_follow(),
                 counted(&valve_bus::HostCounters::late, 0, "late responses", "late_counted_after_a_request"),
                 power_cycled()}},
               {.acknowledged_writes = false, .verifies_writes = false}),
  };
}

}  // namespace fieldproof::conformance
