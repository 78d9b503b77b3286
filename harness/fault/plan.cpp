#include "harness/fault/plan.hpp"

#include <utility>

#include "harness/fault/cases.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::fault {
namespace {

void check_when(const When& when) {
  FIELDPROOF_CHECK(when.chance >= 0.0 && when.chance <= 1.0, "the chance of a fault rule is from 0 to 1");
  FIELDPROOF_CHECK(when.frame.every > 0 && when.unit.every > 0 && when.bit.every > 0,
                   "a fault rule answers every first, second ... time, not every zeroth");
  for (const auto* inner : {&when.all_of, &when.any_of, &when.none_of}) {
    for (const When& condition : *inner) check_when(condition);
  }
}

void check_duration(kernel::Duration duration) {
  FIELDPROOF_CHECK(duration >= kernel::Duration{} && duration <= kLongestDuration,
                   "a duration of a fault rule is from nothing to 10^18 ps");
}

void check_rule(const Rule& rule) {
  check_when(rule.when);
  std::visit(Cases{
                 [](const Force& force) { check_duration(force.duration); },
                 [](const Delay& delay) { check_duration(delay.duration); },
                 [](const Repeat& repeat) { check_duration(repeat.gap); },
                 [](const Mute& mute) { check_duration(mute.duration); },
                 [](const auto&) {},
             },
             rule.effect);
}

}  // namespace

InstalledPlan::InstalledPlan(Plan plan, trace::Trace& trace, const kernel::Random& random,
                             std::uint64_t most_work)
    : plan_(std::move(plan)), trace_(trace), random_(random.split("fault plan")), work_(most_work) {
  for (const Rule& rule : plan_.rules()) {
    check_rule(rule);
    RuleState& state = states_.emplace_back();
    state.rule = &rule;
    state.number = states_.size() - 1;
    each_after(rule.when, [&](const After& after) { state.afters.push_back({&after}); });
    waits_ = waits_ || !state.afters.empty();
  }
  if (waits_) trace_.add_observer(*this);
}

InstalledPlan::~InstalledPlan() {
  if (waits_) trace_.remove_observer(*this);
}

Channel* InstalledPlan::channel_for(std::string_view receiver, trace::Channel place,
                                    std::unique_ptr<FieldMap> fields) {
  auto channel = std::make_unique<RuleChannel>(trace_, place, std::move(fields), work_);
  const kernel::Random of_receiver = random_.split(receiver);
  for (RuleState& state : states_) channel->add(state, receiver, of_receiver.split(state.number));
  if (!channel->has_rules()) return nullptr;
  return channels_.emplace_back(std::move(channel)).get();
}

std::uint64_t InstalledPlan::hits(std::size_t rule) const {
  return states_.at(rule).hits;
}

void InstalledPlan::on_observation(trace::Channel channel, kernel::Time time, std::string_view what,
                                   std::uint64_t) {
  for (RuleState& state : states_) {
    work_.spend(state.afters.size());
    for (AfterState& wait : state.afters) {
      if (!fits(wait.after->observation, what)) continue;
      if (!fits(wait.after->channel, trace_.channel_name(channel))) continue;
      if (++wait.seen == wait.after->nth) wait.since = time;
    }
  }
}

}  // namespace fieldproof::fault
