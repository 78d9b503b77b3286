#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// V(MID), V(MRD) and V(ST) at their ends, at each octet of their width and beside powers of two. A line that
// others keep busy with what is no DLPDU shows how long a station waits for it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

struct FfTimesRow {
  unsigned silence = 0;         // V(MID)
  unsigned response_slots = 1;  // V(MRD)
  unsigned slot = 1;            // V(ST)
  std::vector<MustCatch> catches;
};

constexpr unsigned kWaysOfBeingBusy = 4;  // what is asked for, and what keeps the line busy

kernel::Duration half_bit(const FfBench& bench) {
  return bench.octets(1) / 16;
}

Octets asked(FfScene& scene) {
  if (scene.turn % 2 == 0) return {scene.bench.rules().codes.pn, scene.bench.node()};
  return scene.bench.cd(FfBench::kPublished);
}

DlpduIsNone none_of(const FfScene& scene) {
  return scene.turn / 2 % 2 == 0 ? DlpduIsNone::by_its_check : DlpduIsNone::by_its_first_octet;
}

// When the line is silent at last, so that V(MID) is over half a bit after V(MRD) x V(ST), or just then for a
// station that begins as late after V(MID) as it did before.
kernel::Time last_silence(const FfScene& scene, bool is_too_late) {
  const kernel::Time until = scene.sent + scene.bench.response_delay() - scene.bench.least_gap();
  return is_too_late ? until + half_bit(scene.bench) : until - scene.latency;
}

void expect_answered_in_time(FfScene& scene) {
  const kernel::Time until = last_silence(scene, false);
  if (!keep_busy(scene.bench, until, none_of(scene))) return;
  const DrivenDlpdu one = expect_next(scene.bench, scene.judge, "gives_up_early", "an answer");
  expect_begins(scene.judge, one, until + scene.bench.least_gap(), "answers_too_early",
                scene.sent + scene.bench.response_delay(), "answers_too_late");
}

void expect_given_up(FfScene& scene) {
  if (!keep_busy(scene.bench, last_silence(scene, true), none_of(scene))) {
    scene.bench.listen();
    return;
  }
  expect_silence(scene.bench, scene.judge, "answers_too_late", "V(MRD) x V(ST) is over before V(MID) is");
}

void keep_busy_under_token(FfScene& scene) {
  const kernel::Time until = scene.sent + 4 * scene.bench.least_gap() + scene.bench.frame(20);
  if (keep_busy(scene.bench, until, none_of(scene))) scene.sent = until;
}

FfStep busy_lines() {
  using namespace ff_chart;
  const FfStep question = send("a PN and a CD for the station, in turn", asked);
  return repeat(
      {kWaysOfBeingBusy, 3 * kWaysOfBeingBusy},
      {question,
       FfStep{
           "others keep the line busy, two turns with a wrong check, two with no first octet, until V(MID) "
           "before V(MRD) x V(ST) is over",
           "the answer begins until then", expect_answered_in_time},
       question, FfStep{"they keep it busy half a bit longer", "silence, now and then", expect_given_up},
       submit({Priority::normal, Priority::normal}, 8), pt(Priority::normal, 60'000),
       stimulus<FfScene>("others keep the line busy in the same way", keep_busy_under_token),
       expected<FfScene>("both DLSDUs, and the token returned once", [](FfScene& scene) {
         const auto& all = scene.submitted;
         scene.expect_used({all.end()[-2], all.end()[-1]}, {"frames_missing", "sent_twice"});
       })});
}

FfCase ff_times_case(FfTimesRow row) {
  using namespace ff_chart;
  const std::string numbers =
      fmt::format("V(MID) {}, V(MRD) {} and V(ST) {}", row.silence, row.response_slots, row.slot);
  const auto change = [silence = row.silence, slots = row.response_slots,
                       slot = row.slot](FfConfiguration& configuration) {
    configuration.rules.link.inter_pdu_delay_octets = silence;
    configuration.rules.link.response_delay_slots = slots;
    configuration.rules.link.slot_time_octets = slot;
  };
  return on_chart(
      must_in_time(fmt::format("fieldbus_dll/ff_device/settings/mid_{}_mrd_{}_st_{}_are_kept", row.silence,
                               row.response_slots, row.slot),
                   "FF-46", fmt::format("A station of a link with {} answers within them.", numbers),
                   link_sources::vendors("V(MID), V(MRD), V(ST)"), std::move(row.catches),
                   {{link_sources::own("what is no DLPDU keeps the line busy and ends nothing"),
                     {"gives_up_early", "frames_missing", "token_not_returned"}}}),
      {{},
       {pn(), probe_response("no_probe_response"),
        stimulus<FfScene>("the time until it begins is measured",
                          [](FfScene& scene) {
                            scene.latency = scene.answer.begin - scene.sent - scene.bench.least_gap();
                          }),
        activation(), wait(20), write(8),
        send("a DT1 for another",
             [](FfScene& scene) {
               return scene.bench.dt1(Priority::normal, FfBench::kPeersAddress, FfBench::kSubscribed,
                                      scene.bench.numbered_data(8));
             }),
        wait(static_cast<std::int64_t>(row.silence)), cd(),
        answer<FfScene>(
            "a DT3", "not_published",
            [](const FfScene& scene, const DrivenDlpdu& one) { return is_dt3(scene.bench, one); }),
        busy_lines(), serves()}},
      {.change = change, .is_live = false});
}

}  // namespace

std::vector<FfCase> ff_link_times_cases() {
  std::vector<FfCase> all;
  for (FfTimesRow& row : std::vector<FfTimesRow>{
           {0, 1, 1, {{"silence_of_the_usual_link", "no_probe_response"}}},
           {1, 2, 1, {{"silence_of_the_usual_link", "no_probe_response"}}},
           {2, 3, 4, {{"no_dlpdu_ends_the_wait", "gives_up_early"}}},
           {7,
            8,
            255,
            {{"gives_up_half_a_bit_early", "gives_up_early"},
             {"waits_half_a_bit_longer", "answers_too_late"}}},
           {16, 2, 256, {{"slot_of_eight_bits", "no_probe_response"}}},
           {33,
            3,
            257,
            {{"slot_of_eight_bits", "no_probe_response"}, {"waits_for_ever", "answers_too_late"}}},
           {63, 9, 16, {{"waits_four_slots", "gives_up_early"}}},
           {64, 2, 64, {{"silence_of_six_bits", "answers_too_early"}}},
           {65, 5, 2'048, {{"wrong_check_ends_the_wait", "gives_up_early"}}},
           {119,
            7,
            20,
            {{"waits_a_slot_longer", "answers_too_late"}, {"gives_up_a_slot_early", "gives_up_early"}}},
           {120, 11, 12, {{"silence_of_six_bits", "answers_too_early"}}},
           {120, 11, 4'095, {{"waits_four_slots", "gives_up_early"}}}}) {
    all.push_back(ff_times_case(std::move(row)));
  }
  return all;
}

}  // namespace fieldproof::conformance
