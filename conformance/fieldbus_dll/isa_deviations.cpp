#include "conformance/fieldbus_dll/isa_deviations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string>

#include "conformance/fieldbus_dll/isa_frame_deviants.hpp"
#include "conformance/fieldbus_dll/isa_las_deviants.hpp"
#include "conformance/fieldbus_dll/isa_reply_deviants.hpp"
#include "conformance/fieldbus_dll/isa_token_deviants.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaDevice;
using fieldbus_dll::IsaRules;
using fieldbus_dll::IsaType;

using MakeStation = std::function<std::unique_ptr<IsaDevice>(const IsaConfiguration&)>;

template <typename Deviant, typename... More>
MakeStation station(More... more) {
  return [=](const IsaConfiguration& configuration) {
    return std::make_unique<Deviant>(configuration, more...);
  };
}

// Under rules with one number changed.
template <typename Station, typename Change>
MakeStation with_rules(Change change) {
  return [change](const IsaConfiguration& configuration) {
    IsaConfiguration changed = configuration;
    change(changed.rules);
    return std::make_unique<Station>(changed);
  };
}

struct IsaRow {
  std::string_view name;
  std::string_view mutant;
  std::string_view description;
  MakeStation make;
};

std::vector<IsaRow> token_rows() {
  using namespace isa_deviants;
  return {
      {"no_frame_under_et", "", "returns an ET without sending anything", station<NoFrameUnderEt>()},
      {"source_of_scheduler", "", "sends data with the scheduler's address as the source",
       station<WritesOtherwise>(IsaType::du, 2U, 0x10)},
      {"end_to_everybody", "", "returns its token to everybody",
       station<WritesOtherwise>(IsaType::ee, 1U, 0xFF)},
      {"end_reason_always_done", "", "gives each EE the reason 2",
       station<WritesOtherwise>(IsaType::ee, 3U, 2)},
      {"end_sent_twice", "", "returns its token twice", station<SaysTwice>(0x60)},
      {"et_sends_all", "ISA-1", "sends all it has under an ET", station<EtSendsAll>()},
      {"es_sends_one", "", "sends one frame under an ES", station<EsSendsOne>()},
      {"queue_lost_behind_et", "", "forgets what is queued when it returns an ET",
       station<LosesQueueAtEnd>(EndReason::single_frame_done)},
      {"queue_lost_without_time", "", "forgets what does not fit",
       station<LosesQueueAtEnd>(EndReason::no_time)},
      {"no_end_when_empty", "ISA-7", "keeps a token for which it has nothing", station<NoEndWhenEmpty>()},
      {"no_end_of_sequence", "", "does not return an ES", station<NoEndOfSequence>()},
      {"answers_behind_rr", "", "begins an octet behind V(RR)", station<AnswersBehindRr>()},
      {"rests_before_end", "", "waits for longer than V(RR) before its EE", station<RestsBeforeEnd>()},
      {"priority_inverted", "ISA-2", "sends what is at most as urgent as the token",
       station<PriorityInverted>()},
      {"priority_ignored", "", "does not look at the priority of a token", station<PriorityIgnored>()},
      {"fifo_across_priorities", "ISA-3", "sends in the order of submission",
       station<FifoAcrossPriorities>()},
      {"finishes_a_priority", "", "finishes a priority before it looks at another",
       station<FinishesAPriority>()},
      {"takes_any_token", "ISA-17", "takes tokens for others", station<TakesAnyToken>()},
      {"timers_of_31250", "", "counts its octets at 31.25 kbit/s, whatever the rate",
       station<TimersOf31250>()},
  };
}

std::vector<IsaRow> duration_rows() {
  using namespace isa_deviants;
  return {
      {"duration_from_begin_of_es", "ISA-4", "counts the duration from the begin of the ES",
       station<DurationFromBeginOfEs>()},
      {"fit_without_end", "ISA-5", "leaves no time for the EE", station<FitWithoutEnd>()},
      {"fits_always", "", "sends whatever is left of the duration", station<FitsAlways>()},
      {"fit_is_strict", "ISA-6", "leaves what would fit exactly", station<FitIsStrict>()},
      {"end_behind_duration", "ISA-8", "returns a token whose duration is over",
       station<EndBehindDuration>()},
      {"duration_ignored", "", "does not look at the duration", station<DurationIgnored>()},
      {"duration_little_endian", "ISA-22", "reads the duration with its low octet first",
       station<DurationLittleEndian>()},
      {"zero_is_for_ever", "", "takes no duration for an endless one", station<ZeroIsForEver>()},
  };
}

std::vector<IsaRow> reply_rows() {
  using namespace isa_deviants;
  return {
      {"rr_runs_through_reply", "ISA-9", "stops VC(RR) at the end of a reply, not at its begin",
       station<RrRunsThroughReply>()},
      {"reply_wait_without_slots", "ISA-10", "waits V(MRD) octets for a reply, not slot times",
       with_rules<IsaDle>(
           [](IsaRules& rules) { rules.reply_wait_octets = rules.link.response_delay_slots; })},
      {"reply_wait_a_tenth_longer", "", "waits for a reply a tenth longer than V(RR)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"deaf_and_late", "", "waits a tenth longer, and then talks into whatever is there",
       with_rules<RrRunsThroughReply>([](IsaRules& rules) { rules.reply_wait_octets += 3; })},
      {"reply_ends_token", "", "has no token any more behind a reply", station<LosesTokenByReply>(false)},
      {"missing_reply_ends_token", "", "has no token any more when a reply is missing",
       station<LosesTokenByReply>(true)},
      {"answers_while_waiting", "", "answers a CD while it waits for a reply",
       station<AnswersWhileWaiting>()},
      {"replies_late", "ISA-11", "replies behind V(FD)",
       with_rules<IsaDle>([](IsaRules& rules) { rules.reply_forming_octets = 60; })},
      {"late_reply_lost", "", "forgets data that came behind V(FD)", station<LateReplyLost>()},
      {"does_not_wait_for_user", "", "replies without data though its user works on some",
       station<DoesNotWaitForUser>()},
      {"short_silence", "ISA-12", "begins V(MID) / 2 behind what was on the line",
       with_rules<IsaDle>([](IsaRules& rules) { rules.link.inter_pdu_delay_octets /= 2; })},
      {"reply_not_final", "", "replies without F", station<ReplyNotFinal>()},
      {"reply_to_scheduler", "", "replies to the scheduler", station<WritesOtherwise>(IsaType::dt, 1U, 0x10)},
      {"replies_twice", "", "replies twice", station<SaysTwice>(0x20)},
      {"no_data_no_reply", "", "is silent when it has no data", station<NoDataNoReply>()},
      {"reply_ignores_priority", "", "replies with less urgent data", station<ReplyIgnoresPriority>()},
      {"urgent_as_long_as_normal", "", "accepts urgent data of 128 octets", station<UrgentAsLongAsNormal>()},
      {"one_octet_less", "", "refuses the longest data", station<OneOctetLess>()},
      {"broadcast_not_delivered", "", "does not deliver data for everybody",
       station<BroadcastNotDelivered>()},
      {"broadcast_answered", "", "answers data for everybody", station<BroadcastAnswered>()},
      {"others_data_delivered", "", "delivers data for others", station<OthersDataDelivered>()},
      {"dt_to_everybody_delivered", "", "delivers a DT to everybody", station<DtToEverybodyDelivered>()},
  };
}

std::vector<IsaRow> frame_rows() {
  using namespace isa_deviants;
  return {
      {"short_frames_not_checked", "ISA-15", "does not check frames of five octets",
       station<ShortFramesNotChecked>()},
      {"check_from_zero_too", "ISA-16", "takes a check that begins with 0, too", station<CheckFromZeroToo>()},
      {"violations_are_bits", "ISA-20", "takes N+ for 1 and N- for 0", station<ViolationsAreBits>()},
      {"stuck_behind_violation", "", "hears nothing any more behind a code violation",
       station<StuckBehindViolation>()},
      {"reserved_bit_ignored", "", "does not look at the reserved bit", station<ReservedBitIgnored>()},
      {"priority_zero_taken", "", "takes an ET without priority", station<PriorityZeroTaken>()},
      {"length_not_checked", "", "takes an ET of any length", station<LengthNotChecked>()},
      {"wants_one_preamble_octet", "", "hears no frame with more than one octet of preamble",
       station<WantsOnePreambleOctet>()},
      {"does_not_recover_clock", "", "samples with its own clock", station<DoesNotRecoverClock>()},
      {"wants_exact_edges", "", "takes edges that are at most a twentieth of a bit off",
       station<WantsExactEdges>()},
      {"sends_no_preamble", "", "sends no preamble", station<SendsNoPreamble>()},
      {"end_delimiter_turned", "", "sends its end delimiter the other way round",
       station<EndDelimiterTurned>()},
      {"least_significant_bit_first", "", "sends the least significant bit first",
       station<LeastSignificantBitFirst>()},
  };
}

std::vector<IsaRow> las_rows() {
  using namespace isa_deviants;
  return {
      {"schedule_late", "", "is two slot times late", station<ScheduleShifted>(2)},
      {"schedule_early", "", "is two slot times early", station<ScheduleShifted>(-2)},
      {"items_skipped", "", "leaves an item out", station<ItemsSkipped>()},
      {"delegates_urgent_only", "", "delegates each token as an urgent one", station<DelegatesUrgentOnly>()},
      {"duration_sent_little_endian", "", "sends durations with the low octet first",
       station<DurationSentLittleEndian>()},
      {"waits_out_duration", "", "does not hear the EE of an ES", station<WaitsOutDuration>()},
      {"reclaims_by_uc_only", "", "waits for a silent holder until VC(UC) is over",
       station<ReclaimsByUcOnly>()},
      {"single_token_for_ever", "", "does not supervise an ET", station<SingleTokenForEver>()},
      {"reclaims_early", "ISA-10", "waits V(MRD) octets for a holder, not slot times",
       station<ReclaimsEarly>()},
      {"reclaims_into_holder", "ISA-14", "takes a token back while its holder sends",
       station<ReclaimsIntoHolder>()},
      {"no_supervision", "ISA-13", "has no VC(UC)", station<SupervisesOtherwise>(false)},
      {"supervises_long", "", "takes a token back two slot times late", station<SupervisesOtherwise>(true)},
      {"supervises_without_margin", "", "takes a token back when its duration is over",
       with_rules<IsaLas>([](IsaRules& rules) { rules.supervision_margin_octets = 0; })},
      {"end_of_anybody_taken", "ISA-21", "takes the EE of anybody", station<EndOfAnybodyTaken>()},
      {"forgets_reply_wait", "", "does not count with the wait of a holder that compels",
       station<ForgetsReplyWait>()},
      {"ignores_transfer", "", "does not take over", station<IgnoresTransfer>()},
      {"shows_itself_late", "", "takes over and says nothing until its schedule does",
       station<ShowsItselfLate>()},
      {"schedule_not_begun", "", "takes over without running its schedule", station<ScheduleNotBegun>()},
      {"never_retakes", "ISA-19", "leaves the link to an heir that is silent", station<NeverRetakes>()},
      {"retakes_early", "", "waits V(MRD) octets for its heir, not slot times", station<ReclaimsEarly>()},
      {"transfer_without_version", "", "hands over without the version of its schedule",
       station<TransferWithoutVersion>()},
      {"keeps_schedule_behind_transfer", "ISA-18", "goes on with its schedule behind a TL",
       station<KeepsScheduleBehindTransfer>()},
      {"never_yields", "", "stays when a lower address is the scheduler", station<Yields>(false)},
      {"always_yields", "", "leaves to a higher address, too", station<Yields>(true)},
  };
}

struct Table {
  std::string_view role;
  std::vector<IsaRow> rows;
};

const std::vector<Table>& tables() {
  static const std::vector<Table> all = [] {
    Table dle{"isa_dle", {}};
    for (auto group : {token_rows, duration_rows, reply_rows, frame_rows}) {
      for (IsaRow& row : group()) dle.rows.push_back(std::move(row));
    }
    return std::vector<Table>{std::move(dle), {"isa_las", las_rows()}};
  }();
  return all;
}

}  // namespace

const std::vector<Deviation>& isa_deviations() {
  static const std::vector<Deviation> deviations = [] {
    std::vector<Deviation> all;
    for (const Table& table : tables()) {
      for (const IsaRow& row : table.rows) {
        all.push_back({std::string(row.name), std::string(row.mutant), std::string(table.role),
                       std::string(row.description)});
      }
    }
    return all;
  }();
  return deviations;
}

std::unique_ptr<IsaDevice> make_isa_deviation(std::string_view role, std::string_view name,
                                              const IsaConfiguration& configuration) {
  std::vector<std::string_view> names;
  for (const Table& table : tables()) {
    if (table.role != role) continue;
    for (const IsaRow& row : table.rows) {
      if (row.name == name) return row.make(configuration);
      names.push_back(row.name);
    }
  }
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no deviating {} \"{}\"; near are {}", role, name,
                                  fmt::join(config::nearest(name, names, 3), ", ")));
}

}  // namespace fieldproof::conformance
