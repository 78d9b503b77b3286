#include "conformance/token_bus/dual_channel_scene.hpp"

// When a channel has a fault, who is told, and when it has none any more.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

constexpr const char* kMissingA = "A: no start delimiter";
constexpr const char* kBadA = "A: bad signal";
constexpr const char* kErrorsA = "A: frame errors";
constexpr const char* kErrorsB = "B: frame errors";
constexpr const char* kCleanA = "A: clean again";

void expect_reported_in_time(ManagerScene& scene) {
  scene.expect_events({kMissingA}, "report_wrong");
  // The start delimiter is complete after its preamble.
  const kernel::Duration most = scene.bench.symbols(40) + scene.bench.slot() + scene.bench.indication_delay();
  const kernel::Duration took = scene.bench.last_event() - scene.begin;
  scene.judge.expect(took <= most, "reported_too_late", kernel::describe(most), kernel::describe(took));
}

// Bad signal on A so many symbols after the start delimiter of B; less on B.
void spoil(ManagerScene& scene, std::size_t at, std::size_t on_b = 0) {
  constexpr std::size_t kDelimiter = 40;
  const token_bus::Rules& rules = scene.bench.configuration().rules;
  const std::string frame =
      scene.frame(std::min<std::size_t>(rules.slot_time_octets + 32, token_bus::most_data(rules)));
  // A short frame is spoiled before its end at the latest.
  at = std::min(at, frame.size() - kDelimiter - 8);
  std::string spoiled_a = frame;
  std::string spoiled_b = frame;
  spoiled_a.replace(kDelimiter + at, 4, "BBBB");
  if (on_b > 0) spoiled_b.replace(kDelimiter + on_b, 4, "BBBB");
  scene.carry({spoiled_a}, {spoiled_b});
}

// What comes later than a slot time after a start delimiter, with what follows it until it is seen.
constexpr std::int64_t kOctetsToBeLate = 10;

std::optional<std::string> no_frame_outlasts_a_slot(const judge::Pics& pics) {
  const token_bus::Rules usual;
  const std::int64_t slot = pics.number("slot_time_octets", usual.slot_time_octets);
  if (pics.number("most_octets", static_cast<std::int64_t>(usual.most_octets)) >= slot + kOctetsToBeLate)
    return std::nullopt;
  return "the longest frame is over a slot time after its start delimiter";
}

TestCase for_long_frames(TestCase one) {
  one.not_applicable = no_frame_outlasts_a_slot;
  return one;
}

unsigned errors_in_a_row(const ManagerScene& scene) {
  return scene.bench.configuration().channels.errors_in_a_row;
}
unsigned clean_in_a_row(const ManagerScene& scene) {
  return scene.bench.configuration().channels.clean_in_a_row;
}

// As often as makes a fault, or once less.
ManagerStep carries(const std::string& text, const std::function<void(ManagerScene&)>& run, bool is_fault) {
  return does(text + (is_fault ? ", as often as is a fault" : ", once less than is a fault"),
              [run, is_fault](ManagerScene& scene) {
                const unsigned times = errors_in_a_row(scene) - (is_fault ? 0 : 1);
                for (scene.turn = 0; scene.turn < times; ++scene.turn) run(scene);
              });
}
// Each of them is indicated as it is, too: A is preferred.
ManagerStep wrong_on_a(bool is_fault) {
  return carries(
      "both carry a frame, that of A with a wrong check",
      [](ManagerScene& scene) {
        scene.carry({scene.with_wrong_check()}, {scene.frame()});
        scene.expect_all_of(Channel::a, "wrong_channel");
      },
      is_fault);
}
ManagerStep right_on_both() {
  return does("both carry a right frame", [](ManagerScene& scene) { scene.carry_on_both(); });
}
// Nothing is reported meanwhile.
ManagerStep right_once_less_than_clean() {
  return {"both carry a right frame, once less than makes a channel clean", "nothing is reported",
          [](ManagerScene& scene) {
            for (unsigned n = 1; n < clean_in_a_row(scene); ++n) {
              scene.carry_on_both();
              scene.expect_events({}, "reported_without_fault");
            }
          }};
}

std::vector<ManagerCase> missing_cases() {
  return {
      on_chart(
          manager_must("faults/a_missing_start_delimiter_is_reported", "PST-16",
                       "A channel without a start delimiter for a slot time after one of the other "
                       "channel has a fault; it is reported once, and names the channel.",
                       "no start delimiter for a slot time",
                       {{"reports_nothing", "report_wrong"},
                        {"reports_again_and_again", "report_wrong"},
                        {"reports_the_other_channel", "report_wrong"},
                        {"reports_after_2_slots", "reported_too_late"}}),
          {{3, 30},
           {powered_anew(),
            does("B alone carries a frame", [](ManagerScene& scene) { scene.carry_on(Channel::b); }),
            requires_that("that A has no start delimiter is reported, and within a slot time and the delay",
                          expect_reported_in_time),
            b_serves(), nothing_reported("report_wrong"), b_serves(), nothing_reported("report_wrong")}}),
      on_chart(
          manager_must("faults/a_slot_time_is_not_begun_anew", "PST-16",
                       "The slot time for a start delimiter counts from the first one of the other channel, "
                       "however many of them come in its transmission.",
                       "no start delimiter for a slot time", {{"slot_begins_anew", "reported_too_late"}}),
          {{3, 30},
           {powered_anew(),
            does("B alone carries a transmission of five frames",
                 [](ManagerScene& scene) {
                   std::string train;
                   for (int n = 0; n < 4; ++n) train += scene.frame(0, true);
                   scene.carry({}, {train + scene.frame()});
                 }),
            requires_that("that A has no start delimiter is reported within a slot time of the first one",
                          expect_reported_in_time)}}),
      on_chart(
          manager_must("faults/of_the_other_channel_too", "",
                       "The channel that is not preferred is watched as well.", "both channels are watched",
                       {{"watches_the_preferred_alone", "report_wrong"}}),
          {{3, 30},
           {powered_anew(),
            does("A alone carries a frame", [](ManagerScene& scene) { scene.carry_on(Channel::a); }),
            reported({"B: no start delimiter"}, "report_wrong"), indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(manager_must("faults/within_a_slot_time_is_none", "",
                            "A start delimiter that comes within the slot time, though later than the skew, "
                            "is no fault.",
                            "no start delimiter for a slot time",
                            {{"fault_after_the_skew", "reported_without_fault"}}),
               {{3, 30},
                {powered_anew(),
                 does("A carries a frame eight symbols less than a slot time later than B",
                      [](ManagerScene& scene) {
                        const std::string frame = scene.frame();
                        scene.carry({frame, scene.slot_symbols() - 8}, {frame});
                      }),
                 nothing_reported("reported_without_fault"), still_serves()}}),
  };
}

std::vector<ManagerCase> bad_signal_cases() {
  return {
      on_chart(manager_must("faults/bad_signal_within_a_slot_time", "",
                            "bad_signal within a slot time after the start delimiter of the other channel, "
                            "which has none, is a fault: the other one is preferred.",
                            "bad_signal for a slot time",
                            {{"bad_signal_is_no_fault", "report_wrong"},
                             {"reports_another_cause", "report_wrong"},
                             {"stays_after_bad_signal", "wrong_channel"}}),
               {{4, 40},
                {powered_anew(),
                 does("both carry a frame, A with bad_signal within a slot time after the start delimiter",
                      [](ManagerScene& scene) {
                        spoil(scene, 8 + scene.bench.random_octet() %
                                             static_cast<std::size_t>(scene.slot_symbols() - 32));
                      }),
                 reported({kBadA}, "report_wrong"), indicates_of(Channel::b, "wrong_channel")}}),
      on_chart(manager_must("faults/a_collision_is_none", "",
                            "bad_signal on both channels, at most the skew apart, says nothing about either.",
                            "what both channels spoil says nothing about either",
                            {{"a_collision_is_a_fault", "reported_without_fault"}}),
               {{4, 40},
                {powered_anew(),
                 does("both carry a frame, with bad_signal a symbol apart, A and B first in turn",
                      [](ManagerScene& scene) { spoil(scene, 50, scene.round % 2 == 0 ? 51 : 49); }),
                 nothing_reported("reported_without_fault"), indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(for_long_frames(manager_must(
                   "faults/late_bad_signal_counts_as_an_error", "",
                   "bad_signal later than that spoils a frame: errors_in_a_row are a fault, fewer "
                   "are none.",
                   "spoiled transmissions in a row",
                   {{"bad_signal_at_any_time", "reported_without_fault"},
                    {"errors_are_no_fault", "report_wrong"}})),
               {{2, 20},
                {powered_anew(),
                 carries(
                     "both carry a frame, A with bad_signal later than a slot time after the start delimiter",
                     [](ManagerScene& scene) {
                       spoil(scene, static_cast<std::size_t>(scene.slot_symbols()) + 76);
                       if (scene.turn + 1 < errors_in_a_row(scene))
                         scene.expect_events({}, "reported_without_fault");
                     },
                     true),
                 reported({kErrorsA}, "report_wrong"), indicates_of(Channel::b, "wrong_channel")}}),
  };
}

std::vector<ManagerCase> error_cases() {
  return {
      on_chart(
          manager_must("faults/errors_in_a_row_are_a_fault", "PST-17",
                       "After errors_in_a_row frames with a wrong check on a channel, which the other one "
                       "carries well, the other one is preferred, and the fault is reported.",
                       "spoiled transmissions in a row",
                       {{"errors_are_no_fault", "report_wrong"},
                        {"leaves_after_2", "wrong_channel"},
                        {"leaves_after_4", "report_wrong"}}),
          {{2, 20},
           {powered_anew(), wrong_on_a(true), reported({kErrorsA}, "report_wrong"),
            indicates_of(Channel::b, "wrong_channel"), still_serves()}}),
      on_chart(manager_must("faults/fewer_errors_are_none", "PST-17",
                            "One less are no fault, nor are as many again after a frame that A carries well.",
                            "spoiled transmissions in a row",
                            {{"leaves_after_2", "reported_without_fault"},
                             {"errors_are_never_forgotten", "wrong_channel"}}),
               {{2, 20},
                {powered_anew(), wrong_on_a(false), nothing_reported("reported_without_fault"),
                 right_on_both(), wrong_on_a(false), nothing_reported("reported_without_fault"),
                 indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(manager_must("faults/errors_on_both_are_none", "PST-17",
                            "What both channels carry with a wrong check says nothing about either.",
                            "what both channels spoil says nothing about either",
                            {{"counts_errors_of_both", "reported_without_fault"}}),
               {{2, 20},
                {powered_anew(),
                 carries(
                     "both carry a frame with a wrong check",
                     [](ManagerScene& scene) {
                       const std::string frame = scene.with_wrong_check();
                       scene.carry({frame}, {frame, scene.borne(2)});
                       scene.expect_events({}, "reported_without_fault");
                     },
                     true),
                 indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(
          manager_must("faults/errors_of_the_other_channel", "PST-17",
                       "Errors of the channel that is not preferred are reported, and nothing else "
                       "changes.",
                       "both channels are watched", {{"watches_the_preferred_alone", "report_wrong"}}),
          {{2, 20},
           {powered_anew(),
            carries(
                "both carry a frame, that of B with a wrong check",
                [](ManagerScene& scene) { scene.carry({scene.frame()}, {scene.with_wrong_check()}); }, 3),
            reported({kErrorsB}, "report_wrong"), indicates_of(Channel::a, "wrong_channel")}}),
      on_chart(manager_must("faults/a_frame_without_an_end_is_an_error", "",
                            "A frame that is cut counts as one with a wrong check.",
                            "spoiled transmissions in a row", {{"errors_are_no_fault", "report_wrong"}}),
               {{2, 20},
                {powered_anew(),
                 carries(
                     "both carry a frame, and A is cut within it",
                     [](ManagerScene& scene) {
                       const std::string frame = scene.frame(20);
                       scene.carry({frame.substr(0, 80)}, {frame});
                     },
                     true),
                 reported({kErrorsA}, "report_wrong"), indicates_of(Channel::b, "wrong_channel")}}),
  };
}

std::vector<ManagerCase> e_bit_cases() {
  return {on_chart(
      manager_must(
          "faults/the_e_bit_is_no_error", "",
          "A frame with E = 1 counts for nothing: it neither makes a fault nor ends one, nor a row of "
          "errors. Nor does a frame with I = 1 that silence follows make a fault.",
          "what a repeater has noticed", {{"counts_the_e_bit", "reported_without_fault"}}),
      {{2, 20},
       {powered_anew(),
        carries(
            "both carry a frame, that of A with E = 1",
            [](ManagerScene& scene) {
              const std::string frame = scene.frame();
              scene.carry({frame.substr(0, frame.size() - 1) + "1"}, {frame});
              scene.expect_events({}, "reported_without_fault");
            },
            true),
        carries(
            "both carry a frame, that of A with I = 1 and silence after it",
            [](ManagerScene& scene) {
              const std::string frame = scene.frame();
              scene.carry({frame.substr(0, frame.size() - 2) + "10"}, {frame});
              scene.expect_events({}, "reported_without_fault");
            },
            true),
        indicates_of(Channel::a, "wrong_channel")}})};
}

std::vector<ManagerCase> repair_cases() {
  return {
      on_chart(
          manager_must("faults/a_repaired_channel_is_reported", "",
                       "clean_in_a_row clean transmissions on a channel with a fault end it: that is "
                       "reported, the preference stays, and the next fault is reported again.",
                       "clean transmissions in a row",
                       {{"never_clean_again", "report_wrong"},
                        {"clean_after_one", "reported_without_fault"},
                        {"returns_to_a_when_it_is_clean", "wrong_channel"},
                        {"reports_once_for_ever", "report_wrong"}}),
          {{2, 20},
           {powered_anew(), b_serves(), right_once_less_than_clean(), right_on_both(),
            reported({kCleanA}, "report_wrong"), indicates_of(Channel::b, "wrong_channel"),
            indicates_of(Channel::b, "wrong_channel"), b_serves(), reported({kMissingA}, "report_wrong")}}),
      on_chart(manager_must("faults/a_spoiled_frame_is_no_repair", "",
                            "Only whole frames with a right check count, and only in a row.",
                            "clean transmissions in a row",
                            {{"spoiled_is_clean", "reported_without_fault"},
                             {"clean_is_never_forgotten", "reported_without_fault"}}),
               {{2, 20},
                {powered_anew(), b_serves(), right_once_less_than_clean(),
                 does("both carry a frame, that of A with a wrong check",
                      [](ManagerScene& scene) { scene.carry({scene.with_wrong_check()}, {scene.frame()}); }),
                 nothing_reported("reported_without_fault"), right_once_less_than_clean(), right_on_both(),
                 reported({kCleanA}, "report_wrong")}}),
      on_chart(manager_must("faults/nothing_outlives_the_supply", "",
                            "After a failure of the supply A is preferred, and a fault is reported again.",
                            "what is known is lost with the supply",
                            {{"remembers_over_power_failure", "wrong_channel"}}),
               {{2, 20},
                {powered_anew(), b_serves(), powered_anew(), indicates_of(Channel::a, "wrong_channel"),
                 b_serves(), reported({kMissingA}, "report_wrong")}}),
  };
}

}  // namespace

std::vector<ManagerCase> manager_fault_cases() {
  std::vector<ManagerCase> all;
  for (auto* const chapter : {missing_cases, bad_signal_cases, error_cases, e_bit_cases, repair_cases})
    for (ManagerCase& one : chapter()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
