#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "conformance/valve_bus/node_scene.hpp"
#include "harness/iut/misbehaviour.hpp"

// A node that is set to let go of its valves without a host: what it takes for a sign of life, and when.
namespace fieldproof::conformance {
namespace {

using Frame = std::vector<std::uint8_t>;

constexpr kernel::Duration kLimit = 500 * kernel::kMillisecond;
constexpr kernel::Duration kShortLimit = 8 * kernel::kMillisecond;

void wait_until(NodeBench& bench, kernel::Time when) {
  bench.wait(std::max(kernel::Duration{}, when - bench.now()));
}

void expect_held(NodeScene& scene, kernel::Time since, std::uint16_t valves) {
  wait_until(scene.bench, since + scene.bench.rules().loss_limit * 9 / 10);
  expect_valves(scene.bench, scene.judge, valves, "valves_let_go");
}

void expect_let_go(NodeScene& scene, kernel::Time since) {
  wait_until(scene.bench, since + scene.bench.rules().loss_limit * 11 / 10);
  expect_valves(scene.bench, scene.judge, 0, "valves_hold_without_host");
}

// ---- signs of life ----

struct SignOfLife {
  Frame (*frame)(const NodeScene&);
  bool is_one;
};

Frame own(const NodeScene& scene, unsigned command) {
  return scene.command(scene.bench.address(), command, 0xA5, 0x5A);
}
Frame for_another(const NodeScene& scene, unsigned command) {
  return scene.command(scene.bench.address() ^ 1U, command, 0xA5, 0x5A);
}
Frame with_wrong_check(Frame frame) {
  frame.back() ^= 0x01;
  return frame;
}

constexpr std::array kSigns{
    SignOfLife{[](const NodeScene& scene) { return own(scene, scene.bench.rules().write_command); }, true},
    SignOfLife{[](const NodeScene& scene) { return own(scene, scene.bench.rules().read_command); }, true},
    SignOfLife{[](const NodeScene& scene) { return own(scene, 2); }, true},
    SignOfLife{[](const NodeScene& scene) { return own(scene, 0xFF); }, true},
    SignOfLife{[](const NodeScene& scene) { return for_another(scene, scene.bench.rules().write_command); },
               false},
    SignOfLife{[](const NodeScene& scene) { return for_another(scene, scene.bench.rules().read_command); },
               false},
    SignOfLife{[](const NodeScene& scene) {
                 return with_wrong_check(own(scene, scene.bench.rules().write_command));
               },
               false},
    SignOfLife{
        [](const NodeScene& scene) { return with_wrong_check(own(scene, scene.bench.rules().read_command)); },
        false},
    SignOfLife{[](const NodeScene& scene) { return Frame{scene.bench.address()}; }, false},
    SignOfLife{[](const NodeScene&) { return Frame{0x12, 0x34, 0x26}; }, false},
    // The write that the valves stand by already.
    SignOfLife{[](const NodeScene& scene) { return scene.frame; }, true},
};

void expect_signs_of_life(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  const SignOfLife& sign = kSigns.at(scene.round);
  kernel::Time since = scene.end;
  std::uint16_t valves = scene.valves();
  wait_until(bench, since + bench.rules().loss_limit * 7 / 10);
  scene.send_next(sign.frame(scene));
  if (sign.is_one) since = scene.end;
  if (sign.is_one && scene.frame[1] == bench.rules().write_command) valves = scene.valves();
  expect_held(scene, since, valves);
  expect_let_go(scene, since);
  bench.clear_observations();
}

NodeStep signs_of_life() {
  return {
      "at 0.7 times the limit a write, a read, undefined commands; commands for another node, such with a "
      "wrong check, an octet, a response; the write of before",
      "the valves hold for 0.9 times the limit after the last right command, and are off after 1.1 times",
      expect_signs_of_life};
}

void send_to_others_until_it_is_over(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  const kernel::Time since = scene.end;
  const Frame frame = for_another(scene, bench.rules().write_command);
  wait_until(bench, since + bench.rules().loss_limit * 8 / 10);
  while (bench.now() < since + bench.rules().loss_limit * 11 / 10) {
    bench.send(frame);
    bench.wait(bench.delimiter() + bench.bits(1));
  }
}

// ---- limits ----

void expect_limit(NodeScene& scene) {
  const std::uint16_t valves = scene.valves();
  expect_held(scene, scene.end, valves);
  expect_let_go(scene, scene.end);
}

// Commands and what they need have to fit into the limit many times.
Applicability for_least_bit_rate(std::int64_t slowest) {
  return [slowest](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.number("bit_rate", slowest) >= slowest) return std::nullopt;
    return "commands take too long at this bit rate";
  };
}
Applicability for_quick_line() {
  return for_least_bit_rate(62'500);
}

NodeCase limit_case(std::string name, kernel::Duration limit, std::vector<MustCatch> catches) {
  using namespace node_chart;
  return on_chart(
      {.id = "valve_bus/node/loss/limit_of_" + name,
       .purpose = "RN-42",
       .requirement =
           fmt::format("A node that is set to {} switches its valves off so long after the last command, "
                       "each time, and takes the next command.",
                       kernel::describe(limit)),
       .reference = valve_sources::own("loss of the host: a time after which valves go off"),
       .tags = {"must"},
       .catches = std::move(catches),
       .not_applicable =
           for_both(for_answer("loss_limit", limit), for_least_bit_rate(limit < kLimit ? 250'000 : 0))},
      {{2, 4},
       {stimulus("",
                 [](NodeScene& scene) {
                   const kernel::Duration set = scene.bench.rules().loss_limit;
                   if (scene.bench.capabilities().is_wall_clock && (set > kernel::kSecond || set < kLimit))
                     throw iut::CannotBeDone("a real line takes as long as that, or is too slow for it");
                 }),
        valves_on(), taken(),
        expected("the valves hold for 0.9 times the limit, and are off after 1.1 times", expect_limit),
        serves()}},
      {.loss_limit = limit});
}

}  // namespace

std::vector<NodeCase> node_loss_cases() {
  using namespace node_chart;
  return {
      on_chart(
          {.id = "valve_bus/node/loss/commands_to_it_are_signs_of_life",
           .purpose = "RN-42",
           .requirement =
               "The time after which valves go off counts from each right command to the node, a read and "
               "an undefined one as well; what is for others, or wrong, does not count.",
           .reference = valve_sources::own("loss of the host: a time after which valves go off"),
           .tags = {"must"},
           .catches = {{"kept_alive_by_others", "valves_hold_without_host"},
                       {"kept_alive_by_wrong_frames", "valves_hold_without_host"},
                       {"not_kept_alive_by_reads", "valves_let_go"},
                       {"not_kept_alive_by_undefined_commands", "valves_let_go"},
                       {"not_kept_alive_by_equal_writes", "valves_let_go"},
                       {"lets_go_once", "valves_hold_without_host"},
                       {"lets_go_of_one_board", "valves_hold_without_host"}},
           .not_applicable = for_both(for_answer("loss_limit", kLimit), for_quick_line())},
          {{kSigns.size(), kSigns.size()}, {valves_on(), taken(), signs_of_life(), serves()}},
          {.loss_limit = kLimit}),
      on_chart(
          {.id = "valve_bus/node/loss/writes_that_are_answered_are_signs_of_life",
           .purpose = "RN-42",
           .requirement = "The time after which valves go off counts from each right command to a node that "
                          "answers writes, too.",
           .reference = valve_sources::own("loss of the host: a time after which valves go off"),
           .tags = {"must"},
           .catches = {{"not_kept_alive_by_answered_writes", "valves_let_go"}},
           .not_applicable = for_both(for_both(for_answer("loss_limit", kLimit), for_quick_line()),
                                      for_answer("answers_writes", true))},
          {{kSigns.size(), kSigns.size()}, {valves_on(), taken(), signs_of_life(), serves()}},
          {.answers_writes = true, .loss_limit = kLimit}),
      on_chart({.id = "valve_bus/node/loss/afterwards_the_node_serves_as_before",
                .purpose = "RN-42",
                .requirement = "A node whose valves went off without a host answers reads, leaves its valves "
                               "off until a write, and drives each write, also the one of before.",
                .reference = valve_sources::own("loss of the host: a time after which valves go off"),
                .tags = {"must"},
                .catches = {{"read_restores_valves", "valves_back_without_write"},
                            {"silent_without_host", "no_answer"},
                            {"equal_write_not_driven", "write_not_taken"}},
                .not_applicable = for_both(for_answer("loss_limit", kLimit), for_quick_line())},
               {{2, 4},
                {valves_on(), taken(),
                 expected("the valves are off after 1.1 times the limit",
                          [](NodeScene& scene) { expect_let_go(scene, scene.end); }),
                 read(), answered(), no_valve_moved("valves_back_without_write", "no write has come"),
                 valves_on(), taken(), serves()}},
               {.loss_limit = kLimit}),
      on_chart({.id = "valve_bus/node/loss/what_others_are_sent_delays_nothing",
                .purpose = "RN-42",
                .requirement = "The valves go off in time on a line that is never silent, too.",
                .reference = valve_sources::own("loss of the host: a time after which valves go off"),
                .tags = {"must"},
                .catches = {{"lets_go_in_silence_only", "valves_hold_without_host"}},
                .not_applicable = for_both(for_answer("loss_limit", kLimit), for_quick_line())},
               {{2, 10},
                {valves_on(), taken(),
                 stimulus("from 0.8 times the limit on commands for another node, a delimiter between them, "
                          "until 1.1 times",
                          send_to_others_until_it_is_over),
                 expected("the valves are off",
                          [](NodeScene& scene) {
                            expect_valves(scene.bench, scene.judge, 0, "valves_hold_without_host");
                          }),
                 serves()}},
               {.loss_limit = kLimit}),
      on_chart(
          {.id = "valve_bus/node/loss/is_in_effect_after_each_power_up",
           .purpose = "RN-42",
           .requirement = "The time after which valves go off is in effect after each power-up.",
           .reference = valve_sources::own("loss of the host: a time after which valves go off"),
           .tags = {"must"},
           .catches = {{"lets_go_after_the_first_power_up_only", "valves_hold_without_host"}},
           .not_applicable = for_both(for_answer("loss_limit", kLimit),
                                      for_item("power_can_be_switched", true, declared_node(),
                                               "the bench cannot switch the supply of the node"))},
          {{2, 4},
           {stimulus("power goes and comes",
                     [](NodeScene& scene) {
                       scene.bench.set_power(false);
                       scene.bench.wait(kernel::kMillisecond);
                       scene.bench.power_up();
                     }),
            valves_on(), taken(),
            expected("the valves hold for 0.9 times the limit, and are off after 1.1 times", expect_limit),
            serves()}},
          {.loss_limit = kLimit}),
      // Longer than a timer of 16 bits of milliseconds, and as long as can be.
      limit_case("8_milliseconds", kShortLimit, {{"loss_limit_at_least_10_ms", "valves_hold_without_host"}}),
      limit_case("70_seconds", 70 * kernel::kSecond, {{"loss_limit_in_16_bits", "valves_let_go"}}),
      limit_case("an_hour", 3'600 * kernel::kSecond, {{"lets_go_after_half_an_hour", "valves_let_go"}}),
  };
}

}  // namespace fieldproof::conformance
