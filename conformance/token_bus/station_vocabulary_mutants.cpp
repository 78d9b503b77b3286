#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/station_vocabulary_seeded_faults.hpp"

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
      {"both_failures_reported", "", "reports the last failure as a failed pass, too",
       mutant<BothFailuresReported>()},
      {"failures_kept", "", "counts failures of before a loss of supply", mutant<FailuresKept>()},
  };
}

}  // namespace fieldproof::conformance
