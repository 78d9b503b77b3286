#include "conformance/fieldbus_dll/ff_mutants.hpp"

#include "conformance/fieldbus_dll/ff_device_frame_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_device_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_device_token_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_ending_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_las_live_list_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_las_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_las_standby_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_request_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_sequence_seeded_faults.hpp"
#include "conformance/fieldbus_dll/ff_standby.hpp"
#include "conformance/fieldbus_dll/ff_transmission_seeded_faults.hpp"
#include "conformance/fieldbus_dll/link_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfDlpdu;
using fieldbus_dll::FfLas;
using fieldbus_dll::FfRules;
using fieldbus_dll::FfStation;
using fieldbus_dll::FfType;
using fieldbus_dll::FfUser;
using FfRow = FfMutants::Row;

std::vector<FfRow> ff_token_rows() {
  using namespace ff_seeded_faults;
  return {
      {"no_probe_response", "", "does not answer probes", mutant<NoProbeResponse>()},
      {"mute_after_activation", "", "drives the answer to its first probe and nothing more",
       mutant<MuteAfter>(1U)},
      {"answers_late", "", "begins an octet after V(MRD) x V(ST)", mutant<AnswersLate>()},
      {"answers_for_all_nodes", "", "takes everything for its own", mutant<AnswersForAllNodes>()},
      {"live_from_the_start", "", "uses tokens without having been activated", mutant<LiveFromTheStart>()},
      {"impossible_rules_taken", "", "starts with a V(MID) that cannot be",
       mutant<link_seeded_faults::ImpossibleRulesTaken<FfStation>>()},
      {"priority_inverted", "", "sends what is at most as urgent as the token", mutant<FfPriorityInverted>()},
      {"priority_ignored", "", "does not look at the priority of a token", mutant<FfPriorityIgnored>()},
      {"fifo_across_priorities", "", "sends in the order of submission", mutant<FfFifoAcrossPriorities>()},
      {"one_frame_a_token", "", "sends one frame under a token", mutant<OneFrameAToken>()},
      {"no_return_when_empty", "", "keeps a token for which it has nothing", mutant<NoReturnWhenEmpty>()},
      {"marked_token_unknown", "", "does not know a PT that begins a circulation",
       mutant<MarkedTokenUnknown>()},
      {"sends_to_another", "", "sends to another node than its user says",
       mutant<SendsOtherAddress>(&FfDlpdu::destination)},
      {"sends_as_another", "", "sends with the source of another node",
       mutant<SendsOtherAddress>(&FfDlpdu::source)},
      {"answers_cd_offline", "", "answers a CD without having been activated", mutant<AnswersCdOffline>()},
      {"activated_by_anything", "", "takes whatever an entity sends it for its activation",
       mutant<ActivatedByAnything>()},
      {"activated_by_broadcast", "", "takes an activation of everybody for its own",
       mutant<ActivatedByBroadcast>()},
      {"activated_by_its_users_data", "", "takes data for its user for its activation",
       mutant<ActivatedByItsUsersData>()},
      {"silence_of_the_usual_link", "", "keeps the usual V(MID), whatever its link's is",
       mutant<SilenceOfTheUsualLink>()},
      {"answers_in_the_usual_time", "", "answers within the usual V(MRD) x V(ST), whatever its link's is",
       mutant<AnswersInTheUsualTime>()},
      {"returns_twice", "FF-7", "returns a token by F and by RT", mutant<ReturnsTwice>()},
      {"never_final", "", "sends its last frame without F", mutant<NeverFinal>()},
      {"queue_lost_with_token", "", "forgets what did not fit", mutant<QueueLostWithToken>()},
      {"duration_in_bits", "FF-5", "counts the duration in bits", mutant<DurationTimes>(1)},
      {"duration_in_two_octets", "", "counts the duration in pairs of octets", mutant<DurationTimes>(16)},
      {"duration_of_12_bits", "", "does not look at the upper four bits of the duration",
       mutant<DurationReadAs>(+[](std::uint16_t read) { return static_cast<std::int64_t>(read & 0x0FFFU); })},
      {"duration_with_sign", "", "takes the highest bit of the duration for its sign",
       mutant<DurationReadAs>(
           +[](std::uint16_t read) { return std::int64_t{static_cast<std::int16_t>(read)}; })},
      {"duration_ignored", "", "does not look at the duration", mutant<FfDurationIgnored>()},
      {"duration_from_begin_of_pt", "", "counts the duration from the begin of the PT",
       mutant<DurationFromBeginOfPt>()},
      {"fit_is_strict", "", "leaves what would fit exactly", mutant<FfFitIsStrict>()},
      {"overhead_not_charged", "FF-6", "leaves preamble and delimiters out of what must fit",
       mutant<OverheadNotCharged>()},
      {"urgent_as_long_as_normal", "FF-19", "accepts urgent data of 128 octets",
       mutant<FfUrgentAsLongAsNormal>()},
  };
}

std::vector<FfRow> ff_times_rows() {
  using namespace ff_seeded_faults;
  using fieldbus_dll::LinkRules;
  using fieldbus_dll::response_delay;
  return {
      {"silence_of_six_bits", "", "looks at six bits of V(MID)",
       with_rules<FfStation>([](FfRules& rules) { rules.link.inter_pdu_delay_octets %= 64; })},
      {"slot_of_eight_bits", "", "looks at eight bits of V(ST)",
       mutant<AnswersUntil>(+[](const LinkRules& link) {
         return octets(link, std::int64_t{link.response_delay_slots} * (link.slot_time_octets & 0xFF));
       })},
      {"waits_four_slots", "", "waits four V(ST) for the line, whatever its link has",
       mutant<AnswersUntil>(
           +[](const LinkRules& link) { return octets(link, 4 * std::int64_t{link.slot_time_octets}); })},
      {"waits_a_slot_longer", "", "waits a V(ST) longer for the line",
       mutant<AnswersUntil>(+[](const LinkRules& link) {
         return response_delay(link) + octets(link, link.slot_time_octets);
       })},
      {"gives_up_a_slot_early", "", "waits a V(ST) less for the line",
       mutant<AnswersUntil>(+[](const LinkRules& link) {
         return response_delay(link) - octets(link, link.slot_time_octets);
       })},
      {"waits_half_a_bit_longer", "", "begins half a bit after V(MRD) x V(ST) yet",
       mutant<AnswersUntil>(
           +[](const LinkRules& link) { return response_delay(link) + octets(link, 1) / 16; })},
      {"gives_up_half_a_bit_early", "", "begins half a bit before V(MRD) x V(ST) at the latest",
       mutant<AnswersUntil>(
           +[](const LinkRules& link) { return response_delay(link) - octets(link, 1) / 16; })},
      {"waits_for_ever", "", "answers however long the line is busy",
       mutant<AnswersUntil>(+[](const LinkRules&) { return 3600 * kernel::kSecond; })},
      {"no_dlpdu_ends_the_wait", "", "takes what is no DLPDU for one of a scheduler",
       mutant<NoDlpduIsTakenForOne>()},
      {"claims_end_nothing", "", "leaves claims of the link", mutant<TakesTypeFor>(FfType::cl, std::nullopt)},
      {"returns_end_tokens", "", "takes a RT of others for the end of its token",
       mutant<TakesTypeFor>(FfType::rt, FfType::pn)},
      {"idle_ends_nothing", "", "answers though an IDLE came before",
       mutant<TakesTypeFor>(FfType::idle, std::nullopt)},
      {"time_by_the_usual_code", "", "knows TD by its usual code, whatever its link has",
       with_rules<FfStation>([](FfRules& rules) { rules.codes.td = fieldbus_dll::FfCodes{}.td; })},
      {"half_a_bit_into_what_follows", "", "sends what ends half a bit after its token",
       mutant<HalfABitIntoWhatFollows>()},
      {"returns_whatever_is_left", "", "sends RT though it does not fit", mutant<ReturnsWhateverIsLeft>()},
      {"queue_of_128", "", "forgets what is submitted while 128 data of its priority wait",
       mutant<QueueOf128>()},
      {"takes_256", "", "receives 256 frames and no more", mutant<Takes256>()},
      {"forgets_in_silence", "", "is off behind ten seconds of silence", mutant<ForgetsInSilence>()},
      {"wrong_check_ends_the_wait", "", "takes what has a wrong check for a DLPDU of a scheduler",
       mutant<WrongCheckIsTakenForOne>()},
  };
}

std::vector<FfRow> ff_publisher_rows() {
  using namespace ff_seeded_faults;
  return {
      {"publishes_first_write", "", "publishes what was written first", mutant<PublishesFirstWrite>()},
      {"published_not_final", "", "keeps the token after a DT3", mutant<PublishedNotFinal>()},
      {"buffer_torn", "FF-21", "publishes half of an old buffer", mutant<BufferTorn>()},
      {"counts_reads", "", "counts CDs as writes", mutant<CountsReads>()},
      {"counts_to_255", "", "does not begin anew after 255 writes", mutant<CountsTo255>()},
      {"counts_nothing", "", "does not count writes", mutant<CountsNothing>()},
      {"publishes_anything", "", "answers a CD for any of its addresses with its buffer",
       mutant<PublishesAnything>()},
      {"subscribed_to_all", "", "delivers what everybody publishes", mutant<SubscribedTo>(true)},
      {"subscribed_without_link", "", "does not look at the link in the address of a publisher",
       mutant<SubscribedWithoutLink>()},
      {"subscribed_to_none", "", "delivers nothing of a publisher", mutant<SubscribedTo>(false)},
  };
}

std::vector<FfRow> ff_frame_rows() {
  using namespace ff_seeded_faults;
  using Octet = std::uint8_t;
  return {
      {"takes_other_residue", "FF-18", "takes a check that is not complemented, too",
       mutant<TakesOtherResidue>()},
      {"check_of_high_octet", "", "looks at one octet of the check", mutant<CheckOfHighOctet>()},
      {"long_read_as_short", "FF-24", "reads long addresses as short ones",
       mutant<ReadsControlAs>(+[](Octet octet) { return static_cast<Octet>(octet & 0xF7); })},
      {"priority_zero_taken", "", "takes a PT without priority",
       mutant<ReadsControlAs>(+[](Octet octet) { return octet == 0x30 ? Octet{0x31} : octet; })},
      {"es_is_pt", "", "takes an ES for a PT", mutant<ReadsControlAs>(+[](Octet octet) {
         return (octet & 0xF8) == 0x38 ? static_cast<Octet>(octet & 0xF7) : octet;
       })},
      {"check_of_tokens_only", "", "looks at the check of PTs only", mutant<CheckOfTokensOnly>()},
      {"takes_violated_frames", "", "takes frames with code violations, whatever their check",
       mutant<TakesViolatedFrames>()},
      {"stuck_behind_violation", "", "receives nothing any more after a code violation",
       mutant<FfStuckBehindViolation>()},
      {"tells_other_source", "", "reports another source to its user",
       mutant<TellsOtherwise>(+[](FfUser& user, FfDlpdu dlpdu, kernel::Time when) {
         dlpdu.source ^= 0x0100;
         tell_user(user, dlpdu, when);
       })},
      {"tells_normal_priority", "", "reports normal priority to its user, whatever came",
       mutant<TellsOtherwise>(+[](FfUser& user, FfDlpdu dlpdu, kernel::Time when) {
         dlpdu.priority = fieldbus_dll::Priority::normal;
         tell_user(user, dlpdu, when);
       })},
      {"tells_no_writes", "", "reports no number of writes of a DT3 to its user",
       mutant<TellsOtherwise>(+[](FfUser& user, FfDlpdu dlpdu, kernel::Time when) {
         dlpdu.writes = 0;
         tell_user(user, dlpdu, when);
       })},
      {"tells_twice", "", "reports everything to its user twice",
       mutant<TellsOtherwise>(+[](FfUser& user, FfDlpdu dlpdu, kernel::Time when) {
         tell_user(user, dlpdu, when);
         tell_user(user, dlpdu, when);
       })},
      {"deaf_to_broadcasts", "", "does not report to its user what is for everybody",
       mutant<TellsOtherwise>(+[](FfUser& user, FfDlpdu dlpdu, kernel::Time when) {
         if (dlpdu.destination != fieldbus_dll::kEverybody) tell_user(user, dlpdu, when);
       })},
      {"tells_live_lists", "", "reports to its user what data link entities send each other",
       mutant<TellsLiveLists>()},
      {"tail_ignored", "", "takes a DLPDU with an octet after it", mutant<TailIgnored>()},
      {"two_octets_of_preamble", "", "sends two octets of preamble",
       with_rules<FfStation>([](FfRules& rules) { rules.link.preamble_octets = 2; })},
      {"preamble_of_the_usual_link", "", "sends one octet of preamble, whatever its link has",
       with_rules<FfStation>([](FfRules& rules) { rules.link.preamble_octets = 1; })},
      {"codes_of_the_usual_link", "", "knows the usual codes, whatever its link has",
       with_rules<FfStation>([](FfRules& rules) { rules.codes = {}; })},
      {"deaf_to_long_frames", "", "does not receive frames of more than 128 octets",
       mutant<link_seeded_faults::DeafToLongFrames<FfStation>>()},
      {"short_silence", "", "begins V(MID) / 2 after what was on the line",
       with_rules<FfStation>([](FfRules& rules) { rules.link.inter_pdu_delay_octets /= 2; })},
      {"no_silence_behind_own", "", "begins an octet after its own frames", mutant<NoSilenceBehindOwn>()},
  };
}

std::vector<FfRow> ff_request_rows() {
  using namespace ff_seeded_faults;
  return {
      {"unknown_requests_taken", "", "refuses no request that it does not know",
       mutant<link_seeded_faults::UnknownRequestsTaken<FfStation>>()},
      {"orders_taken", "", "takes the order of a link master, though it is none",
       mutant<link_seeded_faults::OrdersTaken<FfStation>>()},
      {"priority_zero_accepted", "", "does not refuse data of priority 0",
       mutant<link_seeded_faults::AcceptsPriority<FfStation, fieldbus_dll::FfRequest>>(0U)},
      {"priority_four_accepted", "", "does not refuse data of priority 4",
       mutant<link_seeded_faults::AcceptsPriority<FfStation, fieldbus_dll::FfRequest>>(4U)},
      {"no_data_is_the_usual_data", "", "takes a longest DLSDU of 0 for that of the usual link",
       with_rules<FfStation>([](FfRules& rules) {
         if (rules.link.most_data[2] == 0) rules.link.most_data[2] = 64;
       })},
      {"buffers_of_64", "", "cuts its buffers at 64 octets, whatever its link carries",
       mutant<BuffersOf64>()},
      {"each_second_write_lost", "", "publishes each second time what it has published before",
       mutant<EachSecondWriteLost>()},
      {"four_buffers", "", "publishes four buffers and no more", mutant<KnowsSoMany>(4U, 1'000U)},
      {"eight_subscriptions", "", "subscribes to eight buffers and no more", mutant<KnowsSoMany>(1'000U, 8U)},
      {"urgent_behind_those_of_the_token", "",
       "sends what is submitted during a token after what waited before", mutant<UrgentBehindThose>()},
      {"lost_beside_the_last", "", "forgets what is submitted while its last DT1 is on the line",
       mutant<LostBesideTheLast>()},
      {"node_with_sign", "", "spoils the link of its own address when its node is above 7F",
       mutant<NodeWithSign>()},
      {"duration_in_ns_of_32_bits", "", "counts the duration in nanoseconds of 32 bits",
       mutant<DurationReadAs>(+[](std::uint16_t read) {
         return static_cast<std::int64_t>(static_cast<std::uint32_t>(read * 256'000ULL) / 256'000U);
       })},
  };
}

std::vector<FfRow> ff_reception_rows() {
  using namespace ff_seeded_faults;
  return {
      {"bits_counted_on", "", "counts bits on when a start delimiter cuts an octet off",
       mutant<link_seeded_faults::BitsCountedOn<FfStation>>()},
      {"silence_from_the_delimiter", "", "counts silence from the end delimiter, whatever follows",
       mutant<link_seeded_faults::SilenceFromTheDelimiter<FfStation>>()},
      {"last_of_a_transmission", "", "takes the last frame of a transmission only",
       mutant<link_seeded_faults::LastOfATransmission<FfStation>>()},
      {"two_of_a_transmission", "", "takes the first two frames of a transmission only",
       mutant<link_seeded_faults::FirstTwoOfATransmission<FfStation>>()},
      {"everybody_on_a_link", "", "takes FFFF with a link for everybody", mutant<TakesForEverybody>(true)},
      {"everybody_of_a_node", "", "takes the selector FF of any node for everybody",
       mutant<TakesForEverybody>(false)},
      {"deaf_behind_71_minutes", "", "receives nothing more after 2^32 microseconds",
       mutant<link_seeded_faults::DeafBehind71Minutes<FfStation>>()},
      {"levels_are_half_bits", "", "takes each level for half a bit, however fine they are",
       mutant<link_seeded_faults::LevelsAreHalfBits<FfStation>>()},
      {"does_not_recover_clock", "", "samples with its own clock",
       mutant<link_seeded_faults::DoesNotRecoverClock<FfStation>>()},
      {"wants_exact_edges", "", "receives nothing whose edges are off",
       mutant<link_seeded_faults::WantsExactEdges<FfStation>>()},
      {"pairs_from_the_beginning", "", "finds no frame after an odd number of half bits",
       mutant<FindsPairsOnly>()},
      {"deaf_behind_no_symbol", "", "leaves a transmission that begins with half bits that are no symbol",
       mutant<DeafBehindNoSymbol>()},
      {"deaf_behind_a_cut_frame", "", "leaves a transmission whose first frame ends without a delimiter",
       mutant<DeafBehindACutFrame>()},
      {"node_ff_is_nobody", "", "takes FF for the address of nobody", mutant<NodeFfIsNobody>()},
      {"restarts_on_a_long_jabber", "", "begins anew when the line was busy for more than a second",
       mutant<RestartsOnALongJabber>()},
      {"receives_while_sending", "", "receives what others send while it sends",
       mutant<ReceivesWhileSending>()},
      {"others_taken_for_its_echo", "", "takes others that begin while it sends for itself",
       mutant<TakesOthersForItsEcho>()},
      {"refuses_on_a_busy_line", "", "refuses its user while others send", mutant<RefusesOnABusyLine>()},
      {"short_requests_taken", "", "takes a submit that ends within its address",
       mutant<ShortRequestsTaken>()},
      {"long_dt3_unsupported", "", "leaves a DT3 with a long address where it does not support them",
       mutant<LongDt3Unsupported>()},
      {"refuses_once", "", "starts with impossible rules the second time", mutant<RefusesOnce>()},
      {"thirty_two_buffers", "", "publishes 32 buffers and no more", mutant<KnowsSoMany>(32U, 1'000U)},
      {"sixty_four_subscriptions", "", "subscribes to 64 buffers and no more",
       mutant<KnowsSoMany>(1'000U, 64U)},
  };
}

std::vector<FfRow> ff_sequence_rows() {
  using namespace ff_seeded_faults;
  return FfMutants::for_check({
      {"token_kept_behind_probe", "", "uses a token though another node was probed meanwhile",
       mutant<TokenKeptBehindProbe>()},
      {"answer_kept_behind_other", "", "answers though another node was probed meanwhile",
       mutant<AnswerKeptBehindOther>()},
      {"data_ends_token", "", "drops the token when it receives data", mutant<DataEndsToken>()},
      {"deaf_behind_fault", "", "misses what comes after a faulty frame", mutant<DeafBehindFault>()},
      {"newest_first", "", "sends what was submitted last", mutant<NewestFirst<FfStation>>()},
      {"least_of_last_token", "", "sends by the priority of the token before", mutant<LeastOfLastToken>()},
      {"duration_of_last_token_too", "", "adds the duration of the token before",
       mutant<DurationOfLastTokenToo>()},
      {"each_third_return_missing", "", "does not send each third RT", mutant<EachThirdReturnMissing>()},
      {"second_of_priority_lost", "", "forgets urgent data that waits after a token",
       mutant<SecondOfPriorityLost>()},
      {"tail_of_last_write", "", "keeps the tail of a longer buffer", mutant<TailOfLastWrite>()},
      {"writes_between_cds_count_once", "", "counts only the first write after a CD",
       mutant<WritesBetweenCdsCountOnce>()},
      {"buffers_share_the_count", "", "counts the writes of all its buffers together",
       mutant<BuffersShareTheCount>()},
      {"count_of_a_later_write", "", "publishes the buffer of one instant with the count of another",
       mutant<CountOfALaterWrite>()},
  });
}

std::vector<FfRow> ff_schedule_rows() {
  using namespace ff_seeded_faults;
  return {
      {"token_over_due", "FF-8", "passes tokens whatever is due", mutant<TokenOverDue>()},
      {"least_token_ignored", "FF-9", "passes tokens for less than V(DMDT)",
       with_rules<FfLas>([](FfRules& rules) { rules.least_token_octets = 32; })},
      {"no_allowance_for_pt", "", "does not count what the PT itself takes", mutant<NoAllowanceForPt>()},
      {"cut_to_the_least", "", "passes tokens of V(DMDT) when not all of V(DTHT) is left",
       mutant<CutToTheLeast>()},
      {"schedule_in_centiseconds", "", "keeps its schedule to 10 ms", mutant<ScheduleInCentiseconds>()},
      {"item_skipped", "", "leaves an item out", mutant<ItemSkipped>()},
      {"answer_time_from_begin", "FF-17", "counts V(MRD) x V(ST) from the begin of its frame",
       mutant<AnswerTimeFromBegin>()},
      {"answer_time_doubled", "", "waits twice V(MRD) x V(ST)", mutant<AnswerTimeDoubled>()},
      {"line_left_silent", "", "does not keep the line active", mutant<LineLeftSilent>()},
  };
}

std::vector<FfRow> ff_circulation_rows() {
  using namespace ff_seeded_faults;
  return {
      {"descending_order", "", "passes the token in descending order",
       mutant<SaysOtherwise>(
           FfType::pt, +[](FfDlpdu& pt) { pt.node = static_cast<std::uint8_t>(0x25 - pt.node); })},
      {"begin_not_marked", "", "does not mark the first token of a circulation",
       mutant<SaysOtherwise>(
           FfType::pt, +[](FfDlpdu& pt) { pt.begins_circulation = false; })},
      {"probes_unpolled", "FF-10", "probes all addresses", mutant<ProbesUnpolled>()},
      {"probes_live_nodes", "", "probes live nodes, too", mutant<ProbesOtherwise>(1, true)},
      {"first_probe_left_out", "", "begins to probe with the second address", mutant<FirstProbeLeftOut>()},
      {"refuses_its_last_instant", "", "takes an item at the last instant of a macrocycle for impossible",
       mutant<RefusesItsLastInstant>()},
      {"probes_descending", "", "probes in descending order", mutant<ProbesOtherwise>(-1, false)},
      {"no_probe_when_busy", "FF-11", "does not probe when nodes have much to say",
       mutant<NoProbeWhenBusy>()},
      {"steers_the_wrong_way", "FF-2", "admits less when the rotation is fast", mutant<SteersTheWrongWay>()},
      {"steps_to_the_extreme", "FF-4", "admits everything at once", mutant<StepsToTheExtreme>()},
      {"rotation_counted_twice", "FF-3", "counts parts of a rotation twice", mutant<RotationCountedTwice>()},
      {"steps_back_to_the_extreme", "", "admits urgent data only at once after a slow rotation",
       mutant<StepsBackToTheExtreme>()},
      {"holder_never_stopped", "", "lets a holder overstay its token", mutant<HolderNeverStopped>()},
      {"return_of_anybody_taken", "", "takes a DT1 with F of anybody for the return of the token",
       mutant<ReturnOfAnybodyTaken>()},
      {"own_buffer_kept", "", "does not publish its own buffer",
       mutant<IdlesInPlaceOf>(
           +[](const FfDlpdu& dlpdu, const FfConfiguration&) { return dlpdu.type == FfType::dt3; })},
      {"target_ignored", "", "does not look at V(TTRT)", mutant<TargetIgnored>()},
      {"equal_rotation_is_fast", "FF-1", "takes a rotation of V(TTRT) for a fast one",
       mutant<EqualRotationIsFast>()},
  };
}

std::vector<FfRow> ff_live_list_rows() {
  using namespace ff_seeded_faults;
  using fieldbus_dll::kEverybody;
  return {
      {"no_activation", "", "does not activate a node that it has found",
       mutant<IdlesInPlaceOf>(+[](const FfDlpdu& dlpdu, const FfConfiguration&) {
         return dlpdu.type == FfType::dt1 && dlpdu.destination != kEverybody;
       })},
      {"live_list_not_told", "", "does not send its live list",
       mutant<IdlesInPlaceOf>(+[](const FfDlpdu& dlpdu, const FfConfiguration&) {
         return dlpdu.type == FfType::dt1 && dlpdu.destination == kEverybody;
       })},
      {"new_node_without_token", "", "passes no token to nodes that it has found",
       mutant<IdlesInPlaceOf>(+[](const FfDlpdu& dlpdu, const FfConfiguration& configuration) {
         return dlpdu.type == FfType::pt && std::ranges::count(configuration.live, dlpdu.node) == 0;
       })},
      {"live_list_reversed", "FF-23", "sends its live list with the bits turned", mutant<LiveListReversed>()},
      {"probe_response_of_anybody_taken", "", "takes a PR of anybody for that of the node that it has probed",
       mutant<ProbeResponseOfAnybodyTaken>()},
      {"told_live_list_ignored", "", "does not keep the live list that it receives",
       mutant<ToldLiveListIgnored>()},
      {"live_list_cut", "", "sends its live list up to node 1F", mutant<LiveListCut>()},
      {"removed_after_one_miss", "FF-12", "removes who misses one token", mutant<RemovesBehind>(1U)},
      {"removed_after_four_misses", "", "removes who misses four tokens", mutant<RemovesBehind>(4U)},
      {"never_removed", "", "removes nobody", mutant<RemovesBehind>(1'000'000U)},
      {"misses_not_forgotten", "FF-13", "counts misses though tokens are used in between",
       mutant<MissesNotForgotten>()},
      {"time_told_at_full_period", "FF-20", "sends the time each V(TDP)", mutant<TimeToldAtFullPeriod>()},
      {"time_at_half_speed", "", "sends half the time", mutant<TimeAtHalfSpeed>()},
      {"ct_ignored", "", "does not answer who asks for the time", mutant<CtIgnored>()},
  };
}

std::vector<FfRow> ff_claim_rows() {
  using namespace ff_seeded_faults;
  return {
      {"claims_after_one_slot", "FF-14", "claims the link after one V(ST)",
       mutant<ClaimsOtherwise>(1, false)},
      {"never_claims", "", "does not claim the link", mutant<ClaimsOtherwise>(10'000'000, false)},
      {"claims_a_slot_late", "", "claims the link a V(ST) late", mutant<ClaimsOtherwise>(1, true)},
      {"claims_a_slot_early", "", "claims the link a V(ST) early", mutant<ClaimsOtherwise>(-1, true)},
      {"frames_do_not_save_the_link", "", "claims the link whatever is received",
       mutant<FramesDoNotSaveTheLink>()},
      {"noise_does_not_save_the_link", "FF-15", "takes noise for silence", mutant<NoiseDoesNotSaveTheLink>()},
      {"transfer_ignored", "", "does not take over by a TL", mutant<TransferIgnored>()},
      {"transfer_not_checked", "FF-22", "takes a TL with a wrong check", mutant<TransferNotChecked>()},
      {"takes_transfer_of_others", "", "takes a TL for another", mutant<TakesTransferOfOthers>()},
      {"schedule_version_ignored", "", "takes a TL for any version of the schedule",
       mutant<ScheduleVersionIgnored>()},
      {"order_ignored", "", "does not hand the link over when it is ordered to", mutant<OrderIgnored>()},
      {"stays_behind_transfer", "", "stays though its heir sends", mutant<StaysBehindTransfer>()},
      {"never_retakes", "", "does not take back what its heir does not take", mutant<NeverRetakes>()},
      {"schedule_from_the_claim", "", "begins its schedule anew when it claims the link",
       mutant<ScheduleFromTheClaim>()},
      {"live_list_outlasts_supply", "", "remembers who is live without supply",
       mutant<LiveListOutlastsSupply>()},
      {"begins_once", "", "begins as the scheduler with its first supply only", mutant<BeginsOnce>()},
      {"deaf_in_standby", "", "is no device while another is the scheduler", mutant<DeafInStandby>()},
      {"own_data_kept", "", "does not send what its user submits", mutant<OwnDataKept>()},
      {"schedule_not_begun", "", "takes over without running its schedule",
       mutant<ScheduleNotBegunBehindTl>()},
      {"never_leaves", "", "stays whoever else is the scheduler", mutant<NeverLeaves>()},
      {"stays_behind_claim", "FF-16", "stays when another claims the link", mutant<StaysBehindClaim>()},
  };
}

// Of derived sequences.
std::vector<FfRow> ff_las_told_rows() {
  using namespace ff_seeded_faults;
  return {
      {"reply_missing_of_itself", "", "reports its own node where a publisher did not reply",
       mutant<EventsOfItself>()},
      {"each_event_once", "", "reports each kind of event once", mutant<EachEventOnce>()},
      {"data_return_no_token", "", "takes F in a DT1 for nothing", mutant<DataReturnNoToken>()},
      {"all_admitted_behind_two_slow", "", "admits all data at once after two slow rotations",
       mutant<AllAdmittedBehindTwoSlow>()},
      {"own_data_newest_first", "", "sends what its user submitted last", mutant<NewestFirst<FfLas>>()},
      {"own_data_final", "", "sets F in data of its own user",
       mutant<SaysOtherwise>(
           FfType::dt1, +[](FfDlpdu& dt1) { dt1.is_final = !is_of_entity(dt1); })},
      {"activation_time_available", "", "activates with the lowest priority",
       mutant<SaysOtherwise>(
           FfType::dt1,
           +[](FfDlpdu& dt1) {
             if (is_of_entity(dt1) && dt1.destination != fieldbus_dll::kEverybody)
               dt1.priority = Priority::time_available;
           })},
      {"own_item_normal", "", "publishes its own buffers with normal priority",
       mutant<SaysOtherwise>(
           FfType::dt3, +[](FfDlpdu& dt3) { dt3.priority = Priority::normal; })},
      {"live_list_unnumbered", "", "sends revision 0 of the live list always", mutant<LiveListUnnumbered>()},
      {"not_in_its_live_list", "", "leaves itself out of the live list", mutant<NotInItsLiveList>()},
      {"idles_early", "", "sends an IDLE after five slot times", mutant<IdlesEarly>()}};
}

std::vector<FfRow> ff_las_sequence_rows() {
  using namespace ff_seeded_faults;
  return FfMutants::for_check({
      {"removal_after_one_ignored", "", "removes a node after two missed tokens where it is set to one",
       with_rules<FfLas>(
           [](FfRules& rules) { rules.misses_until_removal = std::max(rules.misses_until_removal, 2U); })},
      {"misses_of_all_count", "", "counts the tokens that nodes miss in a row, whoever they are",
       mutant<MissesOfAllCount>()},
      {"misses_forgiven_by_others", "", "forgets all misses when any node uses its token",
       mutant<MissesForgivenByOthers>()},
      {"misses_survive_removal", "", "removes who was removed before after one miss",
       mutant<MissesSurviveRemoval>()},
      {"removed_never_found_again", "", "takes no probe response of who was removed",
       mutant<RemovedNeverFoundAgain>()},
      {"returning_node_not_activated", "", "does not activate who was removed before",
       mutant<ReturningNodeNotActivated>()},
      {"only_first_change_told", "", "sends the live list once", mutant<OnlyFirstChangeTold>()},
      {"unanswered_item_dropped", "", "compels no more what was not answered twice",
       mutant<UnansweredItemDropped>()},
      {"second_time_request_ignored", "", "sends the time to who asks once",
       mutant<SecondTimeRequestIgnored>()},
  });
}

}  // namespace

const FfMutants& ff_device_mutants() {
  static const FfMutants table("ff_device", {ff_token_rows, ff_times_rows, ff_publisher_rows, ff_frame_rows,
                                             ff_request_rows, ff_reception_rows, ff_sequence_rows});
  return table;
}

namespace {

std::vector<FfRow> ff_standby_rows() {
  return mutants_in_standby(ff_device_mutants(), ff_cases(), ff_standby_sequence_role());
}

}  // namespace

const FfMutants& ff_las_mutants() {
  static const FfMutants table(
      "ff_las", {ff_schedule_rows, ff_circulation_rows, ff_live_list_rows, ff_claim_rows, ff_las_told_rows,
                 ff_las_sequence_rows, ff_standby_rows});
  return table;
}

}  // namespace fieldproof::conformance
