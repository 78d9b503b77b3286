#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/valve_bus/characters_item.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// What a line does to characters: wrong bits, breaks, glitches, noise, and others that talk at once.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;

// The frame with level `level` of character `at` inverted.
void send_with_wrong_level(NodeBench& bench, std::span<const std::uint8_t> frame, std::size_t at,
                           std::size_t level) {
  for (std::size_t n = 0; n < frame.size(); ++n) {
    line::Waveform wave;
    wave.rate = bench.rules().bit_rate;
    wave.levels = bench.levels_of(frame[n]);
    if (n == at) wave.levels.flip(level);
    bench.drive(wave);
  }
  bench.await_response_window();
}

std::size_t stop_level(const NodeBench& bench) {
  return character_format(bench.rules()).bits_before_stop();
}

void a_missing_stop_bit_spoils_the_frame(NodeBench& bench, CaseJudge& judge) {
  for (std::size_t at = 0; at < valve_bus::kCommandOctets; ++at) {
    send_with_wrong_level(bench, bench.telling_write(), at, stop_level(bench));
    expect_ignored(bench, judge, "takes_frame_without_stop_bit", fmt::format("octet {} has no stop bit", at));
    expect_serves(bench, judge);
  }
}

void a_wrong_parity_spoils_the_frame(NodeBench& bench, CaseJudge& judge) {
  expect_serves(bench, judge);
  for (std::size_t at = 0; at < valve_bus::kCommandOctets; ++at) {
    send_with_wrong_level(bench, bench.telling_write(), at, stop_level(bench) - 1);
    expect_ignored(bench, judge, "takes_wrong_parity", fmt::format("octet {} has a wrong parity", at));
    expect_serves(bench, judge);
  }
}

void the_ninth_bit_is_not_looked_at(NodeBench& bench, CaseJudge& judge) {
  for (std::size_t at = 0; at < valve_bus::kCommandOctets; ++at) {
    bench.clear_observations();
    const auto frame = bench.telling_write();
    send_with_wrong_level(bench, frame, at, stop_level(bench) - 1);
    expect_valves(bench, judge, bench.valves_of(frame[2], frame[3]), "ninth_bit_looked_at");
  }
}

void a_break_is_no_frame(NodeBench& bench, CaseJudge& judge) {
  for (const kernel::Duration time : {kernel::kMillisecond, 10 * kernel::kMillisecond, kernel::kSecond}) {
    // Shorter than a character it would be one.
    const kernel::Duration length = std::max(time, bench.characters(4));
    line::Waveform wave;
    wave.rate = bench.rules().bit_rate;
    wave.levels.append_fill(false, static_cast<std::size_t>(kernel::levels_within(length, wave.rate)));
    bench.drive(wave);
    bench.wait(bench.delimiter() + kernel::kMicrosecond);
    expect_ignored(bench, judge, "acts_on_break", "a low line says nothing");
    const auto frame = bench.telling_write();
    bench.send(frame);
    bench.await_response_window();
    expect_valves(bench, judge, bench.valves_of(frame[2], frame[3]), "does_not_recover");
    bench.clear_observations();
    expect_serves(bench, judge);
  }
}

// A low pulse of so many tenths of a bit, then a frame as long after it as a delimiter, or at once.
void glitch(NodeBench& bench, unsigned tenths) {
  line::Waveform wave;
  wave.rate = 10 * bench.rules().bit_rate;
  wave.levels.append_fill(false, tenths);
  wave.levels.append_idle(10);
  bench.drive(wave);
}

void glitches_are_no_start_bits(NodeBench& bench, CaseJudge& judge) {
  for (const unsigned tenths : {1U, 2U, 3U, 4U}) {
    bench.clear_observations();
    glitch(bench, tenths);
    const auto frame = bench.telling_write();
    bench.send(frame);
    bench.await_response_window();
    expect_valves(bench, judge, bench.valves_of(frame[2], frame[3]), "takes_glitch_for_start_bit");
  }
  for (const unsigned tenths : {6U, 7U, 9U}) {
    bench.clear_observations();
    glitch(bench, tenths);
    bench.send(bench.telling_write());
    bench.await_response_window();
    // It may be a character or none; what follows is a frame of its own in no case.
    expect_serves(bench, judge);
  }
}

// Random levels on a line that nobody drives. They hold a valid frame for the node once in some 2^40
// characters: the case sends some thousands.
void noise_is_no_frame(NodeBench& bench, CaseJudge& judge) {
  bench.write(0x5A, 0xA5);
  bench.await_response_window();
  bench.clear_observations();
  for (int n = 0; n < bench.volume(10, 200); ++n) {
    line::Waveform wave;
    wave.rate = bench.rules().bit_rate * (bench.random().chance(0.5) ? 1 : 7);
    for (int word = 0; word < 40; ++word) wave.levels.append(bench.random().next(), 64);
    bench.drive(wave);
    bench.wait(bench.characters(static_cast<double>(bench.random().below(8))));
    expect_ignored(bench, judge, "acts_on_noise", "nobody drives the line");
  }
  expect_serves(bench, judge);
}

void a_command_into_an_answer_is_not_taken(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(8, 100); ++n) {
    bench.clear_observations();
    const kernel::Time end = bench.read();
    // Up to where an answer has begun.
    kernel::Time latest = end + bench.delimiter() + turnaround_time_span(bench.rules());
    while (bench.now() < latest && !bench.has_driven()) bench.wait(5 * kernel::kMicrosecond);
    judge.expect(bench.has_driven(), "no_answer", "one answer", "the node did not say anything");
    bench.wait(bench.bits(1) + kernel::Duration{bench.random().between(0, bench.characters(1).count())});
    bench.interject(bench.telling_write(), bench.now());
    bench.wait(bench.characters(6));
    bench.await_response_window();
    expect_no_valve_moved(bench, judge, "acts_on_garbled_command", "it was sent into the node's own answer");
    judge.expect(bench.answers().front().driver_off < bench.now() - bench.characters(2),
                 "driver_not_released", "the driver goes off after the answer", "it is on");
    expect_serves(bench, judge);
  }
}

void a_collision_does_not_change_the_node(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(8, 100); ++n) {
    bench.clear_observations();
    const auto switches = static_cast<std::uint16_t>(bench.random().below(0x10000));
    bench.boards().set_input(0, switches);
    const kernel::Time end = bench.read();
    const kernel::Time latest = end + bench.delimiter() + turnaround_time_span(bench.rules());
    while (bench.now() < latest && !bench.has_driven()) bench.wait(5 * kernel::kMicrosecond);
    bench.interject(octets_of(valve_bus::Response{bench.random_octet(), bench.random_octet()}), bench.now());
    bench.await_response_window();
    expect_answer(bench, judge, switches, end);
    expect_no_valve_moved(bench, judge, "acts_on_garbled_command", "two nodes answered at once");
    expect_serves(bench, judge);
  }
}

}  // namespace

std::vector<NodeCase> node_line_cases() {
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/line/missing_stop_bit_spoils_the_frame",
                    .purpose = "RN-22",
                    .requirement = "A character without its stop bit spoils the frame that it stands in.",
                    .reference = valve_sources::own("the stop bit is looked at"),
                    .stimulus = "Writes with the stop bit of each character missing in turn.",
                    .expected = "No valve moves; the node serves what follows.",
                    .tags = {"must"},
                    .catches = {{"stop_bit_ignored", "takes_frame_without_stop_bit"}}},
                   a_missing_stop_bit_spoils_the_frame});
  cases.push_back(
      {{.id = "valve_bus/node/line/wrong_parity_spoils_the_frame",
        .purpose = "RN-23",
        .requirement = "With parity, a character with a wrong one spoils its frame.",
        .reference = valve_sources::own("character format P1"),
        .stimulus = "Right frames; then writes with the parity of each character wrong in turn.",
        .expected = "The right ones are served, the others are not.",
        .tags = {"must"},
        .catches = {{"parity_inverted", "does_not_recover"}, {"parity_ignored", "takes_wrong_parity"}},
        .not_applicable = for_characters("P1")},
       a_wrong_parity_spoils_the_frame,
       {.characters = CharacterProfile::even_parity}});
  cases.push_back({{.id = "valve_bus/node/line/ninth_bit_is_not_looked_at",
                    .purpose = "RN-24",
                    .requirement = "With nine bits, receivers do not look at the ninth.",
                    .reference = valve_sources::own("character format P0"),
                    .stimulus = "Writes with the ninth bit of each character 0 in turn.",
                    .expected = "They are taken.",
                    .tags = {"must"},
                    .catches = {{"ninth_bit_required", "ninth_bit_looked_at"}},
                    .not_applicable = for_characters("P0")},
                   the_ninth_bit_is_not_looked_at,
                   {.characters = CharacterProfile::ninth_bit_one}});
  cases.push_back(
      {{.id = "valve_bus/node/line/break_is_no_frame",
        .purpose = "RN-25",
        .requirement = "A line that is low says nothing, and a delimiter after it the node receives "
                       "again.",
        .reference = valve_sources::own("recovery within a delimiter"),
        .stimulus = "The line low for 1 ms, 10 ms and 1 s; a delimiter; a write.",
        .expected = "Nothing happens by the break, and the write is taken.",
        .tags = {"must"},
        .catches = {{"locks_up_after_break", "does_not_recover"}}},
       a_break_is_no_frame});
  cases.push_back({{.id = "valve_bus/node/line/glitches_are_no_start_bits",
                    .purpose = "RN-26",
                    .requirement = "A low pulse shorter than half a bit is no start bit; a longer one costs "
                                   "the frame after it at most.",
                    .reference = valve_sources::derived("three samples in the middle of the start bit, two "
                                                        "of which must be low"),
                    .stimulus = "Low pulses of 0.1 to 0.9 bit right in front of a write.",
                    .expected = "Up to 0.4 bit the write is taken; after the longer ones the next is.",
                    .tags = {"must"},
                    .catches = {{"start_bit_not_validated", "takes_glitch_for_start_bit"}}},
                   glitches_are_no_start_bits});
  cases.push_back({{.id = "valve_bus/node/line/noise_is_no_frame",
                    .purpose = "RN-31",
                    .requirement = "Noise on a line that nobody drives moves no valve and is not answered.",
                    .reference = valve_sources::own("what is no frame is ignored"),
                    .stimulus = "Random levels, of the length of a bit and shorter, in pieces.",
                    .expected = "No valve moves and no answer; then the node serves.",
                    .tags = {"must"},
                    .catches = {{"valves_off_on_wrong_check", "acts_on_noise"}}},
                   noise_is_no_frame});
  cases.push_back({{.id = "valve_bus/node/line/command_into_an_answer_is_not_taken",
                    .purpose = "RN-21",
                    .requirement = "What is sent into a node's own answer is not taken; the node lets go of "
                                   "the line and serves again.",
                    .reference = valve_sources::derived("one pair, half duplex"),
                    .stimulus = "A write that begins in the middle of an answer.",
                    .expected = "No valve moves, the driver goes off, the next frames are served.",
                    .tags = {"must"},
                    .catches = {{"hears_while_driving", "acts_on_garbled_command"}}},
                   a_command_into_an_answer_is_not_taken});
  cases.push_back({{.id = "valve_bus/node/line/collision_does_not_change_the_node",
                    .purpose = "RN-36",
                    .requirement = "When a second node answers at once, the first one does what it would do "
                                   "alone.",
                    .reference = valve_sources::derived("nodes cannot see that two have one address"),
                    .stimulus = "Another answer into the node's own.",
                    .expected = "Its answer is whole; it serves what follows.",
                    .tags = {"must"},
                    .catches = {{"gives_up_on_collision", "does_not_recover"}}},
                   a_collision_does_not_change_the_node});
  return cases;
}

}  // namespace fieldproof::conformance
