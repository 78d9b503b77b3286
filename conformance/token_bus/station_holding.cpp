#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/station_scene.hpp"

// What a station sends while it holds the token, and for how long.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_sources::controller;
using token_sources::standard;

constexpr std::uint32_t kShortHold = 400;

void short_hold(token_bus::StationConfiguration& configuration) {
  configuration.rules.high_priority_hold_octets = kShortHold;
}
void three_targets(token_bus::StationConfiguration& configuration) {
  configuration.rules.target_rotation_octets = {600, 450, 250};
}
void one_target(token_bus::StationConfiguration& configuration) {
  configuration.rules.target_rotation_octets = {400, 0, 0};
}

bool is_frame_of(const DrivenFrame& one, unsigned priority) {
  return one.is_well_formed && one.is_data() && one.priority() == priority;
}

// All that the station sends until the token, which it passes on.
std::vector<DrivenFrame> visit(TokenScene& scene) {
  std::vector<DrivenFrame> data;
  for (;;) {
    const auto one = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
    scene.judge.expect(one.has_value(), "token_missing", "data, and then the token", "silence");
    scene.since = one->end;
    if (one->is(TokenControl::token)) break;
    data.push_back(*one);
  }
  return data;
}

TokenStep sends(std::string what, std::vector<unsigned> priorities, std::string more, std::string missing) {
  return expected<TokenScene>(
      what + ", then the token", [what, priorities = std::move(priorities), more = std::move(more),
                                  missing = std::move(missing)](TokenScene& scene) {
        const std::vector<DrivenFrame> all = visit(scene);
        for (std::size_t n = 0; n < std::max(all.size(), priorities.size()); ++n) {
          scene.judge.expect(n < all.size(), missing, [&] {
            return Mismatch{{fmt::format("{}: data of priority {}", what, priorities[n])}, "the token"};
          });
          scene.judge.expect(n < priorities.size(), more,
                             [&] { return Mismatch{{what}, all[n].text(), all[n].begin}; });
          scene.judge.expect(is_frame_of(all[n], priorities[n]), "order_wrong", [&] {
            return Mismatch{
                {fmt::format("{}: data of priority {}", what, priorities[n])}, all[n].text(), all[n].begin};
          });
        }
      });
}

// So that the token comes again so much later; the line is not silent meanwhile.
TokenStep others_hold_it_for(std::int64_t octets) {
  return stimulus<TokenScene>(
      fmt::format("the token is with the others until {} octet durations after it came", octets),
      [octets](TokenScene& scene) {
        const kernel::Time until = scene.token_came + scene.bench.octets(octets);
        scene.take_token();
        while (scene.bench.now() + scene.bench.octets(60) < until) {
          scene.send(scene.bench.frame(TokenControl::token, TokenBench::kBelow, TokenBench::kAbove));
          scene.bench.wait(scene.bench.octets(8));
        }
        // The token itself takes its time.
        scene.bench.run_until(until - scene.bench.octets(15));
      });
}

TokenStep timed_token() {
  return stimulus<TokenScene>("000E passes the token to the station", [](TokenScene& scene) {
    scene.token_came =
        scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
  });
}

TokenStep holds_for(std::uint32_t hold) {
  return expected<TokenScene>(
      fmt::format(
          "data of class 6, each begun within {} octet durations after the token, the last completed; "
          "one more would not have begun",
          hold),
      [hold](TokenScene& scene) {
        const kernel::Time came = scene.since;
        const kernel::Time over = came + scene.bench.octets(hold);
        const std::vector<DrivenFrame> all = visit(scene);
        scene.judge.expect(!all.empty(), "hold_not_used", "data", "the token at once");
        for (const DrivenFrame& one : all) {
          scene.judge.expect(one.is_well_formed, "frame_cut", "whole frames", one.text());
          scene.judge.expect(one.begin < over, "hold_exceeded", [&] {
            return Mismatch{
                {fmt::format("no frame from {} on", kernel::describe(over))}, one.text(), one.begin};
          });
        }
        const kernel::Duration pause = all.size() > 1 ? all[1].begin - all[0].end : scene.bench.gap();
        scene.judge.expect(all.back().end + pause >= over, "hold_not_used", [&] {
          return Mismatch{{fmt::format("frames are begun until {}", kernel::describe(over))},
                          fmt::format("the last ends {}", kernel::describe(all.back().end))};
        });
      });
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
               {{}, {joined(), submit_each(40), token(), holds_for(kShortHold)}}, {.adjust = short_hold}),
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
  };
}

}  // namespace fieldproof::conformance
