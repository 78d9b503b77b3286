// The same network with references alone, beside the one with the implementations of a call: what of a result
// is the share of the device, and what every device would show on this cable.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/emc_campaign.hpp"
#include "conformance/planned_network.hpp"

namespace fieldproof::cli {

// Null where nobody but references plays.
std::shared_ptr<const conformance::PlannedNetwork> plan_references(
    const ProtocolEntry& protocol, const conformance::NetworkRequest& request);

// How references did in each test of a campaign, added up; empty where none ran.
std::string beside_text(const EmcCampaign& campaign);
// Whether references did the same in this test, whenever bursts met them.
bool is_as_references(const EmcTest& test);
nlohmann::ordered_json reference_json(const emc::ImmunityResult& reference);

}  // namespace fieldproof::cli
