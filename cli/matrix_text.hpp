// The matrix for people and for programs.
#pragma once

#include <string>

#include "conformance/matrix.hpp"

namespace fieldproof::cli {

// One table per role: a row per case, two columns per mutant under its upright label, a legend, the holes.
std::string matrix_text(const conformance::Matrix& matrix);

// {"schema": "fieldproof/matrix/1", ...}: every cell with verdict, reason and declared reason, and the holes.
std::string matrix_json(const conformance::Matrix& matrix);

}  // namespace fieldproof::cli
