#include "conformance/interbus/master_mutants.hpp"

#include "conformance/interbus/master_at_ends_mutants.hpp"
#include "conformance/interbus/master_at_length_seeded_faults.hpp"
#include "conformance/interbus/master_id_cycle_seeded_faults.hpp"
#include "conformance/interbus/master_seeded_faults.hpp"
#include "conformance/interbus/master_sequence_seeded_faults.hpp"
#include "conformance/interbus/master_stop_seeded_faults.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::MasterState;

// A count that goes round before it reaches the limit.
unsigned never_beyond(const interbus::Rules& rules, unsigned most) {
  return rules.stop_after_bad_cycles > most ? 1'000'000 : rules.stop_after_bad_cycles;
}

constexpr unsigned kDeepestRing = 30;

std::vector<MasterMutants::Row> master_rows() {
  using namespace seeded_faults;
  using interbus::Rules;
  return {
      {"loopback_not_compared", "MM1", "takes any word for the loopback word", mutant<LoopbackNotCompared>()},
      {"loopback_position_not_compared", "MM2", "takes the loopback word wherever it comes back",
       mutant<LoopbackPositionNotCompared>()},
      {"own_check_ignored", "MM3", "does not compare the check of what came back", mutant<OwnCheckIgnored>()},
      {"status_word_ignored", "MM4", "takes a cycle whose status word is marked",
       mutant<StatusWordIgnored>()},
      {"inputs_taken_before_check", "MM5", "gives the application the inputs of rejected cycles",
       mutant<InputsTakenBeforeCheck>()},
      {"inputs_zeroed_on_error", "MM6", "sets all inputs to 0 on a rejected cycle",
       mutant<InputsZeroedOnError>()},
      {"no_id_cycle_after_error", "MM7", "goes on with data cycles after a rejected one",
       mutant<NoIdCycleAfterError>()},
      {"consecutive_never_cleared", "MM8", "a good data cycle does not clear the count of bad ones in a row",
       mutant<ConsecutiveNeverCleared>()},
      {"stop_one_late", "MM9", "stops the bus one bad cycle too late",
       with_rules<interbus::Master>([](Rules& rules) { ++rules.stop_after_bad_cycles; })},
      {"quality_window_too_short", "MM10", "counts bad cycles over a tenth of the window",
       with_rules<interbus::Master>([](Rules& rules) { rules.quality_window_cycles /= 10; })},
      {"quality_bit_early", "", "sets the quality bit one bad cycle too early",
       with_rules<interbus::Master>([](Rules& rules) { --rules.quality_bad_cycles; })},
      {"first_station_first", "MM11", "sends the outputs of the first station first",
       mutant<FirstStationFirst>()},
      {"length_code_binary", "MM12", "reads the length code as a binary number of words",
       mutant<LengthCodeBinary>()},
      {"check_omits_loopback", "MM13", "leaves the loopback word out of the sent check",
       mutant<CheckOmitsLoopback>()},
      {"check_covers_headers", "MM13", "takes the headers into the sent check", mutant<CheckCoversHeaders>()},
      {"outputs_torn", "MM14", "sends the second half of the outputs as they were a cycle before",
       mutant<OutputsTorn>()},
      {"silent_in_long_pauses", "MM15", "sends no status telegrams in pauses longer than 25 ms",
       mutant<SilentInLongPauses>()},
      {"cycle_time_without_ring_delay", "MM16", "leaves the delay of the stations out of the cycle time",
       mutant<CycleTimeWithoutRingDelay>()},
      {"ring_longer_by_an_octet_accepted", "MM17", "also takes a loopback word that comes one octet late",
       mutant<RingLongerByAnOctetAccepted>()},
      {"id_type_ignored", "MM18", "compares only the length of ID codes", mutant<IdTypeIgnored>()},
      {"counter_saturates", "MM19", "its error counters stay at 255", mutant<CounterSaturates>()},
      {"wrong_segment", "MM20", "names the segment after the disturbed one", mutant<WrongSegment>()},
      {"copied_one_cycle_late", "MM21", "copies the inputs of the cycle before",
       mutant<CopiedOneCycleLate>()},
      {"restart_without_id_cycle", "MM22", "restarts with data cycles", mutant<RestartWithoutIdCycle>()},
      {"id_cycle_without_select", "", "sends ID cycles with the headers of data cycles",
       mutant<IdCycleWithoutSelect>()},
      {"select_dropped_in_check", "", "sends the check phase of ID cycles with the headers of data cycles",
       mutant<SelectDroppedInCheck>()},
      {"branches_not_searched", "", "never looks after a second outgoing interface",
       mutant<BranchesNotSearched>()},
      {"bit_rate_kept", "", "drives and reads at 500 kbit/s whatever it is set to",
       with_rules<interbus::Master>([](Rules& rules) { rules.bit_rate = 500'000; })},
      {"station_limit_ignored", "", "takes more stations than allowed",
       with_rules<interbus::Master>([](Rules& rules) { rules.max_stations *= 2; })},
      {"point_limit_ignored", "", "takes more I/O points than allowed",
       with_rules<interbus::Master>([](Rules& rules) { rules.max_io_points *= 2; })},
      {"cycle_start_wanders", "", "starts every second cycle late by 2 % of the cycle time",
       mutant<CycleStartWanders>()},
      {"telegram_count_ignored", "", "does not count the telegrams that come back",
       mutant<TelegramCountIgnored>()},
      {"implausible_inputs_rejected", "", "rejects cycles in which more than three input bits change",
       mutant<ImplausibleInputsRejected>()},
      {"silence_taken_for_good", "", "takes a cycle that does not come back for a good one",
       mutant<SilenceTakenForGood>()},
      {"fault_not_searched", "", "stays stopped without looking for the fault", mutant<FaultNotSearched>()},
      {"copies_every_second_cycle", "", "runs the copy task only after every second cycle",
       mutant<CopiesEverySecondCycle>()},
      {"request_taken_as_it_is", "", "takes a requested cycle time below the shortest possible",
       mutant<RequestTakenAsItIs>()},
      {"changed_ring_ignored", "", "goes on when an ID cycle shows another ring",
       mutant<ChangedRingIgnored>()},
      {"peripheral_fault_not_reported", "", "does not report peripheral faults",
       mutant<PeripheralFaultNotReported>()},
      {"reconfiguration_not_reported", "", "does not report reconfiguration requests",
       mutant<ReconfigurationNotReported>()},
      {"stop_bit_ignored", "", "takes telegrams without a stop bit", mutant<StopBitIgnored>()},
      {"no_clock_tolerance", "", "receives only a return line of exactly its own rate",
       mutant<NoClockTolerance>()},
      {"telegrams_without_gap", "", "leaves no gap between the telegrams of a cycle",
       with_rules<interbus::Master>([](Rules& rules) { rules.telegram_gap_millibits = 0; })},
      {"drives_over_itself", "", "begins a transmission before the one before has left",
       mutant<DrivesOverItself>()},
      {"stop_keeps_outputs", "", "stops without setting the outputs to 0", mutant<StopKeepsOutputs>()},
      {"inputs_frozen", "", "gives the application the inputs of its first data cycle for ever",
       mutant<InputsFrozen>()},
      {"id_cycle_only_claimed", "", "counts an ID cycle after a rejected one, but sends none",
       mutant<IdCycleOnlyClaimed>()},
      {"outputs_one_cycle_late", "", "sends the outputs as they were a cycle before",
       mutant<OutputsOneCycleLate>()},
      {"silent_after_first_data_cycle", "", "falls silent after its first data cycle",
       mutant<SilentAfterFirstDataCycle>()},
      {"silent_after_error", "", "falls silent after the first cycle that it rejects",
       mutant<SilentAfterError>()},
      {"id_cycles_for_ever_after_error", "", "sends ID cycles only after the first cycle that it rejects",
       mutant<IdCyclesForEverAfterError>()},
      {"first_cycles_rejected", "", "rejects its first data cycle", mutant<FirstCyclesRejected>()},
      {"pauses_in_identification", "", "waits 30 ms in silence between the cycles of the recognition",
       mutant<PausesIn<MasterState::identification>>()},
      {"pauses_in_locating", "", "waits 30 ms in silence between the cycles of the search for a fault",
       mutant<PausesIn<MasterState::locating>>()},
      {"later_words_of_a_station_frozen", "", "renews the first three input words of a station only",
       mutant<LaterWordsOfAStationFrozen>()},
      {"third_copy_lost", "", "copies two words and no more", mutant<ThirdCopyLost>()},
      {"lone_station_not_placed", "", "finds no place of a fault in a ring of one station",
       mutant<LoneStationNotPlaced>()},
      {"recognition_stops_late", "", "ends a recognition one bad cycle too late",
       mutant<RecognitionStopsLate>()},
      {"recognition_adds_up", "", "adds the bad cycles of a recognition up", mutant<RecognitionAddsUp>()},
      {"messages_of_recognition_lost", "", "reports no peripheral fault that a recognition has seen",
       mutant<MessagesOfRecognitionLost>()},
      {"order_in_id_cycle_lost", "", "takes the ID cycle on the line for the one that is asked for",
       mutant<OrderInIdCycleLost>()},
      {"looks_at_eight_stations", "", "reports messages of the first eight stations only",
       mutant<LooksAtEightStations>()},
      {"place_in_ring_order", "", "names the station before in the ring where it is the one it hangs on",
       mutant<PlaceInRingOrder>()},
      {"writes_256_words", "", "writes the word that eight bits of its number say", mutant<Writes256Words>()},
      {"counts_bad_cycles_in_4_bits", "", "counts bad cycles in a row in four bits",
       with_rules<interbus::Master>(
           [](Rules& rules) { rules.stop_after_bad_cycles = never_beyond(rules, 15); })},
      {"counts_bad_cycles_in_8_bits", "", "counts bad cycles in a row in eight bits",
       with_rules<interbus::Master>(
           [](Rules& rules) { rules.stop_after_bad_cycles = never_beyond(rules, 255); })},
      {"cycle_time_in_32_bits", "", "keeps the cycle time that is requested in 32 bits of nanoseconds",
       mutant<CycleTimeIn32Bits>()},
      {"each_branch_is_level_2", "", "takes a branch of a branch for one of the second level",
       with_rules<interbus::Master>([](Rules& rules) {
         if (rules.max_levels > 1) rules.max_levels = kDeepestRing;
       })},
      {"orders_of_id_cycles_add_up", "", "meets two orders for an ID cycle by two of them",
       mutant<OrdersOfIdCyclesAddUp>()},
      {"stop_before_run_ignored", "", "ignores a stop in any state but run", mutant<StopBeforeRunIgnored>()},
      {"early_output_kept", "", "sends an output that was written before it ran", mutant<EarlyOutputKept>()},
      {"inputs_cleared_by_stop", "", "sets all inputs to 0 when it is stopped",
       mutant<InputsClearedByStop>()},
      {"output_after_stop_kept", "", "keeps an output that is written after a stop was ordered",
       mutant<OutputAfterStopKept>()},
      {"bad_stop_cycle_repeated", "", "repeats the data cycle of a stop until a good one comes back",
       mutant<BadStopCycleRepeated>()},
      {"start_begins_again", "", "begins again when it is started within a recognition",
       mutant<StartBeginsAgain>()},
      {"last_end_telegram_not_counted", "", "takes a cycle whose last end telegram is missing",
       mutant<LastEndTelegramNotCounted>()},
      {"copies_zero_for_no_word", "", "copies 0 from a word that the ring does not have",
       mutant<CopiesZeroForNoWord>()},
      {"message_bit_kept", "", "looks for peripheral faults at 8000h, whatever it is set to",
       with_rules<interbus::Master>([](Rules& rules) { rules.message_peripheral_fault = 0x8000; })},
      {"pulse_widths_even", "", "copies pulses of an odd number of cycles one cycle shorter",
       mutant<PulseWidthsEven>()},
  };
}

std::vector<MasterMutants::Row> master_check_rows() {
  using namespace seeded_faults;
  return MasterMutants::for_check({
      {"stop_after_one_ignored", "", "stops the bus after two bad cycles where it is set to one",
       with_rules<interbus::Master>([](interbus::Rules& rules) {
         rules.stop_after_bad_cycles = std::max(rules.stop_after_bad_cycles, 2U);
       })},
      {"second_mark_accepted", "", "takes a marked status word when the one before was marked, too",
       mutant<SecondMarkAccepted>()},
      {"stop_one_early_after_restart", "", "once stopped and started, stops the bus one bad cycle too early",
       mutant<StopOneEarlyAfterRestart>()},
      {"inputs_stale_after_id_cycle", "",
       "keeps the inputs in the first data cycle after an ID cycle that was asked for",
       mutant<InputsStaleAfterIdCycle>()},
      {"output_after_error_lost", "", "does not take outputs that are written after a rejected cycle",
       mutant<OutputAfterErrorLost>()},
      {"first_fault_reported_only", "", "reports the peripheral fault of one station only",
       mutant<FirstFaultReportedOnly>()},
      {"copy_skipped_after_error", "",
       "does not run the copy task after the first good cycle after a bad one",
       mutant<CopySkippedAfterError>()},
  });
}

}  // namespace

const MasterMutants& master_mutants() {
  static const MasterMutants table("master", {master_rows, master_rows_at_ends, master_check_rows});
  return table;
}

}  // namespace fieldproof::conformance
