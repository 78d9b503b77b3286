#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "conformance/token_bus/station_scene.hpp"

// The words of charts about what a station receives: what arrives, and what comes of it.
namespace fieldproof::conformance::token_chart {

// Of token_bus::Counters.
enum Counted : std::size_t { kNonSilence, kFragment, kFcsError, kEBitError, kTooLong };

// From 000E.
Octets right_token(TokenScene& scene);
TokenStep drive(std::string text, std::function<line::Levels(TokenScene&)> make);
TokenStep ignored(std::string reason, std::string why);
// Since the case began: `counter_wrong`.
TokenStep counted(std::string name, Counted which, std::uint32_t count);
// The last data that were sent, so many times since the step before: `not_delivered`, `delivered_unasked`.
TokenStep delivered(std::string what, std::size_t count);
// `token_missing`, `token_wrong`.
TokenStep passes_on();

}  // namespace fieldproof::conformance::token_chart
