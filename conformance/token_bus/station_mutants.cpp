#include "conformance/token_bus/station_mutants.hpp"

#include "conformance/token_bus/station_check_seeded_faults.hpp"
#include "conformance/token_bus/station_holding_seeded_faults.hpp"
#include "conformance/token_bus/station_reception_seeded_faults.hpp"
#include "conformance/token_bus/station_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using token_bus::FrameKind;
using token_bus::Rules;
using token_bus::TokenStation;
using TokenRow = TokenMutants::Row;

auto idle_slots(unsigned others, unsigned lowest) {
  return with_rules<TokenStation>([=](Rules& rules) {
    rules.bus_idle_slots = others;
    rules.lowest_bus_idle_slots = lowest;
  });
}

std::vector<TokenRow> token_initialisation_rows() {
  using namespace token_seeded_faults;
  return {
      {"idle_of_five_slots", "", "claims after five slot times of silence", idle_slots(5, 6)},
      {"idle_of_nine_slots", "", "claims after nine slot times of silence", idle_slots(9, 6)},
      {"claims_least_pair_first", "TB-1", "claims by the least significant pair of its address first",
       mutant<ClaimsLeastPairFirst>()},
      {"claims_in_single_slots", "TB-2", "claims with 0, 1, 2 or 3 slot times",
       mutant<ClaimsInSingleSlots>()},
      {"idle_of_the_lowest_as_of_others", "TB-3", "claims after seven slot times as the lowest, too",
       idle_slots(7, 7)},
      {"idle_of_others_as_of_the_lowest", "", "claims after six slot times though it is not the lowest",
       idle_slots(6, 6)},
      {"rival_ignored", "TB-4", "goes on with its claim when another claims longer", mutant<RivalIgnored>()},
      {"eight_claims", "", "claims once for each pair of its address, and not once more",
       mutant<ClaimsOtherNumber>(-1)},
      {"ten_claims", "", "claims once more than it must", mutant<ClaimsOtherNumber>(1)},
  };
}

std::vector<TokenRow> token_joining_rows() {
  using namespace token_seeded_faults;
  return {
      {"range_with_its_ends", "TB-9", "answers a solicitation that names it as the successor",
       mutant<RangeWithItsEnds>()},
      {"addresses_high_octet_first", "TB-10", "compares addresses with the first octet highest",
       mutant<AddressesHighOctetFirst>()},
      {"second_window_at_once", "TB-11", "answers in the first window what is for the second",
       mutant<SecondWindowAtOnce>()},
      {"answers_with_successor", "", "answers with another address than its own",
       mutant<AnswersWithSuccessor>()},
      {"contest_not_complemented", "TB-12", "waits in a contest by its bits, not by their complement",
       mutant<ContestNotComplemented>()},
      {"contest_with_the_first_pair_only", "TB-13",
       "looks at the same pair of bits in each pass of a contest", mutant<ContestWithFirstPairOnly>()},
      {"yields_to_nobody", "", "answers in a contest though another was sooner", mutant<YieldsToNobody>()},
      {"successor_is_who_solicited", "", "takes who solicited for its successor",
       mutant<SuccessorIsWhoSolicited>()},
      {"joins_unreported", "", "reports to its user not that it has joined",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{
           .of_event = +[](token_bus::Event& event) { return event.kind != token_bus::EventKind::joined; }})},
      {"reports_about_a_stranger", "", "reports each event about another station",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{.of_event =
                                                             +[](token_bus::Event& event) {
                                                               event.address = 0x22;
                                                               return true;
                                                             }})},
      {"answers_as_the_lost_one", "TB-16", "answers who_follows about itself, not about its predecessor",
       mutant<AnswersAsTheLostOne>()},
      {"always_joins", "", "joins though it is not to be in the ring", mutant<AlwaysJoins>()},
  };
}

std::vector<TokenRow> token_passing_rows() {
  using namespace token_seeded_faults;
  return {
      {"begins_after_four_octets", "", "leaves a gap of four octets only",
       with_rules<TokenStation>([](Rules& rules) { rules.response_gap_octets = 4; })},
      {"token_to_predecessor", "", "passes the token to its predecessor",
       mutant<WritesOtherwise>(+[](Frame& frame, const TokenStation& station) {
         if (frame.kind == FrameKind::token) frame.destination = station.predecessor();
       })},
      {"token_with_data", "", "sends an octet of data in each token",
       mutant<WritesOtherwise>(+[](Frame& frame, const TokenStation&) {
         if (frame.kind == FrameKind::token) frame.data = {0};
       })},
      {"solicits_with_data", "", "sends an octet of data in each solicit_successor_1",
       mutant<WritesOtherwise>(+[](Frame& frame, const TokenStation&) {
         if (frame.kind == FrameKind::solicit_successor_1) frame.data = {0};
       })},
      {"most_significant_bit_first", "", "sends the most significant bit first",
       mutant<MostSignificantBitFirst>()},
      {"opens_no_window", "", "never solicits", mutant<OpensNoWindow>()},
      {"windows_of_two_slots", "", "waits two slot times in one window",
       mutant<WindowsOtherwise>(FrameKind::solicit_successor_1, 2U)},
      {"lowest_opens_one_window", "TB-8", "solicits by solicit_successor_1 as the lowest, too",
       mutant<LowestAsOthers>()},
      {"answer_not_taken", "", "drops the token when a successor answers", mutant<AnswerNotTaken>()},
      {"contention_is_silence", "", "passes the token on when several answer", mutant<ResolvesOften>(0U)},
      {"resolves_once", "", "resolves contention once only", mutant<ResolvesOften>(1U)},
      {"resolves_for_ever", "", "resolves contention without end", mutant<ResolvesOften>(1'000U)},
      {"contest_of_two_windows", "", "waits two slot times in a contest",
       mutant<WindowsOtherwise>(FrameKind::resolve_contention, 2U)},
      {"success_not_seen", "", "takes no frame for the success of its pass", mutant<SuccessNotSeen>()},
      {"leaving_with_exchanged_neighbours", "TB-21", "leaves with successor and predecessor exchanged",
       mutant<LeavesWithExchangedNeighbours>()},
      {"leaves_without_a_word", "", "leaves without naming its successor to its predecessor",
       mutant<LeavesWithoutAWord>()},
  };
}

std::vector<TokenRow> token_failure_rows() {
  using namespace token_seeded_faults;
  return {
      {"token_three_times", "TB-14", "passes the token three times", mutant<StagesOtherwise>(3U, 2U, true)},
      {"who_follows_once", "TB-15", "asks who follows once", mutant<StagesOtherwise>(2U, 1U, true)},
      {"gives_up_after_who_follows", "", "solicits nobody after who_follows",
       mutant<StagesOtherwise>(2U, 2U, false)},
      {"token_repeated_late", "", "asks who follows in four windows",
       mutant<WindowsOtherwise>(FrameKind::who_follows, 4U)},
      {"noise_is_success", "TB-17", "takes noise after its token for a success",
       mutant<NoiseAfterTokenOtherwise>(true)},
      {"noise_is_failure", "TB-18", "repeats the token after noise at once",
       mutant<NoiseAfterTokenOtherwise>(false)},
      {"unexpected_frames_ignored", "TB-19", "keeps the token when another sends",
       mutant<UnexpectedFramesIgnored>()},
      {"one_repetition_more", "", "repeats a request once more", mutant<RepeatsOtherwise>(1)},
      {"no_repetition", "", "never repeats a request", mutant<RepeatsOtherwise>(-2)},
      {"response_not_taken", "", "takes no response", mutant<ResponseNotTaken>()},
      {"duplicate_ignored", "TB-20", "stays when another has its address", mutant<DuplicateIgnored>()},
  };
}

std::vector<TokenRow> token_holding_rows() {
  using namespace token_seeded_faults;
  return {
      {"data_lost", "", "loses data of a thousand octets and more", mutant<DataLost>()},
      {"frame_cut_at_expiry", "TB-7", "cuts the frame that lasts when its time is over",
       mutant<FrameCutAtExpiry>()},
      {"hold_doubled", "", "serves class 6 twice as long", mutant<HoldOtherwise>(200)},
      {"hold_halved", "", "serves class 6 half as long", mutant<HoldOtherwise>(50)},
      {"served_without_time", "TB-6", "serves lower classes without time left", mutant<ServedWithoutTime>()},
      {"priorities_ignored", "", "sends all data with priority 6", mutant<PrioritiesIgnored>()},
      {"timers_begin_with_the_token", "TB-5", "begins the rotation timers when the token comes",
       mutant<TimersBeginWithTheToken>()},
  };
}

std::vector<TokenRow> token_reception_rows() {
  using namespace token_seeded_faults;
  return {
      {"check_not_looked_at", "", "takes frames with any check", mutant<ReadsBy<CheckNotLookedAt>>()},
      {"delivers_as_if_to_itself", "", "gives data to its user as if they were for itself alone",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{
           .of_data =
               +[](Frame& frame, const TokenStation& station) { frame.destination = station.address(); }})},
      {"delivers_from_another", "", "gives data to its user as if another had sent them",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{
           .of_data = +[](Frame& frame, const TokenStation&) { frame.source = 0x22; }})},
      {"delivers_with_another_priority", "", "gives data to its user with another priority",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{
           .of_data = +[](Frame& frame, const TokenStation&) { frame.priority ^= 1U; }})},
      {"check_in_other_order_taken", "TB-23", "takes a check with its octets in the other order, too",
       mutant<ReadsBy<CheckInOtherOrderToo>>()},
      {"error_bit_ignored", "TB-22", "does not look at the E bit", mutant<ReadsBy<ErrorBitIgnored>>()},
      {"takes_8192_octets", "TB-24", "takes frames of 8192 octets", mutant<ReadsBy<LimitOtherwise<1>>>()},
      {"takes_8190_octets", "TB-24", "takes frames of 8190 octets at most",
       mutant<ReadsBy<LimitOtherwise<-1>>>()},
      {"part_of_an_octet_taken", "", "takes frames with a part of an octet", mutant<PartOfAnOctetTaken>()},
      {"noise_not_counted", "", "does not count signal without a start delimiter", mutant<NoiseNotCounted>()},
      {"unknown_control_is_a_token", "", "takes a frame of unknown control for a token",
       mutant<UnderstandsOtherwise>(&unknown_is_token)},
      {"group_source_taken", "", "takes frames from a group",
       mutant<UnderstandsOtherwise>(&group_is_individual)},
      {"longer_tokens_taken", "", "takes a token with longer addresses",
       mutant<UnderstandsOtherwise>(&longer_token_is_one)},
      {"first_frame_only", "", "receives the first frame of a transmission only", mutant<FirstFrameOnly>()},
      {"data_for_others_delivered", "", "reports data for others to its user",
       mutant<DataForOthersDelivered>()},
      {"broadcast_not_delivered", "", "does not report data for everybody", mutant<BroadcastNotDelivered>()},
      {"responds_with_highest_priority", "", "responds with priority 7",
       mutant<RespondsWithHighestPriority>()},
  };
}

std::vector<TokenRow> token_check_rows() {
  using namespace token_seeded_faults;
  return TokenMutants::for_check({
      {"no_holding_time_ignored", "",
       "sends urgent data as long as it may by default where it may not at all",
       with_rules<token_bus::TokenStation>([](token_bus::Rules& rules) {
         if (rules.high_priority_hold_octets == 0)
           rules.high_priority_hold_octets = token_bus::Rules{}.high_priority_hold_octets;
       })},
      {"deaf_after_fault", "", "misses what comes after a faulty reception", mutant<DeafAfterFault>()},
      {"answers_one_solicitation", "", "answers the first solicitation only", mutant<AnswersOnce>()},
      {"same_response_empty", "", "responds without data where the response is that of before",
       mutant<SameResponseEmpty>()},
  });
}

}  // namespace

const TokenMutants& token_station_mutants() {
  static const TokenMutants table(
      "station",
      {token_initialisation_rows, token_joining_rows, token_passing_rows, token_failure_rows,
       token_holding_rows, token_reception_rows, token_settings_rows, token_line_rows, token_host_rows,
       token_anew_rows, token_vocabulary_rows, token_partial_rows, token_each_rows, token_check_rows});
  return table;
}

}  // namespace fieldproof::conformance
