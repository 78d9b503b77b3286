// What `fieldproof emc` found, as JSON (reports/schema/emc.schema.json).
#pragma once

#include <string>

#include "cli/emc_campaign.hpp"

namespace fieldproof::cli {

std::string emc_json(const EmcCampaign& campaign);

}  // namespace fieldproof::cli
