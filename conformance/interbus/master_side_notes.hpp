#pragma once

#include <cstdint>
#include <span>
#include <string>

// What a MasterSide notes, in words: each number with what it is.
namespace fieldproof::conformance {

std::string master_cycle_text(std::span<const std::int64_t> values);
std::string master_inputs_text(std::span<const std::int64_t> values);
std::string master_report_text(std::span<const std::int64_t> values);
std::string master_state_text(std::span<const std::int64_t> values);

}  // namespace fieldproof::conformance
