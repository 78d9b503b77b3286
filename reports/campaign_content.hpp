// What a page shows of a campaign: its jobs joined to rows, and those that did not end well.
//
// Contract: bounded, however many jobs there were; what is left out is counted. A row is all jobs whose
// command differs in the seed alone. Equal documents give equal contents.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/document_verdict.hpp"

namespace fieldproof::reports {

inline constexpr std::size_t kMostCampaignRows = 500;
inline constexpr std::size_t kMostCampaignFindings = 200;

// The document without "jobs", and with "rows", "rows_left_out", "findings" and "findings_left_out" instead.
nlohmann::ordered_json campaign_content(nlohmann::ordered_json document);

// As its exit code says, only that criterion C and D, and a share of wrong words that was shown to be above
// its goal, are failures here, and criterion B is a warning.
Said said_by_campaign(const nlohmann::json& document);

}  // namespace fieldproof::reports
