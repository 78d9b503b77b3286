#include <fmt/format.h>

#include <variant>

#include "conformance/valve_bus/host_scene.hpp"

// Writes that a host keeps: refreshes that are acknowledged or not, writes and refreshes that find no silent
// line, refreshes of a node for which a write waits; and how long it keeps a part of a command.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostCounters;
using valve_bus::HostError;
using valve_bus::HostErrorKind;

std::string text_of(const std::optional<HostFrame>& frame) {
  return frame ? fmt::format("it sent {}", text_of_command(frame->command()))
               : std::string("nothing was sent");
}

// ---- refreshes with an acknowledge ----

HostFrame next_refresh(HostScene& scene) {
  const auto frame = scene.bench.next_frame(2 * scene.bench.rules().refresh);
  scene.judge.expect(frame && frame->command() == scene.command, "no_refresh",
                     [&] { return Mismatch{{text_of_command(scene.command)}, text_of(frame)}; });
  expect_form(scene.bench, scene.judge, *frame);
  return *frame;
}

// All attempts of the next refresh are answered so, and counted; then error 4.
void expect_refresh_fails(HostScene& scene, bool is_answered, std::uint64_t HostCounters::* counter,
                          const std::string& what) {
  HostBench& bench = scene.bench;
  const HostFrame first = next_refresh(scene);
  const HostCounters before = bench.counters(first.command().id);
  HostFrame last = first;
  const unsigned attempts = bench.rules().read_attempts;
  for (unsigned n = 1; n <= attempts; ++n) {
    if (n > 1) last = expect_retry_in_time(bench, scene.judge, first, last.end);
    if (is_answered) scene.answer(host_chart::written_data(false)(scene), bench.turnaround_time());
  }
  expect_error(bench, scene.judge, {first.command().id, HostErrorKind::not_acknowledged});
  const HostCounters after = bench.counters(first.command().id);
  scene.judge.expect_equal(after.retries - before.retries, attempts - 1, "counters_wrong",
                           "repetitions of a refresh");
  scene.judge.expect_equal(after.*counter - before.*counter, attempts, "counters_wrong", what);
}

HostStep refresh_acknowledged_wrongly() {
  return {"the node acknowledges each attempt of a refresh with other data",
          "three attempts, each after the time-out of the one before, counted as those of a read; error 4",
          [](HostScene& scene) {
            expect_refresh_fails(scene, true, &HostCounters::rejected, "wrong acknowledgements of a refresh");
          }};
}

HostStep refresh_not_acknowledged() {
  return {"nobody acknowledges the next refresh", "the same again", [](HostScene& scene) {
            expect_refresh_fails(scene, false, &HostCounters::timeouts, "attempts of a refresh in vain");
          }};
}

// ---- a line that is not silent ----

constexpr std::uint8_t kWrittenNode = 3;

HostStep written_in_odd_rounds() {
  return {"in each second round the PC writes to a node", "the host sends it", [](HostScene& scene) {
            if (scene.round % 2 == 0) return;
            scene.order(scene.bench.write_to(kWrittenNode));
            scene.expect_sent();
          }};
}

// Octets from now on, for so long.
void talk(HostScene& scene, kernel::Duration duration) {
  const auto count = duration / scene.bench.characters(1) + 1;
  scene.bench.say(std::vector<std::uint8_t>(static_cast<std::size_t>(count), 0x55));
}

HostStep busy_write_is_kept() {
  return {"the line is not silent for one time-out and a half, and the PC orders a write to the node",
          "error 6; when the line is silent, the write is sent within two times of a refresh",
          [](HostScene& scene) {
            HostBench& bench = scene.bench;
            const Command write = bench.write_to(kWrittenNode);
            bench.write_later(octets_for(write), bench.characters(3));
            scene.command = write;
            talk(scene, bench.time_out() * 3 / 2 + bench.characters(8));
            expect_error(bench, scene.judge, {kWrittenNode, HostErrorKind::line_busy});
            const auto frame = bench.next_frame(2 * bench.rules().refresh);
            scene.judge.expect(frame.has_value(), "no_refresh", "the write is refreshed", "nothing was sent");
            scene.judge.expect(frame->command() == write, "old_data_refreshed", text_of_command(write),
                               text_of(frame));
          }};
}

// A tenth before a refresh is due at the earliest, until one has been given up for sure.
HostStep refresh_finds_a_busy_line() {
  return {"the line is not silent when the refresh is due, until it has been given up",
          "the refresh is sent another 50 ms later, not when the line is silent", [](HostScene& scene) {
            HostBench& bench = scene.bench;
            const kernel::Duration refresh = bench.rules().refresh;
            const kernel::Time written = scene.request.start;
            bench.wait(written + refresh * 9 / 10 - bench.delimiter() - bench.characters(7) - bench.now());
            talk(scene, refresh * 2 / 10 + bench.time_out() * 3 / 2 + bench.characters(12));
            const kernel::Time earliest = written + 2 * (refresh * 9 / 10);
            const auto early = bench.next_frame(earliest - bench.now());
            scene.judge.expect(!early, "refresh_too_early", [&] {
              return Mismatch{{fmt::format("nothing before {}: the refresh is due again a refresh later",
                                           kernel::describe(earliest - kernel::kStart))},
                              text_of(early),
                              early->start};
            });
            scene.request = next_refresh(scene);
          }};
}

// ---- a write that waits ----

constexpr unsigned kReadsAhead = 12;

void expect_refreshed_meanwhile(HostScene& scene) {
  HostBench& bench = scene.bench;
  const Command kept = scene.command;
  const Command next = bench.write_to(kept.id);
  for (unsigned n = 0; n < kReadsAhead; ++n) bench.order(bench.read_of(scene.other));
  bench.order(next);
  unsigned refreshes = 0;
  for (;;) {
    const auto frame = bench.next_frame(bench.observation_timeout());
    scene.judge.expect(frame.has_value(), "no_request", text_of_command(next), text_of(frame));
    if (frame->command() == next) break;
    if (frame->command() == kept) ++refreshes;
  }
  scene.judge.expect(
      refreshes > 0, "no_refresh", "what the node was written is refreshed while another write to it waits",
      fmt::format("no refresh within {}", kernel::describe(bench.now() - scene.request.start)));
  bench.note_write(next);
}

// ---- a part of a command ----

void expect_part_reported_in_time(HostScene& scene) {
  constexpr std::uint8_t kPartOf = 7;
  HostBench& bench = scene.bench;
  const kernel::Duration limit = bench.rules().partial_command_limit;
  const kernel::Duration tolerance = limit / 20;
  const auto exchanges = 3 * limit / 2 / (bench.rules().read_attempts * bench.time_out()) + 1;
  for (kernel::Duration::rep n = 0; n < exchanges; ++n) bench.order(bench.read_of(scene.other));
  // At another place within an exchange in each round.
  bench.wait(bench.time_out() * static_cast<int>(1 + 3 * (scene.round % 4)) / 4);
  bench.write({kPartOf, 1});
  const kernel::Time begin = bench.now();
  const HostError part{kPartOf, HostErrorKind::part_of_command};
  for (;;) {
    const auto told = bench.next_told(begin + limit + tolerance - bench.now());
    scene.judge.expect(told.has_value(), "error_not_told",
                       "error 8 within 105 ms of the last octet, whatever the host is at", "none");
    const auto* error = std::get_if<HostError>(&told->what);
    if (error == nullptr || *error != part) continue;
    scene.judge.expect(told->when - begin >= limit - tolerance, "part_given_up_early", [&] {
      return Mismatch{
          {"error 8 after 95 ms at the earliest"}, kernel::describe(told->when - begin), told->when};
    });
    return;
  }
}

}  // namespace

std::vector<HostCase> host_kept_write_cases() {
  using namespace host_chart;
  const judge::Reference refresh = valve_sources::own("a write to each node again");
  const judge::Reference busy = valve_sources::own("a line that is not silent for a time-out");
  const Applicability plain =
      for_both(for_switched_power(), for_both(for_plain_writes(), for_quick_frames(40)));
  return {
      on_chart(
          {.id = "valve_bus/host/cycle/refreshes_wait_for_their_acknowledge",
           .purpose = "RH-29",
           .requirement = "With the option, a refresh is acknowledged, repeated and counted as a write; each "
                          "that was not is reported.",
           .reference = valve_sources::own("option: nodes acknowledge writes"),
           .tags = {"must", "option", "timing"},
           .catches = {{"refresh_acknowledge_not_compared", "no_retry"},
                       {"wrong_acknowledge_not_waited_out", "time_out_too_short"},
                       {"refresh_repetitions_not_counted", "counters_wrong"},
                       {"failed_refresh_not_reported", "error_not_told"},
                       {"failed_refresh_reported_once", "error_not_told"}},
           .not_applicable = for_both(for_switched_power(), for_quick_frames(20))},
          {{2, 20},
           {power_cycled(), write(), answer("the node acknowledges it", written_data(true)),
            refresh_acknowledged_wrongly(), refresh_not_acknowledged(), refresh_not_acknowledged()}},
          {.acknowledged_writes = true, .verifies_writes = false}),
      on_chart(
          {.id = "valve_bus/host/line/busy_write_is_kept",
           .purpose = "RH-20",
           .requirement = "A write that finds no silent line is remembered: it is refreshed, and what was "
                          "written before is not.",
           .reference = busy,
           .tags = {"must", "timing"},
           .catches = {{"busy_write_forgotten", "no_refresh"},
                       {"busy_write_leaves_old_data", "old_data_refreshed"}},
           .not_applicable = plain},
          {{2, 20}, {power_cycled(), written_in_odd_rounds(), busy_write_is_kept()}}),
      on_chart(
          {.id = "valve_bus/host/line/busy_refresh_waits_its_time",
           .purpose = "RH-20",
           .requirement = "A refresh that finds no silent line is given up, and due again a refresh later.",
           .reference = busy,
           .tags = {"must", "timing"},
           .catches = {{"busy_refresh_at_once", "refresh_too_early"},
                       {"busy_refresh_is_the_last", "no_refresh"}},
           .not_applicable = plain},
          {{2, 20}, {power_cycled(), write(), refresh_finds_a_busy_line()}}),
      on_chart({.id = "valve_bus/host/refresh/goes_on_while_a_write_waits",
                .purpose = "RH-39",
                .requirement = "A node is refreshed also while another write to it waits in the FIFO.",
                .reference = refresh,
                .tags = {"must", "timing"},
                .catches = {{"waiting_write_stops_refreshes", "no_refresh"}},
                .not_applicable = plain},
               {{1, 10},
                {power_cycled(),
                 write(),
                 {"the PC orders 12 reads, which nobody answers, and a write to the node",
                  "what it was written is refreshed before the write is sent", expect_refreshed_meanwhile},
                 power_cycled()}}),
      on_chart(
          {.id = "valve_bus/host/fifo/part_is_given_up_in_time",
           .purpose = "RH-25",
           .requirement = "A part of a command is given up 100 ms after its last octet, within 5 %, whatever "
                          "is in front of it or on the line.",
           .reference = valve_sources::own("the rest of a command"),
           .tags = {"must", "timing"},
           .catches = {{"part_given_up_when_idle", "error_not_told"},
                       {"part_given_up_after_110_ms", "error_not_told"}},
           .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
          {{4, 20},
           {power_cycled(),
            {"the PC orders reads, which nobody answers for 150 ms, and half a command",
             "error 8 between 95 and 105 ms later", expect_part_reported_in_time},
            power_cycled()}}),
  };
}

}  // namespace fieldproof::conformance
