#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "conformance/judging.hpp"
#include "conformance/token_bus/station_bench.hpp"
#include "conformance/token_bus/station_twin.hpp"

// A station of the token bus beside its twin: what it has driven, reported, taken and counted since the last
// comparison, each with its reason codes.
namespace fieldproof::conformance {

class TokenComparison {
 public:
  TokenComparison(TokenBench& bench, TokenTwin& twin, CaseJudge& judge)
      : bench_(bench), twin_(twin), judge_(judge) {}

  // The user has submitted so many octets, and they were taken or refused.
  void note_submission(std::size_t size, bool is_taken) { submitted_.push_back({size, is_taken}); }
  // `is_alone`: it has solicited again and again, and nobody has answered.
  void compare(bool is_alone);
  // What was driven before others replied to it, or did what no source says.
  void compare_sure_frames();

 private:
  struct Submission {
    std::size_t size;
    bool is_taken;
  };

  void compare_submissions();
  void compare_frames(std::size_t count);
  void expect_no_early_begin();
  void expect_begun_by(kernel::Time latest);
  void expect_nothing_overdue();
  void expect_chance();
  void compare_indications();
  void compare_all_events(bool is_alone);
  void compare_counters();
  void compare_new(const EventKind& kind, const Observations& seen, const Observations& right);
  void expect_in_time(const DrivenFrame& one, const BeginSpan& span);

  TokenBench& bench_;
  TokenTwin& twin_;
  CaseJudge& judge_;
  std::deque<Submission> submitted_{};
  // What has been compared.
  std::size_t submissions_ = 0;
  std::size_t frames_ = 0;
  std::size_t indications_ = 0;
  std::size_t events_ = 0;
  std::ptrdiff_t sole_seen_ = 0;
  std::ptrdiff_t sole_right_ = 0;
};

}  // namespace fieldproof::conformance
