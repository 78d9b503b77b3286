#include "conformance/running_case.hpp"

#include "harness/fault/plan_file.hpp"
#include "harness/field/differences.hpp"

namespace fieldproof::conformance {

RunningCase::RunningCase(const TestCase& test_case, const Setup& setup, const SuiteGiven& given,
                         const line::TelegramCode* telegrams)
    : test_case_(test_case),
      setup_(setup),
      given_(given),
      telegrams_(telegrams),
      settings_(setup.settings),
      assigned_(assigned_to(test_case, setup)),
      on_real_line_(given.on_real_line ? given.on_real_line(assigned_.uri, test_case.id) : std::nullopt),
      devices_(test_case, setup, given.attach) {}

std::optional<judge::Pics> RunningCase::pics() const {
  if (!on_real_line_) return setup_.pics;
  return setup_.pics ? setup_.pics->completed_by(*on_real_line_) : on_real_line_;
}

fault::Plan declared_plan(const Setup& setup, const SuiteGiven& given, const line::TelegramCode* telegrams) {
  if (setup.plan_file.empty()) return {};
  return fault::load_plan(setup.plan_file,
                          {.telegrams = telegrams, .disturbances = given.disturbances.of_plans});
}

trace::Recorder& RunningCase::start_recorder(const trace::Trace& trace,
                                             std::shared_ptr<const trace::Dissector> dissector) {
  dissector_ = std::move(dissector);
  return recorder_.emplace(trace);
}

void RunningCase::keep(Outcome& outcome) {
  if (recorder_) {
    Recording& kept = outcome.recording;
    kept.trace = recorder_->take();
    kept.dissector = std::move(dissector_);
    kept.truncated = kept.trace.is_cut;
  }
  devices_.keep(outcome);
}

std::vector<std::string> RunningCase::unusual_settings(const field::AnyTable& table) const {
  const void* const configuration = devices_.configuration();
  return configuration == nullptr ? std::vector<std::string>{}
                                  : field::differences_of_any(table, configuration);
}

}  // namespace fieldproof::conformance
