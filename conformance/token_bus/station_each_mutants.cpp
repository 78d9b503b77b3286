#include "conformance/token_bus/station_each_seeded_faults.hpp"
#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/station_reception_seeded_faults.hpp"

// Stations that are right except in one octet, for one action, or at one place.
namespace fieldproof::conformance {

std::vector<TokenMutants::Row> token_each_rows() {
  using namespace token_seeded_faults;
  constexpr std::uint32_t kTwentyBits = 0xF'FFFF;
  return {
      {"asks_by_32_bits", "", "names 32 bits of its successor when it asks who follows",
       mutant<WritesOtherwise>(&asks_by_32_bits)},
      {"data_to_40_bits", "", "sends data to 40 bits of an address",
       mutant<WritesOtherwise>(&data_to_40_bits)},
      {"long_groups_are_asked", "", "accepts requests with response to groups of 48 bits",
       mutant<TakesAlso>(&asked_of_long_groups)},
      {"even_priority_asks", "", "sends requests with response with the lower priority of their class",
       mutant<WritesOtherwise>(&even_priority_asks)},
      {"two_responses_only", "", "takes two responses of its user, and no more", mutant<TwoResponsesOnly>()},
      {"higher_priority_first_in_the_lowest", "", "sends the higher priority of class 0 first",
       mutant<QueuesOtherwise>(&by_priority_in_the_lowest)},
      {"targets_in_20_bits", "", "keeps target rotation times in 20 bits",
       with_rules<TokenStation>([](Rules& rules) {
         for (auto& one : rules.target_rotation_octets) one &= kTwentyBits;
       })},
      {"maintenance_in_20_bits", "", "keeps the target of ring maintenance in 20 bits",
       with_rules<TokenStation>([](Rules& rules) { rules.ring_maintenance_octets &= kTwentyBits; })},
      {"maintenance_since_the_window", "", "measures for ring maintenance from the window before",
       mutant<MaintenanceSinceTheWindow>()},
      {"group_answers", "", "takes a group that answers in a window for its successor",
       mutant<TakesOtherwise>(&group_answers)},
      {"no_contest_when_it_asks", "", "resolves no contention when it asks who follows",
       mutant<NoContestWhenItAsks>()},
      {"contests_go_on", "", "counts contests on from a window that was given up", mutant<ContestsGoOn>()},
      {"noise_forgives_nothing", "", "counts on after a token that noise shows to be taken",
       mutant<NoiseForgivesNothing>()},
      {"long_frames_kept", "", "keeps its count of frames too long over a loss of supply",
       mutant<LongFramesKept>()},
  };
}

}  // namespace fieldproof::conformance
