#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// Refreshes at length: after hours, at the lowest bit rate, of many nodes, and after a line that was busy.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;

constexpr std::uint8_t kRefreshedNode = 7;

void write_to_the_node(HostScene& scene) {
  scene.order(scene.bench.write_to(kRefreshedNode));
  scene.expect_sent();
}

// The next frame, which is the refresh, within a time of the write or refresh before it.
void expect_refresh_between(HostScene& scene, int least_percent, int most_percent) {
  HostBench& bench = scene.bench;
  const kernel::Duration period = bench.rules().refresh;
  const kernel::Time limit = scene.request.start + 2 * period;
  const auto frame = bench.next_frame(std::max(kernel::Duration{}, limit - bench.now()));
  scene.judge.expect(frame.has_value(), "no_refresh", "what was written is refreshed", "nothing was sent");
  expect_form(bench, scene.judge, *frame);
  scene.judge.expect(frame->command() == scene.command, "old_data_refreshed", text_of_command(scene.command),
                     text_of_command(frame->command()));
  scene.judge.expect_between("time between two writes to a node", "us",
                             in_microseconds(frame->start - scene.request.start),
                             in_microseconds(period * least_percent / 100),
                             in_microseconds(period * most_percent / 100), "refresh_period_wrong");
  scene.request = *frame;
}

HostStep refreshed_in_time(unsigned times) {
  return expected(fmt::format("it is refreshed {} times, every 45 to 55 ms", times),
                  [times](HostScene& scene) {
                    for (unsigned n = 0; n < times; ++n) expect_refresh_between(scene, 90, 110);
                  });
}

// Over the end of 16 bits of milliseconds since power-up.
void wait_long(HostScene& scene) {
  constexpr kernel::Time kRoundAt = kernel::Time{} + 65'536 * kernel::kMillisecond;
  scene.bench.wait(kRoundAt - 120 * kernel::kMillisecond - scene.bench.now());
}

void write_again_later(HostScene& scene) {
  const kernel::Duration later = scene.bench.rules().refresh * 3 / 5;
  scene.bench.wait(scene.request.start + later - scene.bench.now());
  write_to_the_node(scene);
}

// From before the refresh is due until it has been given up.
void talk_over_the_refresh(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.wait(scene.request.start + bench.rules().refresh * 17 / 20 - bench.now());
  const kernel::Duration talk = bench.rules().refresh / 4 + 3 * bench.time_out();
  bench.say(std::vector<std::uint8_t>(static_cast<std::size_t>(talk / bench.characters(1)), 0x55));
}

void expect_refreshes_go_on(HostScene& scene) {
  for (unsigned n = 0; n < 2; ++n) {
    const auto frame = scene.bench.next_frame(scene.bench.rules().refresh * 3 / 2);
    scene.judge.expect(frame && frame->command() == scene.command, "no_refresh",
                       "refreshes go on when the line is silent again", "none came within 75 ms");
  }
}

// ---- many nodes ----

constexpr unsigned kWrittenNodes = 80;

void write_to_80_nodes(HostScene& scene) {
  HostBench& bench = scene.bench;
  std::vector<std::uint8_t> octets;
  for (unsigned id = 1; id <= kWrittenNodes; ++id) {
    const Command write = bench.write_to(id);
    bench.note_write(write);
    octets.insert(octets.end(), {write.id, write.command, write.data0, write.data1});
  }
  bench.write(octets);
  bench.wait(400 * kernel::kMillisecond);
  bench.clear_observations();
}

void expect_all_80_refreshed(HostScene& scene) {
  HostBench& bench = scene.bench;
  std::set<unsigned> missing;
  for (unsigned id = 1; id <= kWrittenNodes; ++id) missing.insert(id);
  const kernel::Time end = bench.now() + 400 * kernel::kMillisecond;
  while (const auto frame = bench.next_frame(std::max(kernel::Duration{}, end - bench.now()))) {
    expect_form(bench, scene.judge, *frame);
    scene.judge.expect(bench.is_refresh(frame->command()), "old_data_refreshed",
                       "what was written to the node", text_of_command(frame->command()));
    missing.erase(frame->command().id);
  }
  scene.judge.expect(missing.empty(), "no_refresh", "each of 80 nodes is refreshed", [&] {
    return fmt::format("{} were not, the first of them {:02X}", missing.size(), *missing.begin());
  }());
}

}  // namespace

std::vector<HostCase> host_endurance_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("a write has no acknowledge, so it is repeated");
  const HostStep written{"the PC orders a write", "the host sends it", write_to_the_node};
  const Applicability plain = for_both(for_plain_writes(), for_quick_frames(8));
  const Applicability restarted = for_both(plain, for_switched_power());
  return {
      on_chart({.id = "valve_bus/host/endurance/milliseconds_go_round",
                .purpose = "RH-20",
                .requirement = "Refreshes go on when a host has worked for a minute and more.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"milliseconds_of_16_bits", "no_refresh"}},
                .not_applicable = plain},
               {{1, 1},
                {stimulus("nothing happens until 65.4 s after power-up", wait_long), written,
                 refreshed_in_time(6)}}),
      on_chart({.id = "valve_bus/host/endurance/period_at_the_lowest_bit_rate",
                .purpose = "RH-20",
                .requirement = "A refresh comes 50 ms after the write before it began, also where a write "
                               "takes most of that.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"refresh_counts_from_rest", "refresh_period_wrong"}},
                .not_applicable = for_both(for_plain_writes(), for_settable_dip())},
               {{1, 5}, {written, refreshed_in_time(4)}}, {.dip = 7}),
      on_chart(
          {.id = "valve_bus/host/endurance/new_write_begins_a_period",
           .purpose = "RH-20",
           .requirement = "A new write is refreshed 50 ms after itself, not after the one before it.",
           .reference = own,
           .tags = {"must", "timing"},
           .catches = {{"new_write_refreshed_with_old", "refresh_period_wrong"}},
           .not_applicable = restarted},
          {{2, 20},
           {power_cycled(),
            written,
            {"30 ms later the PC orders another write to the node", "the host sends it", write_again_later},
            refreshed_in_time(2)}}),
      on_chart({.id = "valve_bus/host/endurance/busy_line_ends_no_refresh",
                .purpose = "RH-40",
                .requirement = "A refresh that finds a line that is not silent is not the last one.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"busy_refresh_is_the_last", "no_refresh"}},
                .not_applicable = restarted},
               {{2, 20},
                {power_cycled(), written,
                 stimulus("octets follow each other over the time of its refresh", talk_over_the_refresh),
                 expected("then it is refreshed again and again", expect_refreshes_go_on)}}),
      on_chart({.id = "valve_bus/host/endurance/80_nodes_are_refreshed",
                .purpose = "RH-39",
                .requirement = "However many nodes were written to, each is refreshed, in turns.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"refreshes_64_nodes", "no_refresh"}, {"refreshes_lowest_first", "no_refresh"}},
                .not_applicable =
                    for_both(for_both(for_plain_writes(), for_quick_frames(60)), for_switched_power())},
               {{1, 4},
                {power_cycled(),
                 stimulus("the PC orders writes to 80 nodes, and nothing for 400 ms", write_to_80_nodes),
                 expected("within 400 ms more each node is refreshed", expect_all_80_refreshed)}}),
  };
}

}  // namespace fieldproof::conformance
