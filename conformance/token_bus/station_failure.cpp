#include <fmt/format.h>

#include "conformance/token_bus/station_scene.hpp"

// What a station does when the token that it passes is not taken, or when it is not alone in holding one.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::memory;
using token_sources::standard;

TokenStep passes_below(SpanOf span) {
  return says("the token to 0004", {TokenControl::token, TokenBench::kBelow}, std::move(span),
              "token_missing", "token_wrong");
}

TokenStep asks_who_follows(SpanOf span) {
  return says("who_follows 0004", {TokenControl::who_follows, TokenBench::kBelow, TokenBench::kBelow},
              std::move(span), "who_follows_missing", "who_follows_wrong");
}

TokenStep stranger_sends(std::string what, std::uint8_t control) {
  return send("0020 sends " + what, [control](TokenScene& scene) {
    return scene.bench.data_frame(control, TokenBench::kBelow, TokenBench::kStranger, {1, 2});
  });
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

// 01 001 110: the priority is 6, its highest bit first.
constexpr std::uint8_t kRequestOfSix = 0x72;
constexpr std::uint8_t kResponseOfSix = 0x6A;

TokenStep is_requested(SpanOf span) {
  return expected<TokenScene>("the request", [span = std::move(span)](TokenScene& scene) {
    scene.expect_frame({TokenControl{kRequestOfSix}, TokenBench::kBelow}, span(scene),
                       "a request with response to 0004", "request_missing", "request_wrong");
    scene.judge.expect(scene.answer.data() == scene.data, "request_wrong", "the data of the request",
                       scene.answer.text());
  });
}

}  // namespace

std::vector<TokenCase> token_failure_cases() {
  using token_bus::EventKind;
  return {
      on_chart(
          token_must("failure/a_silent_successor_is_sought", "TB-21",
                     "A token that nobody takes within a slot time is repeated; then the station asks twice "
                     "who follows, then solicits anybody; then it is silent.",
                     standard("token pass failure"),
                     {{"token_three_times", "who_follows_wrong"},
                      {"who_follows_once", "who_follows_wrong"},
                      {"gives_up_after_who_follows", "any_missing"},
                      {"token_repeated_late", "begins_too_late"}},
                     {{controller("no successor"), {"who_follows_wrong"}}}),
          {{},
           {joined(), token(), passes_below(at_once()), passes_below(after_slots(1)),
            asks_who_follows(after_slots(1)), asks_who_follows(after_slots(3)),
            says("anybody is solicited", {TokenControl::solicit_2, kOwnAddress}, after_slots(3),
                 "any_missing", "any_wrong"),
            silence(6 * 28, "speaks_after_failure", "nobody is there"),
            reported("the failure", EventKind::pass_failed, kOwnAddress)}}),
      on_chart(token_must("failure/who_follows_the_lost_one_is_the_successor", "TB-22",
                          "Who answers who_follows is the successor, and gets the token.",
                          standard("who_follows"), {{"answer_not_taken", "token_missing"}}),
               {{},
                {joined(), token(), passes_below(at_once()), passes_below(after_slots(1)),
                 asks_who_follows(after_slots(1)), wait(6),
                 send("0002 answers",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::set_successor, kOwnAddress, 0x0002, 0x0002);
                      }),
                 says("the token to 0002", {TokenControl::token, 0x0002}, at_once(), "token_missing",
                      "token_wrong")}}),
      on_chart(
          token_must("failure/noise_after_the_token_is_waited_out", "TB-24",
                     "After noise that follows the token the station waits four slot times more before it "
                     "repeats the token.",
                     memory("token_pass_timer after noise"),
                     {{"noise_is_success", "token_missing"}, {"noise_is_failure", "begins_too_early"}}),
          {{},
           {joined(), token(), passes_below(at_once()), wait(8), noise(6), passes_below(after_slots(4))}}),
      on_chart(token_must("failure/whatever_follows_noise_is_success", "TB-24",
                          "What is on the line after noise that followed the token shows that it was taken.",
                          memory("token_pass_timer after noise"), {{"noise_is_failure", "token_repeated"}}),
               {{},
                {joined(), token(), passes_below(at_once()), wait(8), noise(6), wait(40), noise(6),
                 silence(5 * 28, "token_repeated", "its successor was active twice")}}),
      on_chart(
          token_must("failure/another_frame_in_a_window_costs_the_token", "TB-26",
                     "A station that waits for answers and receives any other valid frame drops the token.",
                     controller("unexpected frame 10"), {{"unexpected_frames_ignored", "token_kept"}}),
          {{},
           {joined(), until_window(), wait(6), stranger_sends("data to 0004", 0x62),
            silence(5 * 28, "token_kept", "another holds the token"),
            reported("it", EventKind::unexpected_frame, TokenBench::kStranger)}}),
      on_chart(token_must(
                   "failure/requests_are_repeated", "TB-27",
                   "A request without a response is repeated as often as max_retry_limit says, then "
                   "that is reported and the token goes on.",
                   token_sources::mib("max_retry_limit"),
                   {{"one_repetition_more", "token_wrong"}, {"no_repetition", "request_wrong"}},
                   {{memory("three slot times for the response"), {"begins_too_early", "begins_too_late"}}}),
               {{},
                {joined(), request(), token(), is_requested(at_once()), is_requested(after_slots(3)),
                 is_requested(after_slots(3)), passes_below(after_slots(3)),
                 reported("the missing response", EventKind::response_missing, TokenBench::kBelow), taken(),
                 serves()}}),
      on_chart(token_must("failure/a_response_ends_the_request", "TB-27",
                          "A response is reported to the user, and the token goes on.", standard("response"),
                          {{"response_not_taken", "token_wrong"}}),
               {{},
                {joined(), request(), token(), is_requested(at_once()), wait(6),
                 send("0004 responds",
                      [](TokenScene& scene) {
                        scene.data = scene.bench.numbered_data(5);
                        return scene.bench.data_frame(kResponseOfSix, kOwnAddress, TokenBench::kBelow,
                                                      scene.data);
                      }),
                 passes_below(at_once()),
                 require(
                     "the response is reported to its user",
                     [](TokenScene& scene) {
                       const auto& frames = scene.bench.user().frames;
                       return frames.size() == 1 && is_reported_as(scene.bench.sent().back(), frames[0]);
                     },
                     "response_not_reported")}}),
      on_chart(
          token_must("failure/another_frame_in_place_of_a_response_costs_the_token", "TB-28",
                     "A station that waits for a response and receives any other valid frame drops the "
                     "token.",
                     controller("unexpected frame 6"), {{"unexpected_frames_ignored", "token_kept"}}),
          {{},
           {joined(), request(), token(), is_requested(at_once()), wait(6),
            stranger_sends("data to 0004", 0x62), silence(5 * 28, "token_kept", "another holds the token"),
            reported("it", EventKind::unexpected_frame, TokenBench::kStranger)}}),
      on_chart(token_must("failure/the_second_of_an_address_is_silent", "TB-29",
                          "A station that receives a frame with its own address as the source reports it and "
                          "goes offline.",
                          standard("duplicate address"), {{"duplicate_ignored", "speaks_as_duplicate"}}),
               {{},
                {joined(),
                 send("another station with the address of the station sends a token to 0004",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::token, TokenBench::kBelow, kOwnAddress);
                      }),
                 wait(8), token(), silence(10 * 28, "speaks_as_duplicate", "its address is another's"),
                 reported("it", EventKind::duplicate_address, kOwnAddress)}}),
  };
}

}  // namespace fieldproof::conformance
