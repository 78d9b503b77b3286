#include "harness/fault/plan_work.hpp"

namespace fieldproof::fault {

PlanTooHeavy::PlanTooHeavy()
    : std::runtime_error(
          "the plan of faults is too heavy: its rules answer too often, or make too much of each answer, "
          "or its disturbances change too much; narrow \"when\", \"from\" and \"to\", or limit \"times\"") {}

}  // namespace fieldproof::fault
