#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_visits.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// What is left of a station that has dropped the token: all but the token. And its own address in each state.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::own;
using token_sources::standard;

std::vector<TokenStep> window_opened() {
  return {joined(), until_window()};
}

TokenStep stranger_asks() {
  return send("0020 sends a request of priority 0 with response to the station", [](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.data_frame(0x12, scene.bench.address(), TokenBench::kStranger, {7});
  });
}

TokenStep stranger_solicits() {
  return send("0020 solicits those between it and 0004", [](TokenScene& scene) {
    scene.bench.wait(scene.bench.octets(8));
    return scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kStranger);
  });
}

TokenStep second_of_its_address() {
  return send("another station with its address sends data to 0004", [](TokenScene& scene) {
    return scene.bench.data_frame(0x62, TokenBench::kBelow, kOwnAddress, {1, 2});
  });
}

TokenStep refuses_all() {
  return require(
      "data of each priority are refused: it is offline",
      [](TokenScene& scene) {
        bool is_refused = true;
        for (unsigned priority = 0; priority < 8; ++priority)
          is_refused &= !scene.bench.submit({.priority = priority, .destination = TokenBench::kBelow});
        return is_refused;
      },
      "data_not_refused");
}

TokenStep fails_to_pass() {
  return {"it joins, and nobody takes the token that it passes", "it seeks a successor, and finds none",
          [](TokenScene& scene) { scene.fail_to_pass(); }};
}

std::vector<TokenCase> drops() {
  const auto source = controller("unexpected frame 10");
  return {
      on_chart(token_must("dropping/it_stays_in_the_ring", "TB-26",
                          "A station that has dropped the token is a member as before.", source,
                          {{"leaves_when_it_drops", "token_wrong"}}),
               {{},
                and_then(window_opened(),
                         {wait(8), stranger_talks(), keeps_no_token(), forget_events(), token(),
                          passes_below(at_once()), not_reported("joining", token_bus::EventKind::joined)})}),
      on_chart(token_must("dropping/its_data_wait_on", "TB-26",
                          "Data that waited when the token was dropped are sent under the next one.", source,
                          {{"forgets_data_when_it_drops", "data_missing"}}),
               {{},
                and_then(window_opened(),
                         {submit({6, 4}, 10), wait(8), stranger_talks(), keeps_no_token(), token(),
                          sends("class 6 and 4", {6, 4}, "speaks_unasked", "data_missing")})}),
      on_chart(token_must("dropping/a_request_is_answered", "TB-26",
                          "A request with response that costs the token is answered as any other.",
                          own("unexpected frames"), {{"request_that_costs_unanswered", "response_missing"}}),
               {{},
                and_then({stimulus<TokenScene>("its user has a response ready",
                                               [](TokenScene& scene) { scene.bench.set_response({1}); })},
                         window_opened(),
                         {stranger_asks(), says("the response", {TokenControl{0x0A}, TokenBench::kStranger},
                                                at_once(), "response_missing", "response_wrong")})}),
      on_chart(
          token_must("dropping/a_solicitation_is_answered", "TB-26",
                     "A solicitation that costs the token is answered as any other.",
                     own("unexpected frames"), {{"solicitation_that_costs_unanswered", "answer_missing"}}),
          {{}, and_then(window_opened(), {stranger_solicits(), answers(TokenBench::kStranger, at_once())})}),
      on_chart(
          token_must("dropping/each_time_is_reported", "TB-26", "Each token that is dropped is reported.",
                     own("events"), {{"first_unexpected_frame_only", "not_reported"}}),
          {{},
           {joined(), repeat({3, 3}, {until_window(), wait(8), stranger_talks(), keeps_no_token(),
                                      reported_again("it", token_bus::EventKind::unexpected_frame,
                                                     TokenBench::kStranger)})}}),
  };
}

}  // namespace

std::vector<TokenCase> token_dropping_cases() {
  std::vector<TokenCase> all = drops();
  const std::vector<TokenCase> others{
      on_chart(token_must("dropping/its_own_address_is_seen_in_each_state", "TB-29",
                          "A station that receives its own address as a source goes offline, whatever it "
                          "waits for, and refuses all that its user asks for; when its supply returns, it "
                          "takes part again.",
                          standard("duplicate address"),
                          {{"duplicate_in_idle_only", "not_reported"},
                           {"offline_takes_data", "data_not_refused"},
                           {"offline_for_ever", "answer_missing"}}),
               {{},
                {repeat({kListeningStates, kListeningStates},
                        {brought_to_each_state(), second_of_its_address(),
                         reported("it", token_bus::EventKind::duplicate_address, kOwnAddress), refuses_all(),
                         silence(10 * 28, "speaks_as_duplicate", "its address is another's"), starts_anew()}),
                 says("the first claim after seven slot times", {TokenControl::claim}, after_slots(7),
                      "claim_missing", "claim_wrong")}}),
      on_chart(token_must("dropping/a_faulty_transmitter_is_reported_alone", "",
                          "The failure that reaches the limit is reported as such, and no failed pass "
                          "with it; the station is offline, and refuses all that its user asks for.",
                          own("failures"),
                          {{"both_failures_reported", "reported_unfounded"},
                           {"offline_takes_data", "data_not_refused"}}),
               {{},
                {fails_to_pass(), reported("it", token_bus::EventKind::faulty_transmitter, kOwnAddress),
                 not_reported("a failed pass", token_bus::EventKind::pass_failed), refuses_all(),
                 silence(10 * 28, "speaks_as_faulty", "it is offline")}},
               with([](token_bus::Rules& rules) { rules.transmitter_fault_limit = 1; })),
      on_chart(token_must("dropping/failures_begin_anew_with_the_supply", "",
                          "After a loss of supply failures to pass the token count from one.",
                          own("loss of supply"), {{"failures_kept", "not_reported"}}),
               {{},
                {repeat({3, 3}, {fails_to_pass(),
                                 reported_again("it", token_bus::EventKind::pass_failed, kOwnAddress),
                                 starts_anew()})}},
               with([](token_bus::Rules& rules) { rules.transmitter_fault_limit = 2; })),
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace fieldproof::conformance
