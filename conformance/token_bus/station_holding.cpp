#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/station_visits.hpp"

// What a station sends while it holds the token, and for how long.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::standard;

void short_hold(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.high_priority_hold_octets = 400;
}
// A frame and its gap last 31 octet durations: the ninth would begin two after this.
void hold_that_ends_in_a_gap(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.high_priority_hold_octets = 6 + 8 * 31 - 2;
}
void hold_of_one_frame(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.high_priority_hold_octets = 20;
}
void three_targets(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.target_rotation_octets = {600, 450, 250};
}
void one_target(token_bus::StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.target_rotation_octets = {400, 0, 0};
}

TokenStep submit_each(std::size_t count) {
  return submit(std::vector<unsigned>(count, 6U), 10);
}

TokenStep sends_what_was_submitted() {
  return expected<TokenScene>("the data, to 0004, in the order of submission", [](TokenScene& scene) {
    const std::vector<DrivenFrame> all = visit(scene);
    scene.judge.expect_equal(all.size(), std::size_t{1}, "data_missing", "frames of data");
    scene.judge.expect(all[0].data() == scene.data && all[0].destination() == TokenBench::kBelow,
                       "data_wrong", "what the user has submitted", all[0].text());
  });
}

// Longer than the target rotation time from the end of its service on to its next one, and shorter from its
// begin on.
constexpr std::size_t kLongService = 300;

}  // namespace

std::vector<TokenCase> token_holding_cases() {
  return {
      on_chart(
          token_must("holding/data_are_sent_as_submitted", "TB-07",
                     "A station sends what its user submits, from no octet of data to 8182, when it has the "
                     "token.",
                     standard("data frames"), {{"data_lost", "data_missing"}}),
          {{},
           {joined(), repeat({5, 5}, {stimulus<TokenScene>(
                                          "the user submits data of 0, 1, 100, 1000 and 8182 octets",
                                          [](TokenScene& scene) {
                                            constexpr std::array<std::size_t, 5> kSizes{0, 1, 100, 1'000,
                                                                                        8'182};
                                            scene.data = scene.bench.numbered_data(kSizes.at(scene.turn));
                                            scene.judge.expect(
                                                scene.bench.submit(
                                                    {.destination = TokenBench::kBelow, .data = scene.data}),
                                                "data_refused", "the data is accepted", "it was refused");
                                          }),
                                      token(), sends_what_was_submitted(), taken()})}}),
      on_chart(token_must("holding/frames_begin_while_time_is_left", "TB-07",
                          "Class 6 is served until hi_pri_token_hold_time is over; a frame that has begun is "
                          "completed.",
                          controller("hi_pri_token_hold_time"),
                          {{"frame_cut_at_expiry", "frame_cut"},
                           {"hold_doubled", "hold_exceeded"},
                           {"hold_halved", "hold_not_used"}}),
               {{}, {joined(), submit_each(40), token(), holds()}}, {.adjust = short_hold}),
      on_chart(
          token_must("holding/classes_are_served_by_their_rotation_timers", "TB-08",
                     "A lower class is served while its token rotation timer has time left, the more urgent "
                     "class first.",
                     controller("priority option"),
                     {{"served_without_time", "served_without_time"}, {"priorities_ignored", "order_wrong"}}),
          {{},
           {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
            submit({0, 2, 4, 6}, 10), others_hold_it_for(320), timed_token(),
            sends("classes 6, 4 and 2, but not 0, whose time is over", {6, 4, 2}, "served_without_time",
                  "class_not_served"),
            others_hold_it_for(200), timed_token(),
            sends("class 0", {0}, "speaks_unasked", "class_not_served")}},
          {.adjust = three_targets}),
      on_chart(token_must("holding/a_slow_ring_serves_class_six_only", "TB-09",
                          "When the token took longer than all target rotation times only class 6 is served.",
                          controller("priority option"), {{"served_without_time", "served_without_time"}}),
               {{},
                {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
                 submit({0, 2, 4, 6}, 10), others_hold_it_for(700), timed_token(),
                 sends("class 6", {6}, "served_without_time", "class_not_served")}},
               {.adjust = three_targets}),
      on_chart(token_must(
                   "holding/rotation_counts_from_the_service_of_a_class", "TB-10",
                   "The token rotation timer of a class begins anew when the service of the class begins, "
                   "not when the token comes.",
                   controller("token_rotation_timer"), {{"timers_begin_with_the_token", "class_not_served"}}),
               {{},
                {joined(), submit({6, 6, 6, 6, 6, 6, 6}, 10), timed_token(),
                 sends("class 6, for some 200 octet durations", {6, 6, 6, 6, 6, 6, 6}, "speaks_unasked",
                       "data_missing"),
                 submit({4}, 10), others_hold_it_for(500), timed_token(),
                 sends("class 4: 300 octet durations after its last service 400 are not over", {4},
                       "speaks_unasked", "class_not_served")}},
               {.adjust = one_target}),
      on_chart(
          token_must("holding/rotation_counts_from_the_begin_of_a_service", "TB-10",
                     "The token rotation timer of a class begins anew when its service begins, not when it "
                     "ends.",
                     controller("token_rotation_timer"),
                     {{"timers_begin_with_the_end", "served_without_time"}}),
          {{},
           {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
            submit({4}, kLongService), others_hold_it_for(200), timed_token(),
            sends("class 4, a long frame that begins in time", {4}, "speaks_unasked", "class_not_served"),
            submit({4}, 10), others_hold_it_for(500), timed_token(),
            sends("nothing: 400 octet durations are over since the service before began", {},
                  "served_without_time", "class_not_served")}},
          {.adjust = one_target}),
      on_chart(
          token_must("holding/no_frame_begins_when_time_is_over", "TB-07",
                     "hi_pri_token_hold_time begins with the token, and a frame that would begin when it "
                     "is over is not sent, though the one before ended in time.",
                     controller("hi_pri_token_hold_time"),
                     {{"hold_begins_with_the_first_frame", "hold_exceeded"}}),
          {{}, {joined(), submit_each(20), token(), holds()}}, {.adjust = hold_that_ends_in_a_gap}),
      on_chart(token_must("holding/the_hold_time_is_for_class_six_alone", "TB-08",
                          "A lower class is served as long as its rotation timer has left, whatever "
                          "hi_pri_token_hold_time is.",
                          controller("priority option"), {{"lower_classes_held_too", "class_not_served"}}),
               {{},
                {joined(), submit({4, 4, 4}, 10), token(),
                 sends("all of class 4", {4, 4, 4}, "speaks_unasked", "class_not_served")}},
               {.adjust = hold_of_one_frame}),
      on_chart(token_must("holding/a_class_is_served_in_the_order_of_submission", "TB-08",
                          "Within a class what was submitted first is sent first, whichever of the two "
                          "priorities of the class it has.",
                          controller("priority option"),
                          {{"newest_first", "order_wrong"},
                           {"higher_priority_first", "order_wrong"},
                           {"higher_priority_first_in_the_lowest", "order_wrong"}}),
               {{},
                {joined(), submit({6, 7, 6, 7}, 10), submit({4, 5, 4}, 10), submit({2, 3, 2}, 10),
                 submit({0, 1, 0}, 10), token(), sends_in_order()}}),
  };
}

}  // namespace fieldproof::conformance
