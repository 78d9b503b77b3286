#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/station_partial_seeded_faults.hpp"
#include "conformance/token_bus/station_reception_seeded_faults.hpp"

// Stations that are wrong for some words of a vocabulary only.
namespace fieldproof::conformance {

std::vector<TokenMutants::Row> token_vocabulary_rows() {
  using namespace token_seeded_faults;
  using Event = token_bus::EventKind;
  const auto takes = [](TakesOtherwise::Change change) { return mutant<TakesOtherwise>(change); };
  return {
      {"token_by_its_low_octet", "", "takes a token whose destination has its low octet",
       takes(&by_few_bits<FrameKind::token, 8>)},
      {"token_by_16_bits", "", "takes a token whose destination has its low 16 bits",
       takes(&by_few_bits<FrameKind::token, 16>)},
      {"token_of_a_group_taken", "", "takes a token that is for a group", takes(&token_of_a_group)},
      {"data_by_their_low_octet", "", "takes data whose destination has its low octet",
       takes(&by_few_bits<FrameKind::data, 8>)},
      {"data_by_32_bits", "", "takes data whose destination has its low 32 bits",
       takes(&by_few_bits<FrameKind::data, 32>)},
      {"source_by_its_low_octet", "", "takes a source that has its low octet for its own",
       takes(&source_by_few_bits<8>)},
      {"source_by_16_bits", "", "takes a source that has its low 16 bits for its own",
       takes(&source_by_few_bits<16>)},
      {"successor_by_its_low_octet", "", "takes set_successor whose destination has its low octet",
       takes(&by_few_bits<FrameKind::set_successor, 8>)},
      {"successor_by_16_bits", "", "takes set_successor whose destination has its low 16 bits",
       takes(&by_few_bits<FrameKind::set_successor, 16>)},
      {"events_of_16_bits", "", "reports 16 bits of an address",
       mutant<ReportsOtherwise>(ReportsOtherwise::Change{.of_event =
                                                             +[](token_bus::Event& event) {
                                                               event.address &= 0xFFFF;
                                                               return true;
                                                             }})},
      {"response_of_the_asked_only", "", "takes a response from whom it has asked only",
       takes(&response_of_the_asked)},
      {"response_to_another_taken", "", "takes a response to another", takes(&response_to_another)},
      {"any_data_are_a_response", "", "takes any data for a response", takes(&any_data_respond)},
      {"control_is_a_response", "", "takes resolve_contention for a response", takes(&control_responds)},
      {"first_missing_response_only", "", "reports only the first response that is missing",
       mutant<ReportsLess>(Event::response_missing, false)},
      {"missing_response_ends_its_use", "", "passes the token on when a response is missing",
       mutant<MissingResponseEndsUse>()},
      {"leaves_when_it_drops", "", "leaves the ring when it drops the token",
       mutant<BeginsAnewWith>(Event::unexpected_frame, Kept::queues)},
      {"forgets_data_when_it_drops", "", "forgets its data when it drops the token",
       mutant<BeginsAnewWith>(Event::unexpected_frame, Kept::ring)},
      {"request_that_costs_unanswered", "", "does not answer a request that costs it the token",
       takes(&costly_request_unanswered)},
      {"solicitation_that_costs_unanswered", "", "does not answer a solicitation that costs it the token",
       takes(&costly_solicitation_unanswered)},
      {"first_unexpected_frame_only", "", "reports only the first token that it drops",
       mutant<ReportsLess>(Event::unexpected_frame, false)},
      {"duplicate_in_idle_only", "", "sees its own address as a source while it is idle only",
       takes(&duplicate_in_idle)},
      {"offline_takes_data", "", "accepts data while it is offline", mutant<OfflineTakesData>()},
      {"offline_for_ever", "", "stays offline when its supply returns", mutant<OfflineForEver>()},
      {"data_of_members_only", "", "delivers data while it is in the ring only", takes(&data_of_members)},
      {"unasked_response_kept", "", "delivers responses only to its own requests", takes(&asked_responses)},
      {"both_failures_reported", "", "reports the last failure as a failed pass, too",
       mutant<BothFailuresReported>()},
      {"failures_kept", "", "counts failures of before a loss of supply", mutant<FailuresKept>()},
  };
}

std::vector<TokenMutants::Row> token_partial_rows() {
  using namespace token_seeded_faults;
  using Event = token_bus::EventKind;
  return {
      {"token_1000_lost", "", "does not take its thousandth token", mutant<NthTokenLost>()},
      {"datum_300_lost", "", "never sends the 300th datum", mutant<NthDatumLost>()},
      {"equal_data_once", "", "delivers data that are those of before once", mutant<EqualDataOnce>()},
      {"counts_in_octets", "", "counts errors up to 255", mutant<CountsInOctets>()},
      {"windows_not_drawn", "", "draws the same bits for each window", mutant<WindowsNotDrawn>()},
      {"last_claim_always_short", "", "ends each claim with one of no slot time", mutant<LastClaimShort>()},
      {"timers_begin_full", "", "begins with time left for each class", mutant<TimersBeginFull>(true)},
      {"timers_kept", "", "has time left for each class after a loss of supply",
       mutant<TimersBeginFull>(false)},
      {"class_served_to_its_end", "", "sends all of a class that has time when its service begins",
       mutant<ClassServedToItsEnd>()},
      {"timers_begin_with_each_datum", "", "begins a rotation timer anew with each datum",
       mutant<TimersBeginWithEachDatum>()},
      {"class_given_up", "", "never serves a class again that had no time for three rounds",
       mutant<ClassGivenUp>()},
      {"priority_of_its_class", "", "sends data with the lower priority of their class",
       mutant<WritesOtherwise>(+[](Frame& frame, const TokenStation&) { frame.priority &= 6U; })},
      {"maintenance_in_16_bits", "", "keeps the target of ring maintenance in 16 bits",
       with_rules<TokenStation>([](Rules& rules) { rules.ring_maintenance_octets &= 0xFFFFU; })},
      {"pauses_when_alone", "", "waits a slot time more between its solicitations",
       mutant<WindowsOtherwise>(FrameKind::solicit_successor_2, 3U)},
      {"solicits_before_its_data", "", "solicits before it sends data when it has claimed the token",
       mutant<SolicitsBeforeItsData>()},
      {"alone_the_first_time_only", "", "reports only the first time that it is alone",
       mutant<ReportsLess>(Event::sole_station, false)},
      {"predecessor_kept_by_a_claim", "", "follows its old predecessor after a claim",
       mutant<PredecessorKeptByClaim>()},
      {"never_leaves_alone", "", "does not leave while it is alone", mutant<WantsRingAlso>(&while_alone)},
      {"answers_after_leaving", "", "answers solicitations after it has left",
       mutant<WantsRingAlso>(&after_leaving)},
      {"urgent_data_only_join", "", "joins or stays for data of class 6 only", mutant<UrgentDataOnlyJoin>()},
      {"failure_drops_data", "", "forgets what waits when it finds no successor", mutant<FailureDropsData>()},
      {"offer_kept", "", "keeps the successor of an answer that was for nothing", mutant<OfferKept>()},
      {"member_takes_the_offer", "", "takes the successor of a solicitation as a member",
       mutant<MemberTakesOffer>()},
      {"noise_ends_its_demand", "", "does not contend after noise", mutant<NoiseEndsItsDemand>()},
      {"yields_to_no_frame", "", "answers in a contest though another was sooner, whatever it sent",
       mutant<YieldsToNoFrame>()},
      {"first_successor_only", "", "reports only its first new successor",
       mutant<ReportsLess>(Event::successor_changed, false)},
      {"first_leaving_only", "", "reports only the first time that it has left",
       mutant<ReportsLess>(Event::left, false)},
      {"length_looked_at_last", "", "counts other errors of frames that are too long",
       mutant<LengthLookedAtLast>()},
      {"long_frames_unchecked", "", "takes frames of more than 2048 octets with any check",
       mutant<HearsOtherwise>(&long_frames_unchecked)},
      {"long_preambles_lost", "", "finds no frame after more than 16 octets of preamble",
       mutant<HearsOtherwise>(&long_preambles_lost)},
      {"low_control_bits_only", "", "looks at four bits of a control code",
       mutant<UnderstandsOtherwise>(&low_control_bits_only)},
      {"blanked_puts_off_the_claim", "", "claims later after what ended while it was blanked",
       mutant<BlankedPutsOff>()},
  };
}

}  // namespace fieldproof::conformance
