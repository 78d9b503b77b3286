#include "conformance/fieldbus_dll/isa_mutants.hpp"

#include <algorithm>

#include "conformance/fieldbus_dll/isa_check_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_frame_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_las_check_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_las_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_reply_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_request_seeded_faults.hpp"
#include "conformance/fieldbus_dll/isa_standby.hpp"
#include "conformance/fieldbus_dll/isa_token_seeded_faults.hpp"
#include "conformance/fieldbus_dll/link_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::IsaDlpdu;
using fieldbus_dll::IsaRules;
using fieldbus_dll::IsaType;

using IsaRow = IsaMutants::Row;

std::vector<IsaRow> isa_token_rows() {
  using namespace isa_seeded_faults;
  return {
      {"no_frame_under_et", "", "returns an ET without sending anything", mutant<NoFrameUnderEt>()},
      {"source_of_scheduler", "", "sends data with the scheduler's address as the source",
       mutant<WritesOtherwise>(IsaType::du, 2U, 0x10)},
      {"end_to_everybody", "", "returns its token to everybody",
       mutant<WritesOtherwise>(IsaType::ee, 1U, 0xFF)},
      {"end_reason_always_done", "", "gives each EE the reason 2",
       mutant<WritesOtherwise>(IsaType::ee, 3U, 2)},
      {"end_sent_twice", "", "returns its token twice", mutant<SaysTwice>(0x60)},
      {"et_sends_all", "ISA-1", "sends all it has under an ET", mutant<EtSendsAll>()},
      {"es_sends_one", "", "sends one frame under an ES", mutant<EsSendsOne>()},
      {"queue_lost_behind_et", "", "forgets what is queued when it returns an ET",
       mutant<LosesQueueAtEnd>(EndReason::single_frame_done)},
      {"queue_lost_without_time", "", "forgets what does not fit",
       mutant<LosesQueueAtEnd>(EndReason::no_time)},
      {"no_end_when_empty", "ISA-7", "keeps a token for which it has nothing", mutant<NoEndWhenEmpty>()},
      {"no_end_of_sequence", "", "does not return an ES", mutant<NoEndOfSequence>()},
      {"answers_behind_rr", "", "begins an octet after V(RR)", mutant<AnswersBehindRr>()},
      {"rests_before_end", "", "waits for longer than V(RR) before its EE", mutant<RestsBeforeEnd>()},
      {"priority_inverted", "ISA-2", "sends what is at most as urgent as the token",
       mutant<PriorityInverted>()},
      {"priority_ignored", "", "does not look at the priority of a token", mutant<PriorityIgnored>()},
      {"fifo_across_priorities", "ISA-3", "sends in the order of submission", mutant<FifoAcrossPriorities>()},
      {"finishes_a_priority", "", "finishes a priority before it looks at another",
       mutant<FinishesAPriority>()},
      {"takes_any_token", "ISA-17", "takes tokens for others", mutant<TakesAnyToken>()},
      {"timers_of_31250", "", "counts its octets at 31.25 kbit/s, whatever the rate",
       mutant<TimersOf31250>()},
  };
}

std::vector<IsaRow> isa_duration_rows() {
  using namespace isa_seeded_faults;
  return {
      {"duration_from_begin_of_es", "ISA-4", "counts the duration from the begin of the ES",
       mutant<DurationFromBeginOfEs>()},
      {"fit_without_end", "ISA-5", "leaves no time for the EE", mutant<FitWithoutEnd>()},
      {"fits_always", "", "sends whatever is left of the duration", mutant<FitsAlways>()},
      {"fit_is_strict", "ISA-6", "leaves what would fit exactly", mutant<FitIsStrict>()},
      {"end_behind_duration", "ISA-8", "returns a token whose duration is over", mutant<EndBehindDuration>()},
      {"duration_ignored", "", "does not look at the duration", mutant<DurationIgnored>()},
      {"duration_little_endian", "ISA-22", "reads the duration with its low octet first",
       mutant<DurationLittleEndian>()},
      {"zero_is_for_ever", "", "takes no duration for an endless one", mutant<ZeroIsForEver>()},
  };
}

std::vector<IsaRow> isa_reply_rows() {
  using namespace isa_seeded_faults;
  return {
      {"rr_runs_through_reply", "ISA-9", "stops VC(RR) at the end of a reply, not at its begin",
       mutant<RrRunsThroughReply>()},
      {"reply_wait_without_slots", "ISA-10", "waits V(MRD) octets for a reply, not slot times",
       with_rules<IsaDle>(
           [](IsaRules& rules) { rules.reply_wait_octets = rules.link.response_delay_slots; })},
      {"reply_wait_a_tenth_longer", "", "waits for a reply a tenth longer than V(RR)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"deaf_and_late", "", "waits a tenth longer, and then sends into whatever is there",
       with_rules<RrRunsThroughReply>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"reply_ends_token", "", "has no token any more after a reply", mutant<LosesTokenByReply>(false)},
      {"missing_reply_ends_token", "", "has no token any more when a reply is missing",
       mutant<LosesTokenByReply>(true)},
      {"answers_while_waiting", "", "answers a CD while it waits for a reply", mutant<AnswersWhileWaiting>()},
      {"replies_late", "ISA-11", "replies after V(FD)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_forming_octets = 60; })},
      {"late_reply_lost", "", "forgets data that came after V(FD)", mutant<LateReplyLost>()},
      {"does_not_wait_for_user", "", "replies without data though its user works on some",
       mutant<DoesNotWaitForUser>()},
      {"short_silence", "ISA-12", "begins V(MID) / 2 after what was on the line",
       with_rules<IsaDle>([](IsaRules& rules) { rules.link.inter_pdu_delay_octets /= 2; })},
      {"reply_not_final", "", "replies without F", mutant<ReplyNotFinal>()},
      {"reply_to_scheduler", "", "replies to the scheduler", mutant<WritesOtherwise>(IsaType::dt, 1U, 0x10)},
      {"replies_twice", "", "replies twice", mutant<SaysTwice>(0x20)},
      {"no_data_no_reply", "", "is silent when it has no data", mutant<NoDataNoReply>()},
      {"reply_ignores_priority", "", "replies with less urgent data", mutant<ReplyIgnoresPriority>()},
      {"urgent_as_long_as_normal", "", "accepts urgent data of 128 octets", mutant<UrgentAsLongAsNormal>()},
      {"one_octet_less", "", "refuses the longest data", mutant<OneOctetLess>()},
      {"codes_of_the_usual_link", "", "knows the usual codes, whatever its link has",
       with_rules<IsaDle>([](IsaRules& rules) { rules.codes = {}; })},
      {"broadcast_not_delivered", "", "does not deliver data for everybody", mutant<BroadcastNotDelivered>()},
      {"broadcast_answered", "", "answers data for everybody", mutant<BroadcastAnswered>()},
      {"tells_other_source", "", "reports another source to its user",
       mutant<TellsOtherwise>(+[](IsaDlpdu& dlpdu) { dlpdu.source ^= 1; })},
      {"tells_normal_priority", "", "reports normal priority to its user, whatever came",
       mutant<TellsOtherwise>(+[](IsaDlpdu& dlpdu) { dlpdu.priority = fieldbus_dll::Priority::normal; })},
      {"others_data_delivered", "", "delivers data for others", mutant<OthersDataDelivered>()},
      {"dt_to_everybody_delivered", "", "delivers a DT to everybody", mutant<DtToEverybodyDelivered>()},
  };
}

std::vector<IsaRow> isa_timers_rows() {
  using namespace isa_seeded_faults;
  return {
      {"silence_of_the_usual_link", "", "keeps the usual V(MID), whatever its link's is",
       with_rules<IsaDle>([](IsaRules& rules) {
         rules.link.inter_pdu_delay_octets = fieldbus_dll::LinkRules{}.inter_pdu_delay_octets;
       })},
      {"forms_within_the_usual_time", "", "replies within the usual V(FD), whatever its link's is",
       with_rules<IsaDle>(
           [](IsaRules& rules) { rules.reply_forming_octets = IsaRules{}.reply_forming_octets; })},
      {"forms_within_eight_bits", "", "looks at eight bits of V(FD)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_forming_octets %= 256; })},
      {"forms_an_octet_less", "", "gives its reply up an octet before V(FD)", mutant<ShiftsTimers>(-16, 0)},
      {"forms_an_octet_longer", "", "replies an octet after V(FD) yet", mutant<ShiftsTimers>(16, 0)},
      {"forms_half_a_bit_longer", "", "replies half a bit after V(FD) yet", mutant<ShiftsTimers>(1, 0)},
      {"waits_the_usual_time", "", "waits for a reply for the usual V(RR), whatever its link's is",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_wait_octets = IsaRules{}.reply_wait_octets; })},
      {"waits_eight_bits", "", "looks at eight bits of V(RR)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_wait_octets %= 256; })},
      {"waits_half_a_bit_less", "", "waits for a reply half a bit less than V(RR)",
       mutant<ShiftsTimers>(0, -1)},
      {"waits_half_a_bit_longer", "", "takes a reply that begins within half a bit after V(RR)",
       mutant<ShiftsTimers>(0, 1)},
      {"no_dlpdu_ends_the_wait", "", "takes what is no DLPDU for data of others",
       mutant<IsaNoDlpduIsTakenForOne>()},
  };
}

std::vector<IsaRow> isa_frame_rows() {
  using namespace isa_seeded_faults;
  return {
      {"short_frames_not_checked", "ISA-15", "does not check frames of five octets",
       mutant<ShortFramesNotChecked>()},
      {"check_from_zero_too", "ISA-16", "takes a check that begins with 0, too", mutant<CheckFromZeroToo>()},
      {"violations_are_bits", "ISA-20", "takes N+ for 1 and N- for 0", mutant<ViolationsAreBits>()},
      {"stuck_behind_violation", "", "receives nothing any more after a code violation",
       mutant<StuckBehindViolation>()},
      {"reserved_bit_ignored", "", "does not look at the reserved bit", mutant<ReservedBitIgnored>()},
      {"priority_zero_taken", "", "takes an ET without priority", mutant<PriorityZeroTaken>()},
      {"length_not_checked", "", "takes an ET of any length", mutant<LengthNotChecked>()},
      {"wants_one_preamble_octet", "", "receives no frame with more than one octet of preamble",
       mutant<WantsOnePreambleOctet>()},
      {"does_not_recover_clock", "", "samples with its own clock",
       mutant<link_seeded_faults::DoesNotRecoverClock<IsaDle>>()},
      {"wants_exact_edges", "", "takes edges that are at most a twentieth of a bit off",
       mutant<link_seeded_faults::WantsExactEdges<IsaDle>>()},
      {"sends_no_preamble", "", "sends no preamble", mutant<SendsNoPreamble>()},
      {"end_delimiter_turned", "", "sends its end delimiter the other way round",
       mutant<EndDelimiterTurned>()},
      {"least_significant_bit_first", "", "sends the least significant bit first",
       mutant<LeastSignificantBitFirst>()},
  };
}

std::vector<IsaRow> isa_request_rows() {
  using namespace isa_seeded_faults;
  using link_seeded_faults::AcceptsPriority;
  return {
      {"unknown_requests_taken", "", "refuses no request that it does not know",
       mutant<link_seeded_faults::UnknownRequestsTaken<IsaDle>>()},
      {"orders_taken", "", "takes the order of a link master, though it is none",
       mutant<link_seeded_faults::OrdersTaken<IsaDle>>()},
      {"unknown_service_is_unit_data", "", "sends a DU for a service that there is not",
       mutant<SubmitsOtherwise>(+[](IsaRequest& request, const IsaRules&) {
         if (request.service > IsaService::reply_data) request.service = IsaService::unit_data;
       })},
      {"priority_zero_accepted", "", "does not refuse data of priority 0",
       mutant<AcceptsPriority<IsaDle, IsaRequest>>(0U)},
      {"priority_four_accepted", "", "does not refuse data of priority 4",
       mutant<AcceptsPriority<IsaDle, IsaRequest>>(4U)},
      {"data_of_cd_left_out", "", "takes a CD with data, and sends it without",
       mutant<SubmitsOtherwise>(+[](IsaRequest& request, const IsaRules&) {
         if (request.service == IsaService::compel) request.data.clear();
       })},
      {"compels_everybody", "", "takes a CD to everybody, and sends it to the first address",
       mutant<SubmitsOtherwise>(+[](IsaRequest& request, const IsaRules& rules) {
         if (request.service == IsaService::compel && request.destination == rules.everybody)
           request.destination = rules.first_address;
       })},
      {"tells_128_octets", "", "reports the first 128 octets of data to its user",
       mutant<TellsOtherwise>(
           +[](IsaDlpdu& dlpdu) { dlpdu.data.resize(std::min<std::size_t>(dlpdu.data.size(), 128)); })},
      {"too_long_is_cut", "", "delivers the first octets of data that are longer than their priority carries",
       mutant<TooLongIsCut>()},
      {"empty_data_left_out", "", "does not deliver data of no octets", mutant<EmptyDataLeftOut>()},
      {"urgent_waits_for_a_token", "", "sends what is urgent and came during a token behind the rest",
       mutant<UrgentWaitsForAToken>()},
      {"waits_for_urgent_data", "", "asks for urgent data, whatever the priority of the CD",
       mutant<WaitsForDataOf>(Priority::urgent)},
      {"waits_for_any_data", "", "asks for time-available data, whatever the priority of the CD",
       mutant<WaitsForDataOf>(Priority::time_available)},
      {"anything_ends_the_wait", "", "replies with less urgent data that come within V(FD)",
       mutant<AnythingEndsTheWait>()},
  };
}

std::vector<IsaRow> isa_setting_rows() {
  using fieldbus_dll::IsaDle;
  return {
      {"lengths_of_the_usual_link", "", "knows the usual longest data, whatever its link's are",
       with_rules<IsaDle>(
           [](IsaRules& rules) { rules.link.most_data = fieldbus_dll::LinkRules{}.most_data; })},
      {"one_length_for_all", "", "takes the greatest of the longest data for that of each priority",
       with_rules<IsaDle>([](IsaRules& rules) {
         rules.link.most_data.fill(*std::ranges::max_element(rules.link.most_data));
       })},
      {"preamble_of_the_usual_link", "", "sends an octet of preamble, whatever its link has",
       with_rules<IsaDle>([](IsaRules& rules) { rules.link.preamble_octets = 1; })},
      {"everybody_of_the_usual_link", "", "knows the usual address of everybody, whatever its link's is",
       with_rules<IsaDle>([](IsaRules& rules) { rules.everybody = IsaRules{}.everybody; })},
      {"first_address_of_the_usual_link", "", "knows the usual first address, whatever its link's is",
       with_rules<IsaDle>([](IsaRules& rules) { rules.first_address = IsaRules{}.first_address; })},
      {"last_address_of_the_usual_link", "", "knows the usual last address, whatever its link's is",
       with_rules<IsaDle>([](IsaRules& rules) { rules.last_address = IsaRules{}.last_address; })},
      {"first_address_is_none", "", "takes the first address for none",
       with_rules<IsaDle>([](IsaRules& rules) { ++rules.first_address; })},
      {"last_address_is_none", "", "takes the last address for none",
       with_rules<IsaDle>([](IsaRules& rules) { --rules.last_address; })},
      {"longest_silence_refused", "", "does not start with a V(MID) of (V(MRD) - 1) x V(ST)",
       mutant<isa_seeded_faults::LongestSilenceRefused>()},
      {"impossible_once_only", "", "refuses a V(MID) that cannot be under its first supply only",
       mutant<isa_seeded_faults::ImpossibleOnceOnly>()},
      {"impossible_rules_taken", "", "starts with a V(MID) that cannot be",
       mutant<link_seeded_faults::ImpossibleRulesTaken<IsaDle>>()},
  };
}

std::vector<IsaRow> isa_reception_rows() {
  using fieldbus_dll::IsaDle;
  using namespace link_seeded_faults;
  return {
      {"deaf_to_long_frames", "", "receives no frame of more than 128 octets",
       mutant<DeafToLongFrames<IsaDle>>()},
      {"bits_counted_on", "", "counts bits on when a start delimiter cuts an octet off",
       mutant<BitsCountedOn<IsaDle>>()},
      {"silence_from_the_delimiter", "", "counts silence from the end delimiter, whatever follows",
       mutant<SilenceFromTheDelimiter<IsaDle>>()},
      {"last_of_a_transmission", "", "takes the last frame of a transmission only",
       mutant<LastOfATransmission<IsaDle>>()},
      {"deaf_behind_71_minutes", "", "receives nothing more after 2^32 microseconds",
       mutant<DeafBehind71Minutes<IsaDle>>()},
      {"levels_are_half_bits", "", "takes each level for half a bit, however fine they are",
       mutant<LevelsAreHalfBits<IsaDle>>()},
  };
}

std::vector<IsaRow> isa_check_rows() {
  using namespace isa_seeded_faults;
  return IsaMutants::for_check({
      {"token_kept_behind_token", "", "uses a token though another station got one meanwhile",
       mutant<TokenKeptBehindToken>()},
      {"reply_kept_behind_token", "", "replies though another station got a token meanwhile",
       mutant<ReplyKeptBehindToken>()},
      {"reply_kept_behind_data", "", "replies though another station sent data meanwhile",
       mutant<GoesOnBehindData>(fieldbus_dll::DleState::replying)},
      {"waits_on_behind_data", "", "waits for its reply though another station sent data meanwhile",
       mutant<GoesOnBehindData>(fieldbus_dll::DleState::awaiting_reply)},
      {"deaf_behind_fault", "", "misses what comes after a faulty frame", mutant<IsaDeafBehindFault>()},
      {"newest_first", "", "sends what was submitted last", mutant<IsaNewestFirst>()},
      {"least_of_last_token", "", "sends by the priority of the token before", mutant<IsaLeastOfLastToken>()},
      {"duration_of_last_token_too", "", "adds the duration of the token before",
       mutant<IsaDurationOfLastTokenToo>()},
      {"reply_repeated", "", "replies with what it has replied before", mutant<ReplyRepeated>()},
      {"missing_reply_costs_the_token", "", "sends nothing more under a token when a reply is missing",
       mutant<MissingReplyCostsTheToken>()},
  });
}

std::vector<IsaRow> isa_las_rows() {
  using namespace isa_seeded_faults;
  return {
      {"schedule_late", "", "is two slot times late", mutant<ScheduleShifted>(2)},
      {"schedule_early", "", "is two slot times early", mutant<ScheduleShifted>(-2)},
      {"items_skipped", "", "leaves an item out", mutant<ItemsSkipped>()},
      {"delegates_urgent_only", "", "delegates each token as an urgent one", mutant<DelegatesUrgentOnly>()},
      {"duration_sent_little_endian", "", "sends durations with the low octet first",
       mutant<DurationSentLittleEndian>()},
      {"waits_out_duration", "", "does not receive the EE of an ES", mutant<WaitsOutDuration>()},
      {"reclaims_by_uc_only", "", "waits for a silent holder until VC(UC) is over",
       mutant<ReclaimsByUcOnly>()},
      {"single_token_for_ever", "", "does not supervise an ET", mutant<SingleTokenForEver>()},
      {"reclaims_early", "ISA-10", "waits V(MRD) octets for a holder, not slot times",
       mutant<ReclaimsEarly>()},
      {"reclaims_into_holder", "ISA-14", "takes a token back while its holder sends",
       mutant<ReclaimsIntoHolder>()},
      {"no_supervision", "ISA-13", "has no VC(UC)", mutant<SupervisesOtherwise>(false)},
      {"supervises_long", "", "takes a token back two slot times late", mutant<SupervisesOtherwise>(true)},
      {"supervises_without_margin", "", "takes a token back when its duration is over",
       with_rules<IsaLas>([](IsaRules& rules) { rules.supervision_margin_octets = 0; })},
      {"end_of_anybody_taken", "ISA-21", "takes the EE of anybody", mutant<EndOfAnybodyTaken>()},
      {"forgets_reply_wait", "", "does not count with the wait of a holder that compels",
       mutant<ForgetsReplyWait>()},
      {"ignores_transfer", "", "does not take over", mutant<IgnoresTransfer>()},
      {"shows_itself_as_nothing", "", "takes over with a DU of priority 0", mutant<ShowsItselfAsNothing>()},
      {"shows_itself_late", "", "takes over and says nothing until its schedule does",
       mutant<ShowsItselfLate>()},
      {"schedule_not_begun", "", "takes over without running its schedule", mutant<ScheduleNotBegun>()},
      {"never_retakes", "ISA-19", "leaves the link to an heir that is silent", mutant<NeverRetakes>()},
      {"retakes_early", "", "waits V(MRD) octets for its heir, not slot times", mutant<ReclaimsEarly>()},
      {"transfer_without_version", "", "hands over without the version of its schedule",
       mutant<TransferWithoutVersion>()},
      {"keeps_schedule_behind_transfer", "ISA-18", "goes on with its schedule after a TL",
       mutant<KeepsScheduleBehindTransfer>()},
      {"period_doubled", "", "runs each second period of its schedule only", mutant<PeriodDoubled>()},
      {"own_data_kept", "", "does not send what its user submits", mutant<OwnDataKept>()},
      {"own_data_over_due", "", "sends what its user submits whatever is due", mutant<OwnDataOverDue>()},
      {"takes_transfer_of_others", "", "takes a TL for another", mutant<TakesTransferOfOthers>()},
      {"deaf_in_standby", "", "uses no token while another is the scheduler", mutant<DeafInStandby>()},
      {"never_yields", "", "stays when a lower address is the scheduler", mutant<Yields>(false)},
      {"always_yields", "", "leaves to a higher address, too", mutant<Yields>(true)},
      {"each_event_once", "", "reports each kind of event once", mutant<IsaEachEventOnce>()},
      {"reclaimed_is_overrun", "", "reports an overrun where a holder was silent", mutant<OverrunTold>()},
      {"order_refused_in_standby", "", "refuses an order while another is the scheduler",
       mutant<OrderRefusedInStandby>()},
      {"first_order_stays", "", "hands over to the first of two that were ordered",
       mutant<FirstOrderStays>()},
      {"own_data_without_return", "", "sends what ends before an item, without the time of a return",
       mutant<OwnDataWithoutReturn>()},
      {"transfer_ignored_by_scheduler", "",
       "does not begin its schedule anew by a TL while it is the scheduler",
       mutant<TransferIgnoredByScheduler>()},
      {"scheduler_never_replies", "", "answers no CD while it is the scheduler",
       mutant<SchedulerNeverReplies>()},
      {"sign_of_life_of_anybody", "", "takes whatever comes after its TL for the sign of life of its heir",
       mutant<SignOfLifeOfAnybody>()},
      {"end_with_a_reason_ignored", "", "takes no EE with another reason than 0",
       mutant<EndWithAReasonIgnored>()},
      {"signed_addresses", "", "takes addresses above 7F for lower ones", mutant<SignedAddresses>()},
      {"one_octet_of_preamble", "", "sends an octet of preamble, whatever its link has",
       with_rules<IsaLas>([](IsaRules& rules) { rules.link.preamble_octets = 1; })},
      {"standby_after_supply", "", "is in standby after each supply but the first",
       mutant<StandbyAfterSupply>()},
      {"sixteen_items", "", "has room for 16 items",
       mutant<OtherSchedule>(+[](fieldbus_dll::IsaSchedule& schedule) {
         schedule.items.resize(std::min<std::size_t>(schedule.items.size(), 16));
       })},
      {"period_of_32_bits", "", "counts its period in 32 bits of nanoseconds",
       mutant<OtherSchedule>(+[](fieldbus_dll::IsaSchedule& schedule) {
         schedule.period %= 0x1'0000'0000 * kernel::kNanosecond;
       })},
      {"scheduler_for_reply_untold", "", "does not report that another scheduler came in place of a reply",
       mutant<SchedulerForReplyUntold>()},
      {"items_in_32_bits", "", "keeps the instants of its items in 32 bits of nanoseconds",
       mutant<ItemsIn32Bits>()},
      {"duration_of_15_bits", "", "sends the lower 15 bits of the duration of a token",
       mutant<DurationOf15Bits>()},
      {"clock_of_32_bits", "", "runs no schedule after 2^32 microseconds", mutant<ClockOf32Bits>()},
      {"no_data_after_its_schedule", "", "sends nothing of its user's when its schedule is over",
       mutant<NothingAfterItsSchedule>(true)},
      {"no_schedule_after_its_schedule", "", "takes no TL when its schedule is over",
       mutant<NothingAfterItsSchedule>(false)},
      {"sign_of_life_first", "", "shows itself before what is due", mutant<SignOfLifeFirst>()},
  };
}

std::vector<IsaRow> isa_las_check_rows() {
  using namespace isa_seeded_faults;
  return IsaMutants::for_check({
      {"item_skipped_after_two_silent", "", "leaves an item out when two holders in a row were silent",
       mutant<ItemSkippedAfterTwoSilent>()},
      {"reclaims_early_after_silence", "",
       "waits half of V(RR) for a frame when the holder before was silent",
       mutant<ReclaimsEarlyAfterSilence>()},
      {"supervises_long_after_kept", "", "takes tokens back late once a holder has kept one",
       mutant<SupervisesLongAfterKept>()},
      {"second_transfer_ignored", "", "hands over once only", mutant<SecondTransferIgnored>()},
      {"yields_once", "", "leaves to a lower address once only", mutant<YieldsOnce>()},
      {"first_item_skipped_after_return", "",
       "begins its schedule with the second item when the link is handed back",
       mutant<FirstItemSkippedAfterReturn>()},
  });
}

}  // namespace

const IsaMutants& isa_dle_mutants() {
  static const IsaMutants table(
      "isa_dle", {isa_token_rows, isa_duration_rows, isa_reply_rows, isa_timers_rows, isa_frame_rows,
                  isa_check_rows, isa_request_rows, isa_setting_rows, isa_reception_rows});
  return table;
}

namespace {

std::vector<IsaMutants::Row> isa_standby_rows() {
  return mutants_in_standby(isa_dle_mutants(), isa_cases(), isa_standby_sequence_role());
}

}  // namespace

const IsaMutants& isa_las_mutants() {
  static const IsaMutants table("isa_las", {isa_las_rows, isa_las_check_rows, isa_standby_rows});
  return table;
}

}  // namespace fieldproof::conformance
