// What brings a real implementation into its first state before each case: a relay, a debugger, a script.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "conformance/test_case.hpp"

namespace fieldproof::cli {

inline constexpr std::chrono::seconds kLongestReset{60};

// Runs the command in a shell in which $1 is the id of the case, and waits for its end. Gives why
// it has not reset anything: another exit code than 0, a signal, no end within the limit, each with the last
// lines of what it said. Everything that it has started ends with it.
std::function<std::optional<std::string>(const conformance::TestCase&)> reset_hook(
    std::string command, std::chrono::milliseconds limit = kLongestReset);

}  // namespace fieldproof::cli
