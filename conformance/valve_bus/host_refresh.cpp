#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "conformance/valve_bus/host_scene.hpp"

// Refreshes beside everything else that a host does.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;

bool is_write_of(const HostBench& bench, const Command& command) {
  return command.command == bench.rules().write_command;
}

HostFrame next_request(HostBench& bench, CaseJudge& judge) {
  const auto frame = bench.next_frame(bench.rules().refresh * 2);
  judge.expect(frame.has_value(), "no_refresh", "what was written is refreshed", "nothing was sent");
  expect_form(bench, judge, *frame);
  return *frame;
}

// ---- one node ----

// How the reads of a round are answered, and of which node they are.
struct Disturbance {
  bool is_answered;
  bool is_of_written_node;
};
constexpr std::array kDisturbances{Disturbance{true, true}, Disturbance{true, false},
                                   Disturbance{false, true}, Disturbance{false, false}};
constexpr std::uint8_t kWrittenNode = 40;
constexpr int kReadsAhead = 3;

// Reads without end, for some periods; between two refreshes there is a whole read at most.
void expect_refreshed_beside_reads(HostScene& scene) {
  HostBench& bench = scene.bench;
  const Disturbance& how = kDisturbances.at(scene.round % kDisturbances.size());
  const Command write = bench.write_to(kWrittenNode);
  const Command read = bench.read_of(how.is_of_written_node ? kWrittenNode : 41);
  bench.order(write);
  kernel::Time last = expect_request(bench, scene.judge, write).start;
  const kernel::Duration longest =
      bench.rules().refresh * 11 / 10 +
      bench.rules().read_attempts * (bench.time_out() * 11 / 10 + bench.characters(10));
  for (const kernel::Time end = bench.now() + 4 * bench.rules().refresh; bench.now() < end;) {
    for (int n = 0; n < kReadsAhead && bench.fifo_room() > bench.rules().fifo_octets - 12; ++n)
      bench.order(read);
    const HostFrame frame = next_request(bench, scene.judge);
    if (is_write_of(bench, frame.command())) {
      scene.judge.expect(frame.command() == write, "old_data_refreshed", text_of_command(write),
                         text_of_command(frame.command()));
      last = frame.start;
    } else if (how.is_answered) {
      bench.answer(bench.random_response());
    }
    scene.judge.expect(bench.now() - last < longest, "no_refresh", [&] {
      return Mismatch{{fmt::format("a refresh within {}", kernel::describe(longest))},
                      fmt::format("none since {}", kernel::describe(last)),
                      bench.now()};
    });
  }
}

// ---- many nodes ----

constexpr int kFramesToATurn = 5;
constexpr unsigned kLastNode = 99;
constexpr unsigned kSomeNodes = 20;
constexpr unsigned kManyNodes = 45;  // more than can be refreshed in time

void write_to_nodes(HostScene& scene, unsigned first, unsigned last) {
  for (unsigned id = first; id <= last; ++id) {
    scene.bench.order(scene.bench.write_to(kLastNode - 2 * (id - 1)));
    for (int frames = 1; scene.bench.fifo_room() < scene.bench.rules().fifo_octets; ++frames) {
      scene.judge.expect(frames <= kFramesToATurn, "command_waits_for_refreshes",
                         "refreshes and commands take turns", "a command waits for refreshes");
      const HostFrame frame = next_request(scene.bench, scene.judge);
      scene.bench.note_write(frame.command());
    }
  }
}

void expect_each_refreshed(HostScene& scene) {
  std::set<std::uint8_t> refreshed;
  const kernel::Time end = scene.bench.now() + scene.bench.rules().refresh * 3 / 2;
  while (scene.bench.now() < end) {
    const Command seen = next_request(scene.bench, scene.judge).command();
    scene.judge.expect(scene.bench.is_refresh(seen), "old_data_refreshed", "what was written to the node",
                       text_of_command(seen));
    refreshed.insert(seen.id);
  }
  scene.judge.expect_equal(refreshed.size(), std::size_t{kSomeNodes}, "no_refresh",
                           "nodes that are refreshed");
}

// With refreshes that never cease.
void expect_command_in_its_turn(HostScene& scene) {
  scene.bench.wait(scene.bench.rules().refresh * 2);
  scene.bench.clear_observations();
  scene.command = scene.bench.read_of(3);
  scene.bench.order(scene.command);
  unsigned refreshes = 0;
  while (next_request(scene.bench, scene.judge).command() != scene.command) {
    scene.judge.expect(++refreshes <= 2, "command_waits_for_refreshes", "refreshes and commands take turns",
                       "three refreshes were sent while a command waited");
  }
}

// ---- the rest after a refresh ----

void order_after_a_refresh(HostScene& scene) {
  HostBench& bench = scene.bench;
  const Command write = bench.write_to(kWrittenNode);
  bench.order(write);
  expect_request(bench, scene.judge, write);
  const HostFrame refresh = next_request(bench, scene.judge);
  scene.order(bench.read_of(3));
  scene.expect_sent();
  const kernel::Duration least = bench.delimiter() + bench.rules().write_distance;
  scene.judge.expect(scene.request.start - refresh.end + kernel::kNanosecond >= least,
                     "write_distance_too_short", [&] {
                       return Mismatch{{fmt::format("{} or more after a write", kernel::describe(least))},
                                       kernel::describe(scene.request.start - refresh.end),
                                       scene.request.start};
                     });
}

}  // namespace

std::vector<HostCase> host_refresh_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("a write has no acknowledge, so it is repeated");
  const Applicability quick = for_both(for_plain_writes(), for_quick_frames(60));
  return {
      on_chart({.id = "valve_bus/host/refresh/goes_on_beside_reads",
                .purpose = "RH-39",
                .requirement =
                    "A node is refreshed whatever is read, and whatever comes of it: a refresh waits for a "
                    "read at most.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"refreshes_when_idle", "no_refresh"}},
                .not_applicable = quick},
               {{4, 40},
                {power_cycled(),
                 {"a write; then reads of that node or of another, answered or not, without a pause",
                  "the node is refreshed", expect_refreshed_beside_reads}}}),
      on_chart(
          {.id = "valve_bus/host/refresh/reaches_each_node",
           .purpose = "RH-39",
           .requirement = "Each node that was written to is refreshed; where more are than can be in time, "
                          "refreshes and commands take turns.",
           .reference = own,
           .tags = {"must", "timing"},
           .catches = {{"never_refreshes", "no_refresh"},
                       {"refreshes_go_first", "command_waits_for_refreshes"}},
           .not_applicable = for_both(quick, for_switched_power())},
          {{1, 5},
           {power_cycled(),
            stimulus("the PC writes to 20 nodes",
                     [](HostScene& scene) { write_to_nodes(scene, 1, kSomeNodes); }),
            expected("each is refreshed within 75 ms", expect_each_refreshed),
            stimulus("and to 25 more",
                     [](HostScene& scene) { write_to_nodes(scene, kSomeNodes + 1, kManyNodes); }),
            {"100 ms later the PC orders a read", "it is sent after two refreshes at most",
             expect_command_in_its_turn}}}),
      on_chart({.id = "valve_bus/host/refresh/is_left_alone",
                .purpose = "RH-18",
                .requirement =
                    "After a refresh, as after each write, the line is left alone for a delimiter and 1 ms.",
                .reference = valve_sources::own("a delimiter and 1 ms after a write"),
                .tags = {"must", "timing"},
                .catches = {{"write_distance_missing", "write_distance_too_short"}},
                .not_applicable = for_both(quick, for_switched_power())},
               {{2, 50},
                {power_cycled(),
                 {"a write, its refresh, and a read that is ordered then",
                  "it begins a delimiter and 1 ms later", order_after_a_refresh}}}),
  };
}

}  // namespace fieldproof::conformance
