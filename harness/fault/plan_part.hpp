#pragma once

#include <string>

namespace fieldproof::fault {

// A rule or a disturbance of a plan, as reports call it.
struct PlanPart {
  std::string place;  // a JSON pointer into the plan: "/rules/0"
  std::string name;   // as the plan gives it, cut when it is long; may be empty
};

}  // namespace fieldproof::fault
