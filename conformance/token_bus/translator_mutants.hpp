#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/token_bus/translator_device.hpp"

namespace fieldproof::conformance {

using TranslatorMutants = DeviceMutants<token_bus::TranslatorDevice, token_bus::TranslatorConfiguration>;

// Translators with one seeded fault each.
const TranslatorMutants& translator_mutants();

}  // namespace fieldproof::conformance
