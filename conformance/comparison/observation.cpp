#include "conformance/comparison/observation.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {
namespace {

bool extremes_agree(std::span<const Observations> extremes, std::size_t n) {
  const auto has = [&](const Observations& one) { return one.size() > n; };
  const bool is_done = has(extremes.front());
  return std::ranges::all_of(extremes, [&](const Observations& one) {
    return has(one) == is_done && (!is_done || one[n].values == extremes.front()[n].values);
  });
}

std::set<std::int64_t> admissible(std::span<const LevelHistory> extremes, kernel::Time from,
                                  kernel::Time to) {
  std::set<std::int64_t> values;
  for (const LevelHistory& one : extremes) {
    for (const std::int64_t value : one.within(from, to)) values.insert(value);
  }
  return values;
}

}  // namespace

bool compare_events(const EventKind& kind, std::span<const Observation> iut,
                    std::span<const Observations> extremes, bool is_settled, CaseJudge& judge) {
  FIELDPROOF_CHECK(!extremes.empty(), "something is compared with a reference at least");
  const Observations& first = extremes.front();
  for (std::size_t n = 0;; ++n) {
    const bool is_seen = n < iut.size();
    const bool is_due = n < first.size();
    if (!extremes_agree(extremes, n)) return false;
    if (is_seen && is_due) {
      judge.expect(iut[n].values == first[n].values, kind.different, [&] {
        return Mismatch{{kind.text(first[n].values)}, kind.text(iut[n].values), iut[n].when};
      });
      continue;
    }
    if (!is_settled || (!is_seen && !is_due)) return true;
    if (is_due)
      judge.fail(kind.missing, {{kind.text(first[n].values)}, fmt::format("no more {}", kind.name)});
    judge.fail(kind.surplus, {{fmt::format("no more {}", kind.name)}, kind.text(iut[n].values), iut[n].when});
  }
}

void LevelHistory::begin(std::int64_t value, kernel::Time from) {
  steps_.assign(1, {from, value});
}

void LevelHistory::set(std::int64_t value, kernel::Time when) {
  steps_.push_back({std::max(when, steps_.back().from), value});
}

std::int64_t LevelHistory::at(kernel::Time when) const {
  return within(when, when).back();
}

std::vector<std::int64_t> LevelHistory::within(kernel::Time from, kernel::Time to) const {
  const auto is_after = [](kernel::Time time, const Step& step) { return time < step.from; };
  auto first = std::upper_bound(steps_.begin(), steps_.end(), from, is_after);
  if (first != steps_.begin()) --first;
  std::vector<std::int64_t> values;
  for (; first != steps_.end() && (first->from <= to || values.empty()); ++first)
    values.push_back(first->value);
  return values;
}

std::optional<LevelMismatch> first_mismatch(const LevelKind& kind, const LevelHistory& iut,
                                            std::span<const LevelHistory> extremes, kernel::Time from,
                                            kernel::Time to) {
  const auto is_judged = [&](kernel::Time when) { return when > from && when <= to; };
  // Where it changes, and where what an extreme has changed must have been taken.
  std::map<kernel::Time, bool> instants{{to, false}};
  for (const LevelHistory& one : extremes) {
    for (const LevelHistory::Step& step : one.steps()) {
      const kernel::Time latest = step.from + kind.later;
      if (is_judged(latest)) instants[latest];
    }
  }
  const auto steps = iut.steps();
  for (std::size_t n = 1; n < steps.size(); ++n) {
    const bool goes_on = n + 1 < steps.size() && steps[n + 1].from - steps[n].from <= kind.skew;
    if (!goes_on && is_judged(steps[n].from)) instants[steps[n].from] = true;
  }
  for (const auto& [when, is_change] : instants) {
    const auto allowed = admissible(extremes, when - kind.later, when + kind.earlier);
    const std::int64_t value = iut.at(when);
    if (allowed.contains(value)) continue;
    return LevelMismatch{when, value, {allowed.begin(), allowed.end()}, is_change};
  }
  return std::nullopt;
}

void fail_level(const LevelKind& kind, const LevelMismatch& mismatch, CaseJudge& judge) {
  std::string expected;
  for (const std::int64_t one : mismatch.allowed)
    expected += (expected.empty() ? "" : " or ") + kind.text(one);
  const std::string_view changed = mismatch.allowed.size() > 1 ? kind.different : kind.unasked;
  judge.fail(mismatch.is_change ? changed : kind.not_taken,
             {{expected}, kind.text(mismatch.value), mismatch.when});
}

}  // namespace fieldproof::conformance
