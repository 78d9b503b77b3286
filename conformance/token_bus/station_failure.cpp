#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_visits.hpp"

// What a station does when the token that it passes is not taken, or when it is not alone in holding one.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::memory;
using token_sources::standard;

TokenStep stranger_sends(std::string what, std::uint8_t control) {
  return send("0020 sends " + what, [control](TokenScene& scene) {
    return scene.bench.data_frame(control, TokenBench::kBelow, TokenBench::kStranger, {1, 2});
  });
}

constexpr std::size_t kShortData = 10;

// 000E solicits it and passes the token, which it passes on in vain.
TokenStep fails_to_pass(const std::string& times, std::function<unsigned(const token_bus::Rules&)> count) {
  return {fmt::format("{}, 000E solicits the station and passes the token to it", times),
          "each time it joins, and finds no successor", [count = std::move(count)](TokenScene& scene) {
            const unsigned most = count(scene.bench.rules());
            for (unsigned n = 0; n < most; ++n) scene.fail_to_pass();
          }};
}

unsigned all_but_one(const token_bus::Rules& rules) {
  return rules.transmitter_fault_limit - 1;
}
unsigned one_time(const token_bus::Rules&) {
  return 1;
}

// It answers 000E, and gets the token.
TokenStep joins() {
  return stimulus<TokenScene>(
      "000E solicits the station, which answers, and passes the token to it", [](TokenScene& scene) {
        scene.bench.wait(scene.bench.octets(8));
        scene.send(scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove));
        scene.expect_frame({TokenControl::set_successor, TokenBench::kAbove}, scene.at_once(), "its answer",
                           "answer_missing", "answer_wrong");
        scene.bench.wait(scene.bench.octets(6));
        scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
      });
}

TokenStep is_offline() {
  return {"000E solicits the station, and passes the token to it", "silence: it is offline",
          [](TokenScene& scene) {
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove));
            scene.expect_silence(scene.bench.slots(2), "speaks_as_faulty", "its transmitter is faulty");
            scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
            scene.expect_silence(scene.bench.slots(10), "speaks_as_faulty", "its transmitter is faulty");
          }};
}

std::vector<TokenStep> becomes_faulty() {
  return {fails_to_pass("as often as the limit of failures says, but once", all_but_one),
          require(
              "it is not reported as faulty yet",
              [](TokenScene& scene) {
                return !scene.bench.user().has_event(token_bus::EventKind::faulty_transmitter, kOwnAddress);
              },
              "faulty_too_soon"),
          fails_to_pass("once more", one_time),
          reported("the fault", token_bus::EventKind::faulty_transmitter, kOwnAddress), is_offline()};
}

template <unsigned limit>
void fault_limit(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.transmitter_fault_limit = limit;
  // No window is due before the last of them.
  configuration.rules.max_inter_solicit_count = 255;
}

TokenStep reports_each_joining() {
  return require(
      "it has reported each time that it has joined",
      [](TokenScene& scene) {
        return std::ranges::count(scene.bench.user().events, token_bus::EventKind::joined,
                                  &token_bus::Event::kind) ==
               std::ptrdiff_t{scene.bench.rules().transmitter_fault_limit};
      },
      "not_reported");
}

TokenCase faulty_after(const std::string& id, const std::string& times, std::vector<MustCatch> catches,
                       TokenNeeds needs) {
  return on_chart(token_must("failure/" + id, "",
                             "A station that failed to pass the token " + times +
                                 " in a row reports a faulty transmitter, and goes offline.",
                             memory("transmitter_fault_count"), std::move(catches)),
                  {{}, and_then(becomes_faulty(), {reports_each_joining()})}, std::move(needs));
}

// 01 010 110: the priority is 6, its highest bit first.

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
           and_then({joined()}, seeks_successor(),
                    {silence(6 * 28, "speaks_after_failure", "nobody is there"),
                     reported("the failure", EventKind::pass_failed, kOwnAddress)})}),
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
      on_chart(
          token_must("failure/another_frame_between_two_of_its_own_costs_the_token", "TB-28",
                     "A station that receives a frame between two of its own while it holds the token drops "
                     "it.",
                     standard("duplicate token"), {{"token_kept_between_frames", "token_kept"}}),
          {{},
           {joined(), submit({6, 6}, kShortData), token(),
            says("the first data, to 0004", {TokenControl{0x62}, TokenBench::kBelow}, at_once(),
                 "data_missing", "data_wrong"),
            wait(5), stranger_sends("data to 0004", 0x62),
            silence(5 * 28, "token_kept", "another holds the token"),
            reported("it", EventKind::unexpected_frame, TokenBench::kStranger)}}),
      faulty_after("seven_failures_are_a_faulty_transmitter", "seven times",
                   {{"faulty_after_six", "faulty_too_soon"},
                    {"faulty_after_eight", "not_reported"},
                    {"fault_unreported", "not_reported"},
                    {"joins_once", "not_reported"}},
                   {}),
      faulty_after("one_failure_may_be_a_faulty_transmitter", "once, which is the limit,",
                   {{"faulty_after_seven", "not_reported"}}, {.adjust = fault_limit<1>}),
      faulty_after("a_faulty_transmitter_may_have_64_failures", "64 times, which is the limit,",
                   {{"faulty_after_seven", "answer_missing"}}, {.adjust = fault_limit<64>}),
      on_chart(token_must("failure/a_success_forgives_the_failures", "",
                          "Failures to pass the token count in a row: a success begins their count anew.",
                          memory("transmitter_fault_count"), {{"failures_not_forgiven", "answer_missing"}}),
               {{},
                and_then({fails_to_pass("as often as the limit of failures says, but once", all_but_one),
                          joined()},
                         becomes_faulty())},
               {.adjust = fault_limit<3>}),
      on_chart(token_must("failure/a_repetition_that_is_taken_forgives_them", "",
                          "A pass that succeeds when the token is repeated is a success.",
                          memory("transmitter_fault_count"), {{"failures_not_forgiven", "answer_missing"}}),
               {{},
                and_then({fails_to_pass("as often as the limit of failures says, but once", all_but_one),
                          joins(), passes_below(at_once()), passes_below(after_slots(1)), taken()},
                         becomes_faulty())},
               {.adjust = fault_limit<3>}),
      on_chart(
          token_must("failure/what_waits_outlasts_a_failure", "TB-21",
                     "Data that wait when no successor is found are sent when the station has joined again.",
                     standard("token pass failure"), {{"failure_drops_data", "data_missing"}}),
          {{},
           {submit({0}, 10), fails_to_pass("with its first token, under which class 0 has no time", one_time),
            joins(), sends("the data of class 0", {0}, "speaks_unasked", "data_missing")}}),
      on_chart(
          token_must("failure/who_begins_in_the_gap_is_waited_for", "TB-21",
                     "A station that is about to send waits for who begins within the gap, and a gap more.",
                     token_sources::own("the gap"), {{"begins_after_four_octets", "begins_too_early"}}),
          {{4, 40}, {joined(), token(), wait(4), noise(10), passes_below(at_once()), taken()}}),
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
