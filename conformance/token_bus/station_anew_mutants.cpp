#include "conformance/token_bus/station_anew_seeded_faults.hpp"
#include "conformance/token_bus/station_mutants.hpp"

// Stations that are right at first.
namespace fieldproof::conformance {

std::vector<TokenMutants::Row> token_anew_rows() {
  using namespace token_seeded_faults;
  return {
      {"contest_goes_on_from_before", "", "contends by the next pair though it is solicited anew",
       mutant<ContestGoesOn>()},
      {"claim_goes_on_from_before", "", "claims by the next pair though it has given up before",
       mutant<ClaimGoesOn>()},
      {"contests_used_up", "", "resolves nine contests in all", mutant<ContestsUsedUp>()},
      {"search_goes_on_from_before", "", "seeks a new successor from where the search before ended",
       mutant<SearchGoesOn>()},
      {"second_noise_is_success", "", "takes noise after a repeated token for a success",
       mutant<SecondNoiseIsSuccess>()},
      {"repetitions_used_up", "", "repeats the first request only", mutant<RepetitionsUsedUp>()},
      {"neighbours_kept_by_a_claim", "", "keeps its neighbours when it claims the token",
       mutant<NeighboursKeptByClaim>()},
      {"window_not_held_open", "", "passes the token on while an answer lasts",
       mutant<BeginsNotSeen>(AccessState::await_response)},
      {"response_not_waited_for", "", "repeats a request while its response lasts",
       mutant<BeginsNotSeen>(AccessState::await_ifm_response)},
      {"success_not_waited_for", "", "repeats the token while its successor sends",
       mutant<BeginsNotSeen>(AccessState::check_token_pass)},
      {"blanks_always", "", "blanks its receiver after a frame that another follows", mutant<BlanksAlways>()},
      {"group_is_successor", "", "takes a group that is named for its successor", mutant<GroupIsSuccessor>()},
      {"successor_of_another_taken", "", "takes the successor that is named to another",
       mutant<SuccessorOfAnotherTaken>()},
      {"members_do_not_contend", "", "contends outside of the ring only", mutant<MembersDoNotContend>()},
      {"responds_in_the_ring_only", "", "responds in the ring only", mutant<RespondsInTheRingOnly>()},
      {"responds_for_groups", "", "responds to requests for groups", mutant<RespondsForGroups>()},
      {"hold_begins_with_the_first_frame", "", "counts the hold time from its first frame on",
       mutant<HoldBeginsWithFirstFrame>()},
      {"lower_classes_held_too", "", "serves lower classes for the hold time of class 6 at most",
       mutant<LowerClassesHeldToo>()},
      {"leaves_with_data_left", "", "leaves the ring though data wait", mutant<LeavesWithDataLeft>()},
      {"joins_once", "", "reports only the first time that it has joined",
       mutant<ReportsLess>(token_bus::EventKind::joined, false)},
      {"data_lost_with_the_token", "", "reports no data that cost it the token",
       mutant<ReportsLess>(token_bus::EventKind::unexpected_frame, true)},
  };
}

}  // namespace fieldproof::conformance
