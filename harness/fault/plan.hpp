#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/fault/channel.hpp"
#include "harness/fault/channel_chain.hpp"
#include "harness/fault/disturbance.hpp"
#include "harness/fault/fields.hpp"
#include "harness/fault/plan_part.hpp"
#include "harness/fault/plan_work.hpp"
#include "harness/fault/rule.hpp"
#include "harness/fault/rule_channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/trace/trace.hpp"

// A fault plan is a list of rules and of disturbances. As a value it can be read from a file (plan_file.hpp),
// written and hashed; installed on the trace of a segment it makes one channel per receiver and keeps what
// the rules remember: hits, observations, random streams.
namespace fieldproof::fault {

class Plan {
 public:
  Plan() = default;
  explicit Plan(std::vector<Rule> rules) : rules_(std::move(rules)) {}

  // Rules are asked in the order in which they were added; so are disturbances, after them.
  Plan& add(Rule rule) {
    rules_.push_back(std::move(rule));
    return *this;
  }
  Plan& add(Disturbance disturbance) {
    disturbances_.push_back(std::move(disturbance));
    return *this;
  }
  const std::vector<Rule>& rules() const { return rules_; }
  const std::vector<Disturbance>& disturbances() const { return disturbances_; }
  bool empty() const { return rules_.empty() && disturbances_.empty(); }
  // Rules, then disturbances.
  std::vector<PlanPart> parts() const;
  // Those of the disturbances, each once.
  std::vector<std::string> caveats() const;

  friend bool operator==(const Plan&, const Plan&) = default;

 private:
  std::vector<Rule> rules_;
  std::vector<Disturbance> disturbances_;
};

// Rules with their memory, for one segment and one run. Deterministic: the random stream of a rule at a
// receiver depends on the seed, the name of the receiver and the place of the rule, not on what other rules
// and receivers draw. A disturbance has one stream for all its receivers, as one generator has: what each of
// them draws for itself its model splits by the name of the receiver.
class InstalledPlan final : private trace::Observer {
 public:
  // `random` is split, not drawn from. The trace must outlive the plan. A plan that makes more than
  // `most_work` of the run ends it (see plan_work.hpp).
  InstalledPlan(Plan plan, trace::Trace& trace, const kernel::Random& random,
                std::uint64_t most_work = PlanWork::kMostSteps);
  ~InstalledPlan() override;

  // Who asks for a channel.
  struct Receiver {
    std::string_view name;
    trace::Channel place;       // hits are told to the trace here
    std::int64_t bit_rate = 0;  // of what it expects; disturbances must know it
  };

  // The channel of a receiver, for `Link::set_channel`; null when nothing of the plan can ever mean it.
  // Without a map each transmission is a frame (see TransmissionFields). The channel lives as long as the
  // plan.
  Channel* channel_for(const Receiver& receiver, std::unique_ptr<FieldMap> fields = nullptr);

  const Plan& plan() const { return plan_; }
  // How often rule number `rule` has hit: a rule that forces a level that stands already hits too.
  std::uint64_t hits(std::size_t rule) const;
  // How many waves disturbance number `disturbance` has changed, at all receivers.
  std::uint64_t changes(std::size_t disturbance) const { return changes_.at(disturbance); }
  // Both, in the order of `Plan::parts`.
  std::vector<std::uint64_t> hits_of_parts() const;

 private:
  void on_observation(trace::Channel channel, kernel::Time time, std::string_view what,
                      std::uint64_t value) override;
  void add_disturbances(const Receiver& receiver, ChannelChain& chain);

  const Plan plan_;
  trace::Trace& trace_;
  kernel::Random random_;
  std::deque<RuleState> states_;                    // channels point into it
  std::deque<std::uint64_t> changes_;               // of each disturbance; channels point into it
  PlanWork work_;                                   // of all receivers
  bool waits_ = false;                              // some rule waits for an observation
  std::vector<std::unique_ptr<Channel>> channels_;  // of the receivers, and what their chains lead through
};

}  // namespace fieldproof::fault
