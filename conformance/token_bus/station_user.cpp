#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"
#include "conformance/token_bus/station_visits.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// What the user of a station asks of it: what is refused, responses, when it is to be in the ring.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_bus::Action;
using token_bus::DataRequest;
using token_sources::own;
using token_sources::standard;

constexpr std::size_t kMostOctets = 8'182;
constexpr std::uint64_t kGroup = 0x0003;

const std::array<DataRequest, 5>& refused_requests() {
  static const std::array<DataRequest, 5> all{
      DataRequest{.priority = 8, .destination = TokenBench::kBelow, .data = {1}},
      DataRequest{.destination = TokenBench::kBelow, .data = Octets(kMostOctets + 1)},
      DataRequest{.action = Action::request_with_response, .destination = kGroup, .data = {1}},
      DataRequest{.action = Action::request_with_response, .destination = 0xFFFF, .data = {1}},
      DataRequest{.priority = 255, .destination = TokenBench::kBelow, .data = {1}}};
  return all;
}

TokenStep is_refused() {
  return {
      "the user submits priority 8, 8183 octets, a request with response to 0003, one to everybody, and "
      "priority 255, in turn",
      "it is refused", [](TokenScene& scene) {
        scene.judge.expect(!scene.bench.submit(refused_requests().at(scene.turn)), "data_not_refused",
                           "it is refused", "it is accepted");
      }};
}

TokenStep response_of(std::size_t size) {
  return stimulus<TokenScene>(fmt::format("the user has a response of {} octets ready", size),
                              [size](TokenScene& scene) {
                                scene.data = scene.bench.numbered_data(size);
                                scene.bench.set_response(scene.data);
                              });
}

// Of priority 4, and what must come.
TokenStep is_responded() {
  return {"000E sends a request of priority 4 for the station", "the last response of the user, to 000E",
          [](TokenScene& scene) {
            constexpr std::uint8_t kRequestOf4 = 0x32;   // 01 001 100
            constexpr std::uint8_t kResponseOf4 = 0x2A;  // 01 010 100
            scene.bench.wait(scene.bench.octets(8));
            scene.send(scene.bench.data_frame(kRequestOf4, kOwnAddress, TokenBench::kAbove, {7}));
            scene.expect_frame({TokenControl{kResponseOf4}, TokenBench::kAbove},
                               {scene.bench.gap(), scene.bench.slots(2)}, "a response of priority 4 to 000E",
                               "response_missing", "response_wrong");
            scene.judge.expect(scene.answer.data() == scene.data, "response_wrong", "the last response",
                               scene.answer.text());
          }};
}

TokenStep names_successor(std::uint64_t to, std::uint64_t successor) {
  return send(fmt::format("0004 names {:04X} as the successor of {:04X}", successor, to),
              [to, successor](TokenScene& scene) {
                return scene.bench.frame(TokenControl::set_successor, to, TokenBench::kBelow, successor);
              });
}

TokenStep data_for_group() {
  return send("000E sends data to the group 0003", [](TokenScene& scene) {
    return scene.bench.data_frame(0x62, kGroup, TokenBench::kAbove, scene.bench.numbered_data(6));
  });
}

}  // namespace

std::vector<TokenCase> token_user_cases() {
  return {
      on_chart(token_must("user/what_fits_no_frame_is_refused", "",
                          "Priorities above 7, more data than a frame holds, and requests with response to a "
                          "group are refused, and nothing of them is sent.",
                          own("requests"),
                          {{"any_priority_taken", "data_not_refused"},
                           {"any_length_taken", "data_not_refused"},
                           {"groups_are_asked", "data_not_refused"}}),
               {{},
                {joined(), repeat({5, 5}, {is_refused()}), token(),
                 sends("nothing", {}, "speaks_unasked", "data_missing")}}),
      on_chart(token_must("user/the_last_response_is_used_each_time", "TB-27",
                          "Each request with response is answered by what its user gave last.",
                          standard("response"),
                          {{"first_response_kept", "response_wrong"},
                           {"two_responses_only", "response_wrong"},
                           {"responds_once", "response_missing"}}),
               {{},
                {joined(), response_of(5), is_responded(), is_responded(), response_of(4), is_responded(),
                 is_responded(), response_of(6), is_responded(), response_of(3), is_responded()}}),
      on_chart(token_must("user/who_is_wanted_again_joins_again", "TB-30",
                          "A station that has left the ring answers no solicitation and nobody who asks who "
                          "follows; when it is wanted in the ring again, it joins again.",
                          standard("in_ring_desired"),
                          {{"follows_outside_of_the_ring", "speaks_after_leaving"},
                           {"wish_taken_once", "answer_missing"}}),
               {{},
                {joined(), desired(false), token(),
                 says("set_successor to 000E with 0004",
                      {TokenControl::set_successor, TokenBench::kAbove, TokenBench::kBelow}, at_once(),
                      "leaving_missing", "leaving_wrong"),
                 passes_below(at_once()), taken(),
                 send("0020 asks who follows 000E",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::who_follows, TokenBench::kAbove,
                                                 TokenBench::kStranger, TokenBench::kAbove);
                      }),
                 silence(2 * 28, "speaks_after_leaving", "it is not in the ring"), desired(true), joined(),
                 token(), passes_on()}}),
      on_chart(token_must("user/it_responds_outside_of_the_ring", "TB-27",
                          "A station answers a request with response whether it is in the ring or not, and "
                          "none for a group.",
                          standard("response"),
                          {{"responds_in_the_ring_only", "response_missing"},
                           {"responds_for_groups", "responds_unasked"}}),
               {{},
                {response_of(5), is_responded(), wait(8),
                 send("000E sends a request of priority 4 for the group 0003",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x32, kGroup, TokenBench::kAbove, {7});
                      }),
                 silence(3 * 28, "responds_unasked", "nobody answers for a group")}}),
      on_chart(
          token_must("user/it_stays_until_its_data_are_sent", "TB-30",
                     "A station that is not to be in the ring any more stays while data wait, and leaves "
                     "when they are sent.",
                     standard("in_ring_desired"), {{"leaves_with_data_left", "leaves_with_data"}}),
          {{},
           {joined(), submit({6, 6, 6}, 20), desired(false), token(),
            sends("what has time: one frame", {6}, "leaves_with_data", "data_missing"), taken(), token(),
            sends("one more", {6}, "leaves_with_data", "data_missing"), taken(), token(),
            says("the last", {TokenControl{0x62}, TokenBench::kBelow}, at_once(), "data_missing",
                 "data_wrong"),
            says("set_successor to 000E with 0004",
                 {TokenControl::set_successor, TokenBench::kAbove, TokenBench::kBelow}, at_once(),
                 "leaving_missing", "leaving_wrong"),
            passes_below(at_once())}},
          with([](token_bus::Rules& rules) { rules.high_priority_hold_octets = 20; })),
      on_chart(
          token_must("user/what_costs_the_token_is_received", "TB-26",
                     "A frame that costs a station the token is received as any other: its data are "
                     "reported.",
                     own("unexpected frames"), {{"data_lost_with_the_token", "not_delivered"}}),
          {{},
           {joined(), until_window(), wait(6),
            send("0020 sends data to the station",
                 [](TokenScene& scene) {
                   return scene.bench.data_frame(0x62, kOwnAddress, TokenBench::kStranger,
                                                 scene.bench.numbered_data(6));
                 }),
            reported("it", token_bus::EventKind::unexpected_frame, TokenBench::kStranger),
            delivered("they are delivered", 1), silence(5 * 28, "token_kept", "another holds the token")}}),
      on_chart(
          token_must("user/only_its_own_successor_is_changed", "TB-30",
                     "What is said to another, or names a group, leaves a station its successor.",
                     standard("leaving"),
                     {{"successor_of_another_taken", "token_wrong"}, {"group_is_successor", "token_wrong"}}),
          {{},
           {joined(), names_successor(TokenBench::kStranger, 0x0002), wait(10), token(),
            passes_below(at_once()), taken(), names_successor(kOwnAddress, 0x0003), wait(10), token(),
            passes_below(at_once()), taken()}}),
      on_chart(token_must("user/any_group_is_its_own", "TB-33",
                          "Data for a group, whichever it is, are reported to its user.", own("groups"),
                          {{"broadcast_only", "not_delivered"}}),
               {{}, {joined(), data_for_group(), delivered("they are delivered", 1), wait(10), serves()}}),
      on_chart(token_must("user/a_second_of_its_address_is_seen_before_it_joins", "TB-29",
                          "A station that receives a frame with its own address as the source reports it and "
                          "goes offline, whether it is in the ring or not.",
                          standard("duplicate address"), {{"duplicate_in_the_ring_only", "not_reported"}}),
               {{},
                {wait(10),
                 send("another station with the address of the station sends data to 0004",
                      [](TokenScene& scene) {
                        return scene.bench.data_frame(0x62, TokenBench::kBelow, kOwnAddress, {1, 2});
                      }),
                 reported("it", token_bus::EventKind::duplicate_address, kOwnAddress),
                 silence(10 * 28, "speaks_as_duplicate", "its address is another's")}}),
      on_chart(token_must("user/an_answer_to_another_is_no_answer", "TB-26",
                          "A station that waits for answers and receives set_successor for another drops the "
                          "token.",
                          token_sources::controller("unexpected frame 10"),
                          {{"answer_to_another_taken", "token_kept"}}),
               {{},
                {joined(), until_window(), wait(6),
                 send("0006 sends set_successor to 0020",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::set_successor, TokenBench::kStranger, 0x0006,
                                                 0x0006);
                      }),
                 silence(5 * 28, "token_kept", "another holds the token")}}),
  };
}

}  // namespace fieldproof::conformance
