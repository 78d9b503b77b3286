#include <fmt/format.h>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_visits.hpp"

// Tokens between two windows, and the times that classes of data have, up to the ends of their ranges.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_bus::Rules;
using token_bus::StationConfiguration;
using token_sources::controller;
using token_sources::mib;

// ---- windows ----

// Tokens that were passed on without a window since the one before; the count may be one less where who
// counts begins with the token itself.
void expect_window_after(TokenScene& scene, unsigned least, unsigned most) {
  for (unsigned passed = 0; passed <= most; ++passed) {
    scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
    const auto one = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
    scene.judge.expect(one.has_value(), "token_missing", "the token, or a response window", "silence");
    scene.since = one->end;
    if (!one->is(TokenControl::token)) {
      scene.judge.expect(passed + 1 >= least, "window_early", [&] {
        return Mismatch{{fmt::format("a window after {} tokens", least)},
                        fmt::format("{} after {}", one->text(), passed),
                        one->begin};
      });
      scene.expect_frame({TokenControl::token}, scene.after_slots(1), "the token after the window",
                         "token_missing", "token_wrong");
      return scene.take_token();
    }
    scene.take_token();
  }
  scene.judge.fail("window_missing", {{fmt::format("a window after {} tokens at most", most)}, "none"});
}

TokenStep windows_as_counted() {
  return {"the token goes round",
          "a window after max_inter_solicit_count tokens; then after as many, but for its two low bits",
          [](TokenScene& scene) {
            const unsigned count = scene.bench.rules().max_inter_solicit_count;
            // The token with which it has joined was passed on, too.
            expect_window_after(scene, count - 1, count);
            expect_window_after(scene, count & ~3U, count | 3U);
          }};
}

TokenCase windows_with(const std::string& id, const std::string& what, std::vector<MustCatch> catches,
                       TokenNeeds needs) {
  return on_chart(token_must("settings/" + id, "TB-11",
                             "With " + what + " so many tokens go by between two response windows.",
                             mib("max_inter_solicit_count"), std::move(catches)),
                  {{}, {joined(), windows_as_counted()}}, std::move(needs));
}

// The token comes again so much later.
TokenStep rotations(unsigned count, std::int64_t octets) {
  return repeat({count, count},
                {others_hold_it_for(octets), timed_token(),
                 says("the token to 0004, without a window", {TokenControl::token, TokenBench::kBelow},
                      at_once(), "token_missing", "window_in_a_slow_ring")});
}

std::vector<TokenCase> windows() {
  return {
      windows_with("sixteen_tokens_between_windows", "max_inter_solicit_count 16",
                   {{"eighteen_tokens_at_least", "window_missing"}}, {}),
      windows_with("255_tokens_between_windows", "max_inter_solicit_count 255",
                   {{"sixteen_tokens_always", "window_early"}},
                   with([](Rules& rules) { rules.max_inter_solicit_count = 255; })),
      // Its time begins anew with each pass: a window is no later for it.
      windows_with("a_maintenance_time_of_a_few_rounds",
                   "a time of ring maintenance that is longer than a round and shorter than sixteen",
                   {{"maintenance_since_the_window", "window_missing"}},
                   with([](Rules& rules) { rules.ring_maintenance_octets = 300; })),
      on_chart(token_must("settings/a_slow_ring_opens_no_window", "TB-11",
                          "When the token took longer than the target rotation time of ring maintenance, no "
                          "window is opened; when it is fast again, one is.",
                          controller("token_rotation_timer of ring maintenance"),
                          {{"ring_maintenance_ignored", "window_in_a_slow_ring"}}),
               {{},
                {joined(),
                 timed_token(),
                 passes_below(at_once()),
                 rotations(24, 400),
                 taken(),
                 {"the token comes again at once", "a window: the tokens between two have long passed",
                  [](TokenScene& scene) { expect_window_after(scene, 0, 1); }}}},
               with([](Rules& rules) { rules.ring_maintenance_octets = 300; })),
  };
}

// ---- the time of classes ----

void drawn_hold(StationConfiguration& configuration, kernel::Random& random) {
  configuration.rules.high_priority_hold_octets = drawn(random, 100, 1'200);
}

std::vector<TokenCase> holds_of_all_lengths() {
  const auto requirement = "Class 6 is served as long as hi_pri_token_hold_time says.";
  const auto source = controller("hi_pri_token_hold_time");
  return {
      on_chart(token_must("settings/a_hold_time_that_is_drawn", "TB-07", requirement, source,
                          {{"hold_of_2000_octets", "hold_exceeded"}}),
               {{}, {joined(), submit(std::vector<unsigned>(80, 6U), 10), token(), holds()}},
               {.adjust = drawn_hold}),
      on_chart(token_must("settings/no_hold_time_at_all", "TB-07", requirement, source,
                          {{"hold_of_ten_octets_at_least", "hold_exceeded"}}),
               {{},
                {joined(), submit({6, 6}, 10), token(),
                 sends("nothing: there is no time", {}, "hold_exceeded", "data_missing")}},
               with([](Rules& rules) { rules.high_priority_hold_octets = 0; })),
      on_chart(token_must("settings/the_longest_hold_time", "TB-07", requirement, source,
                          {{"hold_in_15_bits", "hold_not_used"}}),
               {{}, {joined(), submit(std::vector<unsigned>(10, 6U), 8'000), token(), holds()}},
               with([](Rules& rules) { rules.high_priority_hold_octets = 65'535; })),
      on_chart(token_must(
                   "settings/targets_at_their_ends", "TB-08",
                   "A class whose target rotation time is the longest is served in a slow ring, and one "
                   "that has none is not served in a fast one.",
                   controller("token_rotation_timer"),
                   {{"targets_in_16_bits", "class_not_served"}, {"zero_is_no_limit", "served_without_time"}}),
               {{},
                {joined(), timed_token(), sends("nothing", {}, "speaks_unasked", "data_missing"),
                 submit({0, 2, 4}, 10), others_hold_it_for(100), timed_token(),
                 sends("classes 4 and 2", {4, 2}, "served_without_time", "class_not_served"),
                 submit({2, 4}, 10), others_hold_it_for(70'000), timed_token(),
                 sends("class 4", {4}, "served_without_time", "class_not_served")}},
               with([](Rules& rules) { rules.target_rotation_octets = {2'097'151, 1'000, 0}; })),
  };
}

}  // namespace

std::vector<TokenCase> token_rotation_settings_cases() {
  std::vector<TokenCase> all = windows();
  const std::vector<TokenCase> holds = holds_of_all_lengths();
  all.insert(all.end(), holds.begin(), holds.end());
  return all;
}

}  // namespace fieldproof::conformance
