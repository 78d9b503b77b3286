#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

#include "conformance/valve_bus/host_scene.hpp"

// What goes round: refreshes of writes, polls of many nodes; and the options that make writes safer.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostErrorKind;
using valve_bus::Response;

// The newest write of a node, and when it was last on the line.
struct Refreshed {
  Command command;
  kernel::Time start;
};
using RefreshedNodes = std::map<std::uint8_t, Refreshed>;

// As many as can be refreshed without keeping each other waiting for a tenth of the period.
std::size_t nodes_to_refresh(const HostBench& bench) {
  const kernel::Duration write = bench.characters(5) + bench.delimiter() + bench.rules().write_distance;
  return 1 + static_cast<std::size_t>(std::min<std::int64_t>(2, bench.rules().refresh / 12 / write));
}

HostFrame next_write(HostBench& bench, CaseJudge& judge) {
  auto frame = bench.next_frame(2 * bench.rules().refresh);
  judge.expect(frame.has_value(), "no_refresh", "writes are refreshed", "nothing was sent");
  expect_form(bench, judge, *frame);
  return *std::move(frame);
}

void expect_refresh(HostBench& bench, CaseJudge& judge, RefreshedNodes& nodes, const HostFrame& frame) {
  const double wanted = in_microseconds(bench.rules().refresh);
  const Command seen = frame.command();
  const auto node = nodes.find(seen.id);
  judge.expect(node != nodes.end() && seen.command == bench.rules().write_command, "refresh_unasked",
               [&] { return Mismatch{{"only what was written is refreshed"}, text_of_command(seen)}; });
  judge.expect(seen == node->second.command, "old_data_refreshed", [&] {
    return Mismatch{{text_of_command(node->second.command)}, text_of_command(seen), frame.start};
  });
  judge.expect_between("time between two writes to a node", "us",
                       in_microseconds(frame.start - node->second.start), 0.9 * wanted, 1.1 * wanted,
                       "refresh_period_wrong");
  node->second.start = frame.start;
}

void order_new_write(HostBench& bench, CaseJudge& judge, RefreshedNodes& nodes, std::uint8_t id) {
  Command write = bench.write_to(id);
  // Other data than before.
  if (nodes.contains(id)) write.data0 = static_cast<std::uint8_t>(~nodes[id].command.data0);
  bench.order(write);
  const kernel::Time limit = bench.now() + 2 * bench.rules().refresh;
  HostFrame frame = next_write(bench, judge);
  while (frame.command() != write) {
    judge.expect(bench.now() < limit, "no_request", "the new write is sent", "only old ones were");
    expect_refresh(bench, judge, nodes, frame);
    frame = next_write(bench, judge);
  }
  nodes[id] = {write, frame.start};
}

void writes_are_refreshed(HostBench& bench, CaseJudge& judge) {
  constexpr std::array<std::uint8_t, 3> kIds{40, 3, 99};
  RefreshedNodes nodes;
  for (const std::uint8_t id : std::span(kIds).first(nodes_to_refresh(bench))) {
    order_new_write(bench, judge, nodes, id);
  }
  const int rounds = bench.volume(2, 20);
  for (int n = 0; n <= rounds; ++n) {
    if (n > 0) order_new_write(bench, judge, nodes, kIds.front());
    for (const kernel::Time limit = bench.now() + 3 * bench.rules().refresh; bench.now() < limit;) {
      expect_refresh(bench, judge, nodes, next_write(bench, judge));
    }
  }
}

// ---- polls ----

void order_reads(HostBench& bench, unsigned last_id) {
  for (unsigned id = 1; id <= last_id; ++id) bench.order(bench.read_of(id));
}

void answer_poll(HostBench& bench, CaseJudge& judge, unsigned id) {
  const Response response = bench.random_response();
  bench.answer(response);
  expect_response(bench, judge, static_cast<std::uint8_t>(id), response);
}

// From the first request to where the last response has been told. Node `dead` does not answer; 0 is none.
kernel::Duration polled_all(HostBench& bench, CaseJudge& judge, std::uint8_t dead) {
  const unsigned nodes = bench.rules().last_address;
  order_reads(bench, nodes);
  kernel::Time begin{};
  for (unsigned id = 1; id <= nodes; ++id) {
    const HostFrame frame = expect_request(bench, judge, bench.read_of(id));
    if (id == 1) begin = frame.start;
    if (id != dead) {
      answer_poll(bench, judge, id);
      continue;
    }
    for (unsigned poll = 1; poll < bench.rules().read_attempts; ++poll) expect_retry(bench, judge, frame);
    expect_error(bench, judge, {dead, HostErrorKind::no_response});
    expect_old_if_known(bench, judge, dead);
  }
  return bench.now() - begin;
}

void expect_cycles_of_99_nodes(HostScene& scene) {
  HostBench& bench = scene.bench;
  const auto& rules = bench.rules();
  const kernel::Duration attempt = latest_repetition(bench) + bench.characters(5);
  const kernel::Duration whole = polled_all(bench, scene.judge, 0);
  // The last one would take its time for late responses after the cycle.
  const auto dead = static_cast<std::uint8_t>(bench.random().between(1, rules.last_address - 1));
  const kernel::Duration with_dead = polled_all(bench, scene.judge, dead);
  scene.judge.measure("cycle of 99 nodes", "us", in_microseconds(whole));
  scene.judge.expect_between("longer by a dead node", "us", in_microseconds(with_dead - whole), 0,
                             in_microseconds(static_cast<int>(rules.read_attempts) * attempt),
                             "cycle_grows_too_much");
}

void polls_do_not_jitter(HostBench& bench, CaseJudge& judge) {
  constexpr unsigned kNodes = 20;
  const int cycles = bench.volume(10, 500);
  order_reads(bench, kNodes);
  kernel::Time before{};
  kernel::Duration shortest = kernel::Duration::max();
  kernel::Duration longest{};
  for (int cycle = 0; cycle < cycles; ++cycle) {
    order_reads(bench, kNodes);  // the next one, before this one is over
    for (unsigned id = 1; id <= kNodes; ++id) {
      const HostFrame frame = expect_request(bench, judge, bench.read_of(id));
      if (id == 1 && cycle > 0) {
        shortest = std::min(shortest, frame.start - before);
        longest = std::max(longest, frame.start - before);
      }
      if (id == 1) before = frame.start;
      answer_poll(bench, judge, id);
    }
  }
  judge.measure("shortest period", "us", in_microseconds(shortest));
  judge.expect_between("jitter of the period", "us", in_microseconds(longest - shortest), 0,
                       in_microseconds(shortest) / 100, "period_jitters");
}

// ---- options ----

// The next frame that is no refresh.
Command next_command(HostBench& bench, CaseJudge& judge, std::string_view missing_reason) {
  const kernel::Time limit = bench.now() + bench.observation_timeout();
  for (;;) {
    const auto frame = bench.next_frame(std::max(kernel::Duration{}, limit - bench.now()));
    judge.expect(frame.has_value(), missing_reason, "it sends what is due", "nothing was sent");
    expect_form(bench, judge, *frame);
    if (!bench.is_refresh(frame->command())) return frame->command();
  }
}

void expect_written_node_read(HostScene& scene) {
  const Command read = next_command(scene.bench, scene.judge, "no_verification");
  scene.judge.expect(read.id == scene.command.id && read.command == scene.bench.rules().read_command,
                     "no_verification", "a read of the node that was written to", text_of_command(read));
}

void expect_write_repeated(HostScene& scene) {
  const auto again = scene.bench.next_frame(scene.bench.time_out() * 2);
  scene.judge.expect(again.has_value(), "no_retry", "a write that is not acknowledged is sent again",
                     "it was not");
  expect_form(scene.bench, scene.judge, *again);
  scene.judge.expect(again->command() == scene.command, "no_retry", text_of_command(scene.command),
                     text_of_command(again->command()));
}

// Of two writes that are ordered at once each is read back before the other is sent; a refresh is not.
void expect_each_read_back_first(HostScene& scene) {
  HostBench& bench = scene.bench;
  const std::array writes{bench.write_to(3), bench.write_to(4)};
  for (const Command& write : writes) bench.order(write);
  for (const Command& write : writes) {
    expect_request(bench, scene.judge, write, "no_request");
    scene.command = write;
    expect_written_node_read(scene);
    bench.answer(octets_of(Response{write.data0, write.data1}), bench.turnaround_time());
  }
  expect_nothing_told(bench, scene.judge, 2 * bench.time_out(), "right_readback_told",
                      "the nodes have what was written");
  const kernel::Time end = bench.now() + bench.rules().refresh * 3 / 2;
  while (const auto frame = bench.next_frame(std::max(kernel::Duration{}, end - bench.now()))) {
    scene.judge.expect(bench.is_refresh(frame->command()), "refresh_read_back", "refreshes alone",
                       text_of_command(frame->command()));
  }
}

// A read follows an acknowledge without the distance of a write.
void expect_read_soon_after_acknowledge(HostScene& scene) {
  HostBench& bench = scene.bench;
  const kernel::Time end =
      bench.answer(octets_of(Response{scene.command.data0, scene.command.data1}), bench.turnaround_time());
  const Command read = bench.read_of(scene.command.id);
  bench.order(read);
  scene.request = expect_request(bench, scene.judge, read);
  scene.command = read;
  const kernel::Duration most = bench.delimiter() + 2 * character_notice(bench.rules()) + bench.bits(3);
  scene.judge.expect_between("request after an acknowledge", "us", in_microseconds(scene.request.start - end),
                             0, in_microseconds(most), "late_after_acknowledge");
}

void expect_refresh_acknowledged(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.clear_observations();
  const auto first = bench.next_frame(bench.rules().refresh * 3 / 2);
  scene.judge.expect(
      first && bench.is_refresh(first->command()), "no_refresh", "the write is refreshed",
      first ? fmt::format("it sent {}", text_of_command(first->command())) : std::string("nothing was sent"));
  const auto again = bench.next_frame(bench.time_out() * 3 / 2);
  scene.judge.expect(
      again && again->command() == first->command(), "no_retry",
      "a refresh that is not acknowledged is sent again",
      again ? fmt::format("it sent {}", text_of_command(again->command())) : std::string("nothing was sent"));
}

}  // namespace

std::vector<HostCase> host_cycle_cases() {
  using namespace host_chart;
  const HostStep read_back =
      expected("the host reads the node that was written to", expect_written_node_read);
  const HostStep sent_again = expected("the host sends the write again", expect_write_repeated);
  return {
      {{.id = "valve_bus/host/cycle/writes_are_refreshed",
        .purpose = "RH-20",
        .requirement = "The last write of each node is sent again every 50 ms, within 10 %, with "
                       "the newest data.",
        .reference = valve_sources::own("a write has no acknowledge, so it is repeated"),
        .stimulus = "Writes to up to three nodes, as the bit rate allows; new ones to one of them.",
        .expected = "Each goes out every 45 to 55 ms with its newest data, and nothing else.",
        .tags = {"must", "timing"},
        .catches = {{"refreshes_first_data", "old_data_refreshed"},
                    {"refreshes_each_100_ms", "refresh_period_wrong"},
                    {"never_refreshes", "no_refresh"}},
        .not_applicable = for_plain_writes()},
       writes_are_refreshed},
      on_chart({.id = "valve_bus/host/cycle/dead_node_costs_three_time_outs",
                .purpose = "RH-32",
                .requirement = "A node that does not answer makes a cycle longer by its attempts and "
                               "their time-outs only; the others are served.",
                .reference = valve_sources::own("time-out and attempts"),
                .tags = {"must", "timing"},
                .catches = {{"waits_long_behind_errors", "cycle_grows_too_much"}}},
               {{1, 20},
                {{"the PC orders reads of 99 nodes, which all answer, and again with one that does not",
                  "98 responses and an error; the cycle is at most three frames and time-outs longer",
                  expect_cycles_of_99_nodes}}}),
      {{.id = "valve_bus/host/cycle/polls_do_not_jitter",
        .purpose = "RH-33",
        .requirement = "With equal responses the period of a poll changes by at most 1 %.",
        .reference = valve_sources::derived("one master, no collisions"),
        .details = {{valve_sources::own("1 %"), {"period_jitters"}}},
        .stimulus = "Reads of 20 nodes again and again, all answered equally fast.",
        .expected = "The longest period is at most 1 % longer than the shortest.",
        .tags = {"must", "timing"},
        .catches = {{"requests_late_in_turns", "period_jitters"}}},
       polls_do_not_jitter},
      on_chart({.id = "valve_bus/host/cycle/write_is_verified",
                .purpose = "RH-31",
                .requirement = "With the option, a read after each write must give what was written; "
                               "else this is reported to the PC.",
                .reference = valve_sources::own("verification by a read"),
                .tags = {"must", "option"},
                .catches = {{"verification_not_compared", "error_not_told"}}},
               {{2, 50},
                {write(), read_back, answer("the node answers with what was written", written_data(true)),
                 nothing_reported("right_readback_told", "the node has what was written"), write(), read_back,
                 answer("the node answers with one bit changed", written_data(false)),
                 error(HostErrorKind::readback_mismatch), write(), read_back,
                 stimulus("no node answers", [](HostScene&) {}), read_back, read_back,
                 error(HostErrorKind::no_response)}},
               {.acknowledged_writes = false, .verifies_writes = true}),
      on_chart({.id = "valve_bus/host/cycle/verification_comes_first",
                .purpose = "RH-31",
                .requirement =
                    "With the option, a write is read back before anything else is sent; a refresh is not.",
                .reference = valve_sources::own("verification by a read"),
                .tags = {"must", "option"},
                .catches = {{"verifies_refreshes", "refresh_read_back"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(10))},
               {{1, 20},
                {power_cycled(),
                 {"the PC orders two writes at once, which the nodes have when they are read",
                  "each is read back before the next is sent, and what follows are refreshes alone",
                  expect_each_read_back_first}}},
               {.acknowledged_writes = false, .verifies_writes = true}),
      on_chart({.id = "valve_bus/host/cycle/acknowledge_is_looked_at",
                .purpose = "RH-18",
                .requirement =
                    "With the option, an acknowledge has the data of its write; it is no response to a read; "
                    "refreshes are acknowledged as well.",
                .reference = valve_sources::own("option: nodes acknowledge writes"),
                .tags = {"must", "option", "timing"},
                .catches = {{"any_acknowledge_taken", "no_retry"}, {"acknowledge_not_awaited", "no_retry"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(20))},
               {{4, 40},
                {power_cycled(),
                 write(),
                 answer("the node answers with one bit changed", written_data(false)),
                 sent_again,
                 {"the node acknowledges it, and the PC orders a read",
                  "the read follows as after a response", expect_read_soon_after_acknowledge},
                 stimulus("no node answers", [](HostScene&) {}),
                 expected("it is polled again",
                          [](HostScene& scene) {
                            for (unsigned n = 1; n < scene.bench.rules().read_attempts; ++n)
                              expect_retry(scene.bench, scene.judge, scene.request);
                          }),
                 error(HostErrorKind::no_response),
                 nothing_reported(kernel::kMillisecond, "acknowledge_told", "nothing was read of the node"),
                 expected("the write is refreshed, and again when it is not acknowledged",
                          expect_refresh_acknowledged)}},
               {.acknowledged_writes = true, .verifies_writes = false}),
      on_chart({.id = "valve_bus/host/cycle/write_is_acknowledged",
                .purpose = "RH-18",
                .requirement = "With the option, a write that is not acknowledged is sent three times in "
                               "all; then an error is reported to the PC.",
                .reference = valve_sources::own("option: nodes acknowledge writes"),
                .tags = {"must", "option"},
                .catches = {{"acknowledge_not_awaited", "no_retry"}},
                .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
               {{2, 50},
                {// Refreshes want to be acknowledged as well: each round begins without any.
                 power_cycled(), write(), answer("the node acknowledges it", written_data(true)),
                 nothing_reported("acknowledge_told", "the write was acknowledged"), write(),
                 stimulus("no node acknowledges it", [](HostScene&) {}), sent_again, sent_again,
                 error(HostErrorKind::not_acknowledged)}},
               {.acknowledged_writes = true, .verifies_writes = false}),
  };
}

}  // namespace fieldproof::conformance
