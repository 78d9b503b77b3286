#include "conformance/valve_bus/node_sequence.hpp"

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_reasons.hpp"
#include "conformance/valve_bus/node_sequence_run.hpp"
#include "conformance/valve_bus/node_vocabulary.hpp"

namespace fieldproof::conformance {
namespace {

// Any silence may stand between two characters of a sequence: what is a frame rests on the delimiter always.
std::vector<PartialSource> sequence_details() {
  std::vector<PartialSource> details = node_details();
  details.push_back({valve_sources::own("silence of 3.5 characters ends a frame, whatever came before it"),
                     {"moves_without_command", "write_not_taken", "answers_without_command", "no_answer"}});
  return details;
}

// What its valves and switches are, and what it has just received or lost.
std::vector<std::vector<NamedCommand>> states_of_a_node() {
  const NamedCommand written{"write", {{"data0", 0xA5}, {"data1", 0x3C}}};
  return {{written},
          {{"switches", {{"data0", 0x5A}, {"data1", 0xC3}}}, {"read"}},
          {{"command", {{"id", 2}, {"command", 1}}}},  // another node's answer is due
          {written, {"wait", {{"ms", 1'000}}}},
          {written, {"power"}},
          {{"power"}, {"sign", {{"kind", 4}}}},
          {written, {"octets"}}};
}

}  // namespace

const SequenceRole& node_sequence_role() {
  static const SequenceRole role{
      {.id = "valve_bus/node/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever comes in whatever order, valves move and answers come by whole frames of the "
                      "node's own, and by nothing else.",
       .reference = valve_sources::paper("frames, block check, what a node does with a command"),
       .details = sequence_details(),
       .rules = node_reasons(),
       .stimulus = "Commands at random, with flipped bits, dropped characters and gaps.",
       .expected = "What the reference does with what arrived, within the times of the rules.",
       .tags = {},
       .catches = {}},
      with_beginnings(node_vocabulary(), states_of_a_node()),
      {{DerivedKind::values, {"switch_bit_stuck", "answer_data_wrong"}},
       {DerivedKind::faults, {"turns_round_late", "answer_too_late"}},
       {DerivedKind::words, {"turns_round_a_tenth_late", "answer_too_late"}},
       {DerivedKind::states, {"turns_round_3_ms_late", "no_answer"}},
       {DerivedKind::walks, {"answers_twice", "answered_twice"}},
       {DerivedKind::repetitions, {"valves_set_at_power_up", "valves_wrong"}},
       {DerivedKind::settings, {"switch_bit_stuck", "answer_data_wrong"}},
       {DerivedKind::drawn, {"turns_round_a_tenth_late", "answer_too_late"}}}};
  return role;
}

void run_node_sequence(const Sequence& sequence, NodeBench& bench, CaseJudge& judge) {
  NodeSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
