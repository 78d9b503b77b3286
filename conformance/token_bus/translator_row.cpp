#include "conformance/token_bus/translator_row.hpp"

#include "conformance/bench_role.hpp"
#include "conformance/token_bus/translator_cases.hpp"
#include "conformance/token_bus/translator_mutants.hpp"
#include "conformance/token_bus/translator_sequence.hpp"
#include "harness/field/pics.hpp"
#include "protocols/token_bus/attached_translator.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/token_bus/translator_dissector.hpp"

namespace fieldproof::conformance {

RoleRow translator_row() {
  using Cases = CaseRole<TranslatorCase, TranslatorSetting, token_bus::TranslatorDissector>;
  return row_of<token_bus::TranslatorRole, token_bus::Translator>(
      {.what = "translator of the token bus", .mutants = translator_mutants},
      Cases{.name = "translator",
            .cases = translator_cases,
            .check = expect_judgeable_sides<TranslatorCase, TranslatorSetting>,
            .pics_items = [] { return field::pics_items_of(token_bus::kTranslatorTable); },
            .usual_answers = [] { return field::declared_by(token_bus::kTranslatorTable, {}); },
            .settings = &token_bus::kTranslatorTable,
            .are_settings_declared = true,
            .sequences = SequenceRow<TranslatorCase>{translator_sequence_role, run_translator_sequence}});
}

}  // namespace fieldproof::conformance
