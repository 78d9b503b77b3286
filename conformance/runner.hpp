// Runs a selection of test cases and hands over one result per case, in catalogue order whatever the number
// of threads.
//
// Contract: the seed of a case depends on the run's seed and the id only, so a case repeats alone as it ran
// in the whole. What a case drove is recorded (bounded) while it runs, and kept of those that do
// not pass when `keeps_recordings` is `failed`. With `confirmations` a failure that does not come again each
// time is inconclusive, `not_confirmed`, and `is_repeatable` says whether its fingerprints agreed.
// kernel::Error of a suite (a setup that cannot be served) ends the run; any other exception, a broken
// invariant too, is the verdict `error` with the reason `internal_error` of that case and the run goes on:
// one defect of the bench must not cost the results of a night. A stop gives up the cases that are at work:
// they are not handed over.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>

#include "conformance/catalogue.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

inline constexpr std::string_view kInternalError = "internal_error";
inline constexpr std::string_view kNotConfirmed = "not_confirmed";
inline constexpr std::string_view kResetFailed = "reset_failed";

std::uint64_t case_seed(std::uint64_t run_seed, std::string_view id);

enum class KeptRecordings { none, failed, all };

struct CaseRun {
  Entry entry;
  Setup setup;  // with the seed of the case
  Outcome outcome;
  bool is_repeatable = true;
};

// How a case is run, besides what decides its outcome in virtual time.
struct RunOptions {
  KeptRecordings keeps_recordings = KeptRecordings::none;
  unsigned confirmations = 0;  // how often a failure must come again
  // Called before each run of a case, to bring what is real into its first state. Gives why it could not.
  std::function<std::optional<std::string>(const TestCase&)> reset{};
};

struct Plan {
  std::vector<Entry> entries;
  Setup setup;  // `seed` is the seed of the run
  unsigned jobs = 1;
  RunOptions manner;
  std::stop_token stop;
  // Receives each case in its turn; false ends the run after it.
  std::function<bool(CaseRun&&)> on_case;
  // The number of finished cases, a few times a second.
  std::function<void(std::size_t)> on_progress;
};

// One case, never throwing anything but kernel::Error. The verdict is not-applicable without running anything
// when the PICS of the setup exclude the case, or when implementations are assigned to other roles only.
CaseRun run_case(const Entry& entry, const Setup& run_setup, const RunOptions& manner = {});

// Throws the kernel::Error of a setup that cannot be served, before anything is run or stored. Each role of
// each protocol is asked once, by its first case that applies.
void check_setup(std::span<const Entry> entries, const Setup& setup);

// The number of cases that were handed over; fewer than planned after a stop.
std::size_t run(const Plan& plan);

}  // namespace fieldproof::conformance
