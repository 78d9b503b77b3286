// After how many commands each mutant is found, for people and for programs.
#pragma once

#include <span>
#include <string>

#include "conformance/detection.hpp"

namespace fieldproof::cli {

// The least share of mutants and seeds that sequences are to find.
inline constexpr double kLeastDetected = 0.95;
bool is_detected_enough(const conformance::DetectionTable& table);

// A row per mutant; then what was not found, whether it was triggered, and the case that finds it.
std::string detection_text(const conformance::DetectionTable& table);

// {"schema": "fieldproof/detection/1", ...}
std::string detection_json(std::span<const conformance::DetectionTable> tables);

}  // namespace fieldproof::cli
