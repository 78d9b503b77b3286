#include <algorithm>

#include "conformance/token_bus/translator_circuit_seeded_faults.hpp"
#include "conformance/token_bus/translator_edge_seeded_faults.hpp"
#include "conformance/token_bus/translator_mutants.hpp"
#include "conformance/token_bus/translator_seeded_faults.hpp"

// Translators that are wrong at an edge, by one code, or by a number that is not that of their settings.
namespace fieldproof::conformance {
namespace {

using namespace token_bus;
using namespace translator_seeded_faults;
using Rows = std::vector<TranslatorMutants::Row>;
using EdgeBlocks = TranslatorBlocks;

template <typename Change>
auto with_settings(Change change) {
  return [=](TranslatorConfiguration configuration) {
    change(configuration);
    return std::make_unique<Translator>(configuration);
  };
}

auto taking(Taken how) {
  return mutant<TakesRequests>(how);
}
auto driving(Driven how) {
  return mutant<DrivesOtherwise>(how, kernel::Duration{});
}

// Masked while the time after the transmission is less than that; the setting, and the delay.
class MaskOtherwise final : public Translator {
 public:
  using Length = unsigned (*)(const TranslatorConfiguration& configuration);
  MaskOtherwise(const TranslatorConfiguration& configuration, Length length)
      : Translator(configuration), length_(length) {}

 private:
  bool is_error_masked(kernel::Duration after) const override {
    return after >= kernel::Duration{} &&
           after < mac_symbols(configuration().rules, length_(configuration()));
  }

  Length length_;
};
auto with_mask_of(MaskOtherwise::Length length) {
  return mutant<MaskOtherwise>(length);
}

class MaskHasItsEnd final : public Translator {
  using Translator::Translator;
  bool is_error_masked(kernel::Duration after) const override {
    return after >= kernel::Duration{} &&
           after <= mac_symbols(configuration().rules, configuration().error_mask_symbols);
  }
};

template <auto block>
auto with_commands_that_reset() {
  return [](const TranslatorConfiguration& configuration) {
    EdgeBlocks blocks;
    auto& one = *(blocks.*block);
    blocks.manager = std::make_unique<CommandResets<std::remove_reference_t<decltype(one)>>>(one);
    return std::make_unique<Translator>(configuration, std::move(blocks));
  };
}

Rows mask_rows_of_translators() {
  using One = const TranslatorConfiguration&;
  return {
      {"mask_of_one_symbol_less", "", "ends its error mask a symbol early",
       with_mask_of([](One one) { return std::max(1U, one.error_mask_symbols) - 1; })},
      {"mask_has_its_end", "", "masks an error that begins when the mask is over", mutant<MaskHasItsEnd>()},
      {"error_without_carrier", "", "indicates a signal error without carrier",
       with_block<&EdgeBlocks::receiver, ErrorWithoutCarrier>()},
      {"mask_of_one_symbol_more", "", "ends its error mask a symbol late",
       with_mask_of([](One one) { return one.error_mask_symbols + 1; })},
      {"mask_of_20_symbols_at_least", "", "masks errors for 20 symbols at least",
       with_mask_of([](One one) { return std::max(20U, one.error_mask_symbols); })},
      {"mask_of_63_symbols_at_most", "", "masks errors for 63 symbols at most",
       with_mask_of([](One one) { return std::min(63U, one.error_mask_symbols); })},
      {"masked_for_ever", "", "masks errors until its next transmission",
       with_mask_of([](One) { return 1'000'000U; })},
      {"mask_from_the_request", "", "counts its error mask from the end of the request",
       with_mask_of(
           [](One one) { return std::max(one.delay_symbols, one.error_mask_symbols) - one.delay_symbols; })},
      {"mask_without_transmitter", "", "masks errors after what it has not sent",
       mutant<MaskWithoutTransmitter>()},
  };
}

Rows clock_rows() {
  return {
      {"slips_after_one_zero", "", "slips after one zero", with_clock<SlipsOtherwise>(1U, 1U)},
      {"slips_after_three_zeros", "", "slips after three zeros", with_clock<SlipsOtherwise>(3U, 1U)},
      {"locked_by_one_one", "", "is locked by a single one", with_clock<LocksOtherwise>(locked_by_one_one)},
      {"ones_lock_nothing", "", "is locked by non_data only", with_clock<LocksOtherwise>(ones_lock_nothing)},
      {"non_data_lock_nothing", "", "is locked by ones only",
       with_clock<LocksOtherwise>(non_data_lock_nothing)},
      {"bad_signal_locks", "", "is locked by bad_signal", with_clock<LocksOtherwise>(bad_signal_locks)},
      {"zeros_need_not_be_in_a_row", "", "slips after two zeros with others between them",
       with_clock<ZerosAddUp>(false)},
      {"zeros_outlive_silence", "", "counts zeros over silence", with_clock<ZerosAddUp>(true)},
      {"ones_outlive_silence", "", "counts ones over silence", with_clock<OnesOutliveSilence>()},
      {"slips_once_in_a_transmission", "", "slips once in a transmission",
       with_clock<SlipsOnceInATransmission>()},
      {"hunts_for_16_symbols", "", "searches the phase in 16 symbols only", with_clock<HuntsFor16Symbols>()},
      {"lock_outlives_short_silence", "", "keeps its phase over one symbol of silence",
       with_clock<LockOutlivesShortSilence>()},
      {"end_delimiter_unlocks", "", "searches the phase anew after an end delimiter",
       with_clock<EndDelimiterUnlocks>()},
  };
}

Rows receiver_rows() {
  return {
      {"silent_until_it_is_locked", "", "indicates no symbol until its phase is sure",
       with_block<&EdgeBlocks::receiver, SilentUntilLocked>()},
      {"third_pair_is_bad_signal", "", "takes two pairs of non_data in a row at most",
       with_block<&EdgeBlocks::receiver, ThirdPairIsBadSignal>()},
      {"due_until_it_comes", "", "awaits the second non_data over other symbols",
       with_block<&EdgeBlocks::receiver, DueOtherwise>(due_until_it_comes)},
      {"no_blanking_after_an_error", "", "blanks nothing where E is 1",
       with_block<&EdgeBlocks::blanking, NoBlankingAfterAnError>()},
      {"blanking_outlives_reset", "", "goes on with its blanking after RESET and a failure of the supply",
       with_block<&EdgeBlocks::blanking, BlankingOutlivesReset>()},
      {"short_end_delimiter", "", "takes half an end delimiter for one",
       with_block<&EdgeBlocks::blanking, ShortEndDelimiter>()},
      {"end_delimiter_over_silence", "", "takes an end delimiter with silence in it for one",
       with_block<&EdgeBlocks::blanking, EndDelimiterOverSilence>()},
      {"bad_signal_within_blanking", "", "indicates bad_signal in its blanking",
       with_block<&EdgeBlocks::blanking, BadSignalWithinBlanking>()},
      {"blanks_while_carrier", "", "blanks as long as there is anything",
       with_block<&EdgeBlocks::blanking, BlanksWhileCarrier>()},
      {"blanking_ends_with_silence", "", "ends its blanking when the line is silent",
       with_block<&EdgeBlocks::blanking, BlankingEndsWithSilence>()},
      {"command_ends_blanking", "", "ends its blanking by any command",
       with_commands_that_reset<&EdgeBlocks::blanking>()},
      {"command_loses_the_phase", "", "forgets its phase by any command",
       with_commands_that_reset<&EdgeBlocks::receiver>()},
  };
}

auto with_blanking_of(unsigned symbols) {
  return with_block<&EdgeBlocks::blanking, BlankingOtherwise>(symbols);
}
auto with_jabber_of(unsigned symbols) {
  return with_block<&EdgeBlocks::jabber, JabberOtherwise>(symbols);
}

Rows number_rows() {
  return {
      {"blanking_of_27_symbols", "", "blanks 27 symbols", with_blanking_of(27)},
      {"blanking_of_28_symbols", "", "blanks 28 symbols, whatever is set", with_blanking_of(28)},
      {"blanking_of_29_symbols", "", "blanks 29 symbols", with_blanking_of(29)},
      {"jabber_one_early", "", "takes 66000 symbols for a jabber", with_jabber_of(65'999)},
      {"jabber_one_late", "", "takes 66001 symbols for no jabber", with_jabber_of(66'001)},
      {"jabber_at_half", "", "counts bits for a jabber", with_jabber_of(33'000)},
      {"bit_rate_of_10_megabits", "", "works at 10 Mbit/s, whatever is set",
       with_settings([](TranslatorConfiguration& one) { one.rules.phy_bit_rate = 10'000'000; })},
      {"delay_of_8_symbols", "", "is eight symbols late, whatever is set",
       with_settings([](TranslatorConfiguration& one) { one.delay_symbols = 8; })},
      {"delay_of_1600_ns", "", "is 1.6 us late, whatever is set",
       with_settings([](TranslatorConfiguration& one) {
         constexpr std::int64_t kBitsOfASymbol = 1'250'000;
         one.delay_symbols =
             static_cast<unsigned>(std::max<std::int64_t>(2, one.rules.phy_bit_rate / kBitsOfASymbol));
         one.answer_symbols = std::max(one.answer_symbols, one.delay_symbols);
       })},
      {"answers_of_8_symbols", "", "answers after eight symbols, whatever is set",
       with_settings([](TranslatorConfiguration& one) { one.answer_symbols = 8; })},
  };
}

}  // namespace

Rows translator_edge_rows() {
  Rows all;
  for (const auto rows : {mask_rows_of_translators, clock_rows, receiver_rows, number_rows})
    for (TranslatorMutants::Row& row : rows()) all.push_back(std::move(row));
  return all;
}

Rows translator_circuit_rows() {
  return {
      {"pad_idle_by_one_code", "", "takes pad_idle as 011 for silence",
       taking(code_taken_for<0b1011, 0b1111>)},
      {"non_data_by_one_code", "", "takes non_data as 101 for one", taking(code_taken_for<0b1101, 0b1001>)},
      {"silence_by_one_code", "", "takes silence as 110 for pad_idle",
       taking(code_taken_for<0b1110, 0b1010>)},
      {"single_silence_filled", "", "sends pad_idle for a single symbol of silence",
       taking(single_silence_filled)},
      {"stuffs_after_64_zeros", "", "sends a one after 64 zeros", taking(stuffs_after_64_zeros)},
      {"first_symbol_after_a_command_lost", "", "loses the first symbol after a command",
       taking(first_after_a_command_lost)},
      {"command_of_two_symbols_at_least", "", "takes no command of one symbol",
       taking(command_of_two_symbols)},
      {"first_command_stands", "", "takes no command that follows another", taking(first_command_stands)},
      {"reset_after_eight_symbols", "", "resets when RESET stands for eight symbols",
       taking(reset_after_eight_symbols)},
      {"serial_data_resets", "", "resets by serial data", taking(code_taken_for<0b0000, 0b0111>)},
      {"sends_by_its_own_clock", "", "sends by its own clock", mutant<SendsByItsOwnClock>()},
      {"answer_of_one_symbol", "", "answers for one symbol", driving(answers_of_at_most<1>)},
      {"answer_of_28_symbols_at_most", "", "answers for 28 symbols at most", driving(answers_of_at_most<28>)},
      {"answer_with_symbol_0_off", "", "answers with symbol 0 off", driving(symbol_0_off)},
      {"answers_too_late", "", "answers 60 us late",
       mutant<DrivesOtherwise>(as_it_is, 60 * kernel::kMicrosecond)},
      {"enable_toggles", "", "disables its transmitter by a second ENABLE TRANSMITTER",
       with_block<&EdgeBlocks::manager, EnableToggles>()},
      {"disable_toggles", "", "loops back by a second DISABLE LOOPBACK",
       with_block<&EdgeBlocks::manager, DisableToggles>()},
      {"enable_disables_loopback", "", "ends loopback by ENABLE TRANSMITTER",
       with_block<&EdgeBlocks::manager, EnableDisablesLoopback>()},
      {"on_the_line_at_power_up", "", "is on the line from power-up",
       with_block<&EdgeBlocks::manager, OnTheLineAtPowerUp>()},
      {"enabled_after_a_jabber", "", "sends again after ENABLE TRANSMITTER though it has jabbered",
       with_block<&EdgeBlocks::manager, EnabledAfterAJabber>()},
      {"disable_refused_after_a_jabber", "", "refuses DISABLE LOOPBACK after a jabber",
       with_block<&EdgeBlocks::manager, AnswersOtherwise>(disable_refused_after_jabber)},
      {"second_enable_taken", "", "acknowledges a second ENABLE TRANSMITTER after a jabber",
       with_block<&EdgeBlocks::manager, AnswersAJabberOnce>(ManagementCommand::enable_transmitter,
                                                            ManagementAnswer::ack)},
      {"jabber_told_once", "", "answers a second idle after a jabber with IDLE",
       with_block<&EdgeBlocks::manager, AnswersAJabberOnce>(ManagementCommand::idle, ManagementAnswer::idle)},
      {"serial_data_tell_a_jabber", "", "answers serial data after a jabber with physical error",
       with_block<&EdgeBlocks::manager, AnswersOtherwise>(serial_data_tell_a_jabber)},
      {"jabber_loops_back", "", "loops back after a jabber",
       with_block<&EdgeBlocks::manager, JabberLoopsBack>()},
      {"jabber_outlives_supply", "", "remembers a jabber over a failure of the supply",
       with_block<&EdgeBlocks::manager, JabberOutlivesSupply>()},
      {"jabber_over_one_silence", "", "counts on over one symbol of silence",
       with_block<&EdgeBlocks::jabber, JabberOverOneSilence>()},
      {"jabber_over_a_command", "", "counts on over a command",
       with_block<&EdgeBlocks::jabber, JabberOverACommand>()},
      {"jabber_without_transmitter", "", "takes what it does not send for a jabber",
       with_block<&EdgeBlocks::jabber, JabberWithoutTransmitter>()},
      {"one_jabber_only", "", "cuts off one jabber only", with_block<&EdgeBlocks::jabber, OneJabberOnly>()},
  };
}

}  // namespace fieldproof::conformance
