// What a verdict means to a server that knows less words than ISO/IEC 9646: passed, failed, an error,
// skipped.
//
// Contract: inconclusive and none never pass, whatever the rules say. A failure that the baseline expects,
// and a case that does not apply, are skipped. What is wrong with a run that none of its cases tells (it is
// incomplete, its baseline is not current) is a complaint: a test of its own, without which the cases that
// were never judged would look like cases that were never asked for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "reports/results.hpp"

namespace fieldproof::reports {

enum class Outcome : std::uint8_t { passed, failure, error, skipped };

enum class InconclusiveAs : std::uint8_t { error, failure, skipped };

struct OutcomeRules {
  InconclusiveAs inconclusive = InconclusiveAs::error;
  bool is_strict = false;  // a warn is a failure
};

Outcome outcome_of(const judge::CaseResult& result, const OutcomeRules& rules);

// One line: why the case is what it is; empty for most that pass. Not escaped.
std::string outcome_message(const judge::CaseResult& result);
// The same with its verdict: "fail: no_answer".
std::string verdict_message(const judge::CaseResult& result);

struct Complaint {
  std::string_view name;  // "is_complete"
  std::string_view type;
  std::string text;
  Outcome outcome = Outcome::failure;
};
// The suite that complaints stand in, as if it were a folder of cases.
inline constexpr std::string_view kComplaintSuite = "fieldproof.run";
std::vector<Complaint> complaints_about(const Run& run, const OutcomeRules& rules);

}  // namespace fieldproof::reports
