#include "conformance/token_bus/translator_mutants.hpp"

#include <algorithm>
#include <limits>

#include "conformance/token_bus/translator_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

using namespace token_bus;
using TranslatorMutant = TranslatorMutants::Row;

auto with_delay_tripled() {
  return [](TranslatorConfiguration configuration) {
    configuration.delay_symbols *= 3;
    configuration.answer_symbols = std::max(configuration.answer_symbols, configuration.delay_symbols);
    return std::make_unique<Translator>(configuration);
  };
}

auto with_encoder(translator_seeded_faults::Encoded encoded) {
  return with_block<&TranslatorBlocks::transmitter, translator_seeded_faults::EncodesOtherwise>(encoded);
}
auto with_indications(translator_seeded_faults::Indicated indicated) {
  return with_block<&TranslatorBlocks::receiver, translator_seeded_faults::IndicatesOtherwise>(indicated);
}
template <typename Manager>
auto with_manager() {
  return with_block<&TranslatorBlocks::manager, Manager>();
}
auto with_answers(translator_seeded_faults::Answer answer) {
  return with_block<&TranslatorBlocks::manager, translator_seeded_faults::AnswersOtherwise>(answer);
}
auto with_blanking(unsigned symbols) {
  return with_block<&TranslatorBlocks::blanking, translator_seeded_faults::BlankingOtherwise>(symbols);
}
auto with_jabber(unsigned symbols) {
  return with_block<&TranslatorBlocks::jabber, translator_seeded_faults::JabberOtherwise>(symbols);
}

std::vector<TranslatorMutant> encoding_rows() {
  using namespace translator_seeded_faults;
  return {
      {"non_data_pair_swapped", "TB-25", "sends CD0,CD0 before CD1,CD1", with_encoder(non_data_pair_swapped)},
      {"pad_idle_as_zero", "TB-26", "sends pad_idle as zero", with_encoder(pad_idle_as_zero)},
      {"zero_and_one_exchanged", "", "sends zero as one, and one as zero",
       with_encoder(zero_and_one_exchanged)},
      {"non_data_without_edges", "", "sends non_data as levels without an edge",
       with_encoder(non_data_without_edges)},
      {"first_symbol_lost", "", "loses the first symbol of a transmission",
       with_block<&TranslatorBlocks::transmitter, FirstSymbolLost>()},
      {"non_data_pair_over_silence", "", "pairs two non_data with silence between them",
       with_block<&TranslatorBlocks::transmitter, NonDataPairOverSilence>()},
      {"jabber_of_10_ms", "", "cuts off what lasts for more than 10 ms", with_jabber(50'000)},
      {"slow_transmitter", "", "sends three times as late as it may", with_delay_tripled()},
  };
}

std::vector<TranslatorMutant> locking_rows() {
  using namespace translator_seeded_faults;
  return {
      {"never_slips", "", "takes the phase as it comes",
       with_clock<SlipsOtherwise>(std::numeric_limits<unsigned>::max(), 1U)},
      {"slips_by_two_bits", "TB-27", "slips by two bits", with_clock<SlipsOtherwise>(2U, 2U)},
      {"slips_in_data", "TB-27", "slips in a field of data", with_clock<SlipsInData>()},
      {"slips_after_28_zeros", "", "slips after 28 zeros only", with_clock<SlipsOtherwise>(28U, 1U)},
      {"slips_once_only", "", "slips in the first transmission that needs it", with_clock<SlipsOnceOnly>()},
      {"keeps_its_phase", "", "keeps the phase of the first transmission", with_clock<KeepsItsPhase>()},
      {"loses_a_bit_after_50000", "", "loses a bit after 50000 symbols", with_clock<LosesABit>()},
      {"samples_by_its_own_clock", "", "takes the bits of the line by its own clock",
       mutant<SamplesByItsOwnClock>()},
      {"slow_receiver", "", "indicates three times as late as it may", with_delay_tripled()},
  };
}

std::vector<TranslatorMutant> decoding_rows() {
  using namespace translator_seeded_faults;
  return {
      {"carrier_ignored", "", "does not look at CARRIER_STATUS",
       with_block<&TranslatorBlocks::receiver, LooksAtLess<true>>()},
      {"error_not_looked_at", "", "does not look at SIGNAL_STATUS",
       with_block<&TranslatorBlocks::receiver, LooksAtLess<false>>()},
      {"error_is_silence", "TB-28", "indicates silence for a signal error",
       with_indications(error_is_silence)},
      {"cut_pair_is_silence", "", "indicates silence for a pair whose second bit is missing",
       with_indications(cut_pair_is_silence)},
      {"idle_is_bad_signal", "", "indicates bad_signal for an idle line that has a carrier",
       with_indications(idle_is_bad_signal)},
      {"data_after_non_data_taken", "", "indicates data where the second non_data is due",
       with_indications(data_after_non_data_taken)},
      {"non_data_in_any_order", "", "indicates non_data in any order",
       with_indications(non_data_in_any_order)},
      {"non_data_pair_read_swapped", "TB-25", "has CD0,CD0 for the first non_data",
       with_indications(non_data_pair_read_swapped)},
      {"error_loses_the_lock", "", "indicates bad_signal from a signal error to the next silence",
       with_block<&TranslatorBlocks::receiver, ErrorLosesTheLock>()},
      {"deaf_after_error", "", "indicates nothing after a collision",
       with_block<&TranslatorBlocks::receiver, DeafAfterError>()},
  };
}

std::vector<TranslatorMutant> blanking_rows() {
  using namespace translator_seeded_faults;
  return {
      {"blanking_absent", "TB-29", "blanks nothing", with_blanking(0)},
      {"blanking_of_6_symbols", "", "blanks six symbols", with_blanking(6)},
      {"blanking_of_100_symbols", "TB-29", "blanks 100 symbols", with_blanking(100)},
      {"blanks_after_every_frame", "", "blanks though more follows",
       with_block<&TranslatorBlocks::blanking, BlanksAfterEveryFrame>()},
      {"heartbeat_indicated", "", "indicates the test of the transceiver",
       mutant<ErrorsMaskedOtherwise>(false)},
      {"errors_masked_while_it_sends", "", "indicates no collision of its own",
       mutant<ErrorsMaskedOtherwise>(true)},
      {"deaf_while_it_sends", "", "receives nothing while it sends", mutant<DeafWhileItSends>()},
      {"deaf_in_management_mode", "", "receives nothing in management mode", mutant<DeafInManagementMode>()},
  };
}

std::vector<TranslatorMutant> management_rows() {
  using namespace translator_seeded_faults;
  return {
      {"reset_enables_transmitter", "TB-30", "enables its transmitter by RESET",
       with_manager<EnabledByReset>()},
      {"transmitter_on_from_the_start", "", "has its transmitter on from power-up",
       with_manager<EnabledFromTheStart>()},
      {"reset_keeps_the_transmitter", "", "leaves its transmitter on when it is reset",
       with_manager<EnabledForGood>()},
      {"enable_does_nothing", "", "refuses to enable its transmitter", with_answers(enable_refused)},
      {"no_loopback_after_reset", "", "is on the line after RESET", with_manager<NotLoopedBack>()},
      {"loopback_never_disabled", "", "stays looped back", with_manager<LoopedBackForGood>()},
      {"line_leaks_into_loopback", "", "receives from the line in loopback, too",
       mutant<LineLeaksIntoLoopback>()},
      {"reset_not_acknowledged", "", "answers RESET with IDLE", with_answers(reset_not_acknowledged)},
      {"idle_acknowledged", "", "acknowledges where no command is", with_answers(idle_acknowledged)},
      {"serial_data_acknowledged", "", "acknowledges serial data", with_answers(serial_acknowledged)},
      {"answers_late", "", "answers after 30 symbols", with_manager<AnswersLate>()},
      {"symbols_leak", "", "indicates symbols in management mode",
       with_block<&TranslatorBlocks::multiplexer, SymbolsLeak>()},
      {"stays_in_management", "", "indicates no symbol after management mode",
       with_block<&TranslatorBlocks::multiplexer, StaysInManagement>()},
      {"commands_are_sent", "", "sends bits in management mode", mutant<CommandsAreSent>()},
      {"remembers_over_power_failure", "", "has its transmitter on after a failure of the supply",
       mutant<IgnoresPowerFailure>()},
      {"jabbers_for_ever", "", "never cuts off a transmission",
       with_jabber(std::numeric_limits<unsigned>::max())},
      {"jabber_is_not_reported", "", "answers IDLE after a jabber", with_answers(jabber_not_reported)},
      {"jabber_outlives_reset", "", "stays off after RESET", with_manager<JabberOutlivesReset>()},
  };
}

std::vector<TranslatorMutant> translator_check_rows() {
  using namespace translator_seeded_faults;
  return TranslatorMutants::for_check({
      {"refuses_a_second_enable", "", "refuses to enable a transmitter that is on",
       with_manager<RefusesASecondEnable>()},
  });
}

}  // namespace

const TranslatorMutants& translator_mutants() {
  static const TranslatorMutants table(
      "translator", {encoding_rows, locking_rows, decoding_rows, blanking_rows, management_rows,
                     translator_circuit_rows, translator_edge_rows, translator_check_rows});
  return table;
}

}  // namespace fieldproof::conformance
