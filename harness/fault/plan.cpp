#include "harness/fault/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
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

void check_disturbance(const Disturbance& disturbance) {
  FIELDPROOF_CHECK(disturbance.model.make_channel != nullptr, "a disturbance has a model");
}

// A disturbance at one receiver, in its window.
class DisturbedReceiver final : public Channel {
 public:
  DisturbedReceiver(const Disturbance& disturbance, std::unique_ptr<Channel> channel, std::uint64_t& changes,
                    const trace::Trace& trace, PlanWork& work)
      : from_(disturbance.from),
        to_(disturbance.to),
        channel_(std::move(channel)),
        changes_(changes),
        trace_(trace),
        work_(work) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    if (sent.start < from_ || sent.start >= to_) return false;
    const std::uint64_t records = trace_.record_count();
    const std::size_t first = arrivals.size();
    const bool is_changed = channel_->pass(sent, arrivals);
    if (is_changed) ++changes_;
    spend(trace_.record_count() - records, arrivals, first);
    return is_changed;
  }

 private:
  // What it told, and what it made of the transmission.
  void spend(std::uint64_t told, const line::Waveforms& arrivals, std::size_t first) {
    constexpr std::uint64_t kStepsOfARecord = 16;
    std::uint64_t steps = 1 + kStepsOfARecord * told;
    for (std::size_t n = first; n < arrivals.size(); ++n) steps += arrivals[n].levels.word_count();
    work_.spend(steps);
  }

  kernel::Time from_;
  kernel::Time to_;
  std::unique_ptr<Channel> channel_;
  std::uint64_t& changes_;
  const trace::Trace& trace_;
  PlanWork& work_;
};

// Cut in front of a character of UTF-8, not within one.
std::string shortened(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  if (name.size() <= kLongest) return name;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end) + "...";
}

}  // namespace

std::vector<PlanPart> Plan::parts() const {
  std::vector<PlanPart> parts;
  const auto add = [&](std::string_view list, std::size_t n, const std::string& name) {
    parts.push_back({fmt::format("/{}/{}", list, n), shortened(name)});
  };
  for (std::size_t n = 0; n < rules_.size(); ++n) add("rules", n, rules_[n].name);
  for (std::size_t n = 0; n < disturbances_.size(); ++n) add("disturbances", n, disturbances_[n].name);
  return parts;
}

std::vector<std::string> Plan::caveats() const {
  std::vector<std::string> all;
  for (const Disturbance& disturbance : disturbances_) {
    for (const std::string& caveat : disturbance.model.caveats) {
      if (std::ranges::find(all, caveat) == all.end()) all.push_back(caveat);
    }
  }
  return all;
}

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
  for (const Disturbance& disturbance : plan_.disturbances()) check_disturbance(disturbance);
  changes_.resize(plan_.disturbances().size());
  if (waits_) trace_.add_observer(*this);
}

InstalledPlan::~InstalledPlan() {
  if (waits_) trace_.remove_observer(*this);
}

Channel* InstalledPlan::channel_for(const Receiver& receiver, std::unique_ptr<FieldMap> fields) {
  auto rules = std::make_unique<RuleChannel>(trace_, receiver.place, std::move(fields), work_);
  const kernel::Random of_receiver = random_.split(receiver.name);
  for (RuleState& state : states_) rules->add(state, receiver.name, of_receiver.split(state.number));
  auto chain = std::make_unique<ChannelChain>();
  if (rules->has_rules()) chain->add(*channels_.emplace_back(std::move(rules)));
  add_disturbances(receiver, *chain);
  if (chain->size() < 2) return chain->first();
  return channels_.emplace_back(std::move(chain)).get();
}

void InstalledPlan::add_disturbances(const Receiver& receiver, ChannelChain& chain) {
  const kernel::Random of_disturbances = random_.split("disturbances");
  for (std::size_t n = 0; n < plan_.disturbances().size(); ++n) {
    const Disturbance& disturbance = plan_.disturbances()[n];
    if (!fits(disturbance.receiver, receiver.name)) continue;
    FIELDPROOF_CHECK(receiver.bit_rate > 0, "a receiver that is disturbed has a bit rate");
    auto channel = disturbance.model.make_channel(
        {receiver.bit_rate, disturbance.from, of_disturbances.split(n), trace_, receiver.place});
    channels_.push_back(
        std::make_unique<DisturbedReceiver>(disturbance, std::move(channel), changes_[n], trace_, work_));
    chain.add(*channels_.back());
  }
}

std::uint64_t InstalledPlan::hits(std::size_t rule) const {
  return states_.at(rule).hits;
}

std::vector<std::uint64_t> InstalledPlan::hits_of_parts() const {
  std::vector<std::uint64_t> hits;
  for (const RuleState& state : states_) hits.push_back(state.hits);
  hits.insert(hits.end(), changes_.begin(), changes_.end());
  return hits;
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
