#include "conformance/valve_bus/node_mutants.hpp"

#include "conformance/valve_bus/character_seeded_faults.hpp"
#include "conformance/valve_bus/node_answer_seeded_faults.hpp"
#include "conformance/valve_bus/node_command_seeded_faults.hpp"
#include "conformance/valve_bus/node_framing_seeded_faults.hpp"
#include "conformance/valve_bus/node_loss_seeded_faults.hpp"
#include "conformance/valve_bus/node_meanwhile_seeded_faults.hpp"
#include "conformance/valve_bus/node_power_seeded_faults.hpp"
#include "conformance/valve_bus/node_sequence_seeded_faults.hpp"
#include "conformance/valve_bus/node_terminal_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::Rules;

using NodeRow = NodeMutants::Row;

std::vector<NodeRow> node_check_rows() {
  using namespace node_seeded_faults;
  return {
      {"check_without_command", "MN1", "leaves COMMAND out of the block check",
       mutant<CheckWithoutCommand>()},
      {"check_is_sum", "MN2", "takes the sum for the block check", mutant<CheckIsSum>()},
      {"check_is_parity", "", "looks at the parity of the block check only", mutant<CheckIsParity>()},
      {"check_is_crc", "", "takes a cyclic code for the block check", mutant<CheckIsCrc>()},
      {"read_not_checked", "MN3", "does not look at the block check of reads", mutant<ReadNotChecked>()},
      {"write_not_checked", "", "does not look at the block check of writes", mutant<WriteNotChecked>()},
      {"check_or_complement", "", "takes the complement of the block check, too",
       mutant<CheckOrComplement>()},
      {"one_board_checks_four_octets", "", "with one board, leaves DATA1 out of the block check",
       mutant<OneBoardChecksFourOctets>()},
      {"deaf_after_100_wrong_checks", "", "receives nothing more after a hundred wrong frames in a row",
       mutant<DeafAfterErrors>(100U)},
      {"valves_off_on_wrong_check", "MN20", "switches its valves off on a frame that is wrong",
       mutant<ValvesOffOnWrongCheck>()},
      {"response_check_with_id", "MN14", "takes its ID into the block check of an answer",
       mutant<ResponseCheckWithId>()},
  };
}

std::vector<NodeRow> node_command_rows() {
  using namespace node_seeded_faults;
  return {
      {"answers_address_zero", "MN7", "takes ID 0 for its own, too", mutant<AnswersAddressZero>()},
      {"address_modulo_128", "MN8", "does not look at the highest bit of the ID", mutant<AddressModulo128>()},
      {"address_low_nibble", "MN8", "looks at the low half of the ID only", mutant<AddressLowNibble>()},
      {"address_switches_binary", "MN9", "reads its address switches as two halves of an octet",
       mutant<AddressSwitchesBinary>()},
      {"address_zero_is_one", "", "takes switches at 00 for address 1", mutant<AddressZeroIsOne>()},
      {"digits_above_nine_add_up", "", "takes a switch above 9 as so many", mutant<DigitsAboveNine>(16U)},
      {"digits_above_nine_wrap", "", "takes a switch at 10 for 0", mutant<DigitsAboveNine>(10U)},
      {"any_command_reads", "MN10", "takes every command but 0 for a read", mutant<AnyCommandReads>()},
      {"read_drives_valves", "MN11", "drives its valves with the data of a read", mutant<ReadDrivesValves>()},
      {"answers_writes", "MN5", "answers writes",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.answers_writes = !rules.answers_writes; })},
  };
}

std::vector<NodeRow> node_process_rows() {
  using namespace node_seeded_faults;
  return {
      {"valves_before_check", "MN4", "drives DATA0 before the check has come", mutant<ValvesBeforeCheck>()},
      {"valves_late", "", "drives its valves 2.3 ms after the delimiter", mutant<ValvesLate>()},
      {"data_swapped", "MN15", "takes DATA0 for the second board and DATA1 for the first",
       mutant<DataSwapped>()},
      {"bits_reversed", "MN16", "takes the highest bit for the first valve", mutant<BitsReversed>()},
      {"valves_one_by_one", "", "moves one valve each 2 us", mutant<ValvesOneByOne>()},
      {"glitches_on_write", "", "switches all valves off for 2 us at each write", mutant<GlitchesOnWrite>()},
      {"one_board_drives_both", "", "drives DATA1 although it has one board", mutant<OneBoardDrivesBoth>()},
      {"one_board_answers_both", "", "answers DATA1 although it has one board",
       mutant<OneBoardAnswersBoth>()},
      {"switches_latched_at_power_up", "MN19", "reads its limit switches at power-up only",
       mutant<SwitchesLatchedAtPowerUp>()},
      {"switch_bit_stuck", "", "reports switch 4 as made, always", mutant<SwitchBitStuck>()},
      {"tears_switches", "", "reads the two halves of its switches 4 us apart", mutant<TearsSwitches>()},
  };
}

std::vector<NodeRow> node_answer_rows() {
  using namespace node_seeded_faults;
  using kernel::kMicrosecond;
  return {
      {"answer_not_cancelled", "", "answers a read whatever is sent before it does",
       mutant<AnswerNotCancelled>()},
      {"answers_twice", "MN22", "answers twice", mutant<AnswersTwice>()},
      {"answers_with_echo", "", "repeats the head of the command in front of its answer",
       mutant<AnswersWithEcho>()},
      {"sends_ninth_bit_0", "", "sends its characters with a ninth bit of 0", mutant<SendsNinthBit0<Node>>()},
      {"gap_between_octets", "", "leaves 20 bits between the octets of an answer",
       mutant<GapBetweenOctets>()},
      {"answers_at_once", "MN12", "answers as soon as it has five octets", mutant<AnswersAtOnce>()},
      {"turns_round_a_tenth_early", "", "answers a tenth of the delimiter before it may",
       mutant<TurnsRoundEarly>(90)},
      {"turns_round_a_tenth_late", "", "answers a tenth of the span later than it may",
       mutant<TurnsRoundSlowly>(110)},
      {"turns_round_late", "", "answers 200 us later than it may",
       mutant<TurnsRoundLate>(200 * kMicrosecond)},
      {"turns_round_3_ms_late", "", "answers 3 ms later than it may",
       mutant<TurnsRoundLate>(3000 * kMicrosecond)},
      {"turn_round_drifts", "", "takes 150 us longer for each answer than for the one before",
       mutant<TurnRoundDrifts>()},
      {"acknowledges_what_it_drives", "", "answers a write with what it drives of it",
       mutant<AcknowledgesWhatItDrives>()},
      {"driver_not_released", "MN13", "keeps its driver on for 20 bits after an answer",
       mutant<DriverOtherwise>(1U, 20U)},
      {"driver_on_late", "", "switches its driver on with the start bit", mutant<DriverOtherwise>(0U, 1U)},
      {"drives_now_and_then", "", "says something unasked after each fifth write",
       mutant<DrivesNowAndThen>()},
      {"falls_silent_after_400_reads", "", "answers 400 reads and no more", mutant<FallsSilent>()},
      {"drives_with_the_answer", "", "drives a write when its answer begins, and not if that is cancelled",
       mutant<DrivesWithTheAnswer>()},
      {"answers_wrong_writes", "", "answers writes with a wrong check where it answers writes",
       mutant<AnswersWrongWrites>()},
  };
}

std::vector<NodeRow> node_frame_rows() {
  using namespace node_seeded_faults;
  using Which = TakesOtherLengths::Which;
  return {
      {"counts_octets_only", "MN6", "takes each five octets for a frame, whatever silence there is",
       mutant<CountsOctetsOnly>()},
      {"buffer_not_cleared", "MN18", "keeps an octet of a wrong frame in front of all that follow",
       mutant<BufferNotCleared>()},
      {"takes_four_octets", "", "takes a write without its check",
       mutant<TakesOtherLengths>(Which::four_octets)},
      {"takes_first_five_octets", "", "takes the first five octets of a longer frame",
       mutant<TakesOtherLengths>(Which::first_five)},
      {"takes_last_five_octets", "", "takes the last five octets of a longer frame",
       mutant<TakesOtherLengths>(Which::last_five)},
      {"delimiter_of_two_characters", "", "takes two characters of silence for a delimiter",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.delimiter_half_characters = 4; })},
      {"delimiter_of_five_characters", "", "needs five characters of silence for a delimiter",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.delimiter_half_characters = 10; })},
      {"gaps_of_three_characters", "", "allows three characters of silence inside a frame",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.longest_gap_half_characters = 6; })},
      {"gaps_of_one_character", "", "allows one character of silence inside a frame",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.longest_gap_half_characters = 2; })},
      {"gaps_of_one_bit_rate", "", "allows silences in a frame by the times of 375 kbit/s",
       with_rules<valve_bus::Node>([](Rules& rules) {
         if (rules.bit_rate < 375'000) rules.longest_gap_half_characters = 6;
         if (rules.bit_rate > 375'000) rules.longest_gap_half_characters = 2;
       })},
      {"delimiter_of_ten_bits", "", "ends frames by characters of ten bits where they have parity",
       with_rules<valve_bus::Node>([](Rules& rules) {
         if (rules.characters == valve_bus::CharacterProfile::even_parity)
           rules.delimiter_half_characters = 6;
       })},
      {"long_gaps_of_ten_bit_characters", "", "allows two characters of silence where they have ten bits",
       with_rules<valve_bus::Node>([](Rules& rules) {
         if (rules.characters == valve_bus::CharacterProfile::eight_bits)
           rules.longest_gap_half_characters = 4;
       })},
      {"gap_timer_of_16_bits", "", "joins what comes 65.536 ms after an unfinished frame to it",
       mutant<GapTimerOf16Bits>()},
      {"deaf_after_a_minute", "", "receives nothing more after a minute of silence",
       mutant<DeafAfterAMinute>()},
      {"deaf_behind_response", "", "does not receive the frame after the response of another node",
       mutant<DeafBehindResponse>()},
      {"deaf_behind_write", "", "receives nothing for 1 ms after a write", mutant<DeafBehindWrite>()},
      {"delimiter_timer_of_16_bits", "",
       "takes silences with a timer of 16 bits of microseconds for short ones",
       mutant<DelimiterTimerOf16Bits>()},
  };
}

std::vector<NodeRow> node_character_rows() {
  using namespace node_seeded_faults;
  return {
      {"stop_bit_ignored", "MN17", "does not look at stop bits", mutant<StopBitIgnored<Node>>()},
      {"parity_inverted", "MN21", "takes the wrong parity for right", mutant<ParityInverted>()},
      {"parity_ignored", "", "does not look at parity", mutant<ParityIgnored<Node>>()},
      {"ninth_bit_required", "", "needs the ninth bit to be 1", mutant<NinthBitRequired<Node>>()},
      {"locks_up_after_break", "", "receives nothing any more after a break", mutant<LocksUpAfterBreak>()},
      {"start_bit_not_validated", "", "takes every falling edge for a start bit",
       mutant<StartBitNotValidated>()},
      {"samples_bits_early", "", "samples each bit when a quarter of it is over",
       mutant<SamplesElsewhere>(4U)},
      {"samples_bits_late", "", "samples each bit when three quarters of it are over",
       mutant<SamplesElsewhere>(12U)},
      {"follows_any_rate", "", "adapts to the bit rate of what it receives", mutant<FollowsAnyRate>()},
      {"clock_too_slow", "", "has a clock that runs 4.5 % slow",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.bit_rate -= rules.bit_rate * 45 / 1000; })},
      {"hears_while_driving", "", "takes what comes while it drives the line", mutant<HearsWhileDriving>()},
      {"gives_up_on_collision", "", "answers no more when another talked into its answer",
       mutant<GivesUpOnCollision>()},
      {"stop_bit_ignored_with_parity", "", "does not look at the stop bit where there is parity",
       mutant<StopBitIgnoredWithParity>()},
      {"skips_breaks", "", "leaves characters of zeros without a stop bit out", mutant<SkipsBreaks>()},
  };
}

std::vector<NodeRow> node_loss_rows() {
  using namespace node_seeded_faults;
  return {
      {"lets_go_after_5_s", "", "switches its valves off after 5 s without a command",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.loss_limit = 5 * kernel::kSecond; })},
      {"lets_go_after_half_an_hour", "", "holds its valves for half an hour at most",
       with_rules<valve_bus::Node>([](Rules& rules) {
         if (rules.loss_limit > kernel::Duration{})
           rules.loss_limit = std::min(rules.loss_limit, 1'800 * kernel::kSecond);
       })},
      {"loss_limit_in_16_bits", "", "keeps the time without a host in 16 bits of milliseconds",
       with_rules<valve_bus::Node>([](Rules& rules) { rules.loss_limit %= 65'536 * kernel::kMillisecond; })},
      {"kept_alive_by_others", "", "takes commands for others for a sign of life",
       mutant<KeptAliveByOthers>()},
      {"kept_alive_by_wrong_frames", "", "takes a command with a wrong check for a sign of life",
       mutant<KeptAliveByWrongFrames>()},
      {"not_kept_alive_by_reads", "", "takes a read for no sign of life", mutant<NotKeptAliveByReads>()},
      {"not_kept_alive_by_undefined_commands", "", "takes an undefined command for no sign of life",
       mutant<NotKeptAliveByUndefinedCommands>()},
      {"not_kept_alive_by_equal_writes", "", "takes a write that moves no valve for no sign of life",
       mutant<NotKeptAliveByEqualWrites>()},
      {"not_kept_alive_by_answered_writes", "", "takes a write that it answers for no sign of life",
       mutant<NotKeptAliveByAnsweredWrites>()},
      {"read_restores_valves", "", "switches its valves on again at the first read after they went off",
       mutant<ReadRestoresValves>()},
      {"silent_without_host", "", "does not answer reads after its valves went off, until a write",
       mutant<SilentWithoutHost>()},
      {"equal_write_not_driven", "", "does not drive a write that is equal to the last one",
       mutant<EqualWriteNotDriven>()},
      {"lets_go_in_silence_only", "", "does not let go of its valves while somebody talks",
       mutant<LetsGoInSilenceOnly>()},
      {"lets_go_after_the_first_power_up_only", "", "lets go of its valves after the first power-up only",
       mutant<LetsGoAfterTheFirstPowerUpOnly>()},
      {"loss_limit_at_least_10_ms", "", "holds its valves for 10 ms at least",
       with_rules<valve_bus::Node>([](Rules& rules) {
         if (rules.loss_limit > kernel::Duration{})
           rules.loss_limit = std::max(rules.loss_limit, 10 * kernel::kMillisecond);
       })},
      {"lets_go_once", "", "lets go of its valves once", mutant<LetsGoOnce>()},
      {"lets_go_of_one_board", "", "lets go of the valves of its first board", mutant<LetsGoOfOneBoard>()},
  };
}

std::vector<NodeRow> node_meanwhile_rows() {
  using namespace node_seeded_faults;
  using Why = KeptAliveBySpoiltFrames::Why;
  return {
      {"loss_drops_the_frame", "", "forgets the frame within which its valves go off without a host",
       mutant<LossDropsTheFrame>()},
      {"loss_cuts_answers", "", "ends an answer within which the time without a host is over",
       mutant<LossCutsAnswers>()},
      {"loss_cancels_answers", "", "sends no answer that waits when the time without a host is over",
       mutant<LossCancelsAnswers>()},
      {"kept_alive_by_long_frames", "", "takes a command with a sixth octet for a sign of life",
       mutant<KeptAliveBySpoiltFrames>(Why::octet_more)},
      {"kept_alive_by_short_frames", "", "takes a command without its check for a sign of life",
       mutant<KeptAliveBySpoiltFrames>(Why::octet_less)},
      {"kept_alive_by_frames_with_gaps", "", "takes a command with a gap in it for a sign of life",
       mutant<KeptAliveBySpoiltFrames>(Why::gap)},
      {"kept_alive_by_wrong_characters", "",
       "takes a command with a wrong parity or without a stop bit for a sign of life",
       mutant<KeptAliveBySpoiltFrames>(Why::wrong_character)},
      {"takes_what_goes_on_behind_answers", "",
       "takes for a frame what follows without a gap on what it did not hear while it drove",
       mutant<TakesWhatGoesOnBehindAnswers>()},
      {"answers_undefined_commands", "", "answers undefined commands where it answers writes",
       mutant<AnswersUndefinedCommands>()},
      {"turns_round_in_1900_us", "", "answers 1.9 ms after it is sure of a command, at each bit rate",
       mutant<TurnsRoundIn1900Microseconds>()},
  };
}

std::vector<NodeRow> node_power_rows() {
  using namespace node_seeded_faults;
  return {
      {"valves_set_at_power_up", "", "has a valve on at power-up", mutant<ValvesSetAtPowerUp>()},
      {"works_without_supply", "", "works when its supply is off", mutant<WorksWithoutSupply>()},
      {"speaks_at_power_up", "", "says something at power-up", mutant<SpeaksAtPowerUp>()},
      {"keeps_octets_over_power_loss", "", "goes on with the frame in which power was lost",
       mutant<KeepsOctetsOverPowerLoss>()},
      {"keeps_valves_over_power_loss", "", "sets its valves at power-up as they were",
       mutant<KeepsValvesOverPowerLoss>()},
      {"deaf_after_power_lost_in_an_answer", "", "takes nothing more after power was lost in its answer",
       mutant<DeafAfterPowerLostInAnAnswer>()},
      {"answers_writes_once", "", "answers writes after the first power-up only",
       mutant<AnswersWritesOnce>()},
  };
}

std::vector<NodeRow> node_sequence_rows() {
  using namespace node_seeded_faults;
  return NodeMutants::for_check({
      {"refused_write_kept", "", "drives the data of a write that it refused at the next read",
       mutant<RefusedWriteKept>()},
      {"least_rate_doubled", "", "works at twice the rate where it is set to 1200 bit/s",
       with_rules<valve_bus::Node>([](valve_bus::Rules& rules) {
         if (rules.bit_rate == 1'200) rules.bit_rate *= 2;
       })},
      {"check_not_reset", "", "goes on with the block check of a frame that was wrong",
       mutant<CheckNotReset>()},
      {"check_skipped_behind_error", "", "does not check the frame after a wrong one",
       mutant<CheckSkippedBehindError>()},
      {"deaf_after_three_errors", "", "receives nothing more after three wrong frames in a row",
       mutant<DeafAfterErrors>(3U)},
      {"long_frame_costs_next", "", "loses the frame after one of more than five octets",
       mutant<LongFrameCostsNext>()},
      {"third_write_lost", "", "loses the write after two equal ones", mutant<ThirdWriteLost>()},
      {"write_behind_write_late", "", "drives the second of two writes when the next command comes",
       mutant<WriteBehindWriteLate>()},
      {"loses_each_fourth_command", "", "does nothing at each fourth command",
       mutant<LosesEachFourthCommand>()},
      {"unknown_command_kept", "", "takes the write after an unknown command for a read",
       mutant<UnknownCommandKept>()},
      {"second_board_skipped", "", "leaves the second board when the first one does not change",
       mutant<SecondBoardSkipped>()},
      {"read_answers_write", "", "answers a read after a write with what was written",
       mutant<ReadAnswersWrite>()},
      {"switches_old_behind_write", "", "answers a read after a write with the switches as they were then",
       mutant<SwitchesOldBehindWrite>()},
      {"repeated_read_answers_old", "", "answers the second of two reads as the first",
       mutant<RepeatedReadAnswersOld>()},
      {"twice_behind_response", "", "answers twice after the response of another node",
       mutant<TwiceBehindResponse>()},
      {"silent_after_power_loss", "", "does not answer the first read after power was lost",
       mutant<SilentAfterPowerLoss>()},
  });
}

}  // namespace

const NodeMutants& node_mutants() {
  static const NodeMutants table(
      "node",
      {node_check_rows, node_command_rows, node_process_rows, node_answer_rows, node_frame_rows,
       node_character_rows, node_loss_rows, node_meanwhile_rows, node_power_rows, node_sequence_rows});
  return table;
}

}  // namespace fieldproof::conformance
