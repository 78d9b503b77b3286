#include <algorithm>

#include "conformance/token_bus/station_host_seeded_faults.hpp"
#include "conformance/token_bus/station_line_seeded_faults.hpp"
#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/station_reception_seeded_faults.hpp"

// Stations whose numbers are not those of their settings, that know short addresses only, or that receive or
// report wrongly over a longer time.
namespace fieldproof::conformance {
namespace {

using token_bus::Rules;
using token_bus::TokenStation;

template <auto member>
auto always(std::decay_t<decltype(std::declval<Rules>().*member)> value) {
  return with_rules<TokenStation>([value](Rules& rules) { rules.*member = value; });
}
template <auto member>
auto at_least(std::decay_t<decltype(std::declval<Rules>().*member)> value) {
  return with_rules<TokenStation>([value](Rules& rules) { rules.*member = std::max(rules.*member, value); });
}
template <auto member>
auto at_most(std::decay_t<decltype(std::declval<Rules>().*member)> value) {
  return with_rules<TokenStation>([value](Rules& rules) { rules.*member = std::min(rules.*member, value); });
}

}  // namespace

std::vector<TokenMutants::Row> token_settings_rows() {
  using namespace token_seeded_faults;
  return {
      {"idle_of_seven_slots", "", "claims after seven slot times, whatever is set",
       always<&Rules::bus_idle_slots>(7)},
      {"idle_of_six_slots_as_the_lowest", "", "claims after six slot times as the lowest, whatever is set",
       always<&Rules::lowest_bus_idle_slots>(6)},
      {"demand_wait_of_four_slots", "", "takes part in a contest for four slot times, whatever is set",
       always<&Rules::demand_wait_slots>(4)},
      {"noise_wait_of_four_slots", "", "waits four slot times after noise, whatever is set",
       always<&Rules::noise_wait_slots>(4)},
      {"response_wait_of_three_slots", "", "waits three slot times for a response, whatever is set",
       always<&Rules::response_wait_slots>(3)},
      {"preamble_of_four_octets", "", "sends four octets of preamble, whatever is set",
       always<&Rules::preamble_octets>(4)},
      {"gap_of_six_octets", "", "leaves a gap of six octets, whatever is set",
       always<&Rules::response_gap_octets>(6)},
      {"gap_of_32_octets_at_most", "", "leaves a gap of 32 octets at most",
       at_most<&Rules::response_gap_octets>(32)},
      {"slot_time_of_28_octets", "", "counts slot times of 28 octets, whatever is set",
       always<&Rules::slot_time_octets>(28)},
      {"slot_time_of_16_octets_at_least", "", "counts slot times of 16 octets at least",
       at_least<&Rules::slot_time_octets>(16)},
      {"slot_time_in_eight_bits", "", "keeps eight bits of the slot time",
       with_rules<TokenStation>([](Rules& rules) { rules.slot_time_octets &= 0xFFU; })},
      {"bit_rate_of_10_megabits", "", "works at 10 Mbit/s, whatever is set",
       always<&Rules::phy_bit_rate>(10'000'000)},
      {"bit_rate_of_5_megabits_at_least", "", "works at 5 Mbit/s at least",
       at_least<&Rules::phy_bit_rate>(5'000'000)},
      {"bit_rate_of_50_megabits_at_most", "", "works at 50 Mbit/s at most",
       at_most<&Rules::phy_bit_rate>(50'000'000)},
      {"one_repetition_at_least", "", "repeats a request once at least",
       at_least<&Rules::max_retry_limit>(1)},
      {"four_repetitions_at_most", "", "repeats a request four times at most",
       at_most<&Rules::max_retry_limit>(4)},
      {"eighteen_tokens_at_least", "", "lets 18 tokens go by at least between two windows",
       at_least<&Rules::max_inter_solicit_count>(24)},
      {"sixteen_tokens_always", "", "lets 16 tokens go by between two windows, whatever is set",
       always<&Rules::max_inter_solicit_count>(16)},
      {"ring_maintenance_ignored", "", "opens windows in a slow ring, too",
       always<&Rules::ring_maintenance_octets>(2'097'151)},
      {"hold_of_2000_octets", "", "serves class 6 for 2000 octet durations, whatever is set",
       always<&Rules::high_priority_hold_octets>(2'000)},
      {"hold_of_ten_octets_at_least", "", "serves class 6 even without a hold time",
       at_least<&Rules::high_priority_hold_octets>(10)},
      {"hold_in_15_bits", "", "keeps 15 bits of the hold time",
       with_rules<TokenStation>([](Rules& rules) { rules.high_priority_hold_octets &= 0x7FFFU; })},
      {"targets_in_16_bits", "", "keeps 16 bits of the target rotation times",
       with_rules<TokenStation>([](Rules& rules) {
         for (std::uint32_t& one : rules.target_rotation_octets) one &= 0xFFFFU;
       })},
      {"zero_is_no_limit", "", "takes a target rotation time of 0 for none", mutant<ZeroIsNoLimit>()},
      {"longest_of_8191_octets", "", "takes frames of 8191 octets, whatever is set",
       always<&Rules::most_octets>(8'191)},
      {"faulty_after_seven", "", "goes offline after seven failures, whatever is set",
       always<&Rules::transmitter_fault_limit>(7)},
      {"blanking_of_24_symbols", "", "blanks its receiver for 24 symbols, whatever is set",
       always<&Rules::blanking_symbols>(24)},
      {"blanking_of_32_symbols", "", "blanks its receiver for 32 symbols, whatever is set",
       always<&Rules::blanking_symbols>(32)},
  };
}

std::vector<TokenMutants::Row> token_line_rows() {
  using namespace token_seeded_faults;
  return {
      {"whole_preamble_needed", "", "needs all of the preamble",
       mutant<HearsOtherwise>(&whole_preamble_needed)},
      {"odd_front_not_found", "", "does not slip by a bit when the front of a preamble is lost",
       mutant<HearsOtherwise>(&odd_front_not_found)},
      {"two_frames_only", "", "receives two frames of a transmission at most",
       mutant<HearsOtherwise>(&two_frames_only)},
      {"stops_at_a_fault", "", "receives nothing after a damaged frame of the same transmission",
       mutant<HearsOtherwise>(&stops_at_a_fault)},
      {"check_before_error_bit", "", "counts a wrong check where the E bit is 1, too",
       mutant<HearsOtherwise>(&check_before_error_bit)},
      {"passes_of_short_addresses", "", "claims and contends in nine passes with any addresses",
       mutant<PassesOfShortAddresses>()},
      {"low_pairs_first", "", "contends by the 16 low bits of its address first", mutant<LowPairsFirst>()},
      {"range_of_low_bits", "", "compares the 16 low bits of addresses", mutant<RangeOfLowBits>()},
      {"length_of_short_addresses", "", "takes data that fit with addresses of 16 bits only",
       mutant<LengthOfShortAddresses>()},
      {"shorter_tokens_taken", "", "takes a token with shorter addresses",
       mutant<HearsOtherwise>(&shorter_token_taken)},
      {"counts_to_nine", "", "counts nine faulty receptions of a kind at most", mutant<CountsToNine>()},
      {"deaf_after_many_faults", "", "understands no frame after 80 faulty receptions",
       mutant<DeafAfterManyFaults>()},
      {"faults_are_contests", "", "contends when it has not understood a frame", mutant<FaultsAreContests>()},
      {"claims_after_faults", "", "claims early when the last receptions were faulty",
       mutant<ClaimsAfterFaults>()},
  };
}

std::vector<TokenMutants::Row> token_host_rows() {
  using namespace token_seeded_faults;
  return {
      {"newest_first", "", "sends what was submitted last first", mutant<QueuesOtherwise>(&in_front)},
      {"higher_priority_first", "", "sends the higher priority of a class first",
       mutant<QueuesOtherwise>(&by_priority)},
      {"timers_begin_with_the_end", "", "begins a rotation timer when the service of its class ends",
       mutant<TimersBeginWithTheEnd>()},
      {"token_kept_between_frames", "", "keeps the token when another sends between its own frames",
       mutant<TokenKeptBetweenFrames>()},
      {"faulty_after_six", "", "goes offline after one failure less",
       with_rules<TokenStation>([](Rules& rules) { rules.transmitter_fault_limit -= 1; })},
      {"faulty_after_eight", "", "goes offline after one failure more",
       with_rules<TokenStation>([](Rules& rules) { rules.transmitter_fault_limit += 1; })},
      {"fault_unreported", "", "does not report that its transmitter is faulty",
       mutant<ReportsOtherwise>(
           ReportsOtherwise::Change{.of_event =
                                        +[](token_bus::Event& event) {
                                          return event.kind != token_bus::EventKind::faulty_transmitter;
                                        }})},
      {"failures_not_forgiven", "", "counts failures to pass the token since it began",
       mutant<FailuresNotForgiven>()},
      {"new_successor_not_taken", "", "keeps its successor when this leaves", mutant<NewSuccessorNotTaken>()},
      {"first_predecessor_kept", "", "takes who passed the first token for its predecessor",
       mutant<FirstPredecessorKept>()},
      {"joins_with_each_token", "", "reports with each token that it has joined",
       mutant<ReportsWithEachToken>(token_bus::EventKind::joined)},
      {"successor_with_each_token", "", "reports a new successor with each token",
       mutant<ReportsWithEachToken>(token_bus::EventKind::successor_changed)},
      {"silent_window_is_a_failure", "", "reports each window as a failure to pass the token",
       mutant<ReportsWindows>(token_bus::EventKind::pass_failed, false)},
      {"alone_in_each_round", "", "reports in each round that it is alone",
       mutant<ReportsWindows>(token_bus::EventKind::sole_station, true)},
      {"noise_reported", "", "reports noise as an unexpected frame", mutant<NoiseReported>()},
      {"follows_outside_of_the_ring", "", "answers who_follows when it has left the ring",
       mutant<FollowsOutside>()},
      {"duplicate_in_the_ring_only", "", "looks for its own address in the ring only",
       mutant<DuplicateInTheRingOnly>()},
      {"answer_to_another_taken", "", "takes set_successor for another as an answer",
       mutant<AnswerToAnotherTaken>()},
      {"any_priority_taken", "", "accepts data of any priority", mutant<TakesAlso>(&of_any_priority)},
      {"any_length_taken", "", "accepts data of any length", mutant<TakesAlso>(&of_any_length)},
      {"groups_are_asked", "", "accepts requests with response to groups",
       mutant<TakesAlso>(&asked_of_groups)},
      {"first_response_kept", "", "keeps the first response of its user", mutant<FirstResponseKept>()},
      {"responds_once", "", "responds to the first request only", mutant<RespondsOnce>()},
      {"wish_taken_once", "", "does what its user wants first, and nothing later", mutant<WishTakenOnce>()},
      {"broadcast_only", "", "reports data for groups to its user where they are for everybody",
       mutant<BroadcastOnly>()},
      {"events_twice", "", "reports each event twice", mutant<EventsTwice>()},
      {"queues_kept", "", "sends after a loss of supply what waited before",
       mutant<KeptOverLoss>(Kept::queues)},
      {"counters_kept", "", "keeps its counters over a loss of supply", mutant<KeptOverLoss>(Kept::counters)},
      {"ring_kept", "", "knows the ring after a loss of supply", mutant<KeptOverLoss>(Kept::ring)},
      {"response_kept", "", "keeps its response over a loss of supply", mutant<KeptOverLoss>(Kept::response)},
      {"wish_kept", "", "keeps over a loss of supply whether it is to be in the ring",
       mutant<KeptOverLoss>(Kept::wish)},
      {"silent_after_loss", "", "does not begin again when its supply returns",
       mutant<KeptOverLoss>(Kept::silence)},
  };
}

}  // namespace fieldproof::conformance
