#include "conformance/valve_bus/suite.hpp"

#include <map>

#include "conformance/assigned.hpp"
#include "conformance/case_recorder.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/node_sequence.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/dissector.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

class ValveBusSuite final : public Suite {
 public:
  explicit ValveBusSuite(ValveBusGiven given) : given_(std::move(given)) {
    for (const NodeCase& one : node_cases()) {
      if (given_.stresses.empty() && has_tag(one.test_case, kStressTag)) continue;
      cases_.push_back(one.test_case);
      node_cases_[one.test_case.id] = &one;
    }
    for (const HostCase& one : host_cases()) {
      if (given_.stresses.empty() && has_tag(one.test_case, kStressTag)) continue;
      cases_.push_back(one.test_case);
      host_cases_[one.test_case.id] = &one;
    }
    mutants_ = node_mutants();
    mutants_.insert(mutants_.end(), host_mutants().begin(), host_mutants().end());
  }

  std::string_view protocol() const override { return "valve_bus"; }
  std::vector<std::string> roles() const override { return {"node", "host"}; }
  bool has_own(std::string_view role) const override {
    return role == "node" ? bool(given_.node.own) : role == "host" && bool(given_.host.own);
  }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Mutant>& mutants() const override { return mutants_; }
  std::vector<judge::PicsItem> pics_items() const override {
    std::vector<judge::PicsItem> all = node_pics_items();
    for (judge::PicsItem& item : host_pics_items()) all.push_back(std::move(item));
    return all;
  }

  std::vector<std::string> caveats(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<std::string>{} : load(setup).caveats();
  }
  std::vector<fault::PlanPart> plan_parts(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<fault::PlanPart>{} : load(setup).parts();
  }

  std::optional<judge::Pics> declared_pics(const TestCase& test_case, const Setup& setup) const override {
    if (auto of_line = on_real_line(test_case, setup))
      return setup.pics ? setup.pics->completed_by(*of_line) : of_line;
    return setup.pics;
  }

  void check(const TestCase& test_case, const Setup& setup) const override {
    if (!setup.network_file.empty()) {
      throw kernel::Error(kernel::ErrorKind::usage,
                          "cases of the valve bus make the line that they need; leave out the network, and "
                          "say in a PICS what the implementation is");
    }
    if (is_of_host(test_case)) {
      host_setting(test_case, setup).make_host(host_configuration({}, declared_host()));
    } else {
      node_setting(test_case, setup).make_node(node_configuration({}, declared_node()));
    }
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    if (is_of_host(test_case)) {
      return run_recorded(*host_cases_.at(test_case.id), host_setting(test_case, setup), setup.record);
    }
    return run_node(*node_cases_.at(test_case.id), setup);
  }

  std::span<const SequenceRole> sequence_roles() const override {
    return std::span(&node_sequence_role(), 1);
  }
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence,
                       const Setup& setup) const override {
    const auto procedure = [&sequence](NodeBench& bench, CaseJudge& judge) {
      run_node_sequence(sequence, bench, judge);
    };
    return run_node({role.test_case, procedure}, setup);
  }

 private:
  // What happens on a real line never happens again: it is always recorded.
  Outcome run_node(const NodeCase& node_case, const Setup& setup) const {
    const bool is_once = on_real_line(node_case.test_case, setup).has_value();
    Outcome outcome =
        run_recorded(node_case, node_setting(node_case.test_case, setup), setup.record || is_once);
    outcome.happens_once = is_once;
    return outcome;
  }

  template <typename Case, typename Setting>
  static Outcome run_recorded(const Case& one, Setting setting, bool is_recorded) {
    CaseRecorder recorder;
    if (is_recorded) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const valve_bus::Rules& rules) {
        return &recorder.start(trace, std::make_shared<valve_bus::FrameDissector>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_on_bench(one, setting);
    recorder.keep(outcome);
    return outcome;
  }

  std::optional<judge::Pics> on_real_line(const TestCase& test_case, const Setup& setup) const {
    return given_.on_real_line ? given_.on_real_line(assigned_to(test_case, setup).uri) : std::nullopt;
  }

  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  bool is_of_host(const TestCase& test_case) const { return host_cases_.contains(test_case.id); }

  // What the setup says, of either role.
  template <typename Setting>
  Setting setting_of(const Setup& setup) const {
    Setting setting;
    setting.seed = setup.seed;
    setting.volume = setup.volume;
    setting.pics = setup.pics;
    setting.stresses = given_.stresses;
    if (!setup.plan_file.empty()) setting.plan = load(setup);
    return setting;
  }

  NodeSetting node_setting(const TestCase& test_case, const Setup& setup) const {
    NodeSetting setting = setting_of<NodeSetting>(setup);
    setting.pics = declared_pics(test_case, setup);
    setting.make_node = [this, uri = assigned_to(test_case, setup).uri, id = test_case.id, seed = setup.seed,
                         limits = setup.limits](const valve_bus::NodeConfiguration& configuration) {
      return make_node({uri, id, seed, limits}, configuration);
    };
    return setting;
  }

  HostSetting host_setting(const TestCase& test_case, const Setup& setup) const {
    HostSetting setting = setting_of<HostSetting>(setup);
    setting.make_host = [this, uri = assigned_to(test_case, setup).uri, id = test_case.id, seed = setup.seed,
                         limits = setup.limits](const valve_bus::HostConfiguration& configuration) {
      return make_host({uri, id, seed, limits}, configuration);
    };
    return setting;
  }

  std::unique_ptr<valve_bus::NodeDevice> make_node(const IutRequest& wanted,
                                                   const valve_bus::NodeConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) return std::make_unique<valve_bus::Node>(configuration);
    if (auto node = given_.node.make(wanted, configuration)) return node;
    return make_node_mutant(mutant_of(wanted.uri, "node of the valve bus"), configuration);
  }

  std::unique_ptr<valve_bus::HostDevice> make_host(const IutRequest& wanted,
                                                   const valve_bus::HostConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) return std::make_unique<valve_bus::Host>(configuration);
    if (auto host = given_.host.make(wanted, configuration)) return host;
    return make_host_mutant(mutant_of(wanted.uri, "host of the valve bus"), configuration);
  }

  ValveBusGiven given_;
  std::vector<TestCase> cases_;
  std::vector<Mutant> mutants_;
  std::map<std::string, const NodeCase*, std::less<>> node_cases_;
  std::map<std::string, const HostCase*, std::less<>> host_cases_;
};

}  // namespace

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given) {
  return std::make_unique<ValveBusSuite>(std::move(given));
}

}  // namespace fieldproof::conformance
