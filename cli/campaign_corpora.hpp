// What the searches of a campaign leave for the next one: the corpora of its jobs, as one of each
// implementation.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "campaign/folder.hpp"
#include "campaign/growth.hpp"
#include "cli/campaign_plan.hpp"

namespace fieldproof::cli {

// Jobs of `fuzz` whose calls differ in no more than seed, number of sequences and corpus to begin with share
// one: their sequences are collected, run once more in a process of their own, and those that are enough to
// pass what all pass are kept in corpus/<role> of the folder. Which are these depends on nothing but the
// outcomes.
std::vector<campaign::MergedCorpus> merge_corpora(const CampaignPlan& plan, const campaign::Folder& folder,
                                                  const std::map<std::uint64_t, campaign::Outcome>& outcomes,
                                                  const std::function<bool()>& is_interrupted);

}  // namespace fieldproof::cli
