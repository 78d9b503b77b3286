#include <array>
#include <utility>
#include <vector>

#include "conformance/token_bus/station_words.hpp"

// Situations in which a fault of a station shows that random commands would seldom meet, with the settings
// that matter in them; and the words that do a row of things at once.
namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 5> kLoads{1, 2, 3, 5, 20};
constexpr std::array<std::int64_t, 4> kLoadSizes{20, 1'000, 2'000, 8'000};
constexpr std::array<std::int64_t, 6> kFailures{1, 2, 5, 6, 7, 8};
constexpr std::array<std::int64_t, 3> kClaims{1, 2, 16};
constexpr std::array<std::int64_t, 5> kSlowSlots{20, 100, 400, 780, 1'000};
constexpr std::array<std::int64_t, 4> kSlowRounds{1, 2, 4, 24};

}  // namespace

// They are long: only situations have them.
std::vector<SequenceWord> words_of_many() {
  return {
      {.word = "load",
       .meaning = "the user submits so many data for 0004, of so many octets each",
       .numbers = {{"priority", 0, 7, 0},
                   {"count", 1, 20, 2, kLoads, true},
                   {"size", 0, 8'000, 20, kLoadSizes, true}},
       .weight = 0,
       .is_no_frame = true},
      {.word = "beside",
       .meaning = "frames that are nearly for, from or about the station, one for each octet of an address",
       .numbers = {{"kind", 0, static_cast<std::int64_t>(TokenBeside::controls), 0}},
       .weight = 0,
       .is_no_frame = true},
      {.word = "failures",
       .meaning = "the station joins, gets the token, and nobody is there any more, so often",
       .numbers = {{"times", 1, 64, 1, kFailures, true}},
       .weight = 0,
       .is_no_frame = true},
      {.word = "claims",
       .meaning = "silence until the station has claimed the token, which another has as well, so often",
       .numbers = {{"times", 1, 20, 1, kClaims, true}},
       .weight = 0,
       .is_no_frame = true},
      {.word = "slow_rounds",
       .meaning = "rounds of the token that last so many slot times each, so often",
       .numbers = {{"slots", 10, 1'000, 20, kSlowSlots, true}, {"times", 1, 24, 1, kSlowRounds, true}},
       .weight = 0,
       .is_no_frame = true}};
}

namespace token_situations {
namespace {

using Situations = std::vector<NamedSituation>;

const NamedCommand kOffered{"solicit"};
const NamedCommand kPassed{"token"};
const NamedCommand kSilentPeer{"peer", {{"does", 0}}};
const NamedCommand kAsksWithResponse{"submit_request"};
// Who has solicited passes it the token when it has answered, or resolves contention before.
const NamedCommand kTakenIn{"reply", {{"to", 6}, {"with", 1}}};

NamedCommand replies(TokenCue to, TokenReply with, std::int64_t times = 1, std::int64_t after = 8) {
  return {"reply",
          {{"to", static_cast<std::int64_t>(to)},
           {"with", static_cast<std::int64_t>(with)},
           {"times", times},
           {"after", after}}};
}
NamedCommand load(std::int64_t priority, std::int64_t count, std::int64_t size) {
  return {"load", {{"priority", priority}, {"count", count}, {"size", size}}};
}
NamedCommand beside(TokenBeside kind) {
  return {"beside", {{"kind", static_cast<std::int64_t>(kind)}}};
}
NamedCommand others(std::int64_t octets) {
  return {"others", {{"octets", octets}}};
}
NamedCommand rounds(std::int64_t times) {
  return {"many", {{"what", static_cast<std::int64_t>(TokenSeries::rounds)}, {"times", times}}};
}
NamedCommand slow_rounds(std::int64_t slots, std::int64_t times) {
  return {"slow_rounds", {{"slots", slots}, {"times", times}}};
}
NamedCommand failures(std::int64_t times) {
  return {"failures", {{"times", times}}};
}
NamedCommand desired(std::int64_t is_desired) {
  return {"in_ring", {{"desired", is_desired}}};
}
NamedCommand response_of(std::int64_t size) {
  return {"respond", {{"size", size}}};
}
NamedCommand after_symbols(std::int64_t symbols) {
  return {"soon", {{"symbols", symbols}}};
}
NamedCommand formed(TokenEnding ending) {
  return {"form", {{"ending", static_cast<std::int64_t>(ending)}}};
}
NamedCommand spike(std::int64_t symbols) {
  return {"spike", {{"symbols", symbols}}};
}

const ShownSetting kLongAddresses{"address_length"};
// Slots so long that a round lasts without many frames.
const field::Settings kLongSlots{
    {"slot_time_octets", 1'362}, {"bus_idle_slots", 64}, {"lowest_bus_idle_slots", 64}};

// Addresses that differ in one octet, of both lengths.
Situations of_addresses() {
  const std::vector<ShownSetting> either{kLongAddresses, {"preamble_octets"}};
  return {{{kTakenIn, kOffered, beside(TokenBeside::token_to), beside(TokenBeside::data_to)}, either},
          {{kTakenIn, kOffered, beside(TokenBeside::data_from), kPassed}, either},
          {{kTakenIn, kOffered, beside(TokenBeside::successor_to), kPassed}, either},
          {{beside(TokenBeside::solicited_below), beside(TokenBeside::solicited_above)}, either},
          {{kTakenIn, kOffered, beside(TokenBeside::follows_another), beside(TokenBeside::controls)}, either},
          {{response_of(10), beside(TokenBeside::request_to), {"request"}}, either},
          {{beside(TokenBeside::token_from)}, {kLongAddresses}},
          // Asks for all of the address that it has lost.
          {{kSilentPeer, {"frame", {{"control", 0}, {"to", 0}, {"from", 9}}}}, {kLongAddresses}},
          {{{"ask", {{"action", 1}, {"to", 1}}}, {"ask", {{"action", 1}, {"to", 2}}}, kOffered, kPassed},
           {kLongAddresses}}};
}

Situations of_joining() {
  const NamedCommand contended = replies(TokenCue::successor, TokenReply::contest, 8);
  const std::vector<ShownSetting> waits{{"demand_wait_slots"}, {"demand_wait_slots"}};
  return {{{contended, kOffered, contended, kOffered}, {{"preamble_octets"}, {"blanking_symbols"}}},
          {{replies(TokenCue::successor, TokenReply::contest, 20), kOffered}, {kLongAddresses}},
          {{replies(TokenCue::successor, TokenReply::contest_then_noise, 3), kOffered}},
          {{replies(TokenCue::successor, TokenReply::token, 1, 45), kOffered, kPassed}, waits},
          {{replies(TokenCue::successor, TokenReply::what_is_due, 1, 45), kOffered}, waits},
          {{replies(TokenCue::successor, TokenReply::what_is_due, 1, 185), kOffered}, waits},
          {{replies(TokenCue::successor, TokenReply::contest, 3, 185), kOffered}, waits},
          {{kTakenIn, kOffered, desired(0), kPassed, desired(1), kTakenIn, kOffered}},
          {{desired(0), desired(1), kTakenIn, kOffered}}};
}

// Classes of data, and how long the token has been away.
Situations of_rotation() {
  Situations all;
  for (const std::int64_t priority : {0, 2, 4}) {
    const std::string target = "target_rotation_octets_" + std::to_string(2 - priority / 2);
    const std::int64_t target_octets = 20'000 * (1 + priority / 2);
    const NamedCommand away = others(target_octets / 2);
    all.push_back(
        {{kTakenIn, kOffered, load(6, 2, 1'000), kPassed, load(priority, 20, 2'000), away, kPassed}});
    all.push_back({{kTakenIn, kOffered, kPassed, load(priority, 3, 2'000), kPassed, load(priority, 20, 2'000),
                    away, kPassed, away, kPassed}});
    all.push_back({{kTakenIn, kOffered, load(priority, 3, 20), others(70'000), kPassed, others(70'000),
                    kPassed, others(70'000), kPassed, others(70'000), kPassed, kPassed}});
    all.push_back({{kTakenIn,
                    kOffered,
                    load(priority + 1, 1, 20),
                    load(priority, 1, 20),
                    {"submit", {{"priority", priority + 1}}},
                    kPassed,
                    kPassed},
                   {{target}, {target}}});
    all.push_back({{kTakenIn, kOffered, load(priority, 2, 20), slow_rounds(100, 1)}, {{target, kLongSlots}}});
    all.push_back({{kTakenIn, kOffered, load(priority, 2, 20), slow_rounds(780, 1)}, {{target, kLongSlots}}});
  }
  const field::Settings short_slots{
      {"slot_time_octets", 200}, {"bus_idle_slots", 64}, {"lowest_bus_idle_slots", 64}};
  all.push_back({{kTakenIn, kOffered, slow_rounds(100, 24)},
                 {{"max_inter_solicit_count", short_slots}, {"preamble_octets", short_slots}}});
  all.push_back({{kTakenIn, kOffered, slow_rounds(780, 24)},
                 {{"ring_maintenance_octets", kLongSlots}, {"ring_maintenance_octets", kLongSlots}}});
  return all;
}

Situations of_holding() {
  return {{{kTakenIn, kOffered, load(6, 5, 1'000), kPassed},
           {{"high_priority_hold_octets"}, {"response_gap_octets", {{"slot_time_octets", 200}}}}},
          {{kTakenIn, kOffered, load(6, 5, 8'000), kPassed},
           {{"high_priority_hold_octets"}, {"high_priority_hold_octets"}}},
          {{kTakenIn, kOffered, load(7, 1, 20), load(6, 1, 20), load(7, 1, 20), kPassed}},
          // Another sends between its frames.
          {{kTakenIn, kOffered, replies(TokenCue::data, TokenReply::data), load(6, 3, 20), kPassed, kPassed}},
          {{kTakenIn, kOffered, replies(TokenCue::data, TokenReply::data, 1, 3), load(6, 3, 20), kPassed,
            kPassed}}};
}

Situations of_requests() {
  Situations all{{{kTakenIn, kOffered, kSilentPeer, kAsksWithResponse, load(6, 1, 20), kPassed},
                  {{"max_retry_limit"}, {"max_retry_limit"}, {"response_wait_slots"}}},
                 {{response_of(10), {"request"}, response_of(3), {"request"}, response_of(20), {"request"}}}};
  for (const TokenReply with : {TokenReply::data, TokenReply::response_of_another,
                                TokenReply::response_to_another, TokenReply::data_for_all, TokenReply::token})
    all.push_back(
        {{kTakenIn, kOffered, kAsksWithResponse, replies(TokenCue::request, with), kPassed, kPassed}});
  return all;
}

// Successors that are lost, and what comes in place of them.
Situations of_failures() {
  const NamedCommand noise = replies(TokenCue::token, TokenReply::noise);
  const NamedCommand is_taken = replies(TokenCue::token, TokenReply::noise_then_token);
  return {{{failures(7)}, {{"transmitter_fault_limit"}, {"bus_idle_slots"}}},
          {{failures(7)}},
          {{failures(8)}, {{"transmitter_fault_limit"}}},
          {{failures(2), kPassed, rounds(2)}, {{"transmitter_fault_limit"}}},
          {{failures(6)}},
          {{failures(6), kTakenIn, kOffered, rounds(2), failures(2)}},
          {{failures(6), kOffered, is_taken, kPassed, failures(1)}},
          {{failures(6), {"power"}, failures(2)}},
          {{kTakenIn, kOffered, noise, kPassed}, {{"noise_wait_slots"}, {"noise_wait_slots"}}},
          {{kTakenIn, kOffered, kSilentPeer, noise, kPassed}, {{"noise_wait_slots"}}},
          {{kTakenIn, kOffered, kSilentPeer, replies(TokenCue::who_follows, TokenReply::noise, 2), kPassed}},
          {{kTakenIn, kOffered, replies(TokenCue::solicitation, TokenReply::noise),
            replies(TokenCue::contest, TokenReply::noise, 20), rounds(20)}},
          {{kTakenIn, kOffered, replies(TokenCue::solicitation, TokenReply::noise),
            replies(TokenCue::contest, TokenReply::noise, 10), rounds(20)},
           {kLongAddresses}},
          {{kTakenIn, kOffered, replies(TokenCue::solicitation, TokenReply::group_is_successor), rounds(20)}},
          {{kTakenIn, kOffered, {"frame", {{"control", 5}, {"to", 0}, {"from", 3}, {"about", 6}}}, kPassed}}};
}

// The line: what is hidden after a transmission, and what not.
Situations of_line() {
  const NamedCommand data{"data"};
  return {{{after_symbols(26), data, spike(1)},
           {{"blanking_symbols"}, {"response_gap_octets", {{"slot_time_octets", 28}}}}},
          {{after_symbols(26), data, spike(2), after_symbols(30), data, spike(2)}},
          {{after_symbols(26), data, spike(2), after_symbols(29), data, spike(2)}},
          {{formed(TokenEnding::nothing_after), after_symbols(26), data, spike(2)}},
          {{formed(TokenEnding::too_long), data, formed(TokenEnding::longest), data},
           {{"most_octets"}, {"most_octets"}}},
          {{kTakenIn, kOffered, kPassed},
           {{"phy_bit_rate"},
            {"phy_bit_rate"},
            {"response_gap_octets", {{"slot_time_octets", 100}}},
            {"response_gap_octets", {{"slot_time_octets", 200}}}}}};
}

// What shows after many of a kind only.
Situations of_many() {
  return {{{kTakenIn, kOffered, rounds(1'010)}},
          {{kTakenIn, kOffered, rounds(310)}},
          {{{"claims", {{"times", 16}}}}}};
}

}  // namespace
}  // namespace token_situations

std::vector<NamedSituation> situations_of_a_station() {
  using namespace token_situations;
  Situations all;
  for (auto* make :
       {of_addresses, of_joining, of_rotation, of_holding, of_requests, of_failures, of_line, of_many})
    for (NamedSituation& one : make()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
