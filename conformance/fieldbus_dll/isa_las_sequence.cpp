#include "conformance/fieldbus_dll/isa_las_sequence.hpp"

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_las_reasons.hpp"
#include "conformance/fieldbus_dll/isa_las_sequence_run.hpp"
#include "conformance/fieldbus_dll/isa_las_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kStatesOfIsaLas = 15;  // that walks look for: it acts by itself

std::vector<PartialSource> isa_las_sequence_details() {
  using link_sources::own;
  return {{own("V(RR) is 32 octets, VC(UC) the duration and a margin, items within V(ST) of their time"),
           {"talks_into_token", "talks_into_transfer", "talks_into_reply", "answers_too_early",
            "delegation_early", "line_left_silent", "no_reply", "preamble_wrong", "says_without_supply"}},
          {own("the scheduler's own data, where it ends before the next item"),
           {"sends_other_data", "own_data_over_due", "data_refused", "data_too_long_taken", "reply_wrong"}},
          {own("TL, and the lower address of two schedulers"),
           {"speaks_unasked", "transfer_unasked", "transfer_wrong", "no_transfer", "order_refused",
            "order_without_node_taken"}},
          {own("what its user is given, and in which order"),
           {"not_delivered", "delivered_otherwise", "delivered_unasked"}}};
}

}  // namespace

const SequenceRole& isa_las_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/isa_las/check/follows_the_rules",
       .purpose = "check",
       .requirement =
           "Whatever holders do in whatever order, a scheduler delegates its token as its schedule says, "
           "supervises it, sends its own data in between and hands the link over when it must.",
       .reference = link_sources::isa_paper("the link active scheduler and its timers"),
       .details = isa_las_sequence_details(),
       .rules = isa_las_reasons(),
       .stimulus =
           "Holders at random, and returns with half bits and bits that are flipped and octets that are "
           "missing.",
       .expected = "What an acceptor of the rules allows.",
       .tags = {},
       .catches = {}},
      with_beginnings(isa_las_vocabulary(), states_of_an_isa_las()),
      {{DerivedKind::values, {"schedule_late", "line_left_silent"}},
       {DerivedKind::drawn, {"sign_of_life_of_anybody", "line_left_silent"}},
       {DerivedKind::drawn, {"first_order_stays", "transfer_wrong"}},
       {DerivedKind::drawn, {"order_refused_in_standby", "order_refused"}},
       {DerivedKind::states, {"end_with_a_reason_ignored", "delivered_unasked"}},
       {DerivedKind::drawn, {"signed_addresses", "line_left_silent"}},
       {DerivedKind::settings, {"one_octet_of_preamble", "preamble_wrong"}},
       {DerivedKind::words, {"standby_after_supply", "line_left_silent"}},
       {DerivedKind::faults, {"schedule_not_begun", "line_left_silent"}},
       {DerivedKind::words, {"schedule_early", "delegation_early"}},
       {DerivedKind::words, {"each_event_once", "not_delivered"}},
       {DerivedKind::words, {"reclaimed_is_overrun", "delivered_otherwise"}},
       {DerivedKind::words, {"own_data_without_return", "own_data_over_due"}},
       {DerivedKind::words, {"transfer_ignored_by_scheduler", "delegation_wrong"}},
       {DerivedKind::states, {"retakes_early", "answers_too_early"}},
       {DerivedKind::walks, {"no_supervision", "line_left_silent"}},
       {DerivedKind::repetitions, {"scheduler_never_replies", "no_reply"}},
       {DerivedKind::settings, {"transfer_without_version", "transfer_wrong"}},
       {DerivedKind::drawn, {"scheduler_for_reply_untold", "not_delivered"}},
       {DerivedKind::drawn, {"schedule_early", "delegation_early"}}},
      1,
      kStatesOfIsaLas};
  return role;
}

IsaNeeds isa_las_sequence_needs() {
  return {.schedule = schedule_of_isa_las()};
}

void run_isa_las_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge) {
  IsaLasSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
