#pragma once

#include <vector>

#include "conformance/interbus/master_mutants.hpp"

// Rows of the mutants of a master: settings at their ends, many stations, what is around a start.
namespace fieldproof::conformance {

std::vector<MasterMutants::Row> master_rows_at_ends();

}  // namespace fieldproof::conformance
