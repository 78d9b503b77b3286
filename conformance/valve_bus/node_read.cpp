#include <fmt/format.h>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// Reads: COMMAND 1, the limit switches.
namespace fieldproof::conformance {
namespace {

std::uint16_t random_switches(NodeBench& bench) {
  return static_cast<std::uint16_t>(bench.random().below(0x10000));
}

void a_read_is_answered(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    bench.clear_observations();
    const std::uint16_t switches = random_switches(bench);
    bench.boards().set_input(0, switches);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    expect_answer(bench, judge, switches, end);
    expect_no_valve_moved(bench, judge, "valves_moved_by_read", "a read drives nothing");
  }
}

void data_of_a_read_is_not_looked_at(NodeBench& bench, CaseJudge& judge) {
  bench.write(0x5A, 0xA5);
  bench.await_response_window();
  const std::uint16_t switches = random_switches(bench);
  bench.boards().set_input(0, switches);
  for (unsigned pair = 0; pair < 0x10000; pair += bench.volume(4'099U, 257U)) {
    bench.clear_observations();
    const kernel::Time end =
        bench.send(valve_bus::Command{bench.address(), static_cast<std::uint8_t>(bench.rules().read_command),
                                      static_cast<std::uint8_t>(pair), static_cast<std::uint8_t>(pair >> 8)});
    bench.await_response_window();
    expect_answer(bench, judge, switches, end);
    expect_no_valve_moved(bench, judge, "valves_moved_by_read", "the data of a read mean nothing");
  }
}

void switches_are_told_exactly(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::process_side);
  const auto ask = [&](std::uint16_t switches) {
    bench.clear_observations();
    bench.boards().set_input(0, switches);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    expect_answer(bench, judge, switches, end);
  };
  for (unsigned n = 0; n < 16; ++n) {
    ask(static_cast<std::uint16_t>(1U << n));
    ask(static_cast<std::uint16_t>(~(1U << n)));
  }
}

// All switches change together, again and again: an answer has them all before or all after a change.
void a_snapshot_is_not_torn(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::moving_inputs);
  const auto half_period = 7 * kernel::kMicrosecond;
  bench.boards().set_signal(0, [half_period](kernel::Time when) {
    return (when - kernel::kStart) / half_period % 2 == 0 ? std::uint16_t{0x0000} : std::uint16_t{0xFFFF};
  });
  const bool has_one_board = bench.configuration().boards == 1;
  for (int n = 0; n < bench.volume(20, 400); ++n) {
    bench.clear_observations();
    bench.wait(kernel::Duration{bench.random().between(0, half_period.count())});
    bench.read();
    bench.await_response_window();
    const auto answers = bench.answers();
    judge.expect(answers.size() == 1 && answers[0].characters.size() == 3, "no_answer", "one answer",
                 "none, or of another length");
    const auto octets = answers[0].octets();
    judge.expect(has_one_board || octets[0] == octets[1], "snapshot_torn", [&] {
      return Mismatch{
          {"00 00 or FF FF"}, fmt::format("{:02X} {:02X}", octets[0], octets[1]), answers[0].driver_on};
    });
    judge.expect(octets[0] == 0x00 || octets[0] == 0xFF, "snapshot_torn", [&] {
      return Mismatch{{"00 or FF in DATA0"}, fmt::format("{:02X}", octets[0]), answers[0].driver_on};
    });
  }
}

void an_answer_has_no_gaps(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 200); ++n) {
    bench.clear_observations();
    const std::uint16_t switches = random_switches(bench);
    bench.boards().set_input(0, switches);
    const kernel::Time end = bench.read();
    bench.await_response_window();
    const Transmission answer = expect_answer(bench, judge, switches, end);
    judge.measure("longest gap in an answer", "us", static_cast<double>(answer.longest_gap().count()) * 1e-6);
  }
}

}  // namespace

std::vector<NodeCase> node_read_cases() {
  std::vector<NodeCase> cases;
  cases.push_back(
      {{.id = "valve_bus/node/read/is_answered",
        .purpose = "RN-02",
        .requirement = "A node answers a command 1 for its address with DATA0, DATA1 and their exclusive or; "
                       "its valves stay as they are.",
        .reference = valve_sources::paper("communication frames; node on a read"),
        .stimulus = "Reads, the limit switches random.",
        .expected = "One answer of three octets with these switches and a right check.",
        .tags = {"must"},
        .catches = {{"check_without_command", "no_answer"},
                    {"response_check_with_id", "answer_check_wrong"},
                    {"answers_twice", "answered_twice"},
                    {"answers_with_echo", "answer_length_wrong"},
                    {"sends_ninth_bit_0", "ninth_bit_wrong"}}},
       a_read_is_answered});
  cases.push_back({{.id = "valve_bus/node/read/data_is_not_looked_at",
                    .purpose = "RN-03",
                    .requirement = "DATA0 and DATA1 of a read mean nothing.",
                    .reference = valve_sources::paper("node on a read"),
                    .stimulus = "Reads with pairs of octets from all 65536.",
                    .expected = "The same answer to each, and no valve moves.",
                    .tags = {"must"},
                    .catches = {{"read_drives_valves", "valves_moved_by_read"}}},
                   data_of_a_read_is_not_looked_at});
  cases.push_back(
      {{.id = "valve_bus/node/read/switches_are_told_exactly",
        .purpose = "RN-05",
        .requirement = "Each limit switch has its bit, and an answer reports the switches as they "
                       "are when it is asked for.",
        .reference = valve_sources::paper("limit switches at both ends of 8 cylinders"),
        .stimulus = "Each switch alone made, each alone open.",
        .expected = "Exactly these bits.",
        .tags = {"must"},
        .catches = {{"switches_latched_at_power_up", "answer_data_wrong"},
                    {"switch_bit_stuck", "answer_data_wrong"}}},
       switches_are_told_exactly});
  cases.push_back({{.id = "valve_bus/node/read/snapshot_is_not_torn",
                    .purpose = "RN-05",
                    .requirement = "The switches of an answer are those of one instant.",
                    .reference = valve_sources::own("one snapshot for both octets"),
                    .stimulus = "All switches change together each 7 us; reads at random instants.",
                    .expected = "Each answer has all switches made or all open.",
                    .tags = {"must"},
                    .catches = {{"tears_switches", "snapshot_torn"}}},
                   a_snapshot_is_not_torn});
  cases.push_back({{.id = "valve_bus/node/read/answer_has_no_gaps",
                    .purpose = "RN-20",
                    .requirement = "The characters of an answer follow each other with at most 1.5 "
                                   "characters of silence.",
                    .reference = valve_sources::own("silence inside a frame"),
                    .stimulus = "Reads.",
                    .expected = "No longer gap in an answer.",
                    .tags = {"must", "timing"},
                    .catches = {{"gap_between_octets", "gap_in_answer"}}},
                   an_answer_has_no_gaps});
  return cases;
}

}  // namespace fieldproof::conformance
