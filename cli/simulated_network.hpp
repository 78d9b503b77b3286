// The network of verbs that simulate without a suite.
#pragma once

#include <string_view>

#include "cli/settings.hpp"
#include "protocols/interbus/network.hpp"

namespace fieldproof::cli {

// What the first line of such a verb calls its own network.
inline constexpr std::string_view kCycleTimePaper = "of the cycle-time paper";

// That of --network, else the one of the cycle-time paper, cycling as its authors had set it.
interbus::NetworkDescription simulated_network_from(const Settings& settings);

}  // namespace fieldproof::cli
