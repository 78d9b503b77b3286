// The result of a case as JSON, the one dissector of the journal, of results.json and of everything that
// reads them.
//
// Contract: every member of CaseResult is written and read back. 64-bit integers are strings, because most
// readers of JSON keep 53 bits: decimal ("1000000"), the fingerprint as 16 hexadecimal digits. Doubles are
// numbers in shortest form that reads back equal; what is no number is the string "nan", "inf" or "-inf".
// Text is made valid UTF-8 (untrusted_text.hpp); valid text reads back equal. Keys stand in a fixed order, so
// equal results are equal bytes. A reader skips keys that it does not know (the schema grows additively) and
// throws kernel::Error(configuration) with file, line, pointer and what would be right for what it cannot
// read.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/judge/finding.hpp"

namespace fieldproof::judge {

// Results of equal runs differ in the wall time only: `apart` leaves it out.
enum class WallTime { included, apart };

nlohmann::ordered_json to_json(const CaseResult& result, WallTime wall_time);

CaseResult case_result_from(const config::Value& value);

// The pieces that documents share.
nlohmann::ordered_json number_to_json(double value);
std::string fingerprint_text(std::uint64_t fingerprint);  // 16 lower-case hexadecimal digits
std::uint64_t unsigned_from(const config::Value& value, int base = 10);
Verdict verdict_from(const config::Value& value);
std::vector<std::string> texts_from(const config::Value& value);

}  // namespace fieldproof::judge
