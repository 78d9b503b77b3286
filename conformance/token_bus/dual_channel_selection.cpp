#include "conformance/token_bus/dual_channel_scene.hpp"

// Whose transmission the MAC is given.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

// More than any skew that is borne; and more than the shortest frame, less than a slot time.
constexpr std::int64_t kLate = 40;
std::int64_t later_than_a_frame(const ManagerScene& scene) {
  constexpr std::int64_t kFrame = 130;
  return std::min(kFrame, scene.slot_symbols() - 8);
}

std::string random_noise(ManagerScene& scene) {
  std::string symbols;
  while (symbols.size() < 80) symbols += "01BN1"[scene.bench.random_octet() % 5];
  // No delimiter by chance.
  for (std::size_t at = symbols.find("NN"); at != std::string::npos; at = symbols.find("NN"))
    symbols.at(at) = 'B';
  return symbols + "1";
}

void carry_with_any_skew(ManagerScene& scene) {
  const std::int64_t skew = scene.round % (scene.skew() + 1);
  const bool is_b_later = scene.round / (scene.skew() + 1) % 2 == 0;
  const std::string one = scene.frame();
  scene.carry({one, is_b_later ? 0 : skew}, {one, is_b_later ? skew : 0});
}

// The frame of A later than that of B.
void carry_a_late(ManagerScene& scene, std::int64_t later) {
  scene.carry({scene.frame(), later}, {scene.frame()});
}

ManagerStep of_a(std::string reason) {
  return requires_that("that of A is indicated", [reason = std::move(reason)](ManagerScene& scene) {
    scene.expect_all_of(Channel::a, reason);
  });
}
ManagerStep of_b_from_delimiter(std::string reason) {
  return requires_that("that of B is indicated from its start delimiter on, and nothing else",
                       [reason = std::move(reason)](ManagerScene& scene) {
                         scene.expect_from_delimiter_of(Channel::b, reason);
                       });
}

std::vector<ManagerCase> which_cases() {
  return {
      on_chart(manager_must("selection/one_of_two_is_indicated", "",
                            "What both channels carry, at most the skew apart, is indicated once, to the "
                            "symbol and in time, and nothing is reported.",
                            "the skew that is borne",
                            {{"indicates_both", "indicated_wrong"},
                             {"loses_the_first_symbol", "indicated_wrong"},
                             {"slow_indications", "indicated_too_late"},
                             {"goes_on_with_the_other", "indicated_wrong"}}),
               {{18, 90},
                {does("both carry the same frame, with each skew in turn", carry_with_any_skew),
                 of_a("indicated_wrong"), nothing_reported("reported_without_fault")},
                {powered_anew()}}),
      on_chart(manager_must("selection/the_preferred_channel_within_the_skew", "",
                            "The preferred channel is selected though its start delimiter is the later "
                            "one, up to the skew.",
                            "the skew that is borne", {{"takes_the_first", "wrong_channel"}}),
               {{8, 40},
                {powered_anew(),
                 does("A carries a frame, later than B another one, by each skew in turn",
                      [](ManagerScene& scene) { carry_a_late(scene, 1 + scene.round % scene.skew()); }),
                 of_a("wrong_channel")}}),
      on_chart(manager_must("selection/the_first_with_a_start_delimiter", "",
                            "Where the preferred channel has none, the channel with a start delimiter is "
                            "selected, in the same transmission.",
                            "first to lock",
                            {{"never_leaves_a", "wrong_channel"}, {"leaves_a_one_later", "wrong_channel"}}),
               {{3, 30},
                {powered_anew(),
                 does("B alone carries a frame", [](ManagerScene& scene) { scene.carry_on(Channel::b); }),
                 of_b_from_delimiter("wrong_channel"), still_serves()}}),
      on_chart(manager_must(
                   "selection/stays_with_who_served", "",
                   "The channel that was selected last is the preferred one.", "sticky preference",
                   {{"prefers_a_always", "wrong_channel"}, {"prefers_who_did_not_serve", "wrong_channel"}}),
               {{3, 30},
                {powered_anew(), b_serves(), indicates_of(Channel::b, "wrong_channel"),
                 indicates_of(Channel::b, "wrong_channel"),
                 does("A alone carries a frame", [](ManagerScene& scene) { scene.carry_on(Channel::a); }),
                 indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(
          manager_must("selection/what_comes_too_late_is_left", "",
                       "A start delimiter of the preferred channel that is later than the skew is not "
                       "waited for; what comes after it there is no second transmission.",
                       "the skew that is borne",
                       {{"waits_for_a_slot_time", "wrong_channel"}, {"takes_late_copies", "wrong_channel"}}),
          {{4, 40},
           {powered_anew(),
            does("A carries a frame, 40 or 130 symbols later than B another one",
                 [](ManagerScene& scene) {
                   carry_a_late(scene, scene.round % 2 == 0 ? kLate : later_than_a_frame(scene));
                 }),
            of_b_from_delimiter("wrong_channel"), indicates_of(Channel::b, "wrong_channel")}}),
  };
}

std::vector<ManagerCase> noise_cases() {
  return {
      on_chart(
          manager_must("selection/noise_of_the_other_is_left", "",
                       "What the channel that is not preferred carries without a start delimiter is not "
                       "indicated, and keeps nobody from his frame.",
                       "what comes in front of a start delimiter", {{"indicates_both", "indicated_wrong"}}),
          {{5, 50},
           {powered_anew(),
            does("B carries symbols without a start delimiter",
                 [](ManagerScene& scene) { scene.carry({}, {random_noise(scene)}); }),
            requires_that("silence is indicated",
                          [](ManagerScene& scene) { scene.expect_indicated("", "indicated_wrong"); }),
            does("A carries a frame, and B such symbols",
                 [](ManagerScene& scene) { scene.carry({scene.frame()}, {random_noise(scene)}); }),
            of_a("indicated_wrong")}}),
      on_chart(manager_must("selection/noise_of_the_preferred_is_indicated", "",
                            "What the preferred channel carries without a start delimiter is indicated as it "
                            "is: the MAC has to know of collisions.",
                            "what comes in front of a start delimiter",
                            {{"indicates_frames_alone", "indicated_wrong"},
                             {"bad_signal_is_silence", "indicated_wrong"}}),
               {{5, 50},
                {powered_anew(),
                 does("A carries symbols without a start delimiter",
                      [](ManagerScene& scene) { scene.carry({random_noise(scene)}, {}); }),
                 of_a("indicated_wrong"),
                 does("both carry symbols without a start delimiter",
                      [](ManagerScene& scene) {
                        scene.carry({random_noise(scene)}, {random_noise(scene), scene.borne(3)});
                      }),
                 of_a("indicated_wrong"), nothing_reported("reported_without_fault")}}),
      on_chart(manager_must("selection/silence_is_no_fault", "",
                            "Two silent channels are indicated as silence, and neither has a fault.",
                            "faults show where the other channel carries something",
                            {{"reports_silence", "reported_without_fault"}}),
               {{2, 10},
                {powered_anew(),
                 does("both are silent for 20 slot times",
                      [](ManagerScene& scene) {
                        scene.carry({}, {});
                        scene.bench.wait(20 * scene.bench.slot());
                      }),
                 requires_that("silence is indicated",
                               [](ManagerScene& scene) { scene.expect_indicated("", "indicated_wrong"); }),
                 nothing_reported("reported_without_fault"), still_serves()}}),
  };
}

}  // namespace

std::vector<ManagerCase> manager_selection_cases() {
  auto all = which_cases();
  for (ManagerCase& one : noise_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
