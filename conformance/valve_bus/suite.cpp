#include "conformance/valve_bus/suite.hpp"

#include <map>

#include "conformance/assigned.hpp"
#include "conformance/case_recorder.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_deviations.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/notation.hpp"

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
  }

  std::string_view protocol() const override { return "valve_bus"; }
  std::vector<std::string> roles() const override { return {"node"}; }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Deviation>& deviations() const override { return node_deviations(); }
  std::vector<judge::PicsItem> pics_items() const override { return node_pics_items(); }

  std::vector<std::string> caveats(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<std::string>{} : load(setup).caveats();
  }
  std::vector<fault::PlanPart> plan_parts(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<fault::PlanPart>{} : load(setup).parts();
  }

  void check(const TestCase& test_case, const Setup& setup) const override {
    if (!setup.network_file.empty()) {
      throw kernel::Error(kernel::ErrorKind::usage,
                          "cases for a node of the valve bus make the line that they need; leave out the "
                          "network, and say in a PICS what the node is");
    }
    const NodeSetting setting = setting_of(test_case, setup);
    setting.make_node(node_configuration({}, declared_node()));
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    NodeSetting setting = setting_of(test_case, setup);
    CaseRecorder recorder;
    if (setup.record) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const valve_bus::Rules& rules) {
        return &recorder.start(trace, std::make_shared<valve_bus::FrameNotation>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_node_case(*node_cases_.at(test_case.id), setting);
    recorder.keep(outcome);
    return outcome;
  }

 private:
  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  NodeSetting setting_of(const TestCase& test_case, const Setup& setup) const {
    NodeSetting setting;
    setting.seed = setup.seed;
    setting.volume = setup.volume;
    setting.pics = setup.pics;
    setting.stresses = given_.stresses;
    if (!setup.plan_file.empty()) setting.plan = load(setup);
    setting.make_node = [this, uri = assigned_to(test_case, setup).uri, id = test_case.id,
                         seed = setup.seed](const valve_bus::NodeConfiguration& configuration) {
      return make_node({uri, id, seed}, configuration);
    };
    return setting;
  }

  std::unique_ptr<valve_bus::NodeDevice> make_node(const ValveBusGiven::Wanted& wanted,
                                                   const valve_bus::NodeConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) return std::make_unique<valve_bus::Node>(configuration);
    if (given_.make_node) {
      if (auto node = given_.make_node(wanted, configuration)) return node;
    }
    return make_node_deviation(deviation_of(wanted.uri, "node of the valve bus"), configuration);
  }

  ValveBusGiven given_;
  std::vector<TestCase> cases_;
  std::map<std::string, const NodeCase*, std::less<>> node_cases_;
};

}  // namespace

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given) {
  return std::make_unique<ValveBusSuite>(std::move(given));
}

}  // namespace fieldproof::conformance
