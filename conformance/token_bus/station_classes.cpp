#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_visits.hpp"
#include "conformance/token_bus/station_vocabulary.hpp"

// How long each class is served, from its first token on, and what its data are on the line.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::own;
using token_sources::standard;

// Four frames of 80 octets begin in it, with the round before the token; a fifth does not.
constexpr std::uint32_t kTimeOfFour = 430;
constexpr std::array kLowerClasses{4U, 2U, 0U};

void times_of_four(token_bus::Rules& rules) {
  rules.target_rotation_octets.fill(kTimeOfFour);
}

TokenStep eight_of_the_class() {
  return stimulus<TokenScene>(
      "the user submits eight data of 80 octets of class 4; in the next turns of class 2, of class 0",
      [](TokenScene& scene) {
        for (unsigned n = 0; n < 8; ++n)
          scene.bench.submit({.priority = kLowerClasses.at(scene.turn),
                              .destination = TokenBench::kBelow,
                              .data = scene.bench.numbered_data(80)});
      });
}

TokenStep served_while_time_is_left() {
  return {"000E passes the token to the station",
          "data, each begun before the target rotation time is over since the service before; then the token",
          [](TokenScene& scene) {
            // The service before began within a slot time after its token.
            const kernel::Time over =
                scene.token_came + scene.bench.octets(kTimeOfFour) + scene.bench.slots(1);
            scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
            const std::vector<DrivenFrame> all = visit(scene);
            scene.judge.expect(!all.empty(), "class_not_served", "data", "the token at once");
            scene.judge.expect(all.back().begin < over, "served_without_time", [&] {
              return Mismatch{{fmt::format("no frame from {} on", kernel::describe(over))},
                              all.back().text(),
                              all.back().begin};
            });
          }};
}

}  // namespace

std::vector<TokenCase> token_class_cases() {
  const auto source = controller("token_rotation_timer");
  return {
      on_chart(token_must("classes/at_first_class_six_alone", "TB-08",
                          "At its first token a station serves class 6 alone, after each loss of supply as "
                          "well; at its second token it serves the others.",
                          own("timers after a start"),
                          {{"timers_begin_full", "token_wrong"}, {"timers_kept", "token_wrong"}}),
               {{},
                {repeat({3, 3}, {submit({4, 2, 0}, 10), joined(), token(),
                                 sends("classes 4, 2 and 0", {4, 2, 0}, "speaks_unasked", "class_not_served"),
                                 starts_anew()})}}),
      on_chart(
          token_must("classes/each_is_left_when_its_time_is_over", "TB-08",
                     "A class is served as long as its rotation timer has left, whatever waits in it.",
                     source, {{"class_served_to_its_end", "served_without_time"}}),
          {{},
           {repeat({3, 3}, {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
                            taken(), eight_of_the_class(), served_while_time_is_left(), starts_anew()})}},
          with(times_of_four)),
      on_chart(token_must("classes/rotation_counts_from_the_first_of_several", "TB-10",
                          "The rotation timer of a class begins anew with its service, not with each datum.",
                          source, {{"timers_begin_with_each_datum", "served_without_time"}}),
               {{},
                {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
                 submit({4, 4, 4}, 80), others_hold_it_for(70), timed_token(),
                 sends("all of class 4", {4, 4, 4}, "speaks_unasked", "class_not_served"), submit({4}, 10),
                 others_hold_it_for(kTimeOfFour + 80), timed_token(),
                 sends("nothing: its time is over since the service before began", {}, "served_without_time",
                       "class_not_served")}},
               with(times_of_four)),
      on_chart(token_must("classes/late_is_not_late_for_ever", "TB-09",
                          "A class that had no time in several rounds is served when the ring is fast again.",
                          source, {{"class_given_up", "class_not_served"}}),
               {{},
                {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
                 submit({4, 2, 0}, 10),
                 repeat({6, 6},
                        {others_hold_it_for(kTimeOfFour + 200), timed_token(),
                         sends("nothing: the ring is slow", {}, "served_without_time", "class_not_served")}),
                 others_hold_it_for(100), timed_token(),
                 sends("classes 4, 2 and 0", {4, 2, 0}, "speaks_unasked", "class_not_served")}},
               with(times_of_four)),
      on_chart(token_must("classes/each_priority_stands_on_the_line", "TB-08",
                          "Data go with the priority that they were submitted with, not with that of their "
                          "class.",
                          standard("frame control"), {{"priority_of_its_class", "order_wrong"}}),
               {{},
                {joined(), submit({7, 6, 5, 4, 3, 2, 1, 0}, 10), token(),
                 sends("each priority", {7, 6, 5, 4, 3, 2, 1, 0}, "speaks_unasked", "data_missing")}}),
      on_chart(token_must("classes/ring_maintenance_beyond_16_bits", "TB-11",
                          "With a target rotation time of 65536 octet durations for ring maintenance a ring "
                          "is fast enough for windows.",
                          controller("token_rotation_timer of ring maintenance"),
                          {{"maintenance_in_16_bits", "window_missing"}}),
               {{}, {joined(), until_window()}},
               with([](token_bus::Rules& rules) { rules.ring_maintenance_octets = 65'536; })),
  };
}

}  // namespace fieldproof::conformance
