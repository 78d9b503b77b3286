#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"

// How a station makes a token where there is none.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::standard;

TokenStep first_claim(unsigned slots) {
  return says(fmt::format("the first claim after {} slot times of silence", slots), {TokenControl::claim},
              after_slots(slots), "claim_missing", "claim_wrong");
}

void address_with_all_pairs(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.address = 0xE41A;  // 11 10 01 00 00 01 10 10
}

}  // namespace

std::vector<TokenCase> token_initialisation_cases() {
  return {
      on_chart(token_must("initialisation/first_claim_after_seven_slots", "TB-01",
                          "A station that wants to be in the ring claims the token after seven slot times of "
                          "silence.",
                          memory("bus_idle_timer"),
                          {{"idle_of_five_slots", "begins_too_early"},
                           {"idle_of_nine_slots", "claim_missing"},
                           {"most_significant_bit_first", "claim_wrong"}}),
               {{}, {first_claim(7)}}),
      on_chart(
          token_must("initialisation/claims_are_as_long_as_two_bits_say", "TB-02",
                     "A claim carries 0, 2, 4 or 6 slot times of octets, by two bits of the address, the "
                     "most significant pair first.",
                     memory("order of the pairs"),
                     {{"claims_least_pair_first", "claim_length_wrong"},
                      {"claims_in_single_slots", "claim_length_wrong"}}),
          {{}, {claims()}}, {.adjust = address_with_all_pairs}),
      on_chart(
          token_must("initialisation/yields_to_a_longer_claim", "TB-03",
                     "A station that receives something at the end of the slot time after its claim gives "
                     "up.",
                     standard("claim process"), {{"rival_ignored", "claims_on"}}),
          {{}, {first_claim(7), wait(20), noise(30), silence(6 * 28, "claims_on", "another claims longer")}}),
      on_chart(
          token_must("initialisation/the_last_silent_pass_gives_the_token", "TB-04",
                     "A claim that is silent in all passes has the token: the station sends, or solicits "
                     "successors.",
                     memory("passes: pairs of the address and one"),
                     {{"eight_claims", "claim_wrong"}, {"ten_claims", "no_use_of_the_token"}}),
          {{},
           {claims(), says("anybody is solicited by who is alone", {TokenControl::solicit_2, kOwnAddress},
                           after_slots(1), "no_use_of_the_token", "no_use_of_the_token")}}),
      on_chart(token_must("initialisation/activity_begins_the_idle_time_anew", "TB-05",
                          "Whatever is on the line begins bus_idle_timer anew.", standard("bus_idle_timer"),
                          {{"idle_of_five_slots", "claims_early"}}),
               {{},
                {wait(193), noise(4), silence(7 * 28 - 2, "claims_early", "the line was active"),
                 first_claim(7)}}),
      on_chart(
          token_must("initialisation/the_lowest_claims_a_lost_token_first", "TB-35",
                     "The station with the lowest address of the ring claims a lost token after six slot "
                     "times.",
                     memory("bus_idle_timer of the lowest address"),
                     {{"idle_of_the_lowest_as_of_others", "begins_too_late"}}),
          {{}, {joined_as_lowest(), first_claim(6)}}),
      on_chart(
          token_must("initialisation/others_claim_a_lost_token_later", "TB-35",
                     "A station that is not the lowest claims a lost token after seven slot times.",
                     memory("bus_idle_timer"), {{"idle_of_others_as_of_the_lowest", "begins_too_early"}}),
          {{}, {joined(), first_claim(7)}}),
  };
}

}  // namespace fieldproof::conformance
