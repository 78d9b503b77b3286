#include <fmt/format.h>

#include <array>

#include "conformance/valve_bus/node_lateness.hpp"
#include "conformance/valve_bus/node_scene.hpp"
#include "harness/iut/misbehaviour.hpp"

// What is a frame: only silence says it.
namespace fieldproof::conformance {
namespace {

using Frame = std::vector<std::uint8_t>;

// Its check would fit after the same octets of the write before, too: all data bits of the two differ.
Frame first_octets(NodeScene& scene) {
  Frame frame = scene.moving_write();
  frame.resize(1 + scene.round);
  return frame;
}

constexpr std::array<std::size_t, 9> kMoreOctets{1, 2, 3, 4, 5, 8, 100, 256, 300};

Frame with_more_octets(NodeScene& scene) {
  Frame frame = scene.moving_write();
  frame.insert(scene.round % 2 == 0 ? frame.end() : frame.begin(), kMoreOctets.at(scene.round / 2), 0);
  return frame;
}

constexpr std::array kShortSilences{0.0, 1.0, 2.0, 3.0, 3.4};

// Two frames, or two parts of one, with silence between them.
void send_both(NodeScene& scene, const Frame& first, kernel::Duration silence, const Frame& second) {
  scene.bench.clear_observations();
  scene.bench.send(first);
  scene.bench.wait(silence);
  scene.send_next(second);
}

void send_two_writes(NodeScene& scene) {
  send_both(scene, scene.moving_write(), scene.bench.characters(kShortSilences.at(scene.round)),
            scene.write(0x0F, 0xF0));
}

// Changes within the skew of outputs are one move. Gives what the valves are after each.
std::vector<std::uint16_t> moves_of(NodeBench& bench) {
  std::vector<std::uint16_t> moves;
  kernel::Time begun{};
  for (const auto& change : bench.boards().changes()) {
    if (moves.empty() || change.when - begun > bench.rules().output_skew) {
      begun = change.when;
      moves.push_back(change.after);
    }
    moves.back() = change.after;
  }
  return moves;
}

void expect_two_writes_taken(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.require(&iut::Capabilities::process_side);
  const Frame first = scene.moving_write();
  const Frame back = scene.write(bench.valves(), bench.valves() >> 8U);
  bench.send(first);
  bench.wait_after_write();
  scene.send_next(back);
  const std::vector<std::uint16_t> moves = moves_of(bench);
  const std::uint16_t first_valves = bench.valves_of(first[2], first[3]);
  if (moves.size() != 2) expect_not_late(bench, scene.judge, first_valves);
  scene.judge.expect(moves.size() == 2 && moves[0] == first_valves, "misses_frames_behind_delimiter",
                     "both writes are taken, one after the other",
                     fmt::format("the valves moved {} times", moves.size()));
  expect_valves(bench, scene.judge, scene.valves(), "misses_frames_behind_delimiter");
  bench.clear_observations();
}

constexpr std::array kGapsInFrame{0.5, 1.0, 1.4, 1.6, 2.0, 3.0, 3.4, 3.6, 10.0};

void send_with_gap(NodeScene& scene) {
  const auto at = static_cast<std::ptrdiff_t>(1 + scene.round / kGapsInFrame.size());
  const Frame all = scene.moving_write();
  send_both(scene, {all.begin(), all.begin() + at},
            scene.bench.characters(kGapsInFrame.at(scene.round % kGapsInFrame.size())),
            {all.begin() + at, all.end()});
  scene.frame = all;
}

void expect_short_gaps_taken(NodeScene& scene) {
  if (kGapsInFrame.at(scene.round % kGapsInFrame.size()) < 1.5) {
    expect_valves(scene.bench, scene.judge, scene.valves(), "refuses_short_gap");
  } else {
    node_chart::ignored("takes_long_gap", "1.6 characters of silence or more are in the frame").run(scene);
  }
}

// Timers of 16 and of 32 bits begin anew after so long, in microseconds and in milliseconds.
constexpr std::array kTimerPeriods{65'536 * kernel::kMicrosecond,
                                   kernel::Duration{std::int64_t{1} << 31} * 1'000'000,
                                   kernel::Duration{std::int64_t{1} << 32} * 1'000'000,
                                   65'536 * kernel::kMillisecond, 256 * kernel::kMillisecond};

// The other write comes when such a timer shows more than a frame may have within it, and less than ends one.
void write_after_a_timer(NodeScene& scene) {
  constexpr double kBetween = 2.5;  // characters
  scene.bench.write(0x0F, 0xF0);
  scene.bench.wait(kTimerPeriods.at(scene.round) + scene.bench.characters(kBetween));
  scene.send(scene.write(0xF0, 0x0F));
}

// The other octets come when such a timer shows half a character.
void send_around_a_timer(NodeScene& scene) {
  const kernel::Duration period = kTimerPeriods.at(scene.round);
  if (scene.bench.capabilities().is_wall_clock && period > kernel::kSecond)
    throw iut::CannotBeDone("a real line takes as long as that");
  const auto at = static_cast<std::ptrdiff_t>(1 + scene.round % 4);
  const Frame all = scene.moving_write();
  const kernel::Duration half = scene.bench.characters(0.5);
  send_both(scene, {all.begin(), all.begin() + at}, period + half, {all.begin() + at, all.end()});
}

// A response and the poll that follows it, together, are a valid write to the node whose ID is the first
// octet of the response. Only silence tells them apart.
void send_response_and_poll(NodeScene& scene) {
  const std::uint8_t id = scene.bench.address();
  const bool has_delimiter = scene.round == 1;
  send_both(scene, {id, 0x00, id},
            has_delimiter ? scene.bench.delimiter() + kernel::kMicrosecond : kernel::Duration{},
            {1, 1, 0, 0, 0});
}

void expect_not_joined(NodeScene& scene) {
  expect_no_valve_moved(scene.bench, scene.judge, "joins_frames", "a response and a poll of node 1");
  if (scene.bench.address() != 1) expect_silence(scene.bench, scene.judge, "joins_frames", "nobody asked it");
  scene.bench.clear_observations();
}

void send_response_of_another(NodeScene& scene) {
  const std::uint8_t data0 = scene.bench.random_octet();
  scene.bench.send(octets_of(valve_bus::Response{data0, scene.bench.random_octet()}));
  scene.bench.wait(scene.bench.delimiter() + kernel::kMicrosecond);
}

}  // namespace

std::vector<NodeCase> node_framing_cases() {
  using namespace node_chart;
  const judge::Reference silence = valve_sources::own("silence of 3.5 characters ends a frame");
  return {
      on_chart(
          {.id = "valve_bus/node/framing/short_frames_are_discarded",
           .purpose = "RN-12",
           .requirement = "A frame of fewer than five octets is discarded when silence ends it, and "
                          "leaves nothing after.",
           .reference = silence,
           .tags = {"must"},
           .catches = {{"buffer_not_cleared", "does_not_recover"},
                       {"takes_four_octets", "acts_on_short_frame"}}},
          {{4, 4},
           {moving_write(), sent("the first one, two, three, four octets of another write", first_octets),
            ignored("acts_on_short_frame", "the frame has fewer than five octets"), serves()}}),
      on_chart(
          {.id = "valve_bus/node/framing/long_frames_are_discarded",
           .purpose = "RN-13",
           .requirement = "A frame of more than five octets is discarded, also when five of its "
                          "octets are a valid command: an octet of zeros changes no exclusive or.",
           .reference = silence,
           .tags = {"must"},
           .catches = {{"takes_first_five_octets", "acts_on_long_frame"},
                       {"takes_last_five_octets", "acts_on_long_frame"}}},
          {{2 * kMoreOctets.size(), 2 * kMoreOctets.size()},
           {sent("a write with 1, 2, 3, 4, 5, 8, 100, 256, 300 octets of zeros after it or in front of it",
                 with_more_octets),
            ignored("acts_on_long_frame", "the frame has more than five octets"), serves()}}),
      on_chart({.id = "valve_bus/node/framing/frames_are_told_apart_by_silence",
                .purpose = "RN-14",
                .requirement = "Two frames with less than 3.5 characters of silence between them are "
                               "none; with 3.5 they are two.",
                .reference = silence,
                .tags = {"must"},
                .catches = {{"delimiter_of_two_characters", "takes_frames_without_delimiter"},
                            {"delimiter_of_five_characters", "misses_frames_behind_delimiter"}}},
               {{kShortSilences.size(), kShortSilences.size()},
                {stimulus("two writes with 0, 1, 2, 3, 3.4 characters between them", send_two_writes),
                 ignored("takes_frames_without_delimiter", "fewer than 3.5 are no delimiter"),
                 serves(),
                 {"two writes with 3.5 characters between them", "both are taken, one after the other",
                  expect_two_writes_taken}}}),
      on_chart(
          {.id = "valve_bus/node/framing/gaps_inside_a_frame",
           .purpose = "RN-15",
           .requirement = "Inside a frame up to 1.5 characters of silence are allowed; more spoil "
                          "it.",
           .reference = silence,
           .tags = {"must"},
           .catches = {{"gaps_of_three_characters", "takes_long_gap"},
                       {"gaps_of_one_character", "refuses_short_gap"},
                       {"counts_octets_only", "takes_long_gap"}}},
          {{4 * kGapsInFrame.size(), 4 * kGapsInFrame.size()},
           {stimulus("a write with a gap of 0.5 to 10 characters in front of each octet", send_with_gap),
            expected("it is taken up to 1.4 characters, and ignored from 1.6 on", expect_short_gaps_taken),
            serves()}}),
      on_chart(
          {.id = "valve_bus/node/framing/long_silences_end_a_frame",
           .purpose = "RN-15",
           .requirement = "However long it lasts, silence ends a frame, and what comes then is a new one.",
           .reference = silence,
           .tags = {"must"},
           .catches = {{"gap_timer_of_16_bits", "joins_frames"},
                       {"deaf_after_a_minute", "write_not_taken"},
                       {"delimiter_timer_of_16_bits", "write_not_taken"}},
           // Its valves stand still.
           .not_applicable = for_answer("loss_limit", kernel::Duration{})},
          {{kTimerPeriods.size(), kTimerPeriods.size()},
           {stimulus(
                "a write of all valves with 65.536 ms, 256 ms, 65.536 s, 2147.5 s or 4295.0 s and half a "
                "character of silence in it",
                send_around_a_timer),
            ignored("joins_frames", "silence ends a frame"), valves_on(), taken(),
            stimulus("as much silence",
                     [](NodeScene& scene) { scene.bench.wait(kTimerPeriods.at(scene.round)); }),
            read(), answered(),
            stimulus("a write, 2.5 characters more than as much silence, and another", write_after_a_timer),
            taken(), serves()}},
          {.loss_limit = kernel::Duration{}}),
      on_chart(
          {.id = "valve_bus/node/framing/joined_frames_are_no_write",
           .purpose = "RN-16",
           .requirement = "The response of one node and the poll of node 1 after it are not taken "
                          "for a write, although their octets are one.",
           .reference = valve_sources::calculated("ID 0 ID 1 1 has a block check that fits"),
           .tags = {"must", "hazard"},
           .catches = {{"counts_octets_only", "joins_frames"}}},
          {{2, 2},
           {stimulus("a response that begins with the node's ID and a poll of node 1, without and with a "
                     "delimiter between them",
                     send_response_and_poll),
            expected("no valve moves and no answer but of node 1", expect_not_joined), serves()}}),
      on_chart({.id = "valve_bus/node/framing/own_frame_behind_a_response_is_taken",
                .purpose = "RN-17",
                .requirement = "What other nodes answer does not keep a node from hearing its own frame.",
                .reference = valve_sources::derived("nodes in parallel on one pair receive each other"),
                .tags = {"must"},
                .catches = {{"deaf_behind_response", "write_not_taken"}}},
               {{3, 50},
                {stimulus("a response of another node and a delimiter", send_response_of_another),
                 moving_write(), taken()}}),
  };
}

}  // namespace fieldproof::conformance
