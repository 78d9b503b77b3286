#pragma once

#include <string>
#include <string_view>

#include "conformance/test_case.hpp"

// What the URI of an implementation says, and who plays the role that a case judges.
namespace fieldproof::conformance {

inline constexpr std::string_view kReferenceUri = "ref";
inline constexpr std::string_view kDeviantUri = "deviant:";
inline constexpr std::string_view kRecordedUri = "recorded:";
inline constexpr std::string_view kOwnUri = "own";

// The last assignment for the role of the case, or for every role; else the reference.
Assignment assigned_to(const TestCase& test_case, const Setup& setup);

// The name behind `deviant:`. Throws kernel::Error(usage) for any other URI; `what` is "INTERBUS slave".
std::string deviation_of(const std::string& uri, std::string_view what);

}  // namespace fieldproof::conformance
