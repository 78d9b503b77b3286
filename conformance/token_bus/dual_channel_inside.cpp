#include <fmt/format.h>

#include "conformance/token_bus/dual_channel_scene.hpp"

// Within a transmission: what was begun from one channel is ended from it, whatever becomes of it.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

constexpr std::size_t kMoreOctets = 21;  // than the shortest frame has

// Somewhere after the start delimiter, in front of the end.
std::size_t place_within(ManagerScene& scene, const std::string& frame) {
  constexpr std::size_t kHead = 44;
  constexpr std::size_t kTail = 12;
  return kHead + scene.bench.random_octet() % (frame.size() - kHead - kTail);
}

void cut_a(ManagerScene& scene) {
  const std::string frame = scene.frame(kMoreOctets);
  scene.carry({frame.substr(0, place_within(scene, frame))}, {frame, scene.borne(scene.round % 4)});
}

// Eight symbols, or all that is left.
void spoil_a(ManagerScene& scene) {
  const std::string frame = scene.frame(kMoreOctets);
  const std::size_t at = place_within(scene, frame);
  std::string spoiled = frame;
  const std::size_t count = scene.round % 2 == 0 ? 8 : frame.size() - at;
  spoiled.replace(at, count, std::string(count, 'B'));
  scene.carry({spoiled}, {frame, scene.borne(scene.round % 4)});
}

// Short after the start delimiter, so that a fault is found; A is silent then, and B goes on.
void spoil_and_cut_a(ManagerScene& scene) {
  const std::string frame = scene.frame(kMoreOctets);
  scene.carry({frame.substr(0, 60) + "BBBB"}, {frame});
}

ManagerStep all_of(Channel channel, std::string reason) {
  return requires_that(
      fmt::format("all that {} carries is indicated, and nothing else", text_of(channel)),
      [channel, reason = std::move(reason)](ManagerScene& scene) { scene.expect_all_of(channel, reason); });
}

void carry_train(ManagerScene& scene) {
  const std::string train = scene.frame(0, true) + scene.frame(11, true) + scene.frame();
  const std::int64_t skew = scene.round % (scene.skew() + 1);
  scene.carry({train, scene.round % 2 == 0 ? skew : 0}, {train, scene.round % 2 == 0 ? 0 : skew});
}

// On A the second frame of three has no start delimiter.
void carry_train_with_gap(ManagerScene& scene) {
  const std::string first = scene.frame(0, true);
  const std::string second = scene.frame(11, true);
  const std::string third = scene.frame();
  scene.carry({first + std::string(second.size(), '1') + third}, {first + second + third, scene.borne(2)});
}

// On A what is spoiled never ends; 20 symbols after the first transmission B carries a second one.
void carry_with_a_stuck(ManagerScene& scene, const std::string& stuck, std::size_t symbols) {
  const std::string first = scene.frame();
  std::string on_a = first.substr(0, 60);
  while (on_a.size() < symbols + 200) on_a += stuck;
  const std::string silence(symbols > first.size() ? symbols - first.size() : 20, 'S');
  scene.carry({on_a}, {first + silence + scene.frame()});
}

void expect_second_of_b(ManagerScene& scene) {
  scene.bench.settle();
  const std::string second = from_delimiter(scene.b.symbols.substr(scene.b.symbols.rfind('S') + 1));
  const std::string seen = without_end(scene.bench.indicated().text(), 'S');
  scene.judge.expect(seen.ends_with(second), "wrong_channel", [&] {
    return difference(second, seen.substr(seen.size() - std::min(seen.size(), second.size())));
  });
}

std::vector<ManagerCase> spoiled_cases() {
  return {
      on_chart(manager_must("inside/a_cut_is_given_on", "PST-16",
                            "A channel that falls silent within a frame is indicated as it is: no rest of "
                            "the other channel is put to it.",
                            "no switch within a frame", {{"goes_on_with_the_other", "switched_inside"}}),
               {{8, 80},
                {powered_anew(), does("both carry a frame, and A is cut within it", cut_a),
                 all_of(Channel::a, "switched_inside"), still_serves()}}),
      on_chart(
          manager_must(
              "inside/bad_signal_is_given_on", "",
              "A channel that is spoiled within a frame is indicated as it is.", "no switch within a frame",
              {{"switches_at_bad_signal", "switched_inside"}, {"bad_signal_is_silence", "switched_inside"}}),
          {{8, 80},
           {powered_anew(), does("both carry a frame, and that of A has bad_signal in it", spoil_a),
            all_of(Channel::a, "switched_inside"), still_serves()}}),
      on_chart(manager_must("inside/the_rest_of_the_other_is_left", "PST-16",
                            "When a channel is left, the other one is indicated from its next transmission "
                            "on, not from within one.",
                            "no switch within a frame", {{"indicates_the_rest", "switched_inside"}}),
               {{4, 40},
                {powered_anew(),
                 does("both carry a frame; A has bad_signal in it and is cut, B goes on", spoil_and_cut_a),
                 all_of(Channel::a, "switched_inside"), indicates_of(Channel::b, "wrong_channel")}}),
      on_chart(manager_must("inside/what_is_spoiled_blocks_nothing", "",
                            "A channel that has been spoiled within a frame and falls silent no more keeps "
                            "the next transmission of the other one from nobody.",
                            "what cannot complete is no transmission",
                            {{"waits_for_the_end_of_what_is_spoiled", "wrong_channel"}}),
               {{3, 30},
                {powered_anew(),
                 does("A has bad_signal within a frame, for ever; B carries it and a second one",
                      [](ManagerScene& scene) { carry_with_a_stuck(scene, "B", 0); }),
                 requires_that("the second one is indicated", expect_second_of_b)}}),
      on_chart(manager_must("inside/what_has_no_end_blocks_nothing", "",
                            "Nor does one that carries symbols for longer than any frame.",
                            "what cannot complete is no transmission",
                            {{"waits_for_the_end_of_what_is_spoiled", "wrong_channel"},
                             {"waits_for_an_end_for_ever", "wrong_channel"}}),
               {{1, 3},
                {powered_anew(),
                 does("A carries ones from within a frame on, for ever; B carries it, and one later than the "
                      "longest frame",
                      [](ManagerScene& scene) {
                        carry_with_a_stuck(scene, "1",
                                           8 * (scene.bench.configuration().rules.most_octets + 20));
                      }),
                 requires_that("that is indicated", expect_second_of_b)}}),
  };
}

std::vector<ManagerCase> length_cases() {
  return {
      on_chart(manager_must(
                   "inside/a_train_is_one_transmission", "",
                   "Frames with I = 1 between them are one transmission, and come from one channel.",
                   "end of a transmission",
                   {{"indicates_both", "switched_inside"}, {"selects_each_frame_anew", "switched_inside"}}),
               {{6, 60},
                {powered_anew(),
                 does("both carry three frames, two of them with I = 1, with any skew", carry_train),
                 all_of(Channel::a, "switched_inside"), powered_anew(),
                 does("the same, and on A ones are in the place of the second frame", carry_train_with_gap),
                 all_of(Channel::a, "switched_inside"), still_serves()}}),
      on_chart(manager_must("inside/the_longest_frame_comes_whole", "",
                            "A frame of 8191 octets is indicated to the symbol.", "a manager knows no length",
                            {{"gives_up_after_50000", "switched_inside"}}),
               {{1, 3},
                {powered_anew(),
                 does("both carry a frame of 8191 octets, B five symbols later",
                      [](ManagerScene& scene) {
                        const std::string frame = scene.longest_frame();
                        scene.carry({frame}, {frame, scene.borne(5)});
                      }),
                 all_of(Channel::a, "switched_inside"), nothing_reported("reported_without_fault"),
                 still_serves()}}),
      on_chart(
          manager_must("inside/an_abort_is_given_on", "",
                       "A start delimiter with an end delimiter after it is indicated as it is, and says "
                       "nothing about a channel.",
                       "what both channels spoil says nothing about either",
                       {{"goes_on_with_the_other", "switched_inside"},
                        {"counts_errors_of_both", "reported_without_fault"}}),
          {{4, 20},
           {
               does("both carry an abort, B four symbols later",
                    [](ManagerScene& scene) {
                      const std::string abort = indicated_as(frame_text({}));
                      scene.carry({abort}, {abort, scene.borne(4)});
                    }),
               all_of(Channel::a, "switched_inside"),
               nothing_reported("reported_without_fault"),
           },
           {powered_anew()}}),
      on_chart(manager_must("inside/an_abort_blocks_nothing", "",
                            "A channel that has carried an abort alone does not keep the other one out.",
                            "what has ended is over", {{"an_abort_stays_selected", "wrong_channel"}}),
               {{4, 20},
                {powered_anew(),
                 does("B alone carries an abort, then A alone a frame",
                      [](ManagerScene& scene) {
                        scene.carry({}, {indicated_as(frame_text({}))});
                        scene.carry({scene.frame()}, {});
                      }),
                 requires_that("the frame of A is indicated from its start delimiter on",
                               [](ManagerScene& scene) {
                                 scene.expect_from_delimiter_of(Channel::a, "wrong_channel");
                               })}}),
  };
}

}  // namespace

std::vector<ManagerCase> manager_inside_cases() {
  auto all = spoiled_cases();
  for (ManagerCase& one : length_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
