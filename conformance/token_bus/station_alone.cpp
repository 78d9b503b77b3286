#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// A station that claims the token, and one that is alone.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::standard;

constexpr unsigned kClaims = 9;

// 11 10 01 00 00 01 10 10: no pair is that of the pass before.
void address_of_many_pairs(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.address = 0xE41A;
}

TokenStep solicits_anybody(SpanOf span) {
  return says("anybody is solicited by who is alone", {TokenControl::solicit_2, kOwnAddress}, std::move(span),
              "no_use_of_the_token", "no_use_of_the_token");
}

TokenStep claims_and_loses() {
  return {"another claims longer than the first claim of the station; in the next turns than a later one",
          "claims as long as the bits of its address say, from the first pair on", [](TokenScene& scene) {
            const token_bus::Rules& rules = scene.bench.rules();
            for (unsigned pass = 0; pass <= scene.turn; ++pass) {
              scene.expect_frame({TokenControl::claim},
                                 scene.after_slots(pass == 0 ? rules.bus_idle_slots : 1),
                                 fmt::format("claim number {}", pass + 1), "claim_missing", "claim_wrong");
              const std::uint64_t bits = scene.bench.address() >> (14 - 2 * pass) & 3U;
              scene.judge.expect_equal(
                  scene.answer.data().size(), static_cast<std::size_t>(2 * bits * rules.slot_time_octets),
                  "claim_length_wrong", fmt::format("octets of data in claim {}", pass + 1));
            }
            scene.bench.wait(scene.bench.octets(10));
            scene.since = scene.bench.send_noise(30);
          }};
}

TokenStep last_claims_differ() {
  return require(
      "the last claims are not all equally long",
      [](TokenScene& scene) {
        std::vector<std::size_t> lengths;
        for (std::size_t n = kClaims - 1; n < scene.bench.driven().size(); n += kClaims)
          lengths.push_back(scene.bench.driven()[n].octets.size());
        return std::ranges::adjacent_find(lengths, std::ranges::not_equal_to()) != lengths.end();
      },
      "last_claim_not_drawn");
}

}  // namespace

std::vector<TokenCase> token_alone_cases() {
  return {
      on_chart(
          token_must("alone/it_solicits_without_a_pause", "TB-04",
                     "A station that is alone solicits anybody again as soon as the windows are over.",
                     own("a station that is alone"), {{"pauses_when_alone", "begins_too_late"}}),
          {{},
           {claims(), solicits_anybody(after_slots(1)), repeat({8, 8}, {solicits_anybody(after_slots(2))})}}),
      on_chart(token_must("alone/who_has_claimed_uses_the_token", "TB-04",
                          "Who has claimed the token sends its data first, and solicits then.",
                          standard("claim process"), {{"solicits_before_its_data", "data_wrong"}}),
               {{},
                {submit({6}, 10), claims(),
                 says("the data", {TokenControl{0x62}, TokenBench::kBelow}, after_slots(1), "data_missing",
                      "data_wrong"),
                 solicits_anybody(at_once())}}),
      on_chart(token_must("alone/the_last_claim_is_drawn", "TB-02",
                          "The length of the last claim is drawn anew for each claim of the token.",
                          memory("claim process"), {{"last_claim_always_short", "last_claim_not_drawn"}}),
               {{}, {repeat({16, 32}, {claims(), wait(10), noise(30)}), last_claims_differ()}}),
      on_chart(
          token_must("alone/a_claim_may_be_lost_at_each_pass", "TB-02",
                     "A station that has lost its claim, whichever it was, claims from the first pair "
                     "on.",
                     memory("order of the pairs"), {{"claim_goes_on_from_before", "claim_length_wrong"}}),
          {{}, {repeat({8, 8}, {claims_and_loses()})}}, {.adjust = address_of_many_pairs}),
      on_chart(token_must("alone/each_time_is_reported", "",
                          "A station that is alone again, after it had a successor, reports it again.",
                          own("events"), {{"alone_the_first_time_only", "not_reported"}}),
               {{},
                {repeat({3, 3},
                        {claims(), solicits_anybody(after_slots(1)), solicits_anybody(after_slots(2)),
                         reported_again("that it is alone", token_bus::EventKind::sole_station, kOwnAddress),
                         wait(6),
                         send("0004 answers",
                              [](TokenScene& scene) {
                                return scene.bench.frame(TokenControl::set_successor, kOwnAddress,
                                                         TokenBench::kBelow, TokenBench::kBelow);
                              }),
                         passes_below(at_once()), taken()})}}),
      on_chart(
          token_must("alone/who_has_claimed_knows_no_predecessor", "TB-04",
                     "A member that has claimed a lost token follows nobody: it does not answer who asks "
                     "for the successor of its old predecessor.",
                     own("claims"), {{"predecessor_kept_by_a_claim", "answers_unasked"}}),
          {{},
           and_then({joined()}, forms_ring(),
                    {send("0020 asks who follows 000E",
                          [](TokenScene& scene) {
                            return scene.bench.frame(TokenControl::who_follows, TokenBench::kAbove,
                                                     TokenBench::kStranger, TokenBench::kAbove);
                          }),
                     silence(2 * 28, "answers_unasked", "it has no predecessor")})}),
      on_chart(token_must("alone/it_leaves", "TB-30",
                          "A station that is alone and not to be in the ring any more leaves, and is silent.",
                          standard("in_ring_desired"), {{"never_leaves_alone", "speaks_after_leaving"}}),
               {{},
                {claims(), solicits_anybody(after_slots(1)), desired(false),
                 silence(20 * 28, "speaks_after_leaving", "it is not in the ring"),
                 reported("that it has left", token_bus::EventKind::left, kOwnAddress)}}),
  };
}

}  // namespace fieldproof::conformance
