#include "conformance/valve_bus/suite.hpp"

#include <array>
#include <map>

#include "conformance/case_recorder.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/host_sequence.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/node_sequence.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/dissector.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/host_settings.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/node_settings.hpp"

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
    mutants_ = node_mutants().mutants();
    for (Mutant& one : host_mutants().mutants()) mutants_.push_back(std::move(one));
  }

  std::string_view protocol() const override { return "valve_bus"; }
  std::vector<std::string> roles() const override { return {"node", "host"}; }
  bool has_own(std::string_view role) const override {
    return role == "node" ? bool(given_.own_node) : role == "host" && bool(given_.own_host);
  }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Mutant>& mutants() const override { return mutants_; }
  std::vector<judge::PicsItem> pics_items() const override {
    std::vector<judge::PicsItem> all = node_pics_items();
    for (judge::PicsItem& item : host_pics_items()) all.push_back(std::move(item));
    return all;
  }

  std::vector<field::NamedTable> tables() const override {
    return {{"node", &valve_bus::kNodeTable},
            {"host", &valve_bus::kHostTable},
            {"rules", &valve_bus::kRulesTable}};
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
    if (!setup.playback_file.empty()) return;
    CaseDevices devices(test_case, setup, given_.attach);
    if (is_of_host(test_case)) {
      host_setting(test_case, setup, devices).make_host(host_configuration({}, declared_host()));
    } else {
      node_setting(test_case, setup, devices).make_node(node_configuration({}, declared_node()));
    }
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    if (is_of_host(test_case)) return run_host(*host_cases_.at(test_case.id), setup);
    return run_node(*node_cases_.at(test_case.id), setup);
  }

  std::span<const SequenceRole> sequence_roles() const override {
    static const std::array roles{node_sequence_role(), host_sequence_role()};
    return roles;
  }
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence,
                       const Setup& setup) const override {
    if (role.test_case.role() == "host") {
      const HostCase one{role.test_case, [&sequence](HostBench& bench, CaseJudge& judge) {
                           run_host_sequence(sequence, bench, judge);
                         }};
      return run_host(one, setup);
    }
    return run_node(
        {role.test_case,
         [&sequence](NodeBench& bench, CaseJudge& judge) { run_node_sequence(sequence, bench, judge); }},
        setup);
  }

 private:
  Outcome run_host(const HostCase& host_case, const Setup& setup) const {
    CaseDevices devices(host_case.test_case, setup, given_.attach);
    return run_recorded(host_case, host_setting(host_case.test_case, setup, devices), devices, setup.record);
  }

  // What happens on a real line never happens again: it is always recorded.
  Outcome run_node(const NodeCase& node_case, const Setup& setup) const {
    CaseDevices devices(node_case.test_case, setup, given_.attach);
    const bool is_once = on_real_line(node_case.test_case, setup).has_value();
    Outcome outcome = run_recorded(node_case, node_setting(node_case.test_case, setup, devices), devices,
                                   setup.record || is_once);
    outcome.happens_once = is_once;
    return outcome;
  }

  template <typename Case, typename Setting>
  static Outcome run_recorded(const Case& one, Setting setting, CaseDevices& devices, bool is_recorded) {
    CaseRecorder recorder;
    if (is_recorded) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const valve_bus::Rules& rules) {
        return &recorder.start(trace, std::make_shared<valve_bus::FrameDissector>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_on_bench(one, setting);
    recorder.keep(outcome);
    devices.keep(outcome);
    return outcome;
  }

  std::optional<judge::Pics> on_real_line(const TestCase& test_case, const Setup& setup) const {
    return given_.on_real_line ? given_.on_real_line(assigned_to(test_case, setup).uri) : std::nullopt;
  }

  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  bool is_of_host(const TestCase& test_case) const { return test_case.role() == "host"; }

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

  NodeSetting node_setting(const TestCase& test_case, const Setup& setup, CaseDevices& devices) const {
    NodeSetting setting = setting_of<NodeSetting>(setup);
    setting.pics = declared_pics(test_case, setup);
    setting.make_node = [this, &devices, uri = assigned_to(test_case, setup).uri](
                            const valve_bus::NodeConfiguration& configuration) {
      return devices.make<valve_bus::NodeRole>(
          uri, configuration, [&, uri](const auto& of) { return local_node(devices.request(uri), of); });
    };
    return setting;
  }

  HostSetting host_setting(const TestCase& test_case, const Setup& setup, CaseDevices& devices) const {
    HostSetting setting = setting_of<HostSetting>(setup);
    setting.make_host = [this, &devices, uri = assigned_to(test_case, setup).uri](
                            const valve_bus::HostConfiguration& configuration) {
      return devices.make<valve_bus::HostRole>(
          uri, configuration, [&, uri](const auto& of) { return local_host(devices.request(uri), of); });
    };
    return setting;
  }

  std::unique_ptr<valve_bus::NodeDevice> local_node(const IutRequest& wanted,
                                                    const valve_bus::NodeConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) return std::make_unique<valve_bus::Node>(configuration);
    if (wanted.uri == kOwnUri && given_.own_node) return given_.own_node(wanted, configuration);
    return node_mutants().make(mutant_of(wanted.uri, "node of the valve bus"), configuration);
  }

  std::unique_ptr<valve_bus::HostDevice> local_host(const IutRequest& wanted,
                                                    const valve_bus::HostConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) return std::make_unique<valve_bus::Host>(configuration);
    if (wanted.uri == kOwnUri && given_.own_host) return given_.own_host(wanted, configuration);
    return host_mutants().make(mutant_of(wanted.uri, "host of the valve bus"), configuration);
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
