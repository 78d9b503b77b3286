#include "conformance/valve_bus/node_mutants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string>
#include <utility>

#include "conformance/valve_bus/character_seeded_faults.hpp"
#include "conformance/valve_bus/node_answer_seeded_faults.hpp"
#include "conformance/valve_bus/node_command_seeded_faults.hpp"
#include "conformance/valve_bus/node_framing_seeded_faults.hpp"
#include "conformance/valve_bus/node_power_seeded_faults.hpp"
#include "conformance/valve_bus/node_sequence_seeded_faults.hpp"
#include "conformance/valve_bus/node_terminal_seeded_faults.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::NodeConfiguration;
using valve_bus::NodeDevice;
using valve_bus::Rules;

using MakeNode = std::function<std::unique_ptr<NodeDevice>(const NodeConfiguration&)>;

template <typename Mutant, typename... More>
MakeNode node(More... more) {
  return [=](const NodeConfiguration& configuration) {
    return std::make_unique<Mutant>(configuration, more...);
  };
}

// The reference under rules with one number changed.
template <typename Change>
MakeNode node_with_rules(Change change) {
  return [change](const NodeConfiguration& configuration) {
    NodeConfiguration changed = configuration;
    change(changed.rules);
    return std::make_unique<valve_bus::Node>(changed);
  };
}

struct NodeRow {
  std::string_view name;
  std::string_view label;
  std::string_view description;
  MakeNode make_node;
  bool is_for_check = false;
};

std::vector<NodeRow> node_check_rows() {
  using namespace node_seeded_faults;
  return {
      {"check_without_command", "MN1", "leaves COMMAND out of the block check", node<CheckWithoutCommand>()},
      {"check_is_sum", "MN2", "takes the sum for the block check", node<CheckIsSum>()},
      {"check_is_parity", "", "looks at the parity of the block check only", node<CheckIsParity>()},
      {"check_is_crc", "", "takes a cyclic code for the block check", node<CheckIsCrc>()},
      {"read_not_checked", "MN3", "does not look at the block check of reads", node<ReadNotChecked>()},
      {"write_not_checked", "", "does not look at the block check of writes", node<WriteNotChecked>()},
      {"check_or_complement", "", "takes the complement of the block check, too", node<CheckOrComplement>()},
      {"one_board_checks_four_octets", "", "with one board, leaves DATA1 out of the block check",
       node<OneBoardChecksFourOctets>()},
      {"valves_off_on_wrong_check", "MN20", "switches its valves off on a frame that is wrong",
       node<ValvesOffOnWrongCheck>()},
      {"response_check_with_id", "MN14", "takes its ID into the block check of an answer",
       node<ResponseCheckWithId>()},
  };
}

std::vector<NodeRow> node_command_rows() {
  using namespace node_seeded_faults;
  return {
      {"answers_address_zero", "MN7", "takes ID 0 for its own, too", node<AnswersAddressZero>()},
      {"address_modulo_128", "MN8", "does not look at the highest bit of the ID", node<AddressModulo128>()},
      {"address_low_nibble", "MN8", "looks at the low half of the ID only", node<AddressLowNibble>()},
      {"address_switches_binary", "MN9", "reads its address switches as two halves of an octet",
       node<AddressSwitchesBinary>()},
      {"address_zero_is_one", "", "takes switches at 00 for address 1", node<AddressZeroIsOne>()},
      {"any_command_reads", "MN10", "takes every command but 0 for a read", node<AnyCommandReads>()},
      {"read_drives_valves", "MN11", "drives its valves with the data of a read", node<ReadDrivesValves>()},
      {"answers_writes", "MN5", "answers writes",
       node_with_rules([](Rules& rules) { rules.answers_writes = !rules.answers_writes; })},
  };
}

std::vector<NodeRow> node_process_rows() {
  using namespace node_seeded_faults;
  return {
      {"valves_before_check", "MN4", "drives DATA0 before the check has come", node<ValvesBeforeCheck>()},
      {"valves_late", "", "drives its valves 2.3 ms after the delimiter", node<ValvesLate>()},
      {"data_swapped", "MN15", "takes DATA0 for the second board and DATA1 for the first",
       node<DataSwapped>()},
      {"bits_reversed", "MN16", "takes the highest bit for the first valve", node<BitsReversed>()},
      {"valves_one_by_one", "", "moves one valve each 2 us", node<ValvesOneByOne>()},
      {"glitches_on_write", "", "switches all valves off for 2 us at each write", node<GlitchesOnWrite>()},
      {"one_board_drives_both", "", "drives DATA1 although it has one board", node<OneBoardDrivesBoth>()},
      {"one_board_answers_both", "", "answers DATA1 although it has one board", node<OneBoardAnswersBoth>()},
      {"switches_latched_at_power_up", "MN19", "reads its limit switches at power-up only",
       node<SwitchesLatchedAtPowerUp>()},
      {"switch_bit_stuck", "", "reports switch 4 as made, always", node<SwitchBitStuck>()},
      {"tears_switches", "", "reads the two halves of its switches 4 us apart", node<TearsSwitches>()},
  };
}

std::vector<NodeRow> node_answer_rows() {
  using namespace node_seeded_faults;
  using kernel::kMicrosecond;
  return {
      {"answers_twice", "MN22", "answers twice", node<AnswersTwice>()},
      {"answers_with_echo", "", "repeats the head of the command in front of its answer",
       node<AnswersWithEcho>()},
      {"sends_ninth_bit_0", "", "sends its characters with a ninth bit of 0", node<SendsNinthBit0>()},
      {"gap_between_octets", "", "leaves 20 bits between the octets of an answer", node<GapBetweenOctets>()},
      {"answers_at_once", "MN12", "answers as soon as it has five octets", node<AnswersAtOnce>()},
      {"turns_round_a_tenth_early", "", "answers a tenth of the delimiter before it may",
       node<TurnsRoundEarly>(90)},
      {"turns_round_a_tenth_late", "", "answers a tenth of the span later than it may",
       node<TurnsRoundSlowly>(110)},
      {"turns_round_late", "", "answers 200 us later than it may", node<TurnsRoundLate>(200 * kMicrosecond)},
      {"turns_round_3_ms_late", "", "answers 3 ms later than it may",
       node<TurnsRoundLate>(3000 * kMicrosecond)},
      {"turn_round_drifts", "", "takes 150 us longer for each answer than for the one before",
       node<TurnRoundDrifts>()},
      {"driver_not_released", "MN13", "keeps its driver on for 20 bits after an answer",
       node<DriverOtherwise>(1U, 20U)},
      {"driver_on_late", "", "switches its driver on with the start bit", node<DriverOtherwise>(0U, 1U)},
      {"drives_now_and_then", "", "says something unasked after each fifth write", node<DrivesNowAndThen>()},
      {"falls_silent_after_400_reads", "", "answers 400 reads and no more", node<FallsSilent>()},
  };
}

std::vector<NodeRow> node_frame_rows() {
  using namespace node_seeded_faults;
  using Which = TakesOtherLengths::Which;
  return {
      {"counts_octets_only", "MN6", "takes each five octets for a frame, whatever silence there is",
       node<CountsOctetsOnly>()},
      {"buffer_not_cleared", "MN18", "keeps an octet of a wrong frame in front of all that follow",
       node<BufferNotCleared>()},
      {"takes_four_octets", "", "takes a write without its check",
       node<TakesOtherLengths>(Which::four_octets)},
      {"takes_first_five_octets", "", "takes the first five octets of a longer frame",
       node<TakesOtherLengths>(Which::first_five)},
      {"takes_last_five_octets", "", "takes the last five octets of a longer frame",
       node<TakesOtherLengths>(Which::last_five)},
      {"delimiter_of_two_characters", "", "takes two characters of silence for a delimiter",
       node_with_rules([](Rules& rules) { rules.delimiter_half_characters = 4; })},
      {"delimiter_of_five_characters", "", "needs five characters of silence for a delimiter",
       node_with_rules([](Rules& rules) { rules.delimiter_half_characters = 10; })},
      {"gaps_of_three_characters", "", "allows three characters of silence inside a frame",
       node_with_rules([](Rules& rules) { rules.longest_gap_half_characters = 6; })},
      {"gaps_of_one_character", "", "allows one character of silence inside a frame",
       node_with_rules([](Rules& rules) { rules.longest_gap_half_characters = 2; })},
      {"deaf_behind_response", "", "does not receive the frame after the response of another node",
       node<DeafBehindResponse>()},
      {"deaf_behind_write", "", "receives nothing for 1 ms after a write", node<DeafBehindWrite>()},
  };
}

std::vector<NodeRow> node_character_rows() {
  using namespace node_seeded_faults;
  return {
      {"stop_bit_ignored", "MN17", "does not look at stop bits", node<StopBitIgnored<Node>>()},
      {"parity_inverted", "MN21", "takes the wrong parity for right", node<ParityInverted>()},
      {"parity_ignored", "", "does not look at parity", node<ParityIgnored<Node>>()},
      {"ninth_bit_required", "", "needs the ninth bit to be 1", node<NinthBitRequired<Node>>()},
      {"locks_up_after_break", "", "receives nothing any more after a break", node<LocksUpAfterBreak>()},
      {"start_bit_not_validated", "", "takes every falling edge for a start bit",
       node<StartBitNotValidated>()},
      {"samples_bits_early", "", "samples each bit when a quarter of it is over", node<SamplesElsewhere>(4U)},
      {"samples_bits_late", "", "samples each bit when three quarters of it are over",
       node<SamplesElsewhere>(12U)},
      {"follows_any_rate", "", "adapts to the bit rate of what it receives", node<FollowsAnyRate>()},
      {"clock_too_slow", "", "has a clock that runs 4.5 % slow",
       node_with_rules([](Rules& rules) { rules.bit_rate -= rules.bit_rate * 45 / 1000; })},
      {"hears_while_driving", "", "takes what comes while it drives the line", node<HearsWhileDriving>()},
      {"gives_up_on_collision", "", "answers no more when another talked into its answer",
       node<GivesUpOnCollision>()},
  };
}

std::vector<NodeRow> node_power_rows() {
  using namespace node_seeded_faults;
  return {
      {"lets_go_after_5_s", "", "switches its valves off after 5 s without a command",
       node_with_rules([](Rules& rules) { rules.loss_limit = 5 * kernel::kSecond; })},
      {"valves_set_at_power_up", "", "has a valve on at power-up", node<ValvesSetAtPowerUp>()},
      {"speaks_at_power_up", "", "says something at power-up", node<SpeaksAtPowerUp>()},
      {"keeps_octets_over_power_loss", "", "goes on with the frame in which power was lost",
       node<KeepsOctetsOverPowerLoss>()},
      {"keeps_valves_over_power_loss", "", "sets its valves at power-up as they were",
       node<KeepsValvesOverPowerLoss>()},
  };
}

std::vector<NodeRow> node_sequence_rows() {
  using namespace node_seeded_faults;
  std::vector<NodeRow> rows = {
      {"refused_write_kept", "", "drives the data of a write that it refused at the next read",
       node<RefusedWriteKept>()},
      {"check_not_reset", "", "goes on with the block check of a frame that was wrong",
       node<CheckNotReset>()},
      {"check_skipped_behind_error", "", "does not check the frame after a wrong one",
       node<CheckSkippedBehindError>()},
      {"deaf_after_three_errors", "", "receives nothing more after three wrong frames in a row",
       node<DeafAfterThreeErrors>()},
      {"long_frame_costs_next", "", "loses the frame after one of more than five octets",
       node<LongFrameCostsNext>()},
      {"third_write_lost", "", "loses the write after two equal ones", node<ThirdWriteLost>()},
      {"write_behind_write_late", "", "drives the second of two writes when the next command comes",
       node<WriteBehindWriteLate>()},
      {"loses_each_fourth_command", "", "does nothing at each fourth command",
       node<LosesEachFourthCommand>()},
      {"unknown_command_kept", "", "takes the write after an unknown command for a read",
       node<UnknownCommandKept>()},
      {"second_board_skipped", "", "leaves the second board when the first one does not change",
       node<SecondBoardSkipped>()},
      {"read_answers_write", "", "answers a read after a write with what was written",
       node<ReadAnswersWrite>()},
      {"switches_old_behind_write", "", "answers a read after a write with the switches as they were then",
       node<SwitchesOldBehindWrite>()},
      {"repeated_read_answers_old", "", "answers the second of two reads as the first",
       node<RepeatedReadAnswersOld>()},
      {"twice_behind_response", "", "answers twice after the response of another node",
       node<TwiceBehindResponse>()},
      {"silent_after_power_loss", "", "does not answer the first read after power was lost",
       node<SilentAfterPowerLoss>()},
  };
  for (NodeRow& row : rows) row.is_for_check = true;
  return rows;
}

const std::vector<NodeRow>& node_rows() {
  static const std::vector<NodeRow> table = [] {
    std::vector<NodeRow> all;
    for (auto group : {node_check_rows, node_command_rows, node_process_rows, node_answer_rows,
                       node_frame_rows, node_character_rows, node_power_rows, node_sequence_rows}) {
      for (NodeRow& row : group()) all.push_back(std::move(row));
    }
    return all;
  }();
  return table;
}

}  // namespace

const std::vector<Mutant>& node_mutants() {
  static const std::vector<Mutant> mutants = [] {
    std::vector<Mutant> all;
    for (const NodeRow& row : node_rows()) {
      all.push_back({std::string(row.name), std::string(row.label), "node", std::string(row.description),
                     row.is_for_check});
    }
    return all;
  }();
  return mutants;
}

std::unique_ptr<NodeDevice> make_node_mutant(std::string_view name, const NodeConfiguration& configuration) {
  std::vector<std::string_view> names;
  for (const NodeRow& row : node_rows()) {
    if (row.name == name) return row.make_node(configuration);
    names.push_back(row.name);
  }
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no mutant node \"{}\"; near are {}", name,
                                  fmt::join(config::nearest(name, names, 3), ", ")));
}

}  // namespace fieldproof::conformance
