#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_visits.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// What comes in place of a response, and what a station does whose response is missing.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::mib;
using token_sources::own;

constexpr std::array<std::uint64_t, 4> kResponders{0x0006, TokenBench::kBelow, TokenBench::kAbove, 0xFFFE};

TokenStep responds_each() {
  return send("0006, 0004, 000E and FFFE respond, in turn", [](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.data_frame(kResponseOfSix, scene.bench.address(), kResponders.at(scene.turn),
                                  scene.bench.numbered_data(4));
  });
}

struct NoResponse {
  std::uint8_t control;
  std::uint64_t destination;
  Octets data;
};

const std::vector<NoResponse>& no_responses() {
  static const std::vector<NoResponse> all{{kResponseOfSix, 0x010A, {1}},
                                           {kResponseOfSix, 0x800A, {1}},
                                           {kResponseOfSix, TokenBench::kBelow, {1}},
                                           {kDataOfSix, kOwnAddress, {1}},
                                           {kDataOfSix, TokenBench::kBelow, {1}},
                                           {kDataOfSix, 0xFFFF, {1}},
                                           {kRequestOfSix, kOwnAddress, {1}},
                                           {kRequestOfSix, TokenBench::kBelow, {1}},
                                           {0x00, 0x0000, {}},       // claim_token
                                           {0x20, 0x0020, {}},       // resolve_contention
                                           {0x10, 0x0004, {}},       // a token
                                           {0x30, 0x0004, {2, 0}},   // set_successor
                                           {0xC0, 0x0006, {6, 0}}};  // who_follows
  return all;
}

TokenStep no_response_comes() {
  return send(
      "0020 sends a response to 010A, 800A or 0004, data to the station, to 0004 or to everybody, a request "
      "to the station or to 0004, claim_token, resolve_contention, a token, set_successor or who_follows, "
      "in turn",
      [](TokenScene& scene) {
        const NoResponse& one = no_responses().at(scene.turn);
        scene.bench.wait(scene.bench.octets(8));
        return scene.bench.data_frame(one.control, one.destination, TokenBench::kStranger, one.data);
      });
}

// The first of two.
void requested_in_vain(TokenScene& scene) {
  for (unsigned n = 0; n <= scene.bench.rules().max_retry_limit; ++n) {
    scene.expect_frame({TokenControl{kRequestOfSix}, TokenBench::kBelow},
                       n == 0 ? scene.at_once() : scene.after_slots(scene.bench.rules().response_wait_slots),
                       "the first request", "request_missing", "request_wrong");
    scene.judge.expect(scene.answer.data() == scene.first, "request_wrong", "the data of the first request",
                       scene.answer.text());
  }
}

std::vector<TokenStep> asked() {
  return {request(), token(), is_requested(at_once())};
}

}  // namespace

std::vector<TokenCase> token_request_cases() {
  const auto kinds = static_cast<unsigned>(no_responses().size());
  return {
      on_chart(token_must("requests/whoever_responds_has_responded", "TB-27",
                          "A response to the station is taken from whoever sends it.", own("requests"),
                          {{"response_of_the_asked_only", "token_missing"}}),
               {{},
                {joined(),
                 repeat({4, 4}, and_then(asked(), {responds_each(), passes_below(at_once()),
                                                   delivered("the response is delivered", 1), taken()}))}}),
      on_chart(
          token_must("requests/what_is_no_response_costs_the_token", "TB-28",
                     "What comes in place of a response, and is none to the station, costs it the token.",
                     controller("unexpected frame 10"),
                     {{"response_to_another_taken", "token_kept"},
                      {"any_data_are_a_response", "token_kept"},
                      {"control_is_a_response", "token_kept"}}),
          {{},
           {repeat({kinds, kinds},
                   and_then({joined()}, asked(),
                            {no_response_comes(), keeps_no_token(),
                             reported("it", token_bus::EventKind::unexpected_frame, TokenBench::kStranger),
                             starts_anew()}))}}),
      on_chart(
          token_must("requests/each_missing_response_is_reported", "TB-27",
                     "Each request that nobody has answered is reported, not the first alone.",
                     mib("max_retry_limit"), {{"first_missing_response_only", "not_reported"}}),
          {{},
           {joined(), repeat({3, 3}, and_then(asked(), {request_repeated(),
                                                        reported_again("the missing response",
                                                                       token_bus::EventKind::response_missing,
                                                                       TokenBench::kBelow),
                                                        taken()}))}}),
      on_chart(
          token_must("requests/each_of_two_has_its_repetitions", "TB-27",
                     "Of two requests under one token each is repeated as often as max_retry_limit says.",
                     mib("max_retry_limit"),
                     {{"no_repetition", "request_wrong"}, {"one_repetition_more", "request_wrong"}}),
          {{},
           {joined(), request(),
            stimulus<TokenScene>("and another one",
                                 [](TokenScene& scene) {
                                   scene.first = scene.data;
                                   scene.data = scene.bench.numbered_data(4);
                                   scene.bench.submit({.action = token_bus::Action::request_with_response,
                                                       .destination = TokenBench::kBelow,
                                                       .data = scene.data});
                                 }),
            token(), expected<TokenScene>("the first one, and its repetitions", requested_in_vain),
            is_requested(after_slots(3)), request_repeated(), taken()}}),
      on_chart(token_must("requests/after_a_missing_response_the_token_is_used", "TB-27",
                          "When the repetitions of a request are used up, the token is used for other data.",
                          mib("max_retry_limit"), {{"missing_response_ends_its_use", "data_missing"}}),
               {{},
                {joined(), request(), submit({6, 4, 0}, 10), token(),
                 stimulus<TokenScene>("nobody responds to the request and its repetitions",
                                      [](TokenScene& scene) {
                                        for (unsigned n = 0; n <= scene.bench.rules().max_retry_limit; ++n)
                                          scene.bench.next(scene.bench.now() + scene.bench.slots(6));
                                        scene.bench.wait(scene.bench.slots(2));
                                      }),
                 sends("class 6, 4 and 0", {6, 4, 0}, "speaks_unasked", "data_missing")}}),
  };
}

}  // namespace fieldproof::conformance
