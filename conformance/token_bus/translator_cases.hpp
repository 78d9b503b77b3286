#pragma once

#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/token_bus/station_sources.hpp"
#include "conformance/token_bus/translator_bench.hpp"

// The test cases for a physical layer service translator, PST-01 to PST-15 and PST-18 of the catalogue of
// test purposes and what a user of one would miss.
namespace fieldproof::conformance {

using TranslatorCase = BenchCase<TranslatorBench, TranslatorNeeds>;

const std::vector<TranslatorCase>& translator_cases();

// The chapters, each in its own file.
std::vector<TranslatorCase> translator_encoding_cases();
std::vector<TranslatorCase> translator_vocabulary_cases();
std::vector<TranslatorCase> translator_locking_cases();
std::vector<TranslatorCase> translator_phase_cases();
std::vector<TranslatorCase> translator_decoding_cases();
std::vector<TranslatorCase> translator_pair_cases();
std::vector<TranslatorCase> translator_blanking_cases();
std::vector<TranslatorCase> translator_end_cases();
std::vector<TranslatorCase> translator_mask_cases();
std::vector<TranslatorCase> translator_management_cases();
std::vector<TranslatorCase> translator_command_cases();
std::vector<TranslatorCase> translator_jabber_cases();
std::vector<TranslatorCase> translator_settings_cases();

}  // namespace fieldproof::conformance
