#include "conformance/token_bus/translator_declarations.hpp"

#include "harness/field/pics.hpp"
#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::conformance {

std::vector<judge::PicsItem> translator_pics_items() {
  return field::pics_items_of(token_bus::kTranslatorTable);
}
judge::Pics declared_translator() {
  return field::declared_by(token_bus::kTranslatorTable, token_bus::TranslatorConfiguration{});
}
token_bus::TranslatorConfiguration translator_declared_in(const judge::Pics& pics) {
  return field::declared_in(token_bus::kTranslatorTable, pics);
}

}  // namespace fieldproof::conformance
