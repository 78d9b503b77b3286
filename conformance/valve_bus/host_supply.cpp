#include <utility>
#include <vector>

#include "conformance/valve_bus/host_scene.hpp"

// What is under way when the supply of a host goes is gone with it.
namespace fieldproof::conformance {
namespace {

using valve_bus::Command;
using valve_bus::HostCounters;
using valve_bus::HostErrorKind;

constexpr std::string_view kSurvived = "remembers_over_power_loss";

// One, two or three octets, of another command in each round.
void write_a_part(HostScene& scene) {
  const Command read = scene.bench.read_of(scene.other, 0x11, 0x22);
  const std::vector<std::uint8_t> octets{read.id, read.command, read.data0, read.data1};
  scene.bench.write(std::span(octets).first(1 + scene.round % 3));
}

void expect_whole_command_served(HostScene& scene) {
  HostBench& bench = scene.bench;
  scene.order(bench.read_of(scene.id));
  expect_request(bench, scene.judge, scene.command, kSurvived);
  const valve_bus::Response response = bench.random_response();
  bench.answer(response);
  expect_response(bench, scene.judge, scene.id, response);
  const kernel::Duration limit = scene.bench.rules().partial_command_limit * 6 / 5;
  expect_nothing_told(scene.bench, scene.judge, limit, kSurvived,
                      "the part of a command went with the supply");
}

void say_a_frame(HostScene& scene) {
  scene.bench.say(host_chart::right_octets(scene));
  scene.bench.wait(scene.bench.characters(7));
}

void expect_counters_at_zero(HostScene& scene) {
  scene.judge.expect(scene.bench.counters(scene.id) == HostCounters{}, kSurvived, "the counters stand at 0",
                     "what came after power-up was counted");
}

void expect_no_read_back(HostScene& scene) {
  const auto frame = scene.bench.next_frame(scene.bench.rules().refresh * 3);
  scene.judge.expect(!frame, kSurvived, [&] {
    return Mismatch{{"nothing is sent after power-up"}, "it sent a frame", frame->start};
  });
  expect_nothing_told(scene.bench, scene.judge, {}, kSurvived, "nothing was ordered");
  // What it sent at once after power-up nobody answered.
  scene.judge.expect(scene.bench.counters(scene.command.id) == HostCounters{}, kSurvived,
                     "the counters of the node that was written to stand at 0: it was not read",
                     "they do not");
}

}  // namespace

std::vector<HostCase> host_supply_cases() {
  using namespace host_chart;
  const judge::Reference own = valve_sources::own("power-up is the only reset");
  return {
      on_chart({.id = "valve_bus/host/supply/takes_a_part_of_a_command",
                .purpose = "RH-38",
                .requirement = "A part of a command is gone with the supply: the first octet after power-up "
                               "begins a command, and nothing is reported of the part.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"part_over_power_loss", std::string(kSurvived)}},
                .not_applicable = for_switched_power()},
               {{3, 30},
                {stimulus("the PC writes one, two or three octets of a command", write_a_part),
                 power_cycled(),
                 {"the PC orders a read, and the node answers",
                  "it is sent as it was ordered and served, and nothing else is reported",
                  expect_whole_command_served}}}),
      on_chart({.id = "valve_bus/host/supply/takes_a_failed_attempt",
                .purpose = "RH-38",
                .requirement = "What comes after power-up is not late: the attempt was before it.",
                .reference = own,
                .tags = {"must", "timing"},
                .catches = {{"late_over_power_loss", std::string(kSurvived)}},
                .not_applicable = for_switched_power()},
               {{2, 20},
                {read(), polled_again(), polled_again(), error(HostErrorKind::no_response), power_cycled(),
                 stimulus("a frame comes", say_a_frame),
                 expected("no counter has moved", expect_counters_at_zero)}}),
      on_chart(
          {.id = "valve_bus/host/supply/takes_a_verification",
           .purpose = "RH-38",
           .requirement = "With the option, a read that was to follow a write is gone with the supply.",
           .reference = own,
           .tags = {"must", "option", "timing"},
           .catches = {{"verification_over_power_loss", std::string(kSurvived)}},
           .not_applicable = for_both(for_switched_power(), for_quick_frames(4))},
          {{2, 20},
           {write(), power_cycled(), expected("nothing is sent, reported or counted", expect_no_read_back)}},
          {.acknowledged_writes = false, .verifies_writes = true}),
  };
}

}  // namespace fieldproof::conformance
