#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"

// Numbers of the network that are not the usual ones, up to the ends of their ranges: what a station has as a
// constant shows.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_bus::Rules;
using token_bus::StationConfiguration;
using token_sources::memory;
using token_sources::own;

// None is what it usually is.
void draw_all(StationConfiguration& configuration, kernel::Random& random) {
  Rules& rules = configuration.rules;
  constexpr std::int64_t kMegabit = 1'000'000;
  rules.phy_bit_rate = kMegabit * drawn(random, 1, 8);
  rules.preamble_octets = drawn(random, 5, 12);
  rules.response_gap_octets = drawn(random, 8, 24);
  rules.slot_time_octets = drawn(random, 36, 120);
  rules.bus_idle_slots = drawn(random, 8, 14);
  rules.noise_wait_slots = drawn(random, 5, 9);
  rules.response_wait_slots = drawn(random, 4, 8);
  rules.max_retry_limit = drawn(random, 3, 7);
}

TokenCase life_with(const std::string& id, const std::string& what, std::vector<MustCatch> catches,
                    TokenNeeds needs) {
  return on_chart(
      token_must("settings/" + id, "", "With " + what + " the times of a station are those of its settings.",
                 own("settings of a station"), std::move(catches)),
      {{}, life()}, std::move(needs));
}

std::vector<TokenCase> lives() {
  return {
      life_with("all_that_are_drawn", "settings that are drawn",
                {{"idle_of_seven_slots", "begins_too_early"},
                 {"noise_wait_of_four_slots", "begins_too_early"},
                 {"response_wait_of_three_slots", "begins_too_early"},
                 {"preamble_of_four_octets", "preamble_short"},
                 {"gap_of_six_octets", "begins_too_early"},
                 {"slot_time_of_28_octets", "begins_too_early"},
                 {"bit_rate_of_10_megabits", "claim_wrong"}},
                {.adjust = draw_all}),
      life_with("the_shortest_slot_time", "slot times of 12 octet durations",
                {{"slot_time_of_16_octets_at_least", "claim_missing"}},
                with([](Rules& rules) { rules.slot_time_octets = 12; })),
      life_with("the_longest_slot_time", "slot times of 1362 octet durations",
                {{"slot_time_in_eight_bits", "begins_too_early"}},
                with([](Rules& rules) { rules.slot_time_octets = 1'362; })),
      life_with("the_longest_gap", "a gap of 64 octet durations",
                {{"gap_of_32_octets_at_most", "begins_too_early"}}, with([](Rules& rules) {
                  rules.response_gap_octets = 64;
                  rules.slot_time_octets = 100;
                })),
      life_with("the_lowest_bit_rate", "1 Mbit/s on the line",
                {{"bit_rate_of_5_megabits_at_least", "claim_wrong"}},
                with([](Rules& rules) { rules.phy_bit_rate = 1'000'000; })),
      life_with("the_highest_bit_rate", "100 Mbit/s on the line",
                {{"bit_rate_of_50_megabits_at_most", "claim_missing"}},
                with([](Rules& rules) { rules.phy_bit_rate = 100'000'000; })),
      life_with("no_repetition_of_a_request", "max_retry_limit 0",
                {{"one_repetition_at_least", "token_wrong"}},
                with([](Rules& rules) { rules.max_retry_limit = 0; })),
      life_with("seven_repetitions_of_a_request", "max_retry_limit 7",
                {{"four_repetitions_at_most", "request_wrong"}},
                with([](Rules& rules) { rules.max_retry_limit = 7; })),
  };
}

// ---- lengths, waits ----

Octets data_between_delimiters(TokenScene& scene, std::size_t octets) {
  constexpr std::size_t kAround = 9;  // control, addresses, check
  return scene.bench.data_frame(0x62, scene.bench.address(), TokenBench::kAbove,
                                scene.bench.numbered_data(octets - kAround));
}

std::vector<TokenCase> lengths() {
  return {on_chart(
      token_must("settings/the_longest_frame", "TB-31",
                 "A frame has as many octets between its delimiters as most_octets says, and no more.",
                 own("settings of a station"), {{"longest_of_8191_octets", "delivered_unasked"}}),
      {{},
       {joined(),
        send("data for the station, 500 octets between the delimiters",
             [](TokenScene& scene) { return data_between_delimiters(scene, 500); }),
        delivered("it is delivered", 1), wait(10),
        send("data for the station, 501 octets",
             [](TokenScene& scene) { return data_between_delimiters(scene, 501); }),
        delivered("it is not delivered", 0), counted("frames too long", kTooLong, 1)}},
      with([](Rules& rules) { rules.most_octets = 500; }))};
}

void drawn_idle_of_the_lowest(StationConfiguration& configuration, kernel::Random& random) {
  configuration.rules.lowest_bus_idle_slots = drawn(random, 9, 20);
}

// Longer than the usual one, and shorter than the silence after which it claims.
void drawn_demand_wait(StationConfiguration& configuration, kernel::Random& random) {
  configuration.rules.demand_wait_slots = drawn(random, 6, 10);
  configuration.rules.bus_idle_slots = 30;
}

TokenStep resolves_later(int more) {
  return stimulus<TokenScene>(
      fmt::format("000E resolves contention a slot time {} demand_wait_slots are over",
                  more < 0 ? "before" : "after"),
      [more](TokenScene& scene) {
        const auto slots = static_cast<int>(scene.bench.rules().demand_wait_slots) + more;
        scene.bench.run_until(scene.since + scene.bench.slots(slots));
        scene.send(scene.bench.frame(TokenControl::resolve, TokenBench::kAbove, TokenBench::kAbove));
      });
}

TokenStep answers_in(SpanOf span) {
  return says("set_successor to 000E with its own address",
              {TokenControl::set_successor, TokenBench::kAbove, kOwnAddress}, std::move(span),
              "answer_missing", "answer_wrong");
}

std::vector<TokenCase> waits() {
  return {
      on_chart(token_must("settings/an_idle_time_of_the_lowest_that_is_drawn", "TB-35",
                          "The station with the lowest address of the ring claims a lost token after "
                          "lowest_bus_idle_slots.",
                          memory("bus_idle_timer of the lowest address"),
                          {{"idle_of_six_slots_as_the_lowest", "begins_too_early"}}),
               {{},
                {joined_as_lowest(),
                 says("the first claim", {TokenControl::claim}, after_slots_of(&Rules::lowest_bus_idle_slots),
                      "claim_missing", "claim_wrong")}},
               {.adjust = drawn_idle_of_the_lowest}),
      on_chart(token_must("settings/a_wait_of_who_has_answered_that_is_drawn", "TB-19",
                          "Who has answered takes part in a contest for demand_wait_slots, and not later.",
                          own("settings of a station"), {{"demand_wait_of_four_slots", "answer_missing"}}),
               {{},
                {wait(10),
                 send("000E solicits a successor between it and 0004",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow,
                                                 TokenBench::kAbove);
                      }),
                 // The first two bits of its address are 00.
                 answers_in(at_once()), resolves_later(-1), answers_in(in_window(3)), resolves_later(1),
                 silence(6 * 28, "answers_too_late", "it is no demander any more")}},
               {.adjust = drawn_demand_wait}),
  };
}

}  // namespace

std::vector<TokenCase> token_settings_cases() {
  std::vector<TokenCase> all;
  for (const auto& group : {lives(), lengths(), waits()}) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace fieldproof::conformance
