#include "conformance/token_bus/dual_channel_mutants.hpp"

#include <limits>

#include "conformance/token_bus/dual_channel_limit_seeded_faults.hpp"
#include "conformance/token_bus/dual_channel_seeded_faults.hpp"
#include "conformance/token_bus/dual_channel_selection_seeded_faults.hpp"
#include "conformance/token_bus/dual_channel_symbol_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using namespace token_bus;
using ManagerMutant = ChannelManagerMutants::Row;

// The reference with a selection of its own.
template <typename Selection, typename... More>
auto with_selection(More... more) {
  return [=](const ChannelManagerConfiguration& configuration) {
    return std::make_unique<ChannelManager>(configuration,
                                            std::make_unique<Selection>(configuration, more...));
  };
}
// The reference with settings of its own.
template <typename Change>
auto with_settings(Change change) {
  return [change](ChannelManagerConfiguration configuration) {
    change(configuration);
    return std::make_unique<ChannelManager>(configuration);
  };
}
auto with_errors_in_a_row(unsigned count) {
  return with_settings([count](auto& configuration) { configuration.channels.errors_in_a_row = count; });
}
auto with_clean_in_a_row(unsigned count) {
  return with_settings([count](auto& configuration) { configuration.channels.clean_in_a_row = count; });
}
// After so many slot times and symbols without a start delimiter.
auto missing_after(std::int64_t slot_times, std::int64_t symbols) {
  return [=](const ChannelManagerConfiguration& configuration) {
    const kernel::Duration after =
        slots(configuration.rules, slot_times) + mac_symbols(configuration.rules, symbols);
    return std::make_unique<ChannelManager>(
        configuration, std::make_unique<dual_channel_seeded_faults::MissingOtherwise>(configuration, after));
  };
}
auto waiting_for(std::int64_t slot_times) {
  return [=](const ChannelManagerConfiguration& configuration) {
    return std::make_unique<ChannelManager>(configuration,
                                            std::make_unique<dual_channel_seeded_faults::WaitsOtherwise>(
                                                configuration, slots(configuration.rules, slot_times), true));
  };
}

std::vector<ManagerMutant> request_rows() {
  using namespace dual_channel_seeded_faults;
  return {
      {"sends_on_a_alone", "", "sends on channel A alone", mutant<SendsOtherwise>(on_a_alone)},
      {"sends_on_the_preferred_alone", "", "sends on the preferred channel alone",
       mutant<SendsOtherwise>(on_the_preferred_alone)},
      {"silent_on_a_faulty_channel", "", "sends nothing on a channel with a fault",
       mutant<SendsOtherwise>(on_clean_channels)},
      {"commands_on_a_alone", "", "gives commands to channel A alone",
       mutant<SendsOtherwise>(commands_on_a_alone)},
      {"zero_and_one_exchanged_on_b", "", "sends zero as one, and one as zero on channel B",
       mutant<ExchangesBitsOnB>()},
      {"b_is_20_symbols_later", "", "sends on channel B 20 symbols later", mutant<LateByMore>(0U, 20U, 0U)},
      {"slow_requests", "", "sends three times as late as it may", mutant<LateByMore>(16U, 16U, 0U)},
      {"gives_up_after_50000", "", "drops what is longer than 50000 symbols",
       mutant<TakesApart>(std::size_t{0}, std::size_t{50'000})},
      {"answers_dropped", "", "indicates no answer", mutant<AnswersFromElsewhere>(no_answer)},
      {"answers_of_both_mixed", "", "indicates the answers of both channels",
       mutant<AnswersFromElsewhere>(any_answer)},
      {"answers_of_the_preferred_alone", "", "indicates the answers of the preferred channel alone",
       mutant<AnswersFromElsewhere>(of_the_preferred_alone)},
      {"answers_of_the_other_first", "", "indicates the answers of the other channel first",
       mutant<AnswersFromElsewhere>(of_the_other_first)},
  };
}

std::vector<ManagerMutant> selection_rows() {
  using namespace dual_channel_seeded_faults;
  return {
      {"never_leaves_a", "", "indicates channel A alone",
       with_selection<WaitsOtherwise>(kAlmostForEver, false)},
      {"leaves_a_one_later", "", "selects another channel from the next transmission on only",
       with_selection<WaitsOtherwise>(kAlmostForEver, true)},
      {"takes_the_first", "", "selects whichever start delimiter is the first", waiting_for(0)},
      {"waits_for_a_slot_time", "", "waits for the preferred channel for a slot time", waiting_for(1)},
      {"takes_late_copies", "", "selects the same transmission again when it comes later",
       with_selection<TakesLateCopies>()},
      {"prefers_a_always", "", "prefers channel A whoever served",
       with_selection<PrefersOtherwise>(a_always)},
      {"prefers_who_did_not_serve", "", "changes the channel each time",
       with_selection<PrefersOtherwise>(who_did_not_serve)},
      {"indicates_both", "", "indicates the symbols of both channels", mutant<IndicatesBoth>()},
      {"indicates_frames_alone", "", "indicates nothing but transmissions",
       mutant<IndicatesFromElsewhere>(transmissions_alone)},
      {"loses_the_first_symbol", "", "loses the first symbol of what a channel indicates",
       mutant<TakesApart>(std::size_t{1}, std::numeric_limits<std::size_t>::max() / kUnitLevels)},
      {"slow_indications", "", "indicates 24 symbols later than it may", mutant<LateByMore>(0U, 0U, 24U)},
      {"reports_silence", "", "reports a fault where nobody sends", mutant<ReportsSilence>()},
  };
}

std::vector<ManagerMutant> inside_rows() {
  using namespace dual_channel_seeded_faults;
  return {
      {"goes_on_with_the_other", "", "puts the rest of the other channel to a frame that is cut",
       mutant<IndicatesFromElsewhere>(whoever_goes_on)},
      {"switches_at_bad_signal", "", "changes the channel within a frame that is spoiled",
       mutant<IndicatesFromElsewhere>(whoever_is_clean)},
      {"indicates_the_rest", "", "changes to a channel within its transmission",
       mutant<IndicatesFromElsewhere>(the_preferred_always)},
      {"bad_signal_is_silence", "", "indicates silence for bad_signal", mutant<BadSignalIsSilence>()},
      {"selects_each_frame_anew", "", "selects each frame of a transmission anew",
       with_selection<BeginsOtherwise<Begins::always>>()},
      {"waits_for_the_end_of_what_is_spoiled", "", "stays with a spoiled transmission until it ends",
       with_selection<BeginsOtherwise<Begins::never>>()},
      {"waits_for_an_end_for_ever", "", "stays with a transmission that has no end",
       with_selection<BeginsOtherwise<Begins::after_bad_signal>>()},
  };
}

std::vector<ManagerMutant> fault_rows() {
  using namespace dual_channel_seeded_faults;
  return {
      {"reports_nothing", "", "reports no fault", with_selection<ReportsAtOtherTimes<Reports::nothing>>()},
      {"reports_again_and_again", "", "reports a fault whenever it shows",
       with_selection<ReportsAtOtherTimes<Reports::again_and_again>>()},
      {"reports_once_for_ever", "", "reports no second fault of a channel",
       with_selection<ReportsAtOtherTimes<Reports::once_for_ever>>()},
      {"watches_the_preferred_alone", "", "reports faults of the preferred channel alone",
       with_selection<ReportsAtOtherTimes<Reports::of_the_preferred>>()},
      {"reports_the_other_channel", "", "names the other channel",
       with_selection<ReportsOtherwise>(of_the_other_channel)},
      {"reports_another_cause", "", "names another cause",
       with_selection<ReportsOtherwise>(of_another_cause)},
      {"reports_after_2_slots", "", "misses a start delimiter after two slot times", missing_after(2, 0)},
      {"an_abort_stays_selected", "", "stays with a channel whose transmission has ended within the skew",
       with_selection<AnAbortStaysSelected>()},
      {"slot_begins_anew", "", "begins the slot time anew with each start delimiter of the other channel",
       with_selection<SlotBeginsAnew>()},
      {"fault_after_the_skew", "", "misses a start delimiter after the skew", missing_after(0, 9)},
      {"bad_signal_is_no_fault", "", "does not look at bad_signal",
       with_selection<BadSignalOtherwise>(false, false)},
      {"a_collision_is_a_fault", "", "finds a fault in a collision",
       with_selection<BadSignalOtherwise>(true, true)},
      {"bad_signal_at_any_time", "", "finds a fault in bad_signal at any time",
       with_selection<BadSignalOtherwise>(true, false, true)},
      {"stays_after_bad_signal", "", "prefers a channel with bad_signal",
       with_selection<StaysAfterBadSignal>()},
      {"errors_are_no_fault", "", "does not look at frames",
       with_selection<CountsErrorsOtherwise>(no_errors)},
      {"errors_are_never_forgotten", "", "counts errors that are not in a row",
       with_selection<CountsErrorsOtherwise>(errors_for_ever)},
      {"counts_errors_of_both", "", "counts errors that both channels have",
       with_selection<CountsErrorsOtherwise>(errors_of_both)},
      {"counts_the_e_bit", "", "counts E bits as errors of a channel",
       with_selection<CountsErrorsOtherwise>(errors_of_senders_too)},
      {"leaves_after_2", "", "leaves a channel after two errors", with_errors_in_a_row(2)},
      {"leaves_after_4", "", "leaves a channel after four errors", with_errors_in_a_row(4)},
      {"never_clean_again", "", "never reports that a channel is clean",
       with_selection<CountsCleanOtherwise>(never_clean)},
      {"clean_after_one", "", "has a channel clean after one frame", with_clean_in_a_row(1)},
      {"spoiled_is_clean", "", "counts spoiled frames as clean",
       with_selection<CountsCleanOtherwise>(clean_whatever_it_is)},
      {"clean_is_never_forgotten", "", "counts clean frames that are not in a row",
       with_selection<CountsCleanOtherwise>(clean_for_ever)},
      {"returns_to_a_when_it_is_clean", "", "prefers channel A as soon as it is clean",
       with_selection<PrefersOtherwise>(a_when_it_is_clean)},
      {"remembers_over_power_failure", "", "prefers after a failure of the supply what it preferred before",
       mutant<RemembersChannels>()},
  };
}

// Limits that are a symbol off, what is counted beside what, and settings that are not looked at.
std::vector<ManagerMutant> count_rows() {
  using namespace dual_channel_seeded_faults;
  return {
      {"skew_a_symbol_long", "", "waits a symbol too long for the preferred channel",
       with_selection<WaitsForMore>(1)},
      {"skew_a_symbol_short", "", "waits a symbol too short for the preferred channel",
       with_selection<WaitsForMore>(-1)},
      {"slot_a_symbol_long", "", "misses a start delimiter a symbol too late", missing_after(1, 1)},
      {"slot_a_symbol_short", "", "misses a start delimiter a symbol too early", missing_after(1, -1)},
      {"collisions_a_symbol_long", "", "has a collision a symbol more than the skew apart",
       with_selection<CollidesForMore>(1)},
      {"collisions_a_symbol_short", "", "has a collision a symbol less than the skew apart alone",
       with_selection<CollidesForMore>(-1)},
      {"bad_signal_a_symbol_long", "", "finds a fault in bad_signal a symbol after the slot time",
       with_selection<CountsBadSignalForMore>(1)},
      {"bad_signal_a_symbol_short", "", "finds no fault in bad_signal in the last symbol of the slot time",
       with_selection<CountsBadSignalForMore>(-1)},
      {"misses_within_a_frame", "", "misses a start delimiter within a frame",
       with_selection<MissesWithinOtherwise>(true)},
      {"misses_nothing_within_a_transmission", "", "misses no start delimiter within what is spoiled",
       with_selection<MissesWithinOtherwise>(false)},
      {"start_delimiter_of_six", "", "takes six symbols for a start delimiter",
       mutant<ReadsOtherwise>(end_start_delimiters)},
      {"ends_with_silence_alone", "", "does not end a transmission with its end delimiter",
       mutant<ReadsOtherwise>(set_all_i)},
      {"circuit_that_is_anything_is_looked_at", "",
       "takes a symbol for another by a circuit that is anything",
       mutant<ReadsOtherwise>(look_at_any_circuit)},
      {"reports_16_faults", "", "reports sixteen times", mutant<ReportsUntil>(16U, kAlmostForEver)},
      {"misses_nothing_after_4_seconds", "", "reports nothing after four seconds",
       mutant<ReportsUntil>(std::numeric_limits<unsigned>::max(), 4 * kernel::kSecond)},
      {"drops_what_waits", "", "begins anew with each reception",
       mutant<ReceivesOtherwise<Receives::anew_each_time>>()},
      {"deaf_while_it_sends", "", "receives nothing from a channel while it sends",
       mutant<ReceivesOtherwise<Receives::nothing_while_it_sends>>()},
      {"indicates_at_its_own_rate", "", "indicates each symbol for as long as one of its own",
       mutant<ReceivesOtherwise<Receives::at_its_own_rate>>()},
      {"both_spoiled_ends_a_row", "", "counts errors anew after what both channels spoil",
       with_selection<CountsErrorsOtherwise>(errors_until_both)},
      {"neither_ends_a_row", "", "counts errors anew after an E bit of 1",
       with_selection<CountsErrorsOtherwise>(errors_until_neither)},
      {"error_beside_neither_counts", "", "counts an error where the other channel has an E bit of 1",
       with_selection<CountsErrorsOtherwise>(errors_beside_neither)},
      {"neither_is_clean", "", "counts a frame with an E bit of 1 as clean",
       with_selection<CountsCleanOtherwise>(neither_is_clean)},
      {"neither_begins_clean_ones_anew", "", "counts clean ones anew after an E bit of 1",
       with_selection<CountsCleanOtherwise>(clean_until_neither)},
      {"knows_no_most_octets", "", "has no frame that is too long",
       with_settings([](auto& configuration) { configuration.rules.most_octets = Rules{}.most_octets; })},
      {"takes_all_addresses_for_short", "", "takes frames for whole that are too short with 48 bits",
       with_settings(
           [](auto& configuration) { configuration.rules.address_length = AddressLength::bits_16; })},
      {"counts_in_four_bits", "", "keeps the settings of its counts in four bits",
       with_settings([](auto& configuration) {
         configuration.channels.errors_in_a_row &= 15U;
         configuration.channels.clean_in_a_row &= 15U;
       })},
      {"knows_no_slot_time", "", "counts with the usual slot time, whatever is set",
       with_settings(
           [](auto& configuration) { configuration.rules.slot_time_octets = Rules{}.slot_time_octets; })},
      {"knows_no_skew", "", "counts with the usual skew, whatever is set",
       with_settings(
           [](auto& configuration) { configuration.channels.skew_symbols = ChannelRules{}.skew_symbols; })},
  };
}

std::vector<ManagerMutant> manager_check_rows() {
  using namespace dual_channel_seeded_faults;
  return ChannelManagerMutants::for_check({
      {"reports_one_channel_at_a_time", "", "reports no fault while the other channel has one",
       with_selection<ReportsOneChannelAtATime>()},
      {"stays_where_the_other_has_a_fault", "", "leaves no channel while the other one has a fault",
       with_selection<StaysWhereTheOtherHasAFault>()},
  });
}

}  // namespace

const ChannelManagerMutants& channel_manager_mutants() {
  static const ChannelManagerMutants table("channel_manager", {request_rows, selection_rows, inside_rows,
                                                               fault_rows, count_rows, manager_check_rows});
  return table;
}

}  // namespace fieldproof::conformance
