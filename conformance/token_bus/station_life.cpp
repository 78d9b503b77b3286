#include "conformance/token_bus/station_life.hpp"

#include <fmt/format.h>

#include <utility>

namespace fieldproof::conformance::token_chart {
namespace {

constexpr std::uint64_t kContender = 0xF000;

// 01 001 110: the priority is 6, its highest bit first.

// Two bits each, the most significant pair first.
unsigned pairs_of(const TokenBench& bench) {
  return 4 * token_bus::address_octets(bench.rules());
}
unsigned pair_of(const TokenBench& bench, unsigned pass) {
  return static_cast<unsigned>(bench.address() >> 2 * (pairs_of(bench) - 1 - pass) & 3U);
}

void expect_claim(TokenScene& scene, unsigned pass) {
  const token_bus::Rules& rules = scene.bench.rules();
  scene.expect_frame({TokenControl::claim}, scene.after_slots(pass == 0 ? rules.bus_idle_slots : 1),
                     fmt::format("claim number {}", pass + 1), "claim_missing", "claim_wrong");
  const std::size_t slot = rules.slot_time_octets;
  const std::size_t size = scene.answer.data().size();
  if (pass < pairs_of(scene.bench)) {
    scene.judge.expect_equal(size, 2 * pair_of(scene.bench, pass) * slot, "claim_length_wrong",
                             fmt::format("octets of data in claim {}", pass + 1));
  } else {
    scene.judge.expect(size % (2 * slot) == 0 && size <= 6 * slot, "claim_length_wrong",
                       "0, 2, 4 or 6 slot times of data in the last claim", fmt::format("{} octets", size));
  }
}

}  // namespace

TokenStep claims() {
  return expected<TokenScene>(
      "as many claims as its address has pairs of bits, and one, as long as the bits of each say, a slot "
      "time "
      "apart",
      [](TokenScene& scene) {
        for (unsigned pass = 0; pass <= pairs_of(scene.bench); ++pass) expect_claim(scene, pass);
      });
}

TokenStep contest() {
  return {"for each pair of bits of its address, who has solicited resolves contention",
          "set_successor after 0 to 3 slot times, by the complement of the next two bits of its address",
          [](TokenScene& scene) {
            for (unsigned pass = 0; pass < pairs_of(scene.bench); ++pass) {
              const unsigned delay = 3 - pair_of(scene.bench, pass);
              scene.bench.wait(scene.bench.gap());
              scene.send(scene.bench.frame(TokenControl::resolve, kContender, kContender));
              scene.expect_frame({TokenControl::set_successor, kContender}, scene.in_window(delay),
                                 fmt::format("set_successor in window {}", delay), "answer_missing",
                                 "answer_wrong");
            }
          }};
}

TokenStep asks_who_follows(SpanOf span) {
  return says("who_follows 0004", {TokenControl::who_follows, TokenBench::kBelow, TokenBench::kBelow},
              std::move(span), "who_follows_missing", "who_follows_wrong");
}

TokenStep passes_below(SpanOf span) {
  return says("the token to 0004", {TokenControl::token, TokenBench::kBelow}, std::move(span),
              "token_missing", "token_wrong");
}

TokenStep request() {
  return stimulus<TokenScene>("the user submits a request with response for 0004", [](TokenScene& scene) {
    scene.data = scene.bench.numbered_data(4);
    const bool is_taken = scene.bench.submit({.action = token_bus::Action::request_with_response,
                                              .destination = TokenBench::kBelow,
                                              .data = scene.data});
    scene.judge.expect(is_taken, "data_refused", "the request is accepted", "it was refused");
  });
}

TokenStep is_requested(SpanOf span) {
  return expected<TokenScene>("the request", [span = std::move(span)](TokenScene& scene) {
    scene.expect_frame({TokenControl{kRequestOfSix}, TokenBench::kBelow}, span(scene),
                       "a request with response to 0004", "request_missing", "request_wrong");
    scene.judge.expect(scene.answer.data() == scene.data, "request_wrong", "the data of the request",
                       scene.answer.text());
  });
}

TokenStep request_repeated() {
  return expected<TokenScene>(
      "the request again, as often as max_retry_limit says, then the token", [](TokenScene& scene) {
        const TokenSpan span = scene.after_slots(scene.bench.rules().response_wait_slots);
        for (unsigned n = 0; n < scene.bench.rules().max_retry_limit; ++n) {
          scene.expect_frame({TokenControl{kRequestOfSix}, TokenBench::kBelow}, span,
                             fmt::format("repetition {} of the request", n + 1), "request_missing",
                             "request_wrong");
        }
        scene.expect_frame({TokenControl::token, TokenBench::kBelow}, span, "the token to 0004",
                           "token_missing", "token_wrong");
      });
}

SpanOf after_slots_of(unsigned token_bus::Rules::* count) {
  return [count](const TokenScene& scene) { return scene.after_slots(scene.bench.rules().*count); };
}

std::vector<TokenStep> forms_ring() {
  return {claims(),
          says("anybody is solicited by who is alone", {TokenControl::solicit_2, kOwnAddress}, after_slots(1),
               "no_use_of_the_token", "no_use_of_the_token"),
          wait(6),
          send("0004 answers",
               [](TokenScene& scene) {
                 return scene.bench.frame(TokenControl::set_successor, scene.bench.address(),
                                          TokenBench::kBelow, TokenBench::kBelow);
               }),
          passes_below(at_once()),
          taken()};
}

std::vector<TokenStep> seeks_successor() {
  return {token(),
          passes_below(at_once()),
          passes_below(after_slots(1)),
          asks_who_follows(after_slots(1)),
          asks_who_follows(after_slots(3)),
          says("anybody is solicited", {TokenControl::solicit_2, kOwnAddress}, after_slots(3), "any_missing",
               "any_wrong")};
}

std::vector<TokenStep> life() {
  return and_then(forms_ring(),
                  {token(), passes_below(at_once()), taken(), request(), token(), is_requested(at_once()),
                   request_repeated(), taken(), token(), passes_below(at_once()), wait(8), noise(6),
                   passes_below(after_slots_of(&token_bus::Rules::noise_wait_slots)), taken()},
                  seeks_successor());
}

}  // namespace fieldproof::conformance::token_chart
