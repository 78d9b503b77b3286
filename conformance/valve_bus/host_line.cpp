#include <fmt/format.h>

#include <algorithm>

#include "conformance/valve_bus/host_scene.hpp"

// What a line does to a host: its own echo, lines that are stuck, and noise between the polls.
namespace fieldproof::conformance {
namespace {

// ID ^ COMMAND = DATA0 makes a response of the first three octets of a read.
void order_read_like_a_response(HostScene& scene) {
  HostBench& bench = scene.bench;
  const auto check = static_cast<std::uint8_t>(scene.id ^ bench.rules().read_command);
  scene.order(bench.read_of(scene.id, check, bench.random_octet()));
  scene.expect_sent();
}

kernel::Duration ordinary_time(HostScene& scene) {
  return scene.bench.turnaround_time();
}

kernel::Duration after_ordinary_time(HostScene& scene) {
  return ordinary_time(scene) + scene.bench.bits(1);
}

// So many breaks of a character, one after the other.
void hold_low(HostScene& scene, std::size_t breaks, std::size_t characters = 1) {
  line::Levels low;
  low.append_fill(false, characters * scene.bench.levels_of(0).size());
  for (std::size_t n = 0; n < breaks; ++n) {
    scene.bench.answer_levels(low, ordinary_time(scene) + scene.bench.characters(static_cast<double>(n)));
  }
}

void hold_low_for_three_characters(HostScene& scene) {
  scene.octets.assign(3, 0);
  scene.round == 0 ? hold_low(scene, 3) : hold_low(scene, 1, 3);
}

void keep_low(HostScene& scene) {
  const auto count = 3 * scene.bench.observation_timeout() / scene.bench.characters(1);
  hold_low(scene, static_cast<std::size_t>(count));
}

void expect_read_fails(HostScene& scene) {
  const auto told = scene.bench.next_told(2 * scene.bench.observation_timeout());
  scene.judge.expect(told.has_value(), "waits_for_ever", "an error is reported to the PC",
                     "nothing was reported");
  scene.judge.expect(std::holds_alternative<valve_bus::HostError>(told->what), "low_line_told",
                     fmt::format("an error of {:02X}", scene.id), text_of(*told));
}

void release(HostScene& scene) {
  scene.bench.wait(2 * scene.bench.observation_timeout());
}

// A node that talks on and on, with a write or a read waiting, through all attempts.
void talk_without_end(HostScene& scene) {
  HostBench& bench = scene.bench;
  const auto count = 5 * bench.time_out() / bench.characters(1) + 20;
  bench.answer(std::vector<std::uint8_t>(static_cast<std::size_t>(count), 0x55), {});
  bench.wait(bench.characters(3));
  scene.order(scene.round % 2 == 0 ? bench.write_to(3) : bench.read_of(4));
  bench.note_write(scene.command);  // it is refreshed
}

void keep_high(HostScene& scene) {
  const kernel::Duration length = scene.bench.observation_timeout();
  line::Levels high;
  high.append_idle(static_cast<std::size_t>(kernel::levels_within(length, scene.bench.rules().bit_rate)));
  scene.bench.answer_levels(high, scene.bench.bits(4));
}

void say_between_reads(HostScene& scene) {
  HostBench& bench = scene.bench;
  bench.wait(bench.characters(5) + bench.bits(static_cast<std::int64_t>(bench.random().below(100))));
  scene.octets.resize(1 + scene.round % 4);
  std::ranges::generate(scene.octets, [&] { return bench.random_octet(); });
  if (scene.octets.size() == valve_bus::kResponseOctets) scene.octets[2] = scene.octets[0] ^ scene.octets[1];
  bench.say(scene.octets);
}

// After a valid response as long as it takes to be reported; else the next read may come at once.
kernel::Duration time_to_report_noise(HostScene& scene) {
  const bool is_response = scene.octets.size() == valve_bus::kResponseOctets;
  return scene.bench.characters(is_response ? 8 : static_cast<double>(scene.bench.random().below(8)));
}

}  // namespace

std::vector<HostCase> host_line_cases() {
  using namespace host_chart;
  return {
      on_chart({.id = "valve_bus/host/line/echo_is_no_response",
                .purpose = "RH-13",
                .requirement = "A host that receives its own echo does not take it for a response.",
                .reference = valve_sources::calculated("ID ^ COMMAND = DATA0 is a valid response"),
                .tags = {"must", "hazard"},
                .catches = {{"echo_taken_as_response", "echo_told"}}},
               {{5, 200},
                {{"the PC orders a read of which the first three octets are a valid response, which the host "
                  "receives while it drives",
                  "the host sends it", order_read_like_a_response},
                 nothing_reported(ordinary_time, "echo_told", "no node has answered yet"),
                 answer("the node answers rightly", right_octets, after_ordinary_time),
                 reported()}},
               {.receives_own_echo = true}),
      on_chart({.id = "valve_bus/host/line/low_characters_are_no_response",
                .purpose = "RH-14",
                .requirement = "A line that is low as long as a response is none, although three octets "
                               "of zeros have a right check: their stop bits are missing.",
                .reference = valve_sources::own("the stop bit is looked at"),
                .tags = {"must", "hazard"},
                .catches = {{"stop_bits_not_looked_at", "low_line_told"}}},
               {{2, 2},
                {read(),
                 stimulus("the line is low for three characters, as three and as one break",
                          hold_low_for_three_characters),
                 refused("low_line_told", "a low line has no stop bits")}}),
      on_chart({.id = "valve_bus/host/line/stuck_low_line_is_an_error",
                .purpose = "RH-14",
                .requirement = "A line that stays low ends a read in an error, and the host serves again "
                               "when it is released.",
                .reference = valve_sources::own("the PC is never left without an answer"),
                .tags = {"must"},
                .catches = {{"waits_for_silence", "waits_for_ever"}}},
               {{1, 1},
                {read(), stimulus("the line stays low, longer than all attempts take", keep_low),
                 expected("the PC gets an error", expect_read_fails),
                 nothing_reported(kernel::kMillisecond, "low_line_told", "nothing was known of the node"),
                 stimulus("the line is released", release), recovers()}}),
      on_chart({.id = "valve_bus/host/line/talk_without_end_is_an_error",
                .purpose = "RH-40",
                .requirement =
                    "A command that finds a line that is not silent for a time-out is reported as an error.",
                .reference = valve_sources::own("the PC is never left without an answer"),
                .tags = {"must", "timing"},
                .catches = {{"waits_for_silence", "error_not_told"}, {"busy_told_as_silence", "error_wrong"}},
                .not_applicable = for_plain_writes()},
               {{2, 10},
                {stimulus("octets follow each other for five time-outs, and the PC orders a write, or a read",
                          talk_without_end),
                 error(valve_bus::HostErrorKind::line_busy), recovers()}}),
      on_chart({.id = "valve_bus/host/line/stuck_high_line_is_a_time_out",
                .purpose = "RH-15",
                .requirement = "A line that stays high is no response.",
                .reference = valve_sources::own("a character begins with a low start bit"),
                .tags = {"must"},
                .catches = {{"silence_told_as_data", "high_line_told"}}},
               {{1, 1},
                {read(), stimulus("the line is driven high", keep_high),
                 error(valve_bus::HostErrorKind::no_response, "high_line_told"),
                 nothing_reported(kernel::kMillisecond, "high_line_told", "nothing was known of the node"),
                 recovers()}}),
      on_chart({.id = "valve_bus/host/line/noise_between_polls_is_drained",
                .purpose = "RH-28",
                .requirement = "What is received between two polls is not reported and does not disturb "
                               "the next one.",
                .reference = valve_sources::own("what nobody asked for is drained"),
                .tags = {"must"},
                .catches = {{"keeps_stray_octets", "response_not_told"},
                            {"stray_told_as_response", "noise_told"}}},
               {{8, 300},
                {served_read(),
                 stimulus("one to four octets come between two reads, where they are three a valid response",
                          say_between_reads),
                 nothing_reported(time_to_report_noise, "noise_told", "nothing was asked"), served_read()}}),
  };
}

}  // namespace fieldproof::conformance
