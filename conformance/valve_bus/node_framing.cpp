#include <fmt/format.h>

#include <array>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// What is a frame: only silence says it.
namespace fieldproof::conformance {
namespace {

NodeBench::Octets written(const valve_bus::Command& command) {
  const auto octets = octets_of(command);
  return {octets.begin(), octets.end()};
}

void short_frames_are_discarded(NodeBench& bench, CaseJudge& judge) {
  for (std::size_t count = 1; count < valve_bus::kCommandOctets; ++count) {
    const auto whole = bench.telling_write();
    bench.send(std::span(whole).first(count));
    bench.await_response_window();
    expect_ignored(bench, judge, "acts_on_short_frame", fmt::format("a frame of {} octets is none", count));
    expect_serves(bench, judge);
  }
}

void long_frames_are_discarded(NodeBench& bench, CaseJudge& judge) {
  for (const std::size_t more : {1U, 2U, 3U, 4U, 5U, 8U, 100U, 300U}) {
    const auto whole = bench.telling_write();
    NodeBench::Octets frame(whole.begin(), whole.end());
    frame.resize(frame.size() + more, 0);
    bench.send(frame);
    bench.await_response_window();
    expect_ignored(bench, judge, "acts_on_long_frame", fmt::format("{} octets after it", more));
    NodeBench::Octets in_front(more, 0);
    const auto behind = bench.telling_write();
    in_front.insert(in_front.end(), behind.begin(), behind.end());
    bench.send(in_front);
    bench.await_response_window();
    expect_ignored(bench, judge, "acts_on_long_frame", fmt::format("{} octets in front of it", more));
    expect_serves(bench, judge);
  }
}

void frames_are_told_apart_by_silence(NodeBench& bench, CaseJudge& judge) {
  for (const double gap : {0.0, 1.0, 2.0, 3.0, 3.4}) {
    const auto first = bench.telling_write();
    bench.send(first);
    bench.wait(bench.characters(gap));
    bench.send(written({bench.address(), 0, 0x0F, 0xF0}));
    bench.await_response_window();
    expect_ignored(bench, judge, "takes_frames_without_delimiter",
                   fmt::format("{} characters of silence are no delimiter", gap));
    expect_serves(bench, judge);
  }
  bench.send(bench.telling_write());
  const std::uint16_t moved = static_cast<std::uint16_t>(~bench.valves());
  bench.wait(bench.delimiter() + kernel::kMicrosecond);
  bench.send(written({bench.address(), 0, 0x0F, 0xF0}));
  bench.await_response_window();
  const auto& changes = bench.boards().changes();
  judge.expect(
      changes.size() == 2 && changes[0].after == bench.valves_of(static_cast<std::uint8_t>(moved),
                                                                 static_cast<std::uint8_t>(moved >> 8)),
      "misses_frames_behind_delimiter", "both writes are taken, one after the other",
      fmt::format("the valves moved {} times", changes.size()));
  expect_valves(bench, judge, bench.valves_of(0x0F, 0xF0), "misses_frames_behind_delimiter");
}

// Sends the frame with silence in front of octet `at`.
void send_with_gap(NodeBench& bench, std::span<const std::uint8_t> frame, std::size_t at, double gap) {
  bench.send(frame.first(at));
  bench.wait(bench.characters(gap));
  bench.send(frame.subspan(at));
  bench.await_response_window();
}

void gaps_inside_a_frame(NodeBench& bench, CaseJudge& judge) {
  for (std::size_t at = 1; at < valve_bus::kCommandOctets; ++at) {
    for (const double gap : {0.5, 1.0, 1.4}) {
      bench.clear_observations();
      const std::uint16_t wanted = bench.valves_of(static_cast<std::uint8_t>(~bench.valves()),
                                                   static_cast<std::uint8_t>(~bench.valves() >> 8));
      send_with_gap(bench, bench.telling_write(), at, gap);
      expect_valves(bench, judge, wanted, "refuses_short_gap");
    }
    for (const double gap : {1.6, 2.0, 3.0, 3.4, 3.6, 10.0}) {
      bench.clear_observations();
      send_with_gap(bench, bench.telling_write(), at, gap);
      expect_ignored(bench, judge, "takes_long_gap",
                     fmt::format("{} characters of silence in front of octet {}", gap, at));
    }
  }
  expect_serves(bench, judge);
}

// A response and the poll that follows it, together, are a valid write to the node whose ID is the first
// octet of the response. Only silence tells them apart.
void joined_frames_are_no_write(NodeBench& bench, CaseJudge& judge) {
  const std::uint8_t id = bench.address();
  const std::array<std::uint8_t, 3> response{id, 0x00, id};
  const NodeBench::Octets poll = written({1, 1, 0, 0});
  for (const bool has_delimiter : {false, true}) {
    bench.send(response);
    if (has_delimiter) bench.wait(bench.delimiter() + kernel::kMicrosecond);
    bench.send(poll);
    bench.await_response_window();
    expect_no_valve_moved(bench, judge, "joins_frames",
                          has_delimiter ? "a response, a delimiter, and a poll of node 1"
                                        : "a response and a poll of node 1 without a delimiter");
    if (id != 1) expect_silence(bench, judge, "joins_frames", "nobody asked it");
    bench.clear_observations();
  }
  expect_serves(bench, judge);
}

void own_frame_behind_a_response_is_taken(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    const auto data = bench.random_octet();
    bench.send(octets_of(valve_bus::Response{data, bench.random_octet()}));
    bench.wait(bench.delimiter() + kernel::kMicrosecond);
    bench.clear_observations();
    const auto frame = bench.telling_write();
    const kernel::Time end = bench.send(frame);
    bench.await_response_window();
    expect_write_taken(bench, judge, frame[2], frame[3], end);
  }
}

}  // namespace

std::vector<NodeCase> node_framing_cases() {
  const judge::Reference silence = valve_sources::own("silence of 3.5 characters ends a frame");
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/framing/short_frames_are_discarded",
                    .purpose = "RN-12",
                    .requirement = "A frame of fewer than five octets is discarded when silence ends it, and "
                                   "leaves nothing after.",
                    .reference = silence,
                    .stimulus = "The first one, two, three, four octets of a write, then a write and a read.",
                    .expected = "No valve moves by the short frame; the node serves what follows.",
                    .tags = {"must"},
                    .catches = {{"buffer_not_cleared", "does_not_recover"},
                                {"takes_four_octets", "acts_on_short_frame"}}},
                   short_frames_are_discarded});
  cases.push_back({{.id = "valve_bus/node/framing/long_frames_are_discarded",
                    .purpose = "RN-13",
                    .requirement = "A frame of more than five octets is discarded, also when five of its "
                                   "octets are a valid command: an octet of zeros changes no exclusive or.",
                    .reference = silence,
                    .stimulus = "A write with 1 to 300 octets of zeros after it and in front of it.",
                    .expected = "No valve moves, and the node serves what follows.",
                    .tags = {"must"},
                    .catches = {{"takes_first_five_octets", "acts_on_long_frame"},
                                {"takes_last_five_octets", "acts_on_long_frame"}}},
                   long_frames_are_discarded});
  cases.push_back({{.id = "valve_bus/node/framing/frames_are_told_apart_by_silence",
                    .purpose = "RN-14",
                    .requirement = "Two frames with less than 3.5 characters of silence between them are "
                                   "none; with 3.5 they are two.",
                    .reference = silence,
                    .stimulus = "Two writes with 0, 1, 2, 3, 3.4 and 3.5 characters between them.",
                    .expected = "No valve moves but for the last pair, of which both are taken.",
                    .tags = {"must"},
                    .catches = {{"delimiter_of_two_characters", "takes_frames_without_delimiter"},
                                {"delimiter_of_five_characters", "misses_frames_behind_delimiter"}}},
                   frames_are_told_apart_by_silence});
  cases.push_back({{.id = "valve_bus/node/framing/gaps_inside_a_frame",
                    .purpose = "RN-15",
                    .requirement = "Inside a frame up to 1.5 characters of silence are allowed; more spoil "
                                   "it.",
                    .reference = silence,
                    .stimulus = "Writes with a gap of 0.5 to 10 characters in front of each octet.",
                    .expected = "Taken up to 1.4 characters, never from 1.6 on.",
                    .tags = {"must"},
                    .catches = {{"gaps_of_three_characters", "takes_long_gap"},
                                {"gaps_of_one_character", "refuses_short_gap"},
                                {"counts_octets_only", "takes_long_gap"}}},
                   gaps_inside_a_frame});
  cases.push_back({{.id = "valve_bus/node/framing/joined_frames_are_no_write",
                    .purpose = "RN-16",
                    .requirement = "The response of one node and the poll of node 1 after it are not taken "
                                   "for a write, although their octets are one.",
                    .reference = valve_sources::calculated("ID 0 ID 1 1 has a block check that fits"),
                    .stimulus = "A response that begins with the node's ID and a poll of node 1, without and "
                                "with a delimiter between them.",
                    .expected = "No valve moves; the node serves what follows.",
                    .tags = {"must", "hazard"},
                    .catches = {{"counts_octets_only", "joins_frames"}}},
                   joined_frames_are_no_write});
  cases.push_back({{.id = "valve_bus/node/framing/own_frame_behind_a_response_is_taken",
                    .purpose = "RN-17",
                    .requirement = "What other nodes answer does not keep a node from hearing its own frame.",
                    .reference = valve_sources::derived("nodes in parallel on one pair receive each other"),
                    .stimulus = "A response of another node, a delimiter, a write.",
                    .expected = "The write is taken.",
                    .tags = {"must"},
                    .catches = {{"deaf_behind_response", "write_not_taken"}}},
                   own_frame_behind_a_response_is_taken});
  return cases;
}

}  // namespace fieldproof::conformance
