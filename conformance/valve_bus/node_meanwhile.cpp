#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "conformance/valve_bus/node_scene.hpp"

// What happens while something else is going on: the time without a host is over within a frame or an answer,
// a frame is begun within an answer; and what is no right command, in each way to be none, as a sign of life.
namespace fieldproof::conformance {
namespace {

using SpoiltFrame = std::vector<std::uint8_t>;

constexpr kernel::Duration kMeanwhileLimit = 500 * kernel::kMillisecond;
constexpr std::int64_t kSlowBitRate = 1'200;

void pass_until(NodeBench& bench, kernel::Time when) {
  bench.wait(std::max(kernel::Duration{}, when - bench.now()));
}

// ---- the time is over within a frame ----

// How many characters of a frame have gone by when the valves go off; beyond five it is the silence after it.
constexpr std::array kPlaces{0.5, 1.5, 2.5, 3.5, 4.5, 6.5};

// Nobody knows when exactly a node lets go: it is asked once, and the frame is put there.
void send_frame_into_the_loss(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  const kernel::Duration limit = bench.rules().loss_limit;
  pass_until(bench, scene.end + limit * 11 / 10);
  expect_valves(bench, scene.judge, 0, "valves_hold_without_host");
  const kernel::Duration loss = bench.boards().changes().back().when - scene.end;
  scene.send(scene.write(0x5A, 0xA5));
  expect_valves(bench, scene.judge, scene.valves(), "write_not_taken");
  const double place = kPlaces.at(scene.round / 2 % kPlaces.size());
  pass_until(bench, scene.end + loss - bench.characters(place));
  scene.send(scene.round % 2 == 0 ? scene.command(bench.rules().read_command) : scene.write(0x3C, 0xC3));
}

void expect_frame_served(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  if (scene.round % 2 == 0) {
    expect_answer(bench, scene.judge, scene.switches, scene.end);
    return;
  }
  expect_valves(bench, scene.judge, scene.valves(), "write_not_taken");
  pass_until(bench, scene.end + bench.rules().loss_limit * 9 / 10);
  expect_valves(bench, scene.judge, scene.valves(), "valves_let_go");
}

NodeCase loss_within_a_frame() {
  using namespace node_chart;
  constexpr unsigned kRounds = 2 * kPlaces.size();
  return on_chart(
      {.id = "valve_bus/node/loss/within_a_frame_changes_nothing_of_it",
       .purpose = "RN-42",
       .requirement = "A frame within which the valves go off for want of a host is taken as any other.",
       .reference = valve_sources::own("loss of the host: valves go off, and nothing else"),
       .tags = {"must"},
       .catches = {{"loss_drops_the_frame", "no_answer"}},
       .not_applicable = for_answer("loss_limit", kMeanwhileLimit)},
      {{kRounds, kRounds},
       {valves_on(), taken(),
        stimulus("no command until the valves are off; the write again; a read or a write of which half an "
                 "octet to all, and some of the silence after it, is over when they go off",
                 send_frame_into_the_loss),
        expected("the read is answered; the write is driven, and held for 0.9 times the limit",
                 expect_frame_served),
        serves()}},
      {.loss_limit = kMeanwhileLimit});
}

// ---- the time is over within an answer, or while one waits ----

// Shorter than what goes on between a read and the end of its answer: 33 to 81 ms at 1200 bit/s.
NodeCase loss_within_an_answer(std::int64_t milliseconds, std::vector<MustCatch> catches) {
  using namespace node_chart;
  const kernel::Duration limit = milliseconds * kernel::kMillisecond;
  return on_chart(
      {.id = fmt::format("valve_bus/node/loss/of_{}_ms_leaves_answers_whole", milliseconds),
       .purpose = "RN-42",
       .requirement =
           "An answer that waits, or that is being sent, when the time without a host is over is sent "
           "as any other.",
       .reference = valve_sources::own("loss of the host: valves go off, and nothing else"),
       .tags = {"must"},
       .catches = std::move(catches),
       .not_applicable = for_both(for_answer("loss_limit", limit), for_answer("bit_rate", kSlowBitRate))},
      {{4, 20}, {read(), answered()}}, {.bit_rate = kSlowBitRate, .loss_limit = limit});
}

// ---- what is no right command ----

struct NoCommand {
  void (*send)(NodeScene&);
};

void send_with_gap(NodeScene& scene, const SpoiltFrame& frame, std::size_t place) {
  constexpr double kGap = 2.0;  // characters; 1.5 are allowed
  scene.bench.send(std::span(frame).first(place));
  scene.bench.wait(scene.bench.characters(kGap));
  scene.bench.send(std::span(frame).subspan(place));
}
SpoiltFrame read_of(const NodeScene& scene) {
  return scene.command(scene.bench.address(), scene.bench.rules().read_command, 0, 0);
}
void send_longer(NodeScene& scene, SpoiltFrame frame) {
  frame.push_back(0);
  scene.bench.send(frame);
}

// None moves a valve, even if it is taken: only when they go off tells.
constexpr std::array kNoCommands{
    NoCommand{[](NodeScene& scene) { send_longer(scene, scene.frame); }},
    NoCommand{[](NodeScene& scene) { send_longer(scene, read_of(scene)); }},
    NoCommand{[](NodeScene& scene) { scene.bench.send(std::span(scene.frame).first(4)); }},
    NoCommand{[](NodeScene& scene) { send_with_gap(scene, scene.frame, 1); }},
    NoCommand{[](NodeScene& scene) { send_with_gap(scene, scene.frame, 3); }},
    NoCommand{[](NodeScene& scene) { send_with_gap(scene, read_of(scene), 4); }},
    NoCommand{[](NodeScene& scene) { scene.write_with_wrong_level(scene.stop_level()); }},
    NoCommand{[](NodeScene& scene) {
      constexpr double kTooShort = 3.3;  // of 3.5 characters
      const std::array<std::uint8_t, 1> octet{0x55};
      scene.bench.send(octet);
      scene.bench.wait(scene.bench.characters(kTooShort));
      scene.bench.send(scene.frame);
    }},
};

void expect_no_sign_of_life(NodeScene& scene, void (*send)(NodeScene&)) {
  NodeBench& bench = scene.bench;
  const kernel::Time since = scene.end;
  const std::uint16_t valves = scene.valves();
  const kernel::Duration limit = bench.rules().loss_limit;
  pass_until(bench, since + limit * 7 / 10);
  send(scene);
  pass_until(bench, since + limit * 9 / 10);
  expect_valves(bench, scene.judge, valves, "valves_let_go");
  pass_until(bench, since + limit * 11 / 10);
  expect_valves(bench, scene.judge, 0, "valves_hold_without_host");
  bench.clear_observations();
}

Applicability where_commands_fit() {
  const auto at_rate = [](const judge::Pics& pics) -> std::optional<std::string> {
    constexpr std::int64_t kLeast = 62'500;
    if (pics.number("bit_rate", kLeast) >= kLeast) return std::nullopt;
    return "commands take too long at this bit rate";
  };
  return for_both(for_answer("loss_limit", kMeanwhileLimit), at_rate);
}

NodeCase no_right_command() {
  using namespace node_chart;
  return on_chart(
      {.id = "valve_bus/node/loss/spoilt_commands_are_no_signs_of_life",
       .purpose = "RN-42",
       .requirement = "What is no right command, in whatever way, delays nothing: the valves go off when "
                      "they would without it.",
       .reference = valve_sources::own("loss of the host: counts from right commands"),
       .tags = {"must"},
       .catches = {{"kept_alive_by_long_frames", "valves_hold_without_host"},
                   {"kept_alive_by_short_frames", "valves_hold_without_host"},
                   {"kept_alive_by_frames_with_gaps", "valves_hold_without_host"},
                   {"kept_alive_by_wrong_characters", "valves_hold_without_host"}},
       .not_applicable = where_commands_fit()},
      {{kNoCommands.size(), kNoCommands.size()},
       {valves_on(),
        taken(),
        {"at 0.7 times the limit a write and a read with an octet more, a write with one less, with a gap "
         "of 2 characters, without a stop bit, 3.3 characters after an octet",
         "the valves hold for 0.9 times the limit after the write, and are off after 1.1 times",
         [](NodeScene& scene) {
           expect_no_sign_of_life(scene, kNoCommands.at(scene.round % kNoCommands.size()).send);
         }},
        serves()}},
      {.loss_limit = kMeanwhileLimit});
}

NodeCase wrong_parity_is_no_command() {
  using namespace node_chart;
  constexpr unsigned kRounds = valve_bus::kCommandOctets;
  return on_chart({.id = "valve_bus/node/loss/wrong_parity_is_no_sign_of_life",
                   .purpose = "RN-42",
                   .requirement = "A command of which a character has a wrong parity delays nothing.",
                   .reference = valve_sources::own("loss of the host: counts from right commands"),
                   .tags = {"must"},
                   .catches = {{"kept_alive_by_wrong_characters", "valves_hold_without_host"}},
                   .not_applicable = for_both(where_commands_fit(), for_characters("P1"))},
                  {{kRounds, kRounds},
                   {valves_on(),
                    taken(),
                    {"at 0.7 times the limit a write with the parity of each character wrong in turn",
                     "the valves hold for 0.9 times the limit after the write, and are off after 1.1 times",
                     [](NodeScene& scene) {
                       expect_no_sign_of_life(
                           scene, [](NodeScene& one) { one.write_with_wrong_level(one.stop_level() - 1); });
                     }},
                    serves()}},
                  {.characters = valve_bus::CharacterProfile::even_parity, .loss_limit = kMeanwhileLimit});
}

// ---- what goes on behind an answer ----

// When the node answers is taken from the answer before. Octets in front of the write begin within the
// answer, the write half a character behind its last stop bit, where the driver is off; there is no silence
// in it. Of a node that answers at another time than before it is a frame that is too long all the same.
void write_on_behind_the_answer(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  const kernel::Duration last_stop = scene.answer.characters.back().busy_until - scene.end;
  const unsigned in_front = 1 + scene.round % 3;
  SpoiltFrame octets(in_front, 0xFF);
  scene.frame = scene.moving_write();
  octets.insert(octets.end(), scene.frame.begin(), scene.frame.end());
  bench.clear_observations();
  scene.end = bench.read();
  const kernel::Time begin = scene.end + last_stop + bench.characters(0.5 - in_front);
  pass_until(bench, begin);
  bench.send(octets);
  bench.await_response_window();
}

NodeCase behind_an_answer() {
  using namespace node_chart;
  return on_chart(
      {.id = "valve_bus/node/line/what_goes_on_behind_an_answer_is_no_frame",
       .purpose = "RN-21",
       .requirement = "What is begun within a node's own answer and goes on behind it without a delimiter "
                      "is one thing, of which nothing is a frame.",
       .reference = valve_sources::own("a frame begins after 3.5 characters of silence"),
       .tags = {"must"},
       .catches = {{"takes_what_goes_on_behind_answers", "acts_on_what_goes_on"}}},
      {{6, 60},
       {read(), answered(),
        stimulus("a read, and without a gap 1 to 3 octets begun within its answer and a write behind it",
                 write_on_behind_the_answer),
        no_valve_moved("acts_on_what_goes_on", "no silence is in front of it"), serves()}});
}

}  // namespace

std::vector<NodeCase> node_meanwhile_cases() {
  return {loss_within_a_frame(),
          loss_within_an_answer(
              5, {{"loss_cuts_answers", "answer_length_wrong"}, {"loss_cancels_answers", "no_answer"}}),
          loss_within_an_answer(12, {{"loss_cuts_answers", "answer_length_wrong"}}),
          no_right_command(),
          wrong_parity_is_no_command(),
          behind_an_answer()};
}

}  // namespace fieldproof::conformance
