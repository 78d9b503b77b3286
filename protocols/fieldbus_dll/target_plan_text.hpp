#pragma once

#include <cstdint>
#include <string>

#include "protocols/fieldbus_dll/target_plan.hpp"
#include "protocols/fieldbus_dll/token_network.hpp"

// What a plan of the target rotation time says to people, and as a document.
namespace fieldproof::fieldbus_dll {

// The network and the bound that is asked for.
std::string network_text(const TokenNetwork& network, std::uint64_t seed);
// What was searched, and what is proven.
std::string plan_text(const TargetPlan& plan, const TokenNetwork& network);
// Valid against target_plan.schema.json, "schema" is "fieldproof/target_plan/1".
std::string plan_json(const TargetPlan& plan, const TokenNetwork& network, std::uint64_t seed);

}  // namespace fieldproof::fieldbus_dll
