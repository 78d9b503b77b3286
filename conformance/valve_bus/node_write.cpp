#include "conformance/valve_bus/node_scene.hpp"

// Writes: COMMAND 0, the data for the solenoids.
namespace fieldproof::conformance {

std::vector<NodeCase> node_write_cases() {
  using namespace node_chart;
  return {
      on_chart({.id = "valve_bus/node/write/drives_the_valves",
                .purpose = "RN-01",
                .requirement = "A node takes a command 0 for its address with a right block check to its "
                               "valves and does not answer it.",
                .reference = valve_sources::paper("communication frames; node on a write"),
                .tags = {"must"},
                .catches = {{"check_is_sum", "write_not_taken"},
                            {"valves_before_check", "valves_too_early"},
                            {"valves_late", "valves_too_late"},
                            {"answers_writes", "write_answered"}}},
               {{3, 50}, {write(), taken()}}),
      on_chart({.id = "valve_bus/node/write/every_value_is_driven_at_once",
                .purpose = "RN-04",
                .requirement = "Each bit of DATA0 and DATA1 drives its own solenoid, bit i number i + 1, "
                               "and all that change do so together.",
                .reference = valve_sources::derived("8 solenoids are switched together"),
                .tags = {"must"},
                .catches = {{"data_swapped", "valves_wrong"},
                            {"bits_reversed", "valves_wrong"},
                            {"valves_one_by_one", "valves_one_by_one"}}},
               {{1'100, 2'560},
                {sent("a write with each of the 256 values of DATA0 in turn, again and again, DATA1 random",
                      [](NodeScene& scene) {
                        return scene.write(scene.round & 0xFFU, scene.bench.random_octet());
                      }),
                 taken()}}),
      on_chart(
          {.id = "valve_bus/node/write/repeated_write_does_not_glitch",
           .purpose = "RN-35",
           .requirement = "A write that says what the valves are does not move them: the host "
                          "refreshes its writes for ever.",
           .reference = valve_sources::own("writes are refreshed because nothing acknowledges them"),
           .tags = {"must", "long"},
           .catches = {{"glitches_on_write", "valves_glitch"}}},
          {{20, 5'000},
           {write(), sent("the same write again", [](NodeScene& scene) { return scene.frame; }),
            valves_stand("valves_wrong"), no_valve_moved("valves_glitch", "they stand as the write says")}}),
  };
}

std::vector<NodeCase> node_one_board_cases() {
  using namespace node_chart;
  return {
      on_chart({.id = "valve_bus/node/write/one_board_takes_the_first_octet",
                .purpose = "RN-37",
                .requirement = "A node with one drive board takes DATA0 only, answers 0 in DATA1, and its "
                               "block check covers DATA1 all the same.",
                .reference = valve_sources::own("what the second octet means with one board"),
                .tags = {"must"},
                .catches = {{"one_board_drives_both", "valves_wrong"},
                            {"one_board_answers_both", "answer_data_wrong"},
                            {"one_board_checks_four_octets", "write_not_taken"}},
                .not_applicable = [](const judge::Pics& pics) -> std::optional<std::string> {
                  if (pics.number("boards", 1) == 1) return std::nullopt;
                  return "the node has more than one board";
                }},
               {{3, 50},
                {sent("a write with a random DATA1 other than 0, which moves nothing",
                      [](NodeScene& scene) {
                        return scene.write(scene.bench.random_octet(), scene.bench.random_octet() | 1U);
                      }),
                 taken(),
                 stimulus("all switches of the second board are made",
                          [](NodeScene& scene) { scene.set_switches(scene.switches | 0xFF00U); }),
                 read(), answered()}},
               {.boards = 1}),
  };
}

}  // namespace fieldproof::conformance
