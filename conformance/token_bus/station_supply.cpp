#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// What is left of a station after a loss of supply: nothing.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::own;

TokenStep powered(bool is_on) {
  return stimulus<TokenScene>(is_on ? "the supply of the station returns" : "the supply of the station fails",
                              [is_on](TokenScene& scene) {
                                scene.bench.set_power(is_on);
                                scene.since = scene.bench.now();
                              });
}

TokenStep response_is_ready() {
  return stimulus<TokenScene>("the user has a response ready",
                              [](TokenScene& scene) { scene.bench.set_response({1, 2, 3}); });
}

TestCase supply_must(const std::string& id, std::string requirement, std::vector<MustCatch> catches) {
  return token_must("supply/" + id, "", std::move(requirement), own("loss of supply"), std::move(catches));
}

constexpr std::uint8_t kRequest = 0x32;  // 01 001 100

}  // namespace

std::vector<TokenCase> token_supply_cases() {
  return {
      on_chart(supply_must("waiting_data_are_gone", "Data that waited when the supply failed are not sent.",
                           {{"queues_kept", "token_wrong"}}),
               {{}, {joined(), submit({6, 4, 2, 0}, 10), starts_anew(), joined(), token(), passes_on()}}),
      on_chart(
          supply_must("counters_begin_anew", "Counters of faulty receptions are 0 after a loss of supply.",
                      {{"counters_kept", "counter_wrong"}}),
          {{},
           {joined(), repeat({3, 3}, {noise(8), wait(10)}), counted("non-silence", kNonSilence, 3),
            starts_anew(), wait(10), noise(8), wait(10), counted("non-silence", kNonSilence, 1), joined()}}),
      on_chart(supply_must("its_neighbours_are_unknown",
                           "After a loss of supply a station is outside of the ring, and knows no neighbour.",
                           {{"ring_kept", "answers_unasked"}}),
               {{},
                {joined(), starts_anew(), wait(10),
                 send("0020 asks who follows 000E",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::who_follows, TokenBench::kAbove,
                                                 TokenBench::kStranger, TokenBench::kAbove);
                      }),
                 silence(2 * 28, "answers_unasked", "it has no predecessor"),
                 send("0020 passes the token to the station",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::token, kOwnAddress, TokenBench::kStranger);
                      }),
                 says("the token to 0020", {TokenControl::token, TokenBench::kStranger}, at_once(),
                      "token_missing", "token_wrong"),
                 reported("that it has joined", token_bus::EventKind::joined, TokenBench::kStranger)}}),
      on_chart(
          supply_must("it_is_no_more_the_lowest",
                      "A station that was the lowest of the ring claims a lost token as any other after a "
                      "loss of supply.",
                      {{"ring_kept", "begins_too_early"}}),
          {{},
           {joined_as_lowest(), starts_anew(),
            says("the first claim after seven slot times", {TokenControl::claim}, after_slots(7),
                 "claim_missing", "claim_wrong")}}),
      on_chart(supply_must("its_response_is_gone",
                           "A request is not answered by the response of before the loss of supply.",
                           {{"response_kept", "responds_unasked"}}),
               {{},
                {joined(), response_is_ready(), starts_anew(), wait(10),
                 send("000E sends a request for the station",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(kRequest, kOwnAddress, TokenBench::kAbove, {7});
                      }),
                 silence(3 * 28, "responds_unasked", "it has no response"), joined()}}),
      on_chart(supply_must("it_joins_as_it_is_set",
                           "After a loss of supply in_ring_desired is again what the settings say.",
                           {{"wish_kept", "claim_missing"}}),
               {{},
                {joined(), desired(false), starts_anew(),
                 says("the first claim after seven slot times", {TokenControl::claim}, after_slots(7),
                      "claim_missing", "claim_wrong")}}),
      on_chart(supply_must("without_supply_it_is_silent",
                           "Without supply a station is silent; when it returns, it works as before.",
                           {{"silent_after_loss", "answer_missing"}}),
               {{},
                {joined(), powered(false), wait(8), token(),
                 silence(10 * 28, "speaks_without_supply", "it has no supply"), powered(true), joined(),
                 token(), passes_on()}}),
  };
}

}  // namespace fieldproof::conformance
