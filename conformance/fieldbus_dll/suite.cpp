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
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/isa_sequence_check.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/link_dissector.hpp"

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
    if (is_of_isa(role)) return bool(given_isa(role).own);
    return (role == kFfDevice || role == kFfLas) && bool(given_ff(role).own);
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
    if (is_of_isa(test_case.role())) {
      isa_setting(test_case, setup).make_station({});
    } else {
      ff_setting(test_case, setup).make_station({});
    }
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    if (const auto isa = isa_cases_.find(test_case.id); isa != isa_cases_.end())
      return run_recorded<fieldbus_dll::IsaRules>(*isa->second, isa_setting(test_case, setup), setup.record);
    return run_recorded<fieldbus_dll::FfRules>(*ff_cases_.at(test_case.id), ff_setting(test_case, setup),
                                               setup.record);
  }

  std::span<const SequenceRole> sequence_roles() const override {
    static const std::array roles{isa_dle_sequence_role(), ff_device_sequence_role(), ff_las_sequence_role()};
    return roles;
  }
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence,
                       const Setup& setup) const override {
    if (is_of_isa(role.test_case.role())) {
      const IsaCase one{role.test_case, [&sequence](IsaBench& bench, CaseJudge& judge) {
                          run_isa_dle_sequence(sequence, bench, judge);
                        }};
      return run_recorded<fieldbus_dll::IsaRules>(one, isa_setting(role.test_case, setup), setup.record);
    }
    const bool is_las = role.test_case.role() == kFfLas;
    const FfCase one{role.test_case,
                     [&sequence, is_las](FfBench& bench, CaseJudge& judge) {
                       (is_las ? run_ff_las_sequence : run_ff_device_sequence)(sequence, bench, judge);
                     },
                     is_las ? ff_las_sequence_needs() : FfNeeds{}};
    return run_recorded<fieldbus_dll::FfRules>(one, ff_setting(role.test_case, setup), setup.record);
  }

 private:
  template <typename Rules, typename Case, typename Setting>
  static Outcome run_recorded(const Case& one, Setting setting, bool is_recorded) {
    CaseRecorder recorder;
    if (is_recorded) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const Rules& rules) {
        return &recorder.start(trace, std::make_shared<fieldbus_dll::LinkDissector>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_on_bench(one, setting);
    recorder.keep(outcome);
    return outcome;
  }

  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  // What the setup says, of either profile.
  template <typename Setting, typename Configuration, typename Make>
  Setting setting_of(const TestCase& test_case, const Setup& setup, Make make) const {
    Setting setting;
    setting.seed = setup.seed;
    setting.volume = setup.volume;
    if (!setup.plan_file.empty()) setting.plan = load(setup);
    setting.stresses = &given_.stresses;
    setting.make_station = [this, make, role = test_case.role(), uri = assigned_to(test_case, setup).uri,
                            id = test_case.id, seed = setup.seed,
                            limits = setup.limits](const Configuration& configuration) {
      return (this->*make)(role, {uri, id, seed, limits}, configuration);
    };
    return setting;
  }

  IsaSetting isa_setting(const TestCase& test_case, const Setup& setup) const {
    auto setting = setting_of<IsaSetting, fieldbus_dll::IsaConfiguration>(
        test_case, setup, &FieldbusDllSuite::make_isa_station);
    setting.address = test_case.role() == kIsaLas ? kLasAddress : kDleAddress;
    return setting;
  }

  FfSetting ff_setting(const TestCase& test_case, const Setup& setup) const {
    auto setting = setting_of<FfSetting, fieldbus_dll::FfConfiguration>(test_case, setup,
                                                                        &FieldbusDllSuite::make_ff_station);
    setting.is_link_master = test_case.role() == kFfLas;
    return setting;
  }

  const GivenIsaStations& given_isa(std::string_view role) const {
    return role == kIsaLas ? given_.isa_las : given_.isa_dle;
  }
  const GivenFfStations& given_ff(std::string_view role) const {
    return role == kFfLas ? given_.ff_las : given_.ff_device;
  }

  std::unique_ptr<fieldbus_dll::IsaDevice> make_isa_station(
      const std::string& role, const IutRequest& wanted,
      const fieldbus_dll::IsaConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) {
      if (role == kIsaLas) return std::make_unique<fieldbus_dll::IsaLas>(configuration);
      return std::make_unique<fieldbus_dll::IsaDle>(configuration);
    }
    if (auto station = given_isa(role).make(wanted, configuration)) return station;
    return make_isa_mutant(role, mutant_of(wanted.uri, "station of the profile ISA-D"), configuration);
  }

  std::unique_ptr<fieldbus_dll::FfDevice> make_ff_station(
      const std::string& role, const IutRequest& wanted,
      const fieldbus_dll::FfConfiguration& configuration) const {
    if (wanted.uri == kReferenceUri) {
      if (role == kFfLas) return std::make_unique<fieldbus_dll::FfLas>(configuration);
      return std::make_unique<fieldbus_dll::FfStation>(configuration);
    }
    if (auto station = given_ff(role).make(wanted, configuration)) return station;
    return make_ff_mutant(role, mutant_of(wanted.uri, "station of the profile FF-P"), configuration);
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
