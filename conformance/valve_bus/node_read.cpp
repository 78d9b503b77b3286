#include <fmt/format.h>

#include "conformance/valve_bus/node_scene.hpp"

// Reads: COMMAND 1, the limit switches.
namespace fieldproof::conformance {
namespace {

// 256 of the 65536 pairs of octets, spread over them.
std::vector<std::uint8_t> read_with_data(NodeScene& scene) {
  const unsigned pair = 4'099 * scene.round;
  return scene.command(scene.bench.address(), scene.bench.rules().read_command, pair, pair >> 8);
}

void set_one_switch(NodeScene& scene) {
  scene.bench.require(&iut::Capabilities::process_side);
  const unsigned one = 1U << scene.round / 2;
  scene.set_switches(static_cast<std::uint16_t>(scene.round % 2 == 0 ? one : ~one));
}

constexpr kernel::Duration kHalfPeriod = 7 * kernel::kMicrosecond;

// All switches change together, again and again: an answer has them all before or all after a change.
void keep_switching(NodeScene& scene) {
  scene.bench.require(&iut::Capabilities::process_side);
  scene.bench.require(&iut::Capabilities::moving_inputs);
  scene.bench.boards().set_signal(0, [](kernel::Time when) {
    return (when - kernel::kStart) / kHalfPeriod % 2 == 0 ? std::uint16_t{0x0000} : std::uint16_t{0xFFFF};
  });
  scene.bench.wait(kernel::Duration{scene.bench.random().between(0, kHalfPeriod.count())});
}

void expect_whole_snapshot(NodeScene& scene) {
  const auto answers = scene.bench.answers();
  scene.judge.expect(answers.size() == 1 && answers[0].characters.size() == 3, "no_answer", "one answer",
                     "none, or of another length");
  const auto octets = answers[0].octets();
  const bool is_equal = scene.bench.configuration().boards == 1 || octets[0] == octets[1];
  scene.judge.expect(is_equal && (octets[0] == 0x00 || octets[0] == 0xFF), "snapshot_torn", [&] {
    return Mismatch{
        {"00 00 or FF FF"}, fmt::format("{:02X} {:02X}", octets[0], octets[1]), answers[0].driver_on};
  });
}

}  // namespace

std::vector<NodeCase> node_read_cases() {
  using namespace node_chart;
  return {
      on_chart(
          {.id = "valve_bus/node/read/is_answered",
           .purpose = "RN-02",
           .requirement = "A node answers a command 1 for its address with DATA0, DATA1 and their "
                          "exclusive or; its valves stay as they are.",
           .reference = valve_sources::paper("communication frames; node on a read"),
           .tags = {"must"},
           .catches = {{"check_without_command", "no_answer"},
                       {"response_check_with_id", "answer_check_wrong"},
                       {"answers_twice", "answered_twice"},
                       {"answers_with_echo", "answer_length_wrong"},
                       {"sends_ninth_bit_0", "ninth_bit_wrong"}}},
          {{3, 50}, {read(), answered(), no_valve_moved("valves_moved_by_read", "a read drives nothing")}}),
      on_chart({.id = "valve_bus/node/read/data_is_not_looked_at",
                .purpose = "RN-03",
                .requirement = "DATA0 and DATA1 of a read mean nothing.",
                .reference = valve_sources::paper("node on a read"),
                .tags = {"must"},
                .catches = {{"read_drives_valves", "valves_moved_by_read"}}},
               {{16, 256},
                {valves_on(), sent("a read with a pair of octets from all 65536", read_with_data), answered(),
                 no_valve_moved("valves_moved_by_read", "the data of a read mean nothing")}}),
      on_chart({.id = "valve_bus/node/read/switches_are_told_exactly",
                .purpose = "RN-05",
                .requirement = "Each limit switch has its bit, and an answer reports the switches as they "
                               "are when it is asked for.",
                .reference = valve_sources::paper("limit switches at both ends of 8 cylinders"),
                .tags = {"must"},
                .catches = {{"switches_latched_at_power_up", "answer_data_wrong"},
                            {"switch_bit_stuck", "answer_data_wrong"}}},
               {{32, 32},
                {stimulus("each of the 16 switches alone is made, or alone open", set_one_switch), read(),
                 answered()}}),
      on_chart(
          {.id = "valve_bus/node/read/snapshot_is_not_torn",
           .purpose = "RN-05",
           .requirement = "The switches of an answer are those of one instant.",
           .reference = valve_sources::own("one snapshot for both octets"),
           .tags = {"must"},
           .catches = {{"tears_switches", "snapshot_torn"}}},
          {{20, 400},
           {stimulus("all switches change together each 7 us, up to a random instant", keep_switching),
            read(), expected("all switches of the answer are made or all open", expect_whole_snapshot)}}),
      on_chart({.id = "valve_bus/node/read/answer_has_no_gaps",
                .purpose = "RN-20",
                .requirement = "The characters of an answer follow each other with at most 1.5 "
                               "characters of silence.",
                .reference = valve_sources::own("silence inside a frame"),
                .tags = {"must", "timing"},
                .catches = {{"gap_between_octets", "gap_in_answer"}}},
               {{3, 200},
                {read(), answered(),
                 expected("no gap in it is longer",
                          [](NodeScene& scene) {
                            scene.judge.measure(
                                "longest gap in an answer", "us",
                                static_cast<double>(scene.answer.longest_gap().count()) * 1e-6);
                          })}}),
  };
}

}  // namespace fieldproof::conformance
