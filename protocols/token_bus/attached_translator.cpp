#include "protocols/token_bus/attached_translator.hpp"

#include <utility>

namespace fieldproof::token_bus {

AttachedTranslator::AttachedTranslator(iut::Attachment attachment,
                                       const TranslatorConfiguration& configuration,
                                       const std::string& case_id, std::uint64_t seed)
    : AttachedSides("a translator", std::move(attachment),
                    {case_id, seed, translator_settings(configuration)}) {}

bool ServedTranslator::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  make(translator_configuration_of(begin), bench);
  station().wire(port(kPhySide), port(kMacSide));
  return true;
}

}  // namespace fieldproof::token_bus
