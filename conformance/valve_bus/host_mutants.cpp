#include "conformance/valve_bus/host_mutants.hpp"

#include "conformance/valve_bus/character_seeded_faults.hpp"
#include "conformance/valve_bus/host_application_seeded_faults.hpp"
#include "conformance/valve_bus/host_keeping_seeded_faults.hpp"
#include "conformance/valve_bus/host_lasting_seeded_faults.hpp"
#include "conformance/valve_bus/host_request_seeded_faults.hpp"
#include "conformance/valve_bus/host_response_seeded_faults.hpp"
#include "conformance/valve_bus/host_sequence_seeded_faults.hpp"
#include "conformance/valve_bus/host_waiting_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using HostRow = HostMutants::Row;

std::vector<HostRow> host_command_rows() {
  using namespace host_seeded_faults;
  return {
      {"sends_id_100", "MH15", "sends commands to ID 100", mutant<AddressesFrom>(1U, 100U)},
      {"sends_id_0", "", "sends commands to ID 0", mutant<AddressesFrom>(0U, 99U)},
      {"refuses_id_99", "", "refuses commands to ID 99", mutant<AddressesFrom>(1U, 98U)},
      {"refuses_silently", "", "does not report to the PC what it refuses", mutant<RefusesSilently>()},
      {"sends_any_command", "", "sends undefined commands", mutant<SendsAnyCommand>()},
      {"data_exchanged", "MH19", "sends DATA1 in front of DATA0", mutant<DataExchanged>()},
      {"loses_commands", "", "loses each fiftieth command", mutant<LosesCommands>()},
      {"doubles_commands", "", "sends each fiftieth command twice", mutant<DoublesCommands>()},
      {"fifo_wraps_one_early", "MH9", "writes round a FIFO that is one octet shorter than it reads",
       mutant<HostOfFifo<WrapsOneEarly>>()},
      {"overflow_not_told", "MH10", "drops the newest commands of a full FIFO without a word",
       mutant<OverflowNotTold>()},
      {"overflow_drops_oldest", "", "drops the oldest command for a new one when its FIFO is full",
       mutant<HostOfFifo<DropsOldest>>()},
      {"overflow_drops_octets", "", "loses single octets when its FIFO is full, not whole commands",
       mutant<HostOfFifo<LosesPartsOfCommands>>()},
      {"part_sent", "MH11", "sends what it has of a command of which the rest does not come",
       mutant<PartSent>()},
      {"lost_part_reported", "", "reports a part of a command that did not fit", mutant<LostPartReported>()},
      {"overflow_id_of_7_bits", "", "reports the loss of a command with seven bits of its ID",
       mutant<OverflowIdOf7Bits>()},
      {"no_part_of_id_0", "", "does not report a part of a command that begins with 00",
       mutant<NoPartOfId0>()},
      {"attempts_over_power_loss", "", "has as many attempts less after power-up as it had made before",
       mutant<AttemptsOverPowerLoss>()},
      {"no_refresh_after_error_4", "", "does not refresh a write that took its last attempt",
       mutant<NoRefreshAfterError4>()},
      {"earliest_response_fixed", "", "takes what begins 44 us after a request at every bit rate",
       mutant<EarliestResponseFixed>()},
      {"reads_back_after_error_4", "", "reads back a write that nobody has acknowledged",
       mutant<ReadsBackAfterError4>()},
      {"late_until_a_read", "", "counts late frames also after a write", mutant<LateUntilARead>()},
      {"waits_three_time_outs_for_silence", "", "waits three time-outs for a line that is not silent",
       mutant<WaitsThreeTimeOutsForSilence>()},
      {"part_takes_the_fifo", "", "gives up all that is in its FIFO with a part of a command",
       mutant<PartTakesTheFifo>()},
      {"never_resyncs", "", "waits for the rest of a command for ever",
       with_rules<valve_bus::Host>(
           [](valve_bus::Rules& rules) { rules.partial_command_limit = 1000 * kernel::kSecond; })},
      {"resyncs_early", "", "gives up a command of which the rest takes 10 ms",
       with_rules<valve_bus::Host>(
           [](valve_bus::Rules& rules) { rules.partial_command_limit = 10 * kernel::kMillisecond; })},
  };
}

std::vector<HostRow> host_request_rows() {
  using namespace host_seeded_faults;
  return {
      {"request_check_without_id", "MH1", "leaves the ID out of the block check of a request",
       mutant<RequestCheckWithoutId>()},
      {"request_check_is_sum", "", "sends the sum for the block check", mutant<RequestCheckIsSum>()},
      {"requests_without_ninth_bit", "", "sends its characters with a ninth bit of 0",
       mutant<SendsNinthBit0<Host>>()},
      {"wants_a_delimiter_before_responses", "", "takes no response within 3 characters",
       mutant<WantsADelimiterBeforeResponses>()},
      {"busy_told_as_silence", "", "reports no response where the line is not silent",
       mutant<BusyToldAsSilence>()},
      {"gap_in_request", "", "leaves 20 bits of silence inside a request", mutant<GapInRequest>()},
      {"delimiter_missing", "MH12", "sends at once after a response", mutant<DelimiterMissing>()},
      {"delimiter_of_two_silent_characters", "", "leaves two characters of silence between frames",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.delimiter_half_characters = 4; })},
      {"driver_cuts_stop_bit", "MH13", "switches its driver off one bit early", mutant<DriverCutsStopBit>()},
      {"driver_on_with_start_bit", "", "switches its driver on with the start bit",
       mutant<RequestDriver>(0U, 1U)},
      {"driver_stays_on", "", "keeps its driver on for 20 bits after a request",
       mutant<RequestDriver>(1U, 20U)},
      {"requests_late_in_turns", "", "waits 4 ms after each seventh request", mutant<RequestsLateInTurns>()},
      {"dip_off_by_one", "MH20", "takes the bit rate of the next position of its switches",
       mutant<DipOffByOne>()},
      {"clock_off_by_one_percent", "", "has a clock that is 1 % fast", mutant<ClockOffByOnePercent>()},
      {"dip_read_in_operation", "", "takes another bit rate as soon as its switches are turned",
       mutant<DipReadInOperation>()},
  };
}

std::vector<HostRow> host_write_rows() {
  using namespace host_seeded_faults;
  return {
      {"write_waits_for_answer", "MH8", "repeats a write until it is answered",
       mutant<WriteWaitsForAnswer>()},
      {"write_distance_missing", "", "sends a delimiter after a write",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.write_distance = {}; })},
      {"refreshes_first_data", "MH18", "refreshes what it wrote to a node first",
       mutant<RefreshesFirstData>()},
      {"refreshes_each_100_ms", "", "refreshes writes each 100 ms",
       with_rules<valve_bus::Host>(
           [](valve_bus::Rules& rules) { rules.refresh = 100 * kernel::kMillisecond; })},
      {"never_refreshes", "", "sends each write once",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.refresh = 1000 * kernel::kSecond; })},
      {"equal_writes_sent_once", "", "does not send a write that is as the last one",
       mutant<EqualWritesSentOnce>()},
      {"refreshes_over_power_loss", "", "writes after power-up what it wrote last before",
       mutant<RefreshesOverPowerLoss>()},
      {"refreshes_when_idle", "", "refreshes when the PC has ordered nothing", mutant<RefreshesWhenIdle>()},
      {"refreshes_go_first", "", "sends all refreshes that are due before a command",
       mutant<RefreshesGoFirst>()},
      {"verification_not_compared", "", "reads after a write and does not compare",
       mutant<VerificationNotCompared>()},
      {"verifies_refreshes", "", "reads a node after each refresh, too", mutant<VerifiesRefreshes>()},
      {"any_acknowledge_taken", "", "takes any response to a write for its acknowledge",
       mutant<AnyAcknowledgeTaken>()},
      {"acknowledge_not_awaited", "", "does not wait for the acknowledge of a write",
       mutant<AcknowledgeNotAwaited>()},
  };
}

std::vector<HostRow> host_wait_rows() {
  using namespace host_seeded_faults;
  using kernel::kMicrosecond;
  return {
      {"time_out_fixed", "MH6", "has the time-out of 375 kbit/s at every bit rate",
       mutant<TimeOutOtherwise>(3103 * kMicrosecond, 0U)},
      {"time_out_short", "", "has a time-out that is 10 % short", mutant<TimeOutOtherwise>(Duration{}, 90U)},
      {"time_out_long", "", "has a time-out that is 20 % long", mutant<TimeOutOtherwise>(Duration{}, 120U)},
      {"four_attempts", "MH7", "sends a read four times",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.read_attempts = 4; })},
      {"two_attempts", "MH7", "sends a read two times",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.read_attempts = 2; })},
      {"bad_response_not_repeated", "", "does not repeat a read that was answered wrongly",
       mutant<BadResponseNotRepeated>()},
      {"takes_late_response", "MH4", "takes a late response for that of the next node",
       mutant<TakesLateResponse>()},
      {"late_not_counted", "", "does not count late responses", mutant<LateNotCounted>()},
      {"takes_early_response", "", "takes a response that begins with the end of the request",
       mutant<TakesEarlyResponse>()},
      {"waits_long_behind_errors", "", "sends nothing for 20 ms after an error",
       mutant<WaitsLongBehindErrors>()},
      {"waits_for_silence", "", "waits for ever when the line does not fall silent",
       mutant<WaitsForSilence>()},
  };
}

std::vector<HostRow> host_response_rows() {
  using namespace host_seeded_faults;
  using Which = TakesOtherResponses::Which;
  return {
      {"response_not_checked", "MH2", "does not look at the block check of a response",
       mutant<ResponseNotChecked>()},
      {"id_in_response_check", "MH3", "needs the ID in the block check of a response",
       mutant<ResponseCheckWithId>()},
      {"response_check_is_parity", "", "looks at the parity of the block check only",
       mutant<ResponseCheckIsParity>()},
      {"response_check_too_strict", "", "refuses responses of two equal octets",
       mutant<ResponseCheckTooStrict>()},
      {"takes_two_octets", "", "takes a response without its check",
       mutant<TakesOtherResponses>(Which::two_octets)},
      {"takes_first_three_octets", "", "takes the first three octets of a longer frame",
       mutant<TakesOtherResponses>(Which::first_three)},
      {"takes_last_three_octets", "", "takes the last three octets of a longer frame",
       mutant<TakesOtherResponses>(Which::last_three)},
      {"response_gaps_of_three_characters", "", "allows three characters of silence inside a response",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.longest_gap_half_characters = 6; })},
      {"response_gaps_of_one_character", "", "allows one character of silence inside a response",
       with_rules<valve_bus::Host>([](valve_bus::Rules& rules) { rules.longest_gap_half_characters = 2; })},
      {"echo_taken_as_response", "MH5", "takes its own echo for a response", mutant<TakesEcho>()},
      {"keeps_stray_octets", "", "keeps what nobody asked for in front of the next response",
       mutant<KeepsStrayOctets>()},
      {"right_after_wrong_taken", "", "takes a right response after a wrong one",
       mutant<RightAfterWrongTaken>()},
      {"stray_told_as_response", "", "reports what nobody asked for as a response",
       mutant<StrayToldAsResponse>()},
      {"stop_bits_not_looked_at", "MH17", "does not look at stop bits", mutant<StopBitIgnored<Host>>()},
      {"parity_not_looked_at", "", "does not look at parity", mutant<ParityIgnored<Host>>()},
      {"wants_ninth_bit", "", "needs the ninth bit to be 1", mutant<NinthBitRequired<Host>>()},
  };
}

std::vector<HostRow> host_telling_rows() {
  using namespace host_seeded_faults;
  return {
      {"told_twice", "", "reports each response to the PC twice", mutant<ToldTwice>()},
      {"told_of_node_before", "", "reports a response as that of the node that was read before",
       mutant<ToldOfNodeBefore>()},
      {"response_exchanged", "MH19", "reports DATA1 of a response before DATA0", mutant<ResponseExchanged>()},
      {"old_told_as_new", "MH14", "reports old data as new when a read fails", mutant<OldToldAsNew>()},
      {"old_forgotten", "", "does not report old data when a read fails", mutant<OldForgotten>()},
      {"silence_told_as_data", "", "reports FF FF when nothing answers", mutant<SilenceToldAsData>()},
      {"kind_of_any_attempt", "", "reports a wrong response when any attempt had one",
       mutant<KindOfAnyAttempt>()},
      {"old_data_of_any_node", "", "reports what it read last of any node as old data",
       mutant<OldDataOfAnyNode>()},
      {"old_data_told_once", "", "reports old data of a node once", mutant<OldDataToldOnce>()},
      {"equal_responses_told_once", "", "does not report a response that is as the last one",
       mutant<EqualResponsesToldOnce>()},
      {"zeros_not_told", "", "does not report a response of 00 00", mutant<ZerosNotTold>()},
      {"counters_of_8_bits", "", "has counters of 8 bits", mutant<CountersOf8Bits>()},
      {"counters_over_power_loss", "", "counts on after its supply was off", mutant<CountersOverPowerLoss>()},
      {"overflow_over_power_loss", "", "shows an overflow of before its supply was off",
       mutant<OverflowOverPowerLoss>()},
      {"counters_shared", "MH16", "has one set of counters for all nodes", mutant<CountersShared>()},
  };
}

std::vector<HostRow> host_lasting_rows() {
  using namespace host_seeded_faults;
  return {
      {"refresh_counts_from_rest", "", "counts the time to a refresh from the end of the rest",
       mutant<RefreshFromRest>()},
      {"new_write_refreshed_with_old", "", "refreshes a new write when the one before it was due",
       mutant<NewWriteRefreshedWithOld>()},
      {"milliseconds_of_16_bits", "", "refreshes nothing when its milliseconds have gone round 16 bits",
       mutant<MillisecondsOf16Bits>()},
      {"busy_refresh_is_the_last", "", "refreshes no more what it could not send to a busy line",
       mutant<BusyRefreshIsTheLast>()},
      {"refreshes_64_nodes", "", "refreshes 64 nodes at most", mutant<Refreshes64Nodes>()},
      {"refreshes_lowest_first", "", "refreshes the lowest ID that is due", mutant<RefreshesLowestFirst>()},
      {"part_over_power_loss", "", "keeps a part of a command without its supply",
       mutant<PartOverPowerLoss>()},
      {"verification_over_power_loss", "", "reads after power-up what it wrote before",
       mutant<VerificationOverPowerLoss>()},
      {"late_over_power_loss", "", "counts as late what comes after power-up", mutant<LateOverPowerLoss>()},
      {"acknowledged_not_verified", "", "does not read back what was acknowledged",
       mutant<AcknowledgedNotVerified>()},
      {"verified_against_newest", "", "compares with a write that still waits",
       mutant<VerifiedAgainstNewest>()},
  };
}

std::vector<HostRow> host_attempt_rows() {
  using namespace host_seeded_faults;
  return {
      {"no_rest_behind_wrong", "", "sends at once after a last attempt that was wrong",
       mutant<NoRestBehindWrong>()},
      {"late_behind_wrong", "", "counts as late what comes after a wrong response",
       mutant<LateBehindWrong>()},
      {"wrong_acknowledge_told_as_wrong", "", "reports a wrong response where a write was not acknowledged",
       mutant<WrongAcknowledgeToldAsWrong>()},
      {"first_late_counted", "", "counts the first late frame only", mutant<FirstLateCounted>()},
      {"late_counted_for_ever", "", "counts as late what comes after the next request",
       mutant<LateCountedForEver>()},
      {"late_counter_of_8_bits", "", "counts late frames in 8 bits", mutant<LateCounterOf8Bits>()},
      {"old_forgotten_when_busy", "", "does not report old data when the line is busy",
       mutant<OldForgottenWhenBusy>()},
      {"time_out_cut", "", "cuts its time-out to whole milliseconds", mutant<TimeOutCut>()},
      {"pc_delays_characters", "", "sends a character later when the PC writes",
       mutant<PcDelaysCharacters>()},
      {"pc_restarts_time_out", "", "begins its time-out again when the PC writes",
       mutant<PcRestartsTimeOut>()},
      {"repeats_from_the_ring", "", "repeats what stands in its FIFO where the read stood",
       mutant<RepeatsFromTheRing>()},
  };
}

std::vector<HostRow> host_keeping_rows() {
  using namespace host_seeded_faults;
  return {
      {"refresh_acknowledge_not_compared", "", "takes any acknowledge of a refresh",
       mutant<RefreshAcknowledgeNotCompared>()},
      {"refresh_repetitions_not_counted", "", "does not count the repetitions of refreshes",
       mutant<RefreshRepetitionsNotCounted>()},
      {"failed_refresh_not_reported", "", "reports no refresh that was not acknowledged",
       mutant<FailedRefreshesReported>(0U)},
      {"failed_refresh_reported_once", "", "reports the first refresh that was not acknowledged only",
       mutant<FailedRefreshesReported>(1U)},
      {"busy_write_forgotten", "", "does not refresh a write that found no silent line",
       mutant<BusyWriteForgotten>()},
      {"busy_write_leaves_old_data", "", "refreshes the write before one that found no silent line",
       mutant<BusyWriteLeavesOldData>()},
      {"busy_refresh_at_once", "", "sends a refresh that found no silent line as soon as it is silent",
       mutant<BusyRefreshAtOnce>()},
      {"repeats_into_talk", "", "sends a second attempt while others are on the line",
       mutant<RepeatsIntoTalk>()},
      {"waiting_write_stops_refreshes", "", "does not refresh a node for which a write waits",
       mutant<WaitingWriteStopsRefreshes>()},
      {"part_given_up_when_idle", "", "gives up a part of a command when its exchange is over",
       mutant<PartGivenUpWhenIdle>()},
      {"part_given_up_after_110_ms", "", "gives up a part of a command after 110 ms",
       with_rules<valve_bus::Host>(
           [](valve_bus::Rules& rules) { rules.partial_command_limit = 110 * kernel::kMillisecond; })},
      {"wrong_response_not_waited_out", "", "repeats a read at once after a wrong response",
       mutant<WrongNotWaitedOut>(false)},
      {"wrong_acknowledge_not_waited_out", "", "repeats a write at once after a wrong acknowledgement",
       mutant<WrongNotWaitedOut>(true)},
      {"no_rest_behind_read_back", "", "sends at once after a last attempt to read back",
       mutant<NoRestBehindReadBack>()},
      {"late_of_three_octets_counted", "", "counts late frames of three octets only",
       mutant<LateOfThreeOctetsCounted>()},
      {"inverted_check_taken", "", "takes a response with all bits of its check inverted",
       mutant<InvertedCheckTaken>()},
  };
}

std::vector<HostRow> host_sequence_rows() {
  using namespace host_seeded_faults;
  return HostMutants::for_check({
      {"repeated_read_not_sent", "", "answers a read of the node that was read last by itself",
       mutant<RepeatedReadNotSent>()},
      {"one_retry_less_behind_error", "", "sends a read twice only when the one before it failed",
       mutant<OneRetryLessBehindError>()},
      {"old_data_survive_power", "", "reports what it knew before its supply was off",
       mutant<OldDataSurvivePower>()},
      {"rejected_response_kept", "", "takes DATA0 of a response that it rejected for that of the next",
       mutant<RejectedResponseKept>()},
      {"refused_command_costs_next", "", "loses the command after one that it refused",
       mutant<RefusedCommandCostsNext>()},
      {"write_behind_error_exchanged", "", "sends the data of a write after a failed read in the wrong order",
       mutant<WriteBehindErrorExchanged>()},
  });
}

}  // namespace

const HostMutants& host_mutants() {
  static const HostMutants table(
      "host",
      {host_command_rows, host_request_rows, host_write_rows, host_wait_rows, host_response_rows,
       host_telling_rows, host_lasting_rows, host_attempt_rows, host_keeping_rows, host_sequence_rows});
  return table;
}

}  // namespace fieldproof::conformance
