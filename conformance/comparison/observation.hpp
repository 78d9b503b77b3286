#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/judging.hpp"
#include "harness/kernel/time.hpp"

// What the testers of a bench saw of one station, and how that of an implementation under test is compared
// with that of references.
//
// The references run on lines of their own, at the extremes that the standard allows. What all of them do is
// required. Events (frames, indications) are compared one by one, in their order; where the extremes disagree
// nobody can say what is right. Levels (process outputs) are compared by instant: admissible is what any
// extreme shows within a window around it.
namespace fieldproof::conformance {

struct Observation {
  std::vector<std::int64_t> values;
  kernel::Time when{};
};

using Observations = std::vector<Observation>;

// A kind of events, with the reasons of its findings.
struct EventKind {
  std::string_view name;       // "requests"
  std::string_view missing;    // the references do it, the implementation does not
  std::string_view surplus;    // the implementation does it, the references do not
  std::string_view different;  // both, with other values
  std::string (*text)(std::span<const std::int64_t> values);
};

// Compares the events of the implementation with those of each extreme, from the first on; the first that
// differs is a finding. `is_settled`: all that was due has come; before that, what is still missing on either
// side is no finding. False: the extremes disagree.
bool compare_events(const EventKind& kind, std::span<const Observation> iut,
                    std::span<const Observations> extremes, bool is_settled, CaseJudge& judge);

// The values of one process output, each from its instant on.
class LevelHistory {
 public:
  explicit LevelHistory(std::int64_t value = 0, kernel::Time from = kernel::kStart) { begin(value, from); }

  // Forgets what was before.
  void begin(std::int64_t value, kernel::Time from);
  // Instants never decrease.
  void set(std::int64_t value, kernel::Time when);
  std::int64_t at(kernel::Time when) const;
  // All values that it has within these two instants.
  std::vector<std::int64_t> within(kernel::Time from, kernel::Time to) const;

  struct Step {
    kernel::Time from;
    std::int64_t value;
  };
  std::span<const Step> steps() const { return steps_; }

 private:
  std::vector<Step> steps_;  // the first is what it began with
};

struct LevelKind {
  std::string_view unasked;    // it changes, and no extreme does
  std::string_view different;  // it changes, and the extremes change to something else
  std::string_view not_taken;  // it stays, and the extremes have changed
  kernel::Duration earlier{};  // by which it may change before an extreme
  kernel::Duration later{};    // and after it
  kernel::Duration skew{};     // changes that follow each other so closely are one
  std::string (*text)(std::int64_t value);
};

// Where one is none of those that are admissible.
struct LevelMismatch {
  kernel::Time when{};
  std::int64_t value = 0;
  std::vector<std::int64_t> allowed;
  bool is_change = false;  // it changes to this one then; else it stays
};

// The first one in (from, to]. The extremes must be known until `to` + `earlier`.
std::optional<LevelMismatch> first_mismatch(const LevelKind& kind, const LevelHistory& iut,
                                            std::span<const LevelHistory> extremes, kernel::Time from,
                                            kernel::Time to);
[[noreturn]] void fail_level(const LevelKind& kind, const LevelMismatch& mismatch, CaseJudge& judge);

}  // namespace fieldproof::conformance
