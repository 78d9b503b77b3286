#include "conformance/fieldbus_dll/ff_las_sequence.hpp"

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_las_reasons.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence_run.hpp"
#include "conformance/fieldbus_dll/ff_las_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kStatesOfFfLas = 10;  // that walks look for: it acts by itself

std::vector<PartialSource> ff_las_sequence_details() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  std::vector<PartialSource> details = ff_details();
  details.push_back(
      {own("what a scheduler says when"),
       {"does_not_wait", "order_wrong", "begin_not_marked", "token_for_removed",
        "token_shorter_than_the_time", "priority_wrong", "time_request_ignored", "data_not_sent",
        "sends_other_data", "second_probe", "probes_out_of_order", "time_told_too_often", "idle_early",
        "own_turn_too_long", "over_what_is_due", "says_without_supply"}});
  details.push_back({own("what the user of a scheduler is told"), {"event_wrong"}});
  details.push_back({own("what has changed is sent within two circulations"),
                     {"not_activated", "live_list_not_told", "live_list_wrong"}});
  details.push_back(
      {vendors("V(DMDT), V(DTHT), V(MSO), V(FUN), V(NUN), V(TDP)"),
       {"token_too_short", "token_too_long", "compelled_late", "probes_unpolled", "time_not_told"}});
  details.push_back({memory("IDLE"), {"line_left_silent"}});
  return details;
}

}  // namespace

const SequenceRole& ff_las_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/ff_las/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever nodes do in whatever order, a scheduler runs its schedule, passes the token to who is "
           "live, with the priority that rotations lead to, and sends what has changed.",
       .reference = link_sources::ff_paper("the scheduler: CD by its schedule, tokens in between"),
       .details = ff_las_sequence_details(),
       .rules = ff_las_reasons(),
       .stimulus =
           "Commands at random, with half bits and bits that are flipped and octets that are missing.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      with_beginnings(ff_las_vocabulary(), states_of_a_master()),
      {{DerivedKind::values, {"steps_to_the_extreme", "priority_wrong"}},
       {DerivedKind::faults, {"steers_the_wrong_way", "priority_wrong"}},
       {DerivedKind::words, {"token_over_due", "token_over_due"}},
       {DerivedKind::words, {"reply_missing_of_itself", "event_wrong"}},
       {DerivedKind::words, {"each_event_once", "event_wrong"}},
       {DerivedKind::words, {"data_return_no_token", "event_wrong"}},
       {DerivedKind::values, {"all_admitted_behind_two_slow", "priority_wrong"}},
       {DerivedKind::values, {"own_data_newest_first", "sends_other_data"}},
       {DerivedKind::words, {"own_data_final", "sends_other_data"}},
       {DerivedKind::words, {"activation_time_available", "not_activated"}},
       {DerivedKind::states, {"own_item_normal", "own_buffer_wrong"}},
       {DerivedKind::states, {"live_list_unnumbered", "live_list_wrong"}},
       {DerivedKind::walks, {"line_left_silent", "line_left_silent"}},
       {DerivedKind::words, {"not_in_its_live_list", "live_list_wrong"}},
       {DerivedKind::words, {"idles_early", "idle_early"}},
       {DerivedKind::states, {"steps_back_to_the_extreme", "priority_wrong"}},
       {DerivedKind::repetitions, {"target_ignored", "priority_wrong"}},
       {DerivedKind::settings, {"time_at_half_speed", "time_wrong"}},
       {DerivedKind::drawn, {"token_over_due", "token_over_due"}}},
      1,
      kStatesOfFfLas};
  return role;
}

FfNeeds ff_las_sequence_needs() {
  return {.change = network_of_las};
}

void run_ff_las_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfLasSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
