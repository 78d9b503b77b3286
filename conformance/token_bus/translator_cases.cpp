#include "conformance/token_bus/translator_cases.hpp"

#include <array>

namespace fieldproof::conformance {
namespace {

TranslatorCase translator_canary() {
  return {canary_of("token_bus/translator", token_sources::own("rules of the suite"), "A preamble.",
                    "the case asks for a symbol that no translator indicates."),
          [](TranslatorBench& bench, CaseJudge& judge) {
            bench.carry("10101010");
            bench.settle();
            judge.expect(bench.indicated().text().find('P') != std::string::npos, "canary", "pad_idle",
                         "none");
          }};
}

const std::vector<PartialSource>& translator_details() {
  static const std::vector<PartialSource> details{
      {token_sources::own("what stands between a symbol and what becomes of it"),
       {"sent_too_late", "indicated_too_late"}},
      {token_sources::own("what goes on after something else"), {"does_not_recover"}}};
  return details;
}

}  // namespace

const std::vector<TranslatorCase>& translator_cases() {
  static const std::vector<TranslatorCase> cases = [] {
    static constexpr std::array kChapters{
        translator_encoding_cases,   translator_vocabulary_cases, translator_locking_cases,
        translator_phase_cases,      translator_decoding_cases,   translator_blanking_cases,
        translator_pair_cases,       translator_end_cases,        translator_mask_cases,
        translator_management_cases, translator_command_cases,    translator_jabber_cases,
        translator_settings_cases};
    auto all = cases_of<TranslatorCase>(kChapters, translator_details());
    all.push_back(translator_canary());
    return all;
  }();
  return cases;
}

}  // namespace fieldproof::conformance
