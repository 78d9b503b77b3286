// The judge of one run of one test case: a procedure tells it what was seen and what is required, it keeps
// the findings and the measurements and makes the result.
//
// Contract: the first finding that fails (or is inconclusive) ends the procedure by throwing CaseEnded, which
// `run_procedure` catches; a warning and a measurement do not end it. A case without a finding passes.
// A finding rests on the source of the case, or on that of the detail that its reason belongs to
// (TestCase::details); a failure rests on what its finding rests on, a pass on all of them.
// What the attachment of the implementation cannot do (iut::CannotBeDone) makes the case not applicable.
// Expectations that stand in a loop should describe themselves by a callable: it is only called when the
// expectation does not hold.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/judge/finding.hpp"
#include "harness/kernel/time.hpp"

namespace fieldproof::conformance {

// Thrown by the judge to end a procedure; no error of the bench.
struct CaseEnded {};

// What was seen where something else was required.
struct Mismatch {
  std::vector<std::string> expected;  // every admissible observation
  std::string actual;
  std::optional<kernel::Time> time{};  // of the observation; the judge's clock when absent
  std::string first_difference{};      // field and position, may be empty
  std::vector<std::string> decode{};   // layered: levels, telegrams, cycle, fields; may be empty
};

class CaseJudge {
 public:
  // `test_case` must outlive the judge.
  explicit CaseJudge(const TestCase& test_case) : test_case_(test_case) {}
  CaseJudge(const CaseJudge&) = delete;
  CaseJudge& operator=(const CaseJudge&) = delete;

  // The time of findings that bring none; zero without a clock.
  void use_clock(std::function<kernel::Time()> clock) { clock_ = std::move(clock); }
  // Decode lines for findings that bring none, of what happened around their instants.
  void use_decode(std::function<std::vector<std::string>(kernel::Time)> decode) {
    decode_ = std::move(decode);
  }

  // Is given each step as it begins, to mark it on the time line.
  void use_steps(std::function<void(const std::string&)> on_step) { on_step_ = std::move(on_step); }

  // What the case does from here on, "2 of 5: the node is polled again"; findings name it. An
  // empty text: it is through with its steps.
  void begin_step(const std::string& text);

  template <typename Describe>
    requires std::is_invocable_r_v<Mismatch, Describe>
  void expect(bool holds, std::string_view reason, Describe&& describe) {
    if (!holds) fail(reason, std::forward<Describe>(describe)());
  }
  void expect(bool holds, std::string_view reason, std::string_view expected, std::string_view actual) {
    if (!holds) fail(reason, {{std::string(expected)}, std::string(actual)});
  }
  // `what` names the thing that is compared: "stations found".
  template <typename Actual, typename Expected>
  void expect_equal(const Actual& actual, const Expected& expected, std::string_view reason,
                    std::string_view what) {
    if (actual == static_cast<Actual>(expected)) return;
    fail(reason, {{fmt::format("{}: {}", what, expected)}, fmt::format("{}: {}", what, actual)});
  }
  // Keeps the measurement and fails when it lies outside of [low, high].
  void expect_between(std::string_view name, std::string_view unit, double value, double low, double high,
                      std::string_view reason);

  [[noreturn]] void fail(std::string_view reason, Mismatch sighting);
  // The run could not show what was to be judged.
  [[noreturn]] void inconclusive(std::string_view reason, Mismatch sighting);
  void warn(std::string_view reason, Mismatch sighting);
  void measure(std::string_view name, std::string_view unit, double value);

  // Runs the procedure up to its end or to the finding that ends it. Gives the result with verdict, reason,
  // findings, measurements, requirement and reference; seed, fingerprint and times are the suite's to fill.
  judge::CaseResult run_procedure(const std::function<void(CaseJudge&)>& procedure);

 private:
  void add(judge::Verdict verdict, std::string_view reason, Mismatch sighting);

  const TestCase& test_case_;
  std::function<kernel::Time()> clock_;
  std::function<std::vector<std::string>(kernel::Time)> decode_;
  std::function<void(const std::string&)> on_step_;
  std::string step_;
  std::vector<judge::Finding> findings_;
  std::vector<judge::Measurement> measurements_;
};

}  // namespace fieldproof::conformance
