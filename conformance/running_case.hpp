#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/assigned.hpp"
#include "conformance/case_devices.hpp"
#include "conformance/mutant_table.hpp"
#include "conformance/suite_given.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/plan.hpp"
#include "harness/line/telegram.hpp"
#include "harness/trace/recording.hpp"

// One run of a case: who plays, what is disturbed, and what is recorded of it. Made anew for each run, so
// runs share nothing.
namespace fieldproof::conformance {

// The declared faults of the setup; empty without any.
fault::Plan declared_plan(const Setup& setup, const SuiteGiven& given, const line::TelegramCode* telegrams);

class RunningCase {
 public:
  // All must outlive it. `telegrams`: how a plan writes the telegrams that it inserts; null: it inserts none.
  RunningCase(const TestCase& test_case, const Setup& setup, const SuiteGiven& given,
              const line::TelegramCode* telegrams = nullptr);

  const TestCase& test_case() const { return test_case_; }
  const Setup& setup() const { return setup_; }
  const SuiteGiven& given() const { return given_; }
  // What the implementation is given from the next bench on: those of the setup, or of a sequence.
  const field::Settings& settings() const { return settings_; }
  void use_settings(field::Settings settings) { settings_ = std::move(settings); }
  // Who plays the role of the case.
  const Assignment& assigned() const { return assigned_; }
  // The answers of the setup, completed by what is known of a station on a real line.
  std::optional<judge::Pics> pics() const;
  // What happens on a real line never happens again: it is always recorded.
  bool is_on_real_line() const { return on_real_line_.has_value(); }
  // Whether sequences that fail are run again, to find the smallest and what decides.
  bool explains() const { return setup_.explains && !is_on_real_line(); }
  bool is_recorded() const { return setup_.record || is_on_real_line(); }
  bool is_played_back() const { return devices_.is_played_back(); }
  fault::Plan plan() const { return declared_plan(setup_, given_, telegrams_); }

  // What makes the stations of a URI, each of its own. It must not outlive this. `what` is "INTERBUS slave".
  template <typename Kind, typename Reference>
  auto maker(const std::string& uri,
             const DeviceMutants<typename Kind::Device, typename Kind::Configuration>& mutants,
             std::string_view what) {
    using Configuration = typename Kind::Configuration;
    using Made = std::unique_ptr<typename Kind::Device>;
    const auto local = [this, uri, &mutants, what](const Configuration& of) -> Made {
      if (uri == kReferenceUri) return std::make_unique<Reference>(of);
      const auto* own = given_.own.template find<Kind>();
      if (uri == kOwnUri && own != nullptr) return (*own)(devices_.request(uri), of);
      return mutants.make(mutant_of(uri, what), of);
    };
    return std::function<Made(const Configuration&)>([this, uri, local](const Configuration& configuration) {
      return devices_.make<Kind>(uri, configuration, local);
    });
  }

  // The recorder of this trace, for `Trace::set_recorder`.
  trace::Recorder& start_recorder(const trace::Trace& trace,
                                  std::shared_ptr<const trace::Dissector> dissector);
  // What was recorded goes to the outcome.
  void keep(Outcome& outcome);
  // What the implementation was given otherwise than usual, by the settings of its role.
  std::vector<std::string> unusual_settings(const field::AnyTable& table) const;

 private:
  const TestCase& test_case_;
  const Setup& setup_;
  const SuiteGiven& given_;
  const line::TelegramCode* telegrams_;
  field::Settings settings_;
  Assignment assigned_;
  std::optional<judge::Pics> on_real_line_;
  CaseDevices devices_;
  std::optional<trace::BoundedRecorder> recorder_;
  std::shared_ptr<const trace::Dissector> dissector_;
};

}  // namespace fieldproof::conformance
