#include "conformance/fieldbus_dll/suite.hpp"

#include <array>
#include <map>
#include <string>

#include "conformance/case_recorder.hpp"
#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/ff_sequence.hpp"
#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_las_sequence.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/isa_sequence_check.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/embedded_schemas.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"
#include "protocols/fieldbus_dll/link_dissector.hpp"
#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::string_view kIsaDle = "isa_dle";
constexpr std::string_view kIsaLas = "isa_las";
constexpr std::string_view kFfDevice = "ff_device";
constexpr std::string_view kFfLas = "ff_las";
constexpr std::uint8_t kDleAddress = 0x21;
constexpr std::uint8_t kLasAddress = 0x10;

bool is_of_isa(std::string_view role) {
  return role == kIsaDle || role == kIsaLas;
}

class FieldbusDllSuite final : public Suite {
 public:
  explicit FieldbusDllSuite(FieldbusDllGiven given) : given_(std::move(given)), mutants_(isa_mutants()) {
    for (Mutant& one : ff_mutants()) mutants_.push_back(std::move(one));
    const auto is_left_out = [this](const TestCase& one) {
      return given_.stresses.empty() && has_tag(one, kStressTag);
    };
    for (const IsaCase& one : isa_cases()) {
      if (is_left_out(one.test_case)) continue;
      cases_.push_back(one.test_case);
      isa_cases_[one.test_case.id] = &one;
    }
    for (const FfCase& one : ff_cases()) {
      if (is_left_out(one.test_case)) continue;
      cases_.push_back(one.test_case);
      ff_cases_[one.test_case.id] = &one;
    }
  }

  std::string_view protocol() const override { return "fieldbus_dll"; }
  std::vector<std::string> roles() const override {
    return {std::string(kIsaDle), std::string(kIsaLas), std::string(kFfDevice), std::string(kFfLas)};
  }
  bool has_own(std::string_view role) const override {
    if (is_of_isa(role)) return bool(own_isa(role));
    return (role == kFfDevice || role == kFfLas) && bool(own_ff(role));
  }
  std::vector<field::NamedTable> tables() const override {
    using namespace fieldbus_dll;
    return {{"ff_device", &kFfTable}, {"ff_las", &kFfTable},        {"isa_dle", &kIsaTable},
            {"isa_las", &kIsaTable},  {"ff_rules", &kFfRulesTable}, {"isa_rules", &kIsaRulesTable}};
  }
  std::vector<field::NamedSchema> schemas() const override {
    return {{"token_network", fieldbus_dll::token_network_schema}};
  }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Mutant>& mutants() const override { return mutants_; }

  std::vector<std::string> caveats(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<std::string>{} : load(setup).caveats();
  }
  std::vector<fault::PlanPart> plan_parts(const Setup& setup) const override {
    return setup.plan_file.empty() ? std::vector<fault::PlanPart>{} : load(setup).parts();
  }

  void check(const TestCase& test_case, const Setup& setup) const override {
    if (!setup.network_file.empty()) {
      throw kernel::Error(kernel::ErrorKind::usage,
                          "cases of the data link make the link that they need; leave out the network");
    }
    if (!setup.playback_file.empty()) return;
    CaseDevices devices(test_case, setup, given_.attach);
    if (is_of_isa(test_case.role())) {
      isa_setting(test_case, setup, devices).make_station({});
    } else {
      ff_setting(test_case, setup, devices).make_station({});
    }
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    if (const auto isa = isa_cases_.find(test_case.id); isa != isa_cases_.end())
      return run_isa(*isa->second, setup);
    return run_ff(*ff_cases_.at(test_case.id), setup);
  }

  std::span<const SequenceRole> sequence_roles() const override {
    static const std::array roles{isa_dle_sequence_role(), isa_las_sequence_role(), ff_device_sequence_role(),
                                  ff_las_sequence_role()};
    return roles;
  }
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence,
                       const Setup& setup) const override {
    if (is_of_isa(role.test_case.role())) {
      const bool is_las = role.test_case.role() == kIsaLas;
      const IsaCase one{role.test_case,
                        [&sequence, is_las](IsaBench& bench, CaseJudge& judge) {
                          (is_las ? run_isa_las_sequence : run_isa_dle_sequence)(sequence, bench, judge);
                        },
                        is_las ? isa_las_sequence_needs() : IsaNeeds{}};
      return run_isa(one, setup);
    }
    const bool is_las = role.test_case.role() == kFfLas;
    const FfCase one{role.test_case,
                     [&sequence, is_las](FfBench& bench, CaseJudge& judge) {
                       (is_las ? run_ff_las_sequence : run_ff_device_sequence)(sequence, bench, judge);
                     },
                     is_las ? ff_las_sequence_needs() : FfNeeds{}};
    return run_ff(one, setup);
  }

 private:
  template <typename Rules, typename Case, typename Setting>
  static Outcome run_recorded(const Case& one, Setting setting, CaseDevices& devices, bool is_recorded) {
    CaseRecorder recorder;
    if (is_recorded) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const Rules& rules) {
        return &recorder.start(trace, std::make_shared<fieldbus_dll::LinkDissector>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_on_bench(one, setting);
    recorder.keep(outcome);
    devices.keep(outcome);
    return outcome;
  }

  Outcome run_isa(const IsaCase& one, const Setup& setup) const {
    CaseDevices devices(one.test_case, setup, given_.attach);
    return run_recorded<fieldbus_dll::IsaRules>(one, isa_setting(one.test_case, setup, devices), devices,
                                                setup.record);
  }
  Outcome run_ff(const FfCase& one, const Setup& setup) const {
    CaseDevices devices(one.test_case, setup, given_.attach);
    return run_recorded<fieldbus_dll::FfRules>(one, ff_setting(one.test_case, setup, devices), devices,
                                               setup.record);
  }

  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  // What the setup says, of either profile.
  template <typename Setting>
  Setting setting_of(const Setup& setup) const {
    Setting setting;
    setting.seed = setup.seed;
    setting.volume = setup.volume;
    if (!setup.plan_file.empty()) setting.plan = load(setup);
    setting.stresses = &given_.stresses;
    return setting;
  }

  IsaSetting isa_setting(const TestCase& test_case, const Setup& setup, CaseDevices& devices) const {
    auto setting = setting_of<IsaSetting>(setup);
    const bool is_las = test_case.role() == kIsaLas;
    setting.address = is_las ? kLasAddress : kDleAddress;
    setting.make_station = [this, &devices, is_las, uri = assigned_to(test_case, setup).uri](
                               const fieldbus_dll::IsaConfiguration& configuration) {
      const auto local = [this, &devices, is_las, uri](const fieldbus_dll::IsaConfiguration& of) {
        return local_isa(is_las ? kIsaLas : kIsaDle, devices.request(uri), of);
      };
      return is_las ? devices.make<fieldbus_dll::IsaLasRole>(uri, configuration, local)
                    : devices.make<fieldbus_dll::IsaDleRole>(uri, configuration, local);
    };
    return setting;
  }

  FfSetting ff_setting(const TestCase& test_case, const Setup& setup, CaseDevices& devices) const {
    auto setting = setting_of<FfSetting>(setup);
    const bool is_las = test_case.role() == kFfLas;
    setting.is_link_master = is_las;
    setting.make_station = [this, &devices, is_las, uri = assigned_to(test_case, setup).uri](
                               const fieldbus_dll::FfConfiguration& configuration) {
      const auto local = [this, &devices, is_las, uri](const fieldbus_dll::FfConfiguration& of) {
        return local_ff(is_las ? kFfLas : kFfDevice, devices.request(uri), of);
      };
      return is_las ? devices.make<fieldbus_dll::FfLasRole>(uri, configuration, local)
                    : devices.make<fieldbus_dll::FfDeviceRole>(uri, configuration, local);
    };
    return setting;
  }

  const MakeOwnIsa& own_isa(std::string_view role) const {
    return role == kIsaLas ? given_.own_isa_las : given_.own_isa_dle;
  }
  const MakeOwnFf& own_ff(std::string_view role) const {
    return role == kFfLas ? given_.own_ff_las : given_.own_ff_device;
  }

  std::unique_ptr<fieldbus_dll::IsaDevice> local_isa(std::string_view role, const IutRequest& wanted,
                                                     const fieldbus_dll::IsaConfiguration& of) const {
    if (wanted.uri == kReferenceUri) {
      if (role == kIsaLas) return std::make_unique<fieldbus_dll::IsaLas>(of);
      return std::make_unique<fieldbus_dll::IsaDle>(of);
    }
    if (wanted.uri == kOwnUri && own_isa(role)) return own_isa(role)(wanted, of);
    return make_isa_mutant(std::string(role), mutant_of(wanted.uri, "station of the profile ISA-D"), of);
  }

  std::unique_ptr<fieldbus_dll::FfDevice> local_ff(std::string_view role, const IutRequest& wanted,
                                                   const fieldbus_dll::FfConfiguration& of) const {
    if (wanted.uri == kReferenceUri) {
      if (role == kFfLas) return std::make_unique<fieldbus_dll::FfLas>(of);
      return std::make_unique<fieldbus_dll::FfStation>(of);
    }
    if (wanted.uri == kOwnUri && own_ff(role)) return own_ff(role)(wanted, of);
    return make_ff_mutant(std::string(role), mutant_of(wanted.uri, "station of the profile FF-P"), of);
  }

  FieldbusDllGiven given_;
  std::vector<TestCase> cases_;
  std::vector<Mutant> mutants_;
  std::map<std::string, const IsaCase*, std::less<>> isa_cases_;
  std::map<std::string, const FfCase*, std::less<>> ff_cases_;
};

}  // namespace

std::unique_ptr<Suite> fieldbus_dll_suite(FieldbusDllGiven given) {
  return std::make_unique<FieldbusDllSuite>(std::move(given));
}

}  // namespace fieldproof::conformance
