#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "conformance/mutant_table.hpp"
#include "protocols/token_bus/translator.hpp"

namespace fieldproof::conformance {

using TranslatorMutants = DeviceMutants<token_bus::TranslatorDevice, token_bus::TranslatorConfiguration>;

// Translators with one seeded fault each.
const TranslatorMutants& translator_mutants();

// Rows of this table, each in its own file: of what a translator takes from its circuits and drives on them,
// and of where something ends.
std::vector<TranslatorMutants::Row> translator_circuit_rows();
std::vector<TranslatorMutants::Row> translator_edge_rows();

// The reference with one block of its own.
template <auto member, typename Block, typename... More>
auto with_block(More... more) {
  return [=](const token_bus::TranslatorConfiguration& configuration) {
    token_bus::TranslatorBlocks blocks;
    blocks.*member = std::make_unique<Block>(more...);
    return std::make_unique<token_bus::Translator>(configuration, std::move(blocks));
  };
}
template <typename Clock, typename... More>
auto with_clock(More... more) {
  return [=](const token_bus::TranslatorConfiguration& configuration) {
    token_bus::TranslatorBlocks blocks;
    blocks.receiver = std::make_unique<token_bus::MacDecoder>(std::make_unique<Clock>(more...));
    return std::make_unique<token_bus::Translator>(configuration, std::move(blocks));
  };
}

}  // namespace fieldproof::conformance
