#include "protocols/token_bus/translator_settings.hpp"

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

using field::part;
using field::row;
using judge::Standing;

constexpr field::Unit kSymbols{"MAC symbols"};

constexpr auto kRows = field::rows<TranslatorConfiguration>(
    part<&TranslatorConfiguration::rules>(kRulesTable),
    row<&TranslatorConfiguration::delay_symbols>(
        {kSymbols, {2, 64}, "most, from a symbol on one side to what it becomes on the other", kSourceOwn}),
    row<&TranslatorConfiguration::answer_symbols>(
        {kSymbols, {2, 256}, "most, from a management command to its answer", kSourceOwn}),
    row<&TranslatorConfiguration::error_mask_symbols>(
        {kSymbols,
         {0, 64},
         "after an own transmission, in which a signal error is the SQE test of the transceiver",
         kSourceOwn}),
    row<&TranslatorConfiguration::jabber_symbols>({kSymbols,
                                                   {66'000, 5'000'000},
                                                   "of one transmission, then the transmitter is off",
                                                   kSourceMemory,
                                                   Standing::memory}));

}  // namespace

constexpr field::Table<TranslatorConfiguration> kTranslatorTable =
    field::table<TranslatorConfiguration>(kRows);

field::Settings translator_settings(const TranslatorConfiguration& configuration) {
  return field::settings_of(kTranslatorTable, configuration);
}

TranslatorConfiguration translator_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kTranslatorTable, begin.settings);
}

}  // namespace fieldproof::token_bus
