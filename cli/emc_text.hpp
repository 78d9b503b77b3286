// What `fieldproof emc` found, as a table for a person.
#pragma once

#include <string>

#include "cli/emc_campaign.hpp"

namespace fieldproof::cli {

std::string emc_table_head(bool has_bursts);
std::string emc_line(const EmcTest& test);
// Where no level lies on the other side of where A ends; else empty.
std::string emc_hint(const EmcCampaign& campaign);
// The error statistics and what they rest on.
std::string emc_summary(const EmcCampaign& campaign);

}  // namespace fieldproof::cli
