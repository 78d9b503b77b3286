#include "conformance/fieldbus_dll/suite.hpp"

#include <map>
#include <string>

#include "conformance/case_recorder.hpp"
#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_deviations.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/isa_notation.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaDevice;

constexpr std::string_view kDle = "isa_dle";
constexpr std::string_view kLas = "isa_las";
constexpr std::uint8_t kDleAddress = 0x21;
constexpr std::uint8_t kLasAddress = 0x10;

class FieldbusDllSuite final : public Suite {
 public:
  explicit FieldbusDllSuite(FieldbusDllGiven given) : given_(std::move(given)) {
    for (const IsaCase& one : isa_cases()) {
      cases_.push_back(one.test_case);
      isa_cases_[one.test_case.id] = &one;
    }
  }

  std::string_view protocol() const override { return "fieldbus_dll"; }
  std::vector<std::string> roles() const override { return {std::string(kDle), std::string(kLas)}; }
  bool has_own(std::string_view role) const override {
    return role == kDle ? bool(given_.isa_dle.own) : role == kLas && bool(given_.isa_las.own);
  }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Deviation>& deviations() const override { return isa_deviations(); }

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
    setting_of(test_case, setup).make_station({});
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    IsaSetting setting = setting_of(test_case, setup);
    CaseRecorder recorder;
    if (setup.record) {
      setting.make_recorder = [&recorder](const trace::Trace& trace, const fieldbus_dll::IsaRules& rules) {
        return &recorder.start(trace, std::make_shared<fieldbus_dll::IsaNotation>(rules));
      };
    }
    Outcome outcome;
    outcome.result = run_on_bench(*isa_cases_.at(test_case.id), setting);
    recorder.keep(outcome);
    return outcome;
  }

 private:
  fault::Plan load(const Setup& setup) const {
    return fault::load_plan(setup.plan_file, {.disturbances = given_.disturbances});
  }

  IsaSetting setting_of(const TestCase& test_case, const Setup& setup) const {
    IsaSetting setting;
    setting.address = test_case.role() == kLas ? kLasAddress : kDleAddress;
    setting.seed = setup.seed;
    setting.volume = setup.volume;
    if (!setup.plan_file.empty()) setting.plan = load(setup);
    setting.make_station = [this, role = test_case.role(), uri = assigned_to(test_case, setup).uri,
                            id = test_case.id, seed = setup.seed,
                            limits = setup.limits](const IsaConfiguration& configuration) {
      return make_station(role, {uri, id, seed, limits}, configuration);
    };
    return setting;
  }

  std::unique_ptr<IsaDevice> make_station(const std::string& role, const Wanted& wanted,
                                          const IsaConfiguration& configuration) const {
    const bool is_las = role == kLas;
    if (wanted.uri == kReferenceUri) {
      if (is_las) return std::make_unique<fieldbus_dll::IsaLas>(configuration);
      return std::make_unique<fieldbus_dll::IsaDle>(configuration);
    }
    const GivenIsaStations& given = is_las ? given_.isa_las : given_.isa_dle;
    if (auto station = given.make(wanted, configuration)) return station;
    return make_isa_deviation(
        role, deviation_of(wanted.uri, is_las ? "link master of ISA-D" : "data link entity of ISA-D"),
        configuration);
  }

  FieldbusDllGiven given_;
  std::vector<TestCase> cases_;
  std::map<std::string, const IsaCase*, std::less<>> isa_cases_;
};

}  // namespace

std::unique_ptr<Suite> fieldbus_dll_suite(FieldbusDllGiven given) {
  return std::make_unique<FieldbusDllSuite>(std::move(given));
}

}  // namespace fieldproof::conformance
