#pragma once

#include <cstdint>
#include <stdexcept>

// How much a plan of faults may make of a run. A plan of a few lines can ask for so much (a repetition of
// each level, a thousand times) that its case would never end; then the case is told so instead. What is
// counted are questions to rules, hits, what disturbances tell, and what arrives because of them, never time:
// the same plan is too heavy at the same instant of every run.
namespace fieldproof::fault {

// Thrown in the middle of a run when a plan makes more of it than can be served; no defect of the line, of
// the bench or of an implementation. Who runs a case makes it a verdict that nothing could be shown.
class PlanTooHeavy : public std::runtime_error {
 public:
  PlanTooHeavy();
};

class PlanWork {
 public:
  static constexpr std::uint64_t kMostSteps = 500'000'000;  // a few seconds

  explicit PlanWork(std::uint64_t most = kMostSteps) : most_(most) {}

  void spend(std::uint64_t steps) {
    spent_ += steps;
    if (spent_ > most_) throw PlanTooHeavy();
  }

 private:
  std::uint64_t most_;
  std::uint64_t spent_ = 0;
};

}  // namespace fieldproof::fault
