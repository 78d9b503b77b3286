#include <fmt/format.h>

#include <array>
#include <utility>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"

// Who is meant, and what is asked.
namespace fieldproof::conformance {
namespace {

void only_its_own_id_acts(NodeBench& bench, CaseJudge& judge) {
  for (unsigned id = 0; id < 256; ++id) {
    if (id == bench.address()) continue;
    for (const unsigned command : {bench.rules().write_command, bench.rules().read_command}) {
      bench.clear_observations();
      bench.send(
          valve_bus::Command{static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(command), 0xFF, 0xFF});
      bench.await_response_window();
      const std::string why = fmt::format("ID {} is not its own", id);
      expect_ignored(bench, judge, "acts_on_foreign_id", why);
    }
  }
  expect_serves(bench, judge);
}

// With other switches the same node is another one; the switches of a case are set before it is powered.
void switches_are_decimal(NodeBench& bench, CaseJudge& judge) {
  const unsigned own = bench.address();
  const auto is_own = [&](unsigned id) {
    bench.clear_observations();
    bench.send(valve_bus::Command{static_cast<std::uint8_t>(id), 1, 0, 0});
    bench.await_response_window();
    return bench.has_driven();
  };
  judge.expect(is_own(own), "address_wrong", fmt::format("it answers to {}", own), "it did not answer");
  for (unsigned id = 0; id < 256; ++id) {
    if (id == own) continue;
    judge.expect(!is_own(id), "address_wrong", fmt::format("it answers to {} only", own),
                 fmt::format("it answered to {}", id));
  }
}

void address_zero_never_answers(NodeBench& bench, CaseJudge& judge) {
  for (unsigned id = 0; id < 256; ++id) {
    bench.clear_observations();
    bench.send(
        valve_bus::Command{static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(id & 1U), 0xFF, 0});
    bench.await_response_window();
    expect_ignored(bench, judge, "answers_without_address", "its switches are set to 00");
  }
}

void undefined_commands_are_ignored(NodeBench& bench, CaseJudge& judge) {
  for (unsigned command = 2; command < 256; ++command) {
    bench.clear_observations();
    bench.send(valve_bus::Command{bench.address(), static_cast<std::uint8_t>(command), 0xFF, 0xFF});
    bench.await_response_window();
    expect_ignored(bench, judge, "acts_on_undefined_command", fmt::format("command {} is none", command));
  }
  expect_serves(bench, judge);
}

NodeCase switch_case(unsigned tens, unsigned units, std::vector<MustCatch> catches) {
  return {{.id = fmt::format("valve_bus/node/address/switches_{}{}_are_decimal", tens, units),
           .purpose = "RN-07",
           .requirement = "The two address switches are decimal digits.",
           .reference = valve_sources::derived("two selection switches for the addresses 1 to 99"),
           .stimulus = fmt::format("Reads for all 256 IDs; the switches are set to {}{}.", tens, units),
           .expected = fmt::format("Answers to ID {} only.", 10 * tens + units),
           .tags = {"must"},
           .catches = std::move(catches),
           .not_applicable =
               for_node_with("address_switches_can_be_set", "the bench cannot set the address of the node")},
          switches_are_decimal,
          {.tens = tens, .units = units}};
}

}  // namespace

std::vector<NodeCase> node_address_cases() {
  std::vector<NodeCase> cases;
  cases.push_back({{.id = "valve_bus/node/address/only_its_own_id_acts",
                    .purpose = "RN-06",
                    .requirement = "A node acts on and answers its own ID only; 0 and IDs above 99 are "
                                   "nobody's.",
                    .reference = valve_sources::paper("ID 1 to 99"),
                    .stimulus = "Writes and reads for all other IDs, then for its own.",
                    .expected = "No valve moves and no answer, then it serves.",
                    .tags = {"must"},
                    .catches = {{"answers_address_zero", "acts_on_foreign_id"},
                                {"address_modulo_128", "acts_on_foreign_id"},
                                {"address_low_nibble", "acts_on_foreign_id"}}},
                   only_its_own_id_acts});
  cases.push_back(switch_case(0, 1, {{"answers_address_zero", "address_wrong"}}));
  cases.push_back(switch_case(0, 9, {{"address_low_nibble", "address_wrong"}}));
  cases.push_back(switch_case(1, 0, {{"address_switches_binary", "address_wrong"}}));
  cases.push_back(switch_case(5, 0, {{"address_switches_binary", "address_wrong"}}));
  cases.push_back(switch_case(9, 9, {{"address_switches_binary", "address_wrong"}}));
  cases.push_back({{.id = "valve_bus/node/address/switches_00_never_answer",
                    .purpose = "RN-07",
                    .requirement = "A node whose switches are set to 00 has no address.",
                    .reference = valve_sources::paper("ID 1 to 99"),
                    .stimulus = "Writes and reads for all 256 IDs.",
                    .expected = "No valve moves and no answer.",
                    .tags = {"must"},
                    .catches = {{"address_zero_is_one", "answers_without_address"}},
                    .not_applicable = for_node_with("address_switches_can_be_set",
                                                    "the bench cannot set the address of the node")},
                   address_zero_never_answers,
                   {.tens = 0, .units = 0}});
  cases.push_back({{.id = "valve_bus/node/command/undefined_commands_are_ignored",
                    .purpose = "RN-08",
                    .requirement = "Commands 2 to 255 are none: no action, no answer.",
                    .reference = valve_sources::own("undefined commands are discarded"),
                    .stimulus = "Each of them for the node's ID with a right check, then a write and a read.",
                    .expected = "No valve moves and no answer; then it serves.",
                    .tags = {"must"},
                    .catches = {{"any_command_reads", "acts_on_undefined_command"}}},
                   undefined_commands_are_ignored});
  return cases;
}

}  // namespace fieldproof::conformance
