#include <fmt/format.h>

#include <utility>

#include "conformance/valve_bus/node_scene.hpp"

// Who is meant, and what is asked.
namespace fieldproof::conformance {
namespace {

using MakeId = std::function<unsigned(const NodeScene&)>;

NodeStep read_for(std::string text, MakeId id) {
  return node_chart::sent(std::move(text), [id = std::move(id)](NodeScene& scene) {
    return scene.command(id(scene), scene.bench.rules().read_command, 0xFF, 0xFF);
  });
}

NodeStep write_for(std::string text, MakeId id) {
  return node_chart::sent(std::move(text), [id = std::move(id)](NodeScene& scene) {
    return scene.command(id(scene), scene.bench.rules().write_command, 0xFF, 0xFF);
  });
}

unsigned another_id(const NodeScene& scene) {
  return scene.round + (scene.round < scene.bench.address() ? 0 : 1);
}

unsigned id_of_round(const NodeScene& scene) {
  return scene.round;
}

void expect_answer_to_own_id(NodeScene& scene) {
  const unsigned own = scene.bench.address();
  scene.judge.expect(
      scene.bench.has_driven() == (scene.round == own), "address_wrong",
      fmt::format("it answers to {} only", own),
      fmt::format("it {} to {}", scene.round == own ? "did not answer" : "answered", scene.round));
}

const auto& with_settable_switches() {
  static const auto applies = for_item("address_switches_can_be_set", true, declared_node(),
                                       "the bench cannot set the address of the node");
  return applies;
}

NodeCase switch_case(unsigned tens, unsigned units, std::string mutant) {
  return on_chart(
      {.id = fmt::format("valve_bus/node/address/switches_{}{}_are_decimal", tens, units),
       .purpose = "RN-07",
       .requirement = "The two address switches are decimal digits.",
       .reference = valve_sources::derived("two selection switches for the addresses 1 to 99"),
       .tags = {"must"},
       .catches = {{std::move(mutant), "address_wrong"}},
       .not_applicable = with_settable_switches()},
      {{256, 256},
       {read_for(fmt::format("reads for the 256 IDs in turn; the switches are set to {}{}", tens, units),
                 id_of_round),
        expected(fmt::format("answers to ID {} only", 10 * tens + units), expect_answer_to_own_id)}},
      {.tens = tens, .units = units});
}

NodeStep without_address() {
  return node_chart::ignored("answers_without_address", "its switches give no address");
}

NodeCase above_nine_case(unsigned tens, unsigned units, std::string mutant) {
  return asked_with(
      {.tens = 0, .units = 1},
      on_chart({.id = fmt::format("valve_bus/node/address/switches_{:X}{:X}_never_answer", tens, units),
                .purpose = "RN-07",
                .requirement = "A node with a switch above 9 has no address.",
                .reference = valve_sources::own("switches are decimal digits"),
                .tags = {"must"},
                .catches = {{std::move(mutant), "answers_without_address"}},
                .not_applicable = with_settable_switches()},
               {{256, 256},
                {write_for(fmt::format("a write for each of the 256 IDs in turn; the switches are set to "
                                       "{} and {}",
                                       tens, units),
                           id_of_round),
                 without_address(), read_for("a read for it", id_of_round), without_address()}},
               {.tens = tens, .units = units}));
}

}  // namespace

std::vector<NodeCase> node_address_cases() {
  using namespace node_chart;
  const NodeStep foreign = ignored("acts_on_foreign_id", "the ID is not its own");
  return {
      on_chart({.id = "valve_bus/node/address/only_its_own_id_acts",
                .purpose = "RN-06",
                .requirement = "A node acts on and answers its own ID only; 0 and IDs above 99 are "
                               "nobody's.",
                .reference = valve_sources::paper("ID 1 to 99"),
                .tags = {"must"},
                .catches = {{"answers_address_zero", "acts_on_foreign_id"},
                            {"address_modulo_128", "acts_on_foreign_id"},
                            {"address_low_nibble", "acts_on_foreign_id"}}},
               {{255, 255},
                {write_for("a write for each of the 255 other IDs in turn", another_id), foreign,
                 read_for("a read for it", another_id), foreign, serves()}}),
      switch_case(0, 1, "answers_address_zero"),
      switch_case(0, 9, "address_low_nibble"),
      switch_case(1, 0, "address_switches_binary"),
      switch_case(5, 0, "address_switches_binary"),
      switch_case(9, 9, "address_switches_binary"),
      asked_with({.tens = 0, .units = 1},
                 on_chart({.id = "valve_bus/node/address/switches_00_never_answer",
                           .purpose = "RN-07",
                           .requirement = "A node whose switches are set to 00 has no address.",
                           .reference = valve_sources::paper("ID 1 to 99"),
                           .tags = {"must"},
                           .catches = {{"address_zero_is_one", "answers_without_address"}},
                           .not_applicable = with_settable_switches()},
                          {{256, 256},
                           {write_for("a write for each of the 256 IDs in turn", id_of_round),
                            without_address(), read_for("a read for it", id_of_round), without_address()}},
                          {.tens = 0, .units = 0})),
      above_nine_case(0, 10, "digits_above_nine_add_up"),
      above_nine_case(10, 5, "digits_above_nine_wrap"),
      above_nine_case(5, 15, "digits_above_nine_wrap"),
      above_nine_case(15, 5, "digits_above_nine_wrap"),
      on_chart({.id = "valve_bus/node/command/undefined_commands_are_ignored",
                .purpose = "RN-08",
                .requirement = "Commands 2 to 255 are none: no action, no answer.",
                .reference = valve_sources::own("undefined commands are discarded"),
                .tags = {"must"},
                .catches = {{"any_command_reads", "acts_on_undefined_command"}}},
               {{254, 254},
                {sent("the commands 2 to 255 for the node's ID in turn, with a right check",
                      [](NodeScene& scene) {
                        return scene.command(scene.bench.address(), 2 + scene.round, 0xFF, 0xFF);
                      }),
                 ignored("acts_on_undefined_command", "the command is none"), serves()}}),
  };
}

}  // namespace fieldproof::conformance
