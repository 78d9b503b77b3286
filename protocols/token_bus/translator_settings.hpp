#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/token_bus/translator_device.hpp"

// What an implementation outside is given of the configuration of a translator.
namespace fieldproof::token_bus {

extern const field::Table<TranslatorConfiguration> kTranslatorTable;

field::Settings translator_settings(const TranslatorConfiguration& configuration);
TranslatorConfiguration translator_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::token_bus
