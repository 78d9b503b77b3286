#include <fmt/format.h>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// Writes: COMMAND 0, the data for the solenoids.
namespace fieldproof::conformance {
namespace {

void write_drives_the_valves(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    bench.clear_observations();
    const auto data0 = bench.random_octet();
    const auto data1 = bench.random_octet();
    const kernel::Time end = bench.write(data0, data1);
    bench.await_response_window();
    expect_write_taken(bench, judge, data0, data1, end);
  }
}

void every_value_is_driven_at_once(NodeBench& bench, CaseJudge& judge) {
  const unsigned step = bench.volume(5U, 1U);
  for (unsigned value = 0; value < 256; value += step) {
    bench.clear_observations();
    const auto data0 = static_cast<std::uint8_t>(value);
    const auto data1 = bench.random_octet();
    const kernel::Time end = bench.write(data0, data1);
    bench.await_response_window();
    expect_write_taken(bench, judge, data0, data1, end);
  }
}

void a_repeated_write_does_not_move_the_valves(NodeBench& bench, CaseJudge& judge) {
  bench.require(&iut::Capabilities::process_side);
  const auto data0 = static_cast<std::uint8_t>(bench.random_octet() | 1U);
  const auto data1 = bench.random_octet();
  bench.write(data0, data1);
  bench.await_response_window();
  bench.clear_observations();
  for (int n = 0; n < bench.volume(20, 10'000); ++n) {
    bench.write(data0, data1);
    bench.wait(bench.delimiter() + kernel::kMillisecond);
    expect_no_valve_moved(bench, judge, "valves_glitch", "they stand as the write says");
  }
  bench.await_response_window();
  expect_valves(bench, judge, bench.valves_of(data0, data1), "valves_wrong");
}

void one_board_takes_the_first_octet(NodeBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    bench.clear_observations();
    const auto data0 = bench.random_octet();
    // The check covers an octet that moves nothing.
    const auto data1 = static_cast<std::uint8_t>(bench.random_octet() | 1U);
    const kernel::Time end = bench.write(data0, data1);
    bench.await_response_window();
    expect_write_taken(bench, judge, data0, data1, end);
    bench.clear_observations();
    const auto switches = static_cast<std::uint16_t>(bench.random_octet() | 0xFF00U);
    bench.boards().set_input(0, switches);
    const kernel::Time asked = bench.read();
    bench.await_response_window();
    expect_answer(bench, judge, switches, asked);
  }
}

}  // namespace

std::vector<NodeCase> node_write_cases() {
  std::vector<NodeCase> cases;
  cases.push_back(
      {{.id = "valve_bus/node/write/drives_the_valves",
        .purpose = "RN-01",
        .requirement = "A node takes a command 0 for its address with a right block check to its valves and "
                       "does not answer it.",
        .reference = valve_sources::paper("communication frames; node on a write"),
        .stimulus = "Writes of random octets.",
        .expected = "The valves stand as DATA0 and DATA1 say, at most 2 ms after the delimiter and not "
                    "before the check; the line stays silent.",
        .tags = {"must"},
        .catches = {{"check_is_sum", "write_not_taken"},
                    {"valves_before_check", "valves_too_early"},
                    {"valves_late", "valves_too_late"},
                    {"answers_writes", "write_answered"}}},
       write_drives_the_valves});
  cases.push_back({{.id = "valve_bus/node/write/every_value_is_driven_at_once",
                    .purpose = "RN-04",
                    .requirement = "Each bit of DATA0 and DATA1 drives its own solenoid, bit i number i + 1, "
                                   "and all that change do so together.",
                    .reference = valve_sources::derived("8 solenoids are switched together"),
                    .stimulus = "Writes with all 256 values of DATA0 and random DATA1.",
                    .expected = "Exactly these valves, changing within 1 us.",
                    .tags = {"must"},
                    .catches = {{"data_swapped", "valves_wrong"},
                                {"bits_reversed", "valves_wrong"},
                                {"valves_one_by_one", "valves_one_by_one"}}},
                   every_value_is_driven_at_once});
  cases.push_back({{.id = "valve_bus/node/write/repeated_write_does_not_glitch",
                    .purpose = "RN-35",
                    .requirement = "A write that says what the valves are does not move them: the host "
                                   "refreshes its writes for ever.",
                    .reference = valve_sources::own("writes are refreshed because nothing acknowledges them"),
                    .stimulus = "The same write ten thousand times.",
                    .expected = "No valve moves.",
                    .tags = {"must", "long"},
                    .catches = {{"glitches_on_write", "valves_glitch"}}},
                   a_repeated_write_does_not_move_the_valves});
  cases.push_back(
      {{.id = "valve_bus/node/write/one_board_takes_the_first_octet",
        .purpose = "RN-37",
        .requirement = "A node with one drive board takes DATA0 only, answers 0 in DATA1, and its "
                       "block check covers DATA1 all the same.",
        .reference = valve_sources::own("what the second octet means with one board"),
        .stimulus = "Writes with DATA1 other than 0, then reads with all switches of the "
                    "second board made.",
        .expected = "Valves 1 to 8 as DATA0 says, the others off; DATA1 of the answer is 0.",
        .tags = {"must"},
        .catches = {{"one_board_drives_both", "valves_wrong"},
                    {"one_board_answers_both", "answer_data_wrong"},
                    {"one_board_checks_four_octets", "write_not_taken"}},
        .not_applicable = [](const judge::Pics& pics) -> std::optional<std::string> {
          if (pics.number("boards", 1) == 1) return std::nullopt;
          return "the node has more than one board";
        }},
       one_board_takes_the_first_octet,
       {.boards = 1}});
  return cases;
}

}  // namespace fieldproof::conformance
