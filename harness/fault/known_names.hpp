#pragma once

#include <string>
#include <vector>

#include "harness/fault/plan.hpp"

// What a plan can speak of on one segment: a rule that names something else can never answer, which is a
// mistake of whoever wrote it and no clean run.
namespace fieldproof::fault {

struct KnownNames {
  std::vector<std::string> receivers;
  std::vector<std::string> frame_kinds;
  std::vector<std::string> fields;
  std::vector<std::string> observations;
};

// Of receivers whose protocol gives no map of its frames (see TransmissionFields).
KnownNames names_of_transmissions(std::vector<std::string> receivers, std::vector<std::string> observations);

// Throws kernel::Error(configuration) for the first pattern of a rule or a disturbance that fits no known
// name; the sentence tells which one and the nearest names.
void expect_known_names(const Plan& plan, const KnownNames& known);

}  // namespace fieldproof::fault
