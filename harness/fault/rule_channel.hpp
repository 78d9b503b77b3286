#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "harness/fault/arrivals.hpp"
#include "harness/fault/channel.hpp"
#include "harness/fault/condition.hpp"
#include "harness/fault/fields.hpp"
#include "harness/fault/plan_work.hpp"
#include "harness/fault/rule.hpp"
#include "harness/kernel/random.hpp"
#include "harness/trace/trace.hpp"

// The rules of an installed plan at one receiver. Made by InstalledPlan; rule.hpp says how rules work
// together.
//
// A transmission outside every window, and one for which every rule waits or is spent, costs a look at two
// instants; the map of the fields then only follows it, and is left alone when no rule can answer any more.
namespace fieldproof::fault {

// What all receivers share about one rule.
struct RuleState {
  const Rule* rule = nullptr;
  std::size_t number = 0;
  std::uint64_t hits = 0;
  std::vector<AfterState> afters;  // in the order of each_after

  bool is_spent() const { return hits >= rule->times; }
};

class RuleChannel final : public Channel {
 public:
  RuleChannel(trace::Trace& trace, trace::Channel place, std::unique_ptr<FieldMap> fields, PlanWork& work);

  // Takes the rule if it can mean this receiver at all. The state must not move afterwards.
  void add(RuleState& state, std::string_view receiver, const kernel::Random& random);
  bool has_rules() const { return !rules_.empty(); }

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

 private:
  struct BoundRule {
    RuleState* state;
    Condition condition;
    kernel::Random random;
    std::uint64_t weight;  // conditions to look at for one question
  };
  struct Claim {
    Piece part;
    const Effect* effect;
  };
  struct Interval {
    kernel::Time from;
    kernel::Time to;
  };

  kernel::Time ends_before(const line::Waveform& sent);
  bool can_answer(const line::Waveform& sent);
  void ask(BoundRule& bound, const line::Waveform& sent);
  void ask_about(BoundRule& bound, const Span& span, Piece part, const line::Waveform& sent);
  Piece part_of(const Rule& rule, std::size_t span, const line::Waveform& sent) const;
  bool is_claimed(Piece part) const;
  void enter(BoundRule& bound, const Span& span, Piece part, const line::Waveform& sent);
  void change_levels(const Rule& rule, Piece part, const line::Waveform& sent);
  line::Levels& levels_to_change(const line::Waveform& sent);
  void write(const line::Waveform& sent, line::Waveforms& arrivals);
  void forget_before(kernel::Time time);
  void settle(const line::Waveform& sent, line::Waveforms& arrivals, std::size_t first);
  void silence(line::Waveforms& arrivals, std::size_t first) const;
  void mute(Interval interval);

  trace::Trace& trace_;
  trace::Channel place_;
  PlanWork& work_;
  std::unique_ptr<FieldMap> fields_;
  std::vector<BoundRule> rules_;
  kernel::Time opens_ = kernel::kNever;            // the earliest begin of a window
  kernel::Time closes_{-kernel::Duration::max()};  // the latest end of a window

  std::int64_t known_rate_ = 0;
  kernel::Duration longest_level_{};  // at that rate

  // Of the transmission that passes.
  std::vector<Span> spans_;
  std::vector<Claim> claims_;  // ordered by part
  line::Waveform edited_;
  bool is_edited_ = false;
  Piece asked_;  // the part that the rule was asked about last

  // What reaches into later transmissions.
  std::vector<Interval> mutes_;     // ordered, none touches another
  std::vector<Interval> promised_;  // arrivals beyond the end of their transmission, ordered
};

}  // namespace fieldproof::fault
