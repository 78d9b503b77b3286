#include <algorithm>
#include <array>

#include "conformance/valve_bus/node_scene.hpp"

// What a line does to characters: wrong bits, breaks, glitches, noise, and others that talk at once.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;

// A character of zeros without a stop bit between two octets of a write, without a gap.
void write_with_a_break_inside(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  scene.frame = scene.moving_write();
  const std::size_t place = 1 + scene.round % (scene.frame.size() - 1);
  bench.send(std::span(scene.frame).first(place));
  line::Waveform low;
  low.rate = bench.rules().bit_rate;
  low.levels = bench.levels_of(0);
  low.levels.fill(0, scene.stop_level() + 1, false);
  bench.drive(low);
  bench.wait(bench.bits(1));
  scene.end = bench.send(std::span(scene.frame).subspan(place));
  bench.await_response_window();
}

void write_without_a_stop_bit(NodeScene& scene) {
  scene.write_with_wrong_level(scene.stop_level());
}

// Parity, or the ninth bit.
void write_with_wrong_last_bit(NodeScene& scene) {
  scene.write_with_wrong_level(scene.stop_level() - 1);
}

void hold_low(NodeScene& scene) {
  constexpr std::array kTimes{kernel::kMillisecond, 10 * kernel::kMillisecond, kernel::kSecond};
  line::Waveform wave;
  wave.rate = scene.bench.rules().bit_rate;
  // Shorter than a character it would be one.
  const kernel::Duration length = std::max(kTimes.at(scene.round), scene.bench.characters(4));
  wave.levels.append_fill(false, static_cast<std::size_t>(kernel::levels_within(length, wave.rate)));
  scene.bench.drive(wave);
  scene.bench.wait(scene.bench.delimiter() + kernel::kMicrosecond);
}

// A low pulse of so many tenths of a bit right in front of a write of all valves.
void write_after_pulse(NodeScene& scene, unsigned tenths) {
  line::Waveform wave;
  wave.rate = 10 * scene.bench.rules().bit_rate;
  wave.levels.append_fill(false, tenths);
  wave.levels.append_idle(10);
  scene.bench.drive(wave);
  scene.send(scene.moving_write());
}

void write_after_short_pulse(NodeScene& scene) {
  write_after_pulse(scene, 1 + scene.round);
}

// It may be a character or none; what follows is a frame of its own in no case.
void write_after_long_pulse(NodeScene& scene) {
  write_after_pulse(scene, 6 + scene.round);
}

// Random levels on a line that nobody drives. They hold a valid frame for the node once in some 2^40
// characters: the case sends some thousands.
void make_noise(NodeScene& scene) {
  kernel::Random& random = scene.bench.random();
  line::Waveform wave;
  scene.bench.clear_observations();
  wave.rate = scene.bench.rules().bit_rate * (random.chance(0.5) ? 1 : 7);
  for (int word = 0; word < 40; ++word) wave.levels.append(random.next(), 64);
  scene.bench.drive(wave);
  scene.bench.wait(scene.bench.characters(static_cast<double>(random.below(8))));
}

// A read, up to where its answer has begun.
void read_until_answered(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  scene.end = bench.read();
  const kernel::Time latest = scene.end + bench.delimiter() + turnaround_time_span(bench.rules());
  while (bench.now() < latest && !bench.has_driven()) bench.wait(5 * kernel::kMicrosecond);
  scene.judge.expect(bench.has_driven(), "no_answer", "one answer", "the node did not say anything");
}

void write_into_the_answer(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.wait(bench.bits(1) + kernel::Duration{bench.random().between(0, bench.characters(1).count())});
  bench.interject(scene.moving_write(), bench.now());
  bench.wait(bench.characters(6));
  bench.await_response_window();
}

void expect_driver_off(NodeScene& scene) {
  const kernel::Time limit = scene.bench.now() - scene.bench.characters(2);
  scene.judge.expect(scene.bench.answers().front().driver_off < limit, "driver_not_released",
                     "the driver goes off after the answer", "it is on");
}

void answer_into_the_answer(NodeScene& scene) {
  const std::uint8_t data0 = scene.bench.random_octet();
  scene.bench.interject(octets_of(valve_bus::Response{data0, scene.bench.random_octet()}), scene.bench.now());
  scene.bench.await_response_window();
}

}  // namespace

std::vector<NodeCase> node_line_cases() {
  using namespace node_chart;
  const NodeStep read_begun = {"a read", "an answer begins", read_until_answered};
  constexpr unsigned kEach = valve_bus::kCommandOctets;
  return {
      on_chart(
          {.id = "valve_bus/node/line/missing_stop_bit_spoils_the_frame",
           .purpose = "RN-22",
           .requirement = "A character without its stop bit spoils the frame that it stands in.",
           .reference = valve_sources::own("the stop bit is looked at"),
           .tags = {"must"},
           .catches = {{"stop_bit_ignored", "takes_frame_without_stop_bit"}}},
          {{kEach, kEach},
           {stimulus("a write with the stop bit of each character missing in turn", write_without_a_stop_bit),
            ignored("takes_frame_without_stop_bit", "an octet has no stop bit"), serves()}}),
      on_chart(
          {.id = "valve_bus/node/line/wrong_parity_spoils_the_frame",
           .purpose = "RN-23",
           .requirement = "With parity, a character with a wrong one spoils its frame.",
           .reference = valve_sources::own("character format P1"),
           .tags = {"must"},
           .catches = {{"parity_inverted", "does_not_recover"}, {"parity_ignored", "takes_wrong_parity"}},
           .not_applicable = for_characters("P1")},
          {{kEach, kEach},
           {serves(),
            stimulus("a write with the parity of each character wrong in turn", write_with_wrong_last_bit),
            ignored("takes_wrong_parity", "an octet has a wrong parity"), serves()}},
          {.characters = CharacterProfile::even_parity}),
      on_chart(
          {.id = "valve_bus/node/line/ninth_bit_is_not_looked_at",
           .purpose = "RN-24",
           .requirement = "With nine bits, receivers do not look at the ninth.",
           .reference = valve_sources::own("character format P0"),
           .tags = {"must"},
           .catches = {{"ninth_bit_required", "ninth_bit_looked_at"}},
           .not_applicable = for_characters("P0")},
          {{kEach, kEach},
           {stimulus("a write with the ninth bit of each character 0 in turn", write_with_wrong_last_bit),
            valves_stand("ninth_bit_looked_at")}},
          {.characters = CharacterProfile::ninth_bit_one}),
      on_chart({.id = "valve_bus/node/line/break_is_no_frame",
                .purpose = "RN-25",
                .requirement = "A line that is low says nothing, and a delimiter after it the node receives "
                               "again.",
                .reference = valve_sources::own("recovery within a delimiter"),
                .tags = {"must"},
                .catches = {{"locks_up_after_break", "does_not_recover"}}},
               {{3, 3},
                {stimulus("the line is low for 1 ms, 10 ms or 1 s; a delimiter", hold_low),
                 ignored("acts_on_break", "a low line says nothing"), moving_write(),
                 valves_stand("does_not_recover"), serves()}}),
      on_chart(
          {.id = "valve_bus/node/line/break_in_a_frame_spoils_it",
           .purpose = "RN-22",
           .requirement = "A character of zeros without a stop bit within a frame is part of it: there is "
                          "none.",
           .reference = valve_sources::derived("a stop bit is 1"),
           .tags = {"must"},
           .catches = {{"skips_breaks", "acts_on_break"}}},
          {{4, 8},
           {stimulus("a write with a low line as long as a character before each of its octets in turn",
                     write_with_a_break_inside),
            ignored("acts_on_break", "a character within it has no stop bit"), serves()}}),
      on_chart({.id = "valve_bus/node/line/glitches_are_no_start_bits",
                .purpose = "RN-26",
                .requirement = "A low pulse shorter than half a bit is no start bit; a longer one costs "
                               "the frame after it at most.",
                .reference = valve_sources::derived("three samples in the middle of the start bit, two "
                                                    "of which must be low"),
                .tags = {"must"},
                .catches = {{"start_bit_not_validated", "takes_glitch_for_start_bit"}}},
               {{4, 4},
                {stimulus("a low pulse of 0.1 to 0.4 bit right in front of a write", write_after_short_pulse),
                 valves_stand("takes_glitch_for_start_bit"),
                 stimulus("a low pulse of 0.6 to 0.9 bit right in front of a write", write_after_long_pulse),
                 serves()}}),
      on_chart({.id = "valve_bus/node/line/noise_is_no_frame",
                .purpose = "RN-31",
                .requirement = "Noise on a line that nobody drives moves no valve and is not answered.",
                .reference = valve_sources::own("what is no frame is ignored"),
                .tags = {"must"},
                .catches = {{"valves_off_on_wrong_check", "acts_on_noise"}}},
               {{10, 200},
                {valves_on(), stimulus("random levels, of the length of a bit and shorter", make_noise),
                 ignored("acts_on_noise", "nobody drives the line"), serves()}}),
      on_chart({.id = "valve_bus/node/line/command_into_an_answer_is_not_taken",
                .purpose = "RN-21",
                .requirement = "What is sent into a node's own answer is not taken; the node lets go of "
                               "the line and serves again.",
                .reference = valve_sources::derived("one pair, half duplex"),
                .tags = {"must"},
                .catches = {{"hears_while_driving", "acts_on_garbled_command"}}},
               {{8, 100},
                {read_begun, stimulus("a write into the middle of it", write_into_the_answer),
                 no_valve_moved("acts_on_garbled_command", "it was sent into the node's own answer"),
                 expected("its driver is off", expect_driver_off), serves()}}),
      on_chart({.id = "valve_bus/node/line/collision_does_not_change_the_node",
                .purpose = "RN-36",
                .requirement = "When a second node answers at once, the first one does what it would do "
                               "alone.",
                .reference = valve_sources::derived("nodes cannot see that two have one address"),
                .tags = {"must"},
                .catches = {{"gives_up_on_collision", "does_not_recover"}}},
               {{8, 100},
                {read_begun, stimulus("another answer into it", answer_into_the_answer), answered(),
                 no_valve_moved("acts_on_garbled_command", "two nodes answered at once"), serves()}}),
  };
}

}  // namespace fieldproof::conformance
