#include "conformance/judging.hpp"

#include <algorithm>

#include "harness/fault/plan_work.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

void CaseJudge::add(judge::Verdict verdict, std::string_view reason, Mismatch sighting) {
  judge::Finding finding;
  finding.verdict = verdict;
  finding.reason = reason;
  finding.requirement = test_case_.requirement_of(reason);
  finding.reference = test_case_.reference_of(reason);
  finding.expected = std::move(sighting.expected);
  finding.actual = std::move(sighting.actual);
  if (sighting.time) {
    finding.time = *sighting.time;
  } else if (clock_) {
    finding.time = clock_();
  }
  finding.step = step_;
  finding.first_difference = std::move(sighting.first_difference);
  finding.decode = std::move(sighting.decode);
  if (finding.decode.empty() && decode_) finding.decode = decode_(finding.time);
  findings_.push_back(std::move(finding));
}

void CaseJudge::begin_step(const std::string& text) {
  step_ = text;
  if (on_step_ && !text.empty()) on_step_(text);
}

void CaseJudge::fail(std::string_view reason, Mismatch sighting) {
  add(judge::Verdict::fail, reason, std::move(sighting));
  throw CaseEnded{};
}

void CaseJudge::inconclusive(std::string_view reason, Mismatch sighting) {
  add(judge::Verdict::inconclusive, reason, std::move(sighting));
  throw CaseEnded{};
}

void CaseJudge::warn(std::string_view reason, Mismatch sighting) {
  add(judge::Verdict::warn, reason, std::move(sighting));
}

void CaseJudge::measure(std::string_view name, std::string_view unit, double value) {
  measurements_.push_back({std::string(name), std::string(unit), value, value, value});
}

void CaseJudge::expect_between(std::string_view name, std::string_view unit, double value, double low,
                               double high, std::string_view reason) {
  measurements_.push_back({std::string(name), std::string(unit), value, low, high});
  // Written so that a value that is no number fails.
  if (value >= low && value <= high) return;
  fail(reason, {{fmt::format("{} between {:.6g} and {:.6g} {}", name, low, high, unit)},
                fmt::format("{:.6g} {}", value, unit)});
}

judge::CaseResult CaseJudge::run_procedure(const std::function<void(CaseJudge&)>& procedure) {
  std::string cannot_be_done;
  try {
    procedure(*this);
  } catch (const CaseEnded&) {
    // The finding that ended it is kept.
  } catch (const iut::InDoubt& what) {
    add(judge::Verdict::inconclusive, "timing_in_doubt", {{"answers of the tester in time"}, what.what()});
  } catch (const iut::CannotBeDone& what) {
    cannot_be_done = what.what();
  } catch (const iut::Misbehaviour& done) {
    Mismatch sighting{{"an implementation that answers, in time and to the point"}, done.what()};
    sighting.decode = done.evidence();
    add(judge::Verdict::fail, done.reason(), std::move(sighting));
  } catch (const kernel::Error& failure) {
    if (failure.kind() != kernel::ErrorKind::implementation) throw;
    // It drives in the past, or has gone: nothing can be made of it, and that is its fault.
    add(judge::Verdict::fail, "implementation_misbehaves", {{"what the bench can serve"}, failure.what()});
  } catch (const fault::PlanTooHeavy& heavy) {
    add(judge::Verdict::inconclusive, "plan_too_heavy", {{"a run that ends"}, heavy.what()});
  }
  judge::CaseResult result;
  result.id = test_case_.id;
  result.purpose = test_case_.purpose;
  result.requirement = test_case_.requirement;
  result.reference = test_case_.rests_on();
  if (!cannot_be_done.empty()) {
    result.verdict = judge::Verdict::not_applicable;
    result.reason = cannot_be_done;
    return result;
  }
  result.verdict = judge::Verdict::pass;
  for (const judge::Finding& finding : findings_) {
    if (finding.verdict <= result.verdict) continue;
    result.verdict = finding.verdict;
    result.reason = finding.reason;
    // A warning ended nothing: the rest of the case holds, so its verdict rests on the rest, too.
    if (finding.verdict > judge::Verdict::warn) result.reference = finding.reference;
  }
  result.findings = std::move(findings_);
  result.measurements = std::move(measurements_);
  return result;
}

}  // namespace fieldproof::conformance
