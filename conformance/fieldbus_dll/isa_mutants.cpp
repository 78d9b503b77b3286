#include "conformance/fieldbus_dll/isa_mutants.hpp"

#include "conformance/fieldbus_dll/isa_check_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_frame_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_las_check_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_las_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_reply_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_token_seeded_faults.hpp"
#include "conformance/fieldbus_dll/mutant_table.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaDevice;
using fieldbus_dll::IsaDlpdu;
using fieldbus_dll::IsaRules;
using fieldbus_dll::IsaType;

using IsaTable = MutantTable<IsaDevice, IsaConfiguration>;
using IsaRow = IsaTable::Row;

std::vector<IsaRow> isa_token_rows() {
  using namespace isa_seeded_faults;
  return {
      {"no_frame_under_et", "", "returns an ET without sending anything",
       IsaTable::station<NoFrameUnderEt>()},
      {"source_of_scheduler", "", "sends data with the scheduler's address as the source",
       IsaTable::station<WritesOtherwise>(IsaType::du, 2U, 0x10)},
      {"end_to_everybody", "", "returns its token to everybody",
       IsaTable::station<WritesOtherwise>(IsaType::ee, 1U, 0xFF)},
      {"end_reason_always_done", "", "gives each EE the reason 2",
       IsaTable::station<WritesOtherwise>(IsaType::ee, 3U, 2)},
      {"end_sent_twice", "", "returns its token twice", IsaTable::station<SaysTwice>(0x60)},
      {"et_sends_all", "ISA-1", "sends all it has under an ET", IsaTable::station<EtSendsAll>()},
      {"es_sends_one", "", "sends one frame under an ES", IsaTable::station<EsSendsOne>()},
      {"queue_lost_behind_et", "", "forgets what is queued when it returns an ET",
       IsaTable::station<LosesQueueAtEnd>(EndReason::single_frame_done)},
      {"queue_lost_without_time", "", "forgets what does not fit",
       IsaTable::station<LosesQueueAtEnd>(EndReason::no_time)},
      {"no_end_when_empty", "ISA-7", "keeps a token for which it has nothing",
       IsaTable::station<NoEndWhenEmpty>()},
      {"no_end_of_sequence", "", "does not return an ES", IsaTable::station<NoEndOfSequence>()},
      {"answers_behind_rr", "", "begins an octet behind V(RR)", IsaTable::station<AnswersBehindRr>()},
      {"rests_before_end", "", "waits for longer than V(RR) before its EE",
       IsaTable::station<RestsBeforeEnd>()},
      {"priority_inverted", "ISA-2", "sends what is at most as urgent as the token",
       IsaTable::station<PriorityInverted>()},
      {"priority_ignored", "", "does not look at the priority of a token",
       IsaTable::station<PriorityIgnored>()},
      {"fifo_across_priorities", "ISA-3", "sends in the order of submission",
       IsaTable::station<FifoAcrossPriorities>()},
      {"finishes_a_priority", "", "finishes a priority before it looks at another",
       IsaTable::station<FinishesAPriority>()},
      {"takes_any_token", "ISA-17", "takes tokens for others", IsaTable::station<TakesAnyToken>()},
      {"timers_of_31250", "", "counts its octets at 31.25 kbit/s, whatever the rate",
       IsaTable::station<TimersOf31250>()},
  };
}

std::vector<IsaRow> isa_duration_rows() {
  using namespace isa_seeded_faults;
  return {
      {"duration_from_begin_of_es", "ISA-4", "counts the duration from the begin of the ES",
       IsaTable::station<DurationFromBeginOfEs>()},
      {"fit_without_end", "ISA-5", "leaves no time for the EE", IsaTable::station<FitWithoutEnd>()},
      {"fits_always", "", "sends whatever is left of the duration", IsaTable::station<FitsAlways>()},
      {"fit_is_strict", "ISA-6", "leaves what would fit exactly", IsaTable::station<FitIsStrict>()},
      {"end_behind_duration", "ISA-8", "returns a token whose duration is over",
       IsaTable::station<EndBehindDuration>()},
      {"duration_ignored", "", "does not look at the duration", IsaTable::station<DurationIgnored>()},
      {"duration_little_endian", "ISA-22", "reads the duration with its low octet first",
       IsaTable::station<DurationLittleEndian>()},
      {"zero_is_for_ever", "", "takes no duration for an endless one", IsaTable::station<ZeroIsForEver>()},
  };
}

std::vector<IsaRow> isa_reply_rows() {
  using namespace isa_seeded_faults;
  return {
      {"rr_runs_through_reply", "ISA-9", "stops VC(RR) at the end of a reply, not at its begin",
       IsaTable::station<RrRunsThroughReply>()},
      {"reply_wait_without_slots", "ISA-10", "waits V(MRD) octets for a reply, not slot times",
       IsaTable::with_rules<IsaDle>(
           [](IsaRules& rules) { rules.reply_wait_octets = rules.link.response_delay_slots; })},
      {"reply_wait_a_tenth_longer", "", "waits for a reply a tenth longer than V(RR)",
       IsaTable::with_rules<IsaDle>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"deaf_and_late", "", "waits a tenth longer, and then talks into whatever is there",
       IsaTable::with_rules<RrRunsThroughReply>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"reply_ends_token", "", "has no token any more behind a reply",
       IsaTable::station<LosesTokenByReply>(false)},
      {"missing_reply_ends_token", "", "has no token any more when a reply is missing",
       IsaTable::station<LosesTokenByReply>(true)},
      {"answers_while_waiting", "", "answers a CD while it waits for a reply",
       IsaTable::station<AnswersWhileWaiting>()},
      {"replies_late", "ISA-11", "replies behind V(FD)",
       IsaTable::with_rules<IsaDle>([](IsaRules& rules) { rules.reply_forming_octets = 60; })},
      {"late_reply_lost", "", "forgets data that came behind V(FD)", IsaTable::station<LateReplyLost>()},
      {"does_not_wait_for_user", "", "replies without data though its user works on some",
       IsaTable::station<DoesNotWaitForUser>()},
      {"short_silence", "ISA-12", "begins V(MID) / 2 behind what was on the line",
       IsaTable::with_rules<IsaDle>([](IsaRules& rules) { rules.link.inter_pdu_delay_octets /= 2; })},
      {"reply_not_final", "", "replies without F", IsaTable::station<ReplyNotFinal>()},
      {"reply_to_scheduler", "", "replies to the scheduler",
       IsaTable::station<WritesOtherwise>(IsaType::dt, 1U, 0x10)},
      {"replies_twice", "", "replies twice", IsaTable::station<SaysTwice>(0x20)},
      {"no_data_no_reply", "", "is silent when it has no data", IsaTable::station<NoDataNoReply>()},
      {"reply_ignores_priority", "", "replies with less urgent data",
       IsaTable::station<ReplyIgnoresPriority>()},
      {"urgent_as_long_as_normal", "", "accepts urgent data of 128 octets",
       IsaTable::station<UrgentAsLongAsNormal>()},
      {"one_octet_less", "", "refuses the longest data", IsaTable::station<OneOctetLess>()},
      {"broadcast_not_delivered", "", "does not deliver data for everybody",
       IsaTable::station<BroadcastNotDelivered>()},
      {"broadcast_answered", "", "answers data for everybody", IsaTable::station<BroadcastAnswered>()},
      {"tells_other_source", "", "tells its user another source",
       IsaTable::station<TellsOtherwise>(+[](IsaDlpdu& dlpdu) { dlpdu.source ^= 1; })},
      {"tells_normal_priority", "", "tells its user normal priority, whatever came",
       IsaTable::station<TellsOtherwise>(
           +[](IsaDlpdu& dlpdu) { dlpdu.priority = fieldbus_dll::Priority::normal; })},
      {"others_data_delivered", "", "delivers data for others", IsaTable::station<OthersDataDelivered>()},
      {"dt_to_everybody_delivered", "", "delivers a DT to everybody",
       IsaTable::station<DtToEverybodyDelivered>()},
  };
}

std::vector<IsaRow> isa_frame_rows() {
  using namespace isa_seeded_faults;
  return {
      {"short_frames_not_checked", "ISA-15", "does not check frames of five octets",
       IsaTable::station<ShortFramesNotChecked>()},
      {"check_from_zero_too", "ISA-16", "takes a check that begins with 0, too",
       IsaTable::station<CheckFromZeroToo>()},
      {"violations_are_bits", "ISA-20", "takes N+ for 1 and N- for 0",
       IsaTable::station<ViolationsAreBits>()},
      {"stuck_behind_violation", "", "hears nothing any more behind a code violation",
       IsaTable::station<StuckBehindViolation>()},
      {"reserved_bit_ignored", "", "does not look at the reserved bit",
       IsaTable::station<ReservedBitIgnored>()},
      {"priority_zero_taken", "", "takes an ET without priority", IsaTable::station<PriorityZeroTaken>()},
      {"length_not_checked", "", "takes an ET of any length", IsaTable::station<LengthNotChecked>()},
      {"wants_one_preamble_octet", "", "hears no frame with more than one octet of preamble",
       IsaTable::station<WantsOnePreambleOctet>()},
      {"does_not_recover_clock", "", "samples with its own clock", IsaTable::station<DoesNotRecoverClock>()},
      {"wants_exact_edges", "", "takes edges that are at most a twentieth of a bit off",
       IsaTable::station<WantsExactEdges>()},
      {"sends_no_preamble", "", "sends no preamble", IsaTable::station<SendsNoPreamble>()},
      {"end_delimiter_turned", "", "sends its end delimiter the other way round",
       IsaTable::station<EndDelimiterTurned>()},
      {"least_significant_bit_first", "", "sends the least significant bit first",
       IsaTable::station<LeastSignificantBitFirst>()},
  };
}

std::vector<IsaRow> isa_check_rows() {
  using namespace isa_seeded_faults;
  std::vector<IsaRow> rows{
      {"token_kept_behind_token", "", "uses a token though another station got one meanwhile",
       IsaTable::station<TokenKeptBehindToken>()},
      {"reply_kept_behind_token", "", "replies though another station got a token meanwhile",
       IsaTable::station<ReplyKeptBehindToken>()},
      {"reply_kept_behind_data", "", "replies though another station sent data meanwhile",
       IsaTable::station<GoesOnBehindData>(fieldbus_dll::DleState::replying)},
      {"waits_on_behind_data", "", "waits for its reply though another station sent data meanwhile",
       IsaTable::station<GoesOnBehindData>(fieldbus_dll::DleState::awaiting_reply)},
      {"deaf_behind_fault", "", "misses what comes behind a faulty frame",
       IsaTable::station<IsaDeafBehindFault>()},
      {"newest_first", "", "sends what was submitted last", IsaTable::station<IsaNewestFirst>()},
      {"least_of_last_token", "", "sends by the priority of the token before",
       IsaTable::station<IsaLeastOfLastToken>()},
      {"duration_of_last_token_too", "", "adds the duration of the token before",
       IsaTable::station<IsaDurationOfLastTokenToo>()},
      {"reply_repeated", "", "replies with what it has replied before", IsaTable::station<ReplyRepeated>()},
      {"missing_reply_costs_the_token", "", "sends nothing more under a token when a reply is missing",
       IsaTable::station<MissingReplyCostsTheToken>()},
  };
  for (IsaRow& row : rows) row.is_for_check = true;
  return rows;
}

std::vector<IsaRow> isa_las_rows() {
  using namespace isa_seeded_faults;
  return {
      {"schedule_late", "", "is two slot times late", IsaTable::station<ScheduleShifted>(2)},
      {"schedule_early", "", "is two slot times early", IsaTable::station<ScheduleShifted>(-2)},
      {"items_skipped", "", "leaves an item out", IsaTable::station<ItemsSkipped>()},
      {"delegates_urgent_only", "", "delegates each token as an urgent one",
       IsaTable::station<DelegatesUrgentOnly>()},
      {"duration_sent_little_endian", "", "sends durations with the low octet first",
       IsaTable::station<DurationSentLittleEndian>()},
      {"waits_out_duration", "", "does not hear the EE of an ES", IsaTable::station<WaitsOutDuration>()},
      {"reclaims_by_uc_only", "", "waits for a silent holder until VC(UC) is over",
       IsaTable::station<ReclaimsByUcOnly>()},
      {"single_token_for_ever", "", "does not supervise an ET", IsaTable::station<SingleTokenForEver>()},
      {"reclaims_early", "ISA-10", "waits V(MRD) octets for a holder, not slot times",
       IsaTable::station<ReclaimsEarly>()},
      {"reclaims_into_holder", "ISA-14", "takes a token back while its holder sends",
       IsaTable::station<ReclaimsIntoHolder>()},
      {"no_supervision", "ISA-13", "has no VC(UC)", IsaTable::station<SupervisesOtherwise>(false)},
      {"supervises_long", "", "takes a token back two slot times late",
       IsaTable::station<SupervisesOtherwise>(true)},
      {"supervises_without_margin", "", "takes a token back when its duration is over",
       IsaTable::with_rules<IsaLas>([](IsaRules& rules) { rules.supervision_margin_octets = 0; })},
      {"end_of_anybody_taken", "ISA-21", "takes the EE of anybody", IsaTable::station<EndOfAnybodyTaken>()},
      {"forgets_reply_wait", "", "does not count with the wait of a holder that compels",
       IsaTable::station<ForgetsReplyWait>()},
      {"ignores_transfer", "", "does not take over", IsaTable::station<IgnoresTransfer>()},
      {"shows_itself_late", "", "takes over and says nothing until its schedule does",
       IsaTable::station<ShowsItselfLate>()},
      {"schedule_not_begun", "", "takes over without running its schedule",
       IsaTable::station<ScheduleNotBegun>()},
      {"never_retakes", "ISA-19", "leaves the link to an heir that is silent",
       IsaTable::station<NeverRetakes>()},
      {"retakes_early", "", "waits V(MRD) octets for its heir, not slot times",
       IsaTable::station<ReclaimsEarly>()},
      {"transfer_without_version", "", "hands over without the version of its schedule",
       IsaTable::station<TransferWithoutVersion>()},
      {"keeps_schedule_behind_transfer", "ISA-18", "goes on with its schedule behind a TL",
       IsaTable::station<KeepsScheduleBehindTransfer>()},
      {"period_doubled", "", "runs each second period of its schedule only",
       IsaTable::station<PeriodDoubled>()},
      {"own_data_kept", "", "does not send what its user submits", IsaTable::station<OwnDataKept>()},
      {"own_data_over_due", "", "sends what its user submits whatever is due",
       IsaTable::station<OwnDataOverDue>()},
      {"takes_transfer_of_others", "", "takes a TL for another", IsaTable::station<TakesTransferOfOthers>()},
      {"deaf_in_standby", "", "uses no token while another is the scheduler",
       IsaTable::station<DeafInStandby>()},
      {"never_yields", "", "stays when a lower address is the scheduler", IsaTable::station<Yields>(false)},
      {"always_yields", "", "leaves to a higher address, too", IsaTable::station<Yields>(true)},
  };
}

std::vector<IsaRow> isa_las_check_rows() {
  using namespace isa_seeded_faults;
  std::vector<IsaRow> rows{
      {"item_skipped_after_two_silent", "", "leaves an item out when two holders in a row were silent",
       IsaTable::station<ItemSkippedAfterTwoSilent>()},
      {"reclaims_early_after_silence", "",
       "waits half of V(RR) for a frame when the holder before was silent",
       IsaTable::station<ReclaimsEarlyAfterSilence>()},
      {"supervises_long_after_kept", "", "takes tokens back late once a holder has kept one",
       IsaTable::station<SupervisesLongAfterKept>()},
      {"second_transfer_ignored", "", "hands over once only", IsaTable::station<SecondTransferIgnored>()},
      {"yields_once", "", "leaves to a lower address once only", IsaTable::station<YieldsOnce>()},
      {"first_item_skipped_after_return", "",
       "begins its schedule with the second item when the link is handed back",
       IsaTable::station<FirstItemSkippedAfterReturn>()},
  };
  for (IsaRow& row : rows) row.is_for_check = true;
  return rows;
}

const IsaTable& isa_table() {
  static const IsaTable table = [] {
    IsaTable::Role dle{"isa_dle", {}};
    for (auto group : {isa_token_rows, isa_duration_rows, isa_reply_rows, isa_frame_rows, isa_check_rows}) {
      for (IsaRow& row : group()) dle.rows.push_back(std::move(row));
    }
    IsaTable::Role las{"isa_las", isa_las_rows()};
    for (IsaRow& row : isa_las_check_rows()) las.rows.push_back(std::move(row));
    return IsaTable{{std::move(dle), std::move(las)}};
  }();
  return table;
}

}  // namespace

std::vector<Mutant> isa_mutants() {
  return isa_table().mutants();
}

std::unique_ptr<IsaDevice> make_isa_mutant(std::string_view role, std::string_view name,
                                           const IsaConfiguration& configuration) {
  return isa_table().make(role, name, configuration);
}

}  // namespace fieldproof::conformance
