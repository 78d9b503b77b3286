#include "cli/burst_shrink.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "cli/bits_that_matter.hpp"
#include "cli/exit_code.hpp"
#include "cli/flipped_bits.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_sequence.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

// A folder of this process for what is tried; what is found goes where the caller said.
class TriedPlan {
 public:
  TriedPlan() {
    std::string name = (std::filesystem::temp_directory_path() / "fieldproof-shrink-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw kernel::Error(kernel::ErrorKind::configuration,
                          fmt::format("{}: no folder can be made there: {}", name, std::strerror(errno)));
    }
    folder_ = name;
  }
  TriedPlan(const TriedPlan&) = delete;
  TriedPlan& operator=(const TriedPlan&) = delete;
  ~TriedPlan() {
    std::error_code gone_already;
    std::filesystem::remove_all(folder_, gone_already);
  }
  std::string path() const { return (folder_ / "plan.json").string(); }

 private:
  std::filesystem::path folder_;
};

// The case with all its disturbances, and a note of what they struck until it failed.
struct DisturbedRun {
  FlippedBits struck;
  judge::CaseResult result;
};

DisturbedRun run_disturbed(const CaseFile& stored) {
  const auto struck = std::make_shared<FlippedBits>();
  const conformance::Disturbances all = watched(all_disturbances(), struck);
  const conformance::Catalogue catalogue(make_suites(stored.is_quiet ? without_stresses(all) : all));
  const conformance::CaseRun done = conformance::run_case(catalogue.at(stored.id), stored.setup);
  return {std::move(*struck), done.outcome.result};
}

class BurstShrink {
 public:
  BurstShrink(const CaseFile& stored, const Session& session, std::string reason, std::stop_token stop)
      : entry_(quiet_of(stored), session),
        setup_(stored.setup),
        reason_(std::move(reason)),
        stop_(std::move(stop)) {
    if (!setup_.plan_file.empty()) plan_ = reports::read_text_file(setup_.plan_file);
  }

  // The smallest; nothing when bits alone do not make it fail.
  std::optional<FlippedBits> run(const FlippedBits& struck) {
    return bits_that_matter(struck, [this](const FlippedBits& some) { return still_fails(some); });
  }

  // With these bits, in a plan that is left there.
  conformance::CaseRun run_with(const FlippedBits& bits, const std::string& plan_file) {
    ++runs_;
    reports::write_text_file(plan_file, plan_of(bits, plan_));
    setup_.plan_file = plan_file;
    return conformance::run_case(*entry_, setup_);
  }
  std::size_t runs() const { return runs_; }

 private:
  static CaseFile quiet_of(CaseFile stored) {
    stored.is_quiet = true;
    return stored;
  }
  bool still_fails(const FlippedBits& bits) {
    if (stop_.stop_requested()) return false;
    const judge::CaseResult& result = run_with(bits, tried_.path()).outcome.result;
    return result.verdict == judge::Verdict::fail && result.reason == reason_;
  }

  StoredEntry entry_;
  conformance::Setup setup_;
  TriedPlan tried_;
  std::string plan_;  // the text of the stored one
  std::string reason_;
  std::stop_token stop_;
  std::size_t runs_ = 0;
};

int nothing_to_shrink(Session& session, std::string_view reason) {
  session.terminal.print(
      fmt::format("the stored case fails with '{}' without any struck bit: there is nothing to shrink\n",
                  reports::escaped_line(reason)));
  return kDiffers;
}

}  // namespace

int shrink_bursts(Session& session, const CaseFile& stored, const std::filesystem::path& file) {
  std::filesystem::path plan_file = file;
  plan_file.replace_extension(".plan.json");
  reports::check_writable(plan_file);
  session.terminal.print(reports::run_header(identity_of(session, stored.setup, 1), manifest_of(session, 1)));
  const DisturbedRun disturbed = run_disturbed(stored);
  if (disturbed.result.verdict != judge::Verdict::fail) {
    session.terminal.print(
        fmt::format("the stored case does not fail, its verdict is {}: nothing to shrink\n",
                    judge::name(disturbed.result.verdict)));
    return kDiffers;
  }
  if (disturbed.struck.empty()) return nothing_to_shrink(session, disturbed.result.reason);
  const Interruption interruption(session.settings.duration("max-time"));
  BurstShrink shrinking(stored, session, disturbed.result.reason, interruption.token());
  const auto smallest = shrinking.run(disturbed.struck);
  if (!smallest && interruption.token().stop_requested()) {
    session.terminal.print(
        fmt::format("{}, before it was known which of the {} bits that were struck make it fail\n",
                    interruption.reason(), disturbed.struck.size()));
    return interruption.signal() != 0 ? kSignalBase + interruption.signal() : kInconclusive;
  }
  if (!smallest) {
    session.terminal.print(
        fmt::format("the {} bits that were struck do not make it fail with '{}' without the rest of the "
                    "disturbance\n",
                    disturbed.struck.size(), reports::escaped_line(disturbed.result.reason)));
    return kDiffers;
  }
  if (smallest->empty()) return nothing_to_shrink(session, disturbed.result.reason);
  const conformance::CaseRun done = shrinking.run_with(*smallest, plan_file.string());
  write_quiet_case(file, done, stored);
  reports::TextOptions options;
  options.colour = session.terminal.has_colour();
  options.reproduce = replay_command(file.string());
  session.terminal.print(
      reports::finding_text(identity_of(session, done.setup, 1), done.outcome.result, options));
  session.terminal.print(fmt::format("shrunk from {} struck bits to {}, in {} runs\n{}",
                                     disturbed.struck.size(), smallest->size(), shrinking.runs(),
                                     bit_lines(*smallest)));
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  const judge::CaseResult& result = done.outcome.result;
  if (result.verdict == judge::Verdict::fail && result.reason == disturbed.result.reason)
    return kAllAsExpected;
  session.terminal.print("not confirmed: the implementation did not do the same again\n");
  return kDiffers;
}

}  // namespace fieldproof::cli
