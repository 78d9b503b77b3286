#include "cli/emc_campaign.hpp"

#include <algorithm>

#include "emc/residual/residual_error.hpp"

namespace fieldproof::cli {

void EmcTest::bound_by(const std::vector<network::ProtectedFrame>& frames) {
  for (const network::ProtectedFrame& frame : frames)
    undetected_share = std::max(undetected_share, emc::undetected_share_at(frame, flip_probability));
}

double EmcTest::expected_wrong() const {
  if (undetected.empty()) return static_cast<double>(result.counts.corrupted) * undetected_share;
  double any = 0;
  for (const UndetectedPart& part : undetected) any += part.probability;
  return static_cast<double>(result.counts.sent * result.receivers) * any;
}

EmcTotal total_of(const EmcCampaign& campaign) {
  EmcTotal total;
  for (const EmcTest& test : campaign.tests) {
    total.counts += test.result.counts;
  }
  total.upper_bound_of_share = emc::upper_bound_of_share(total.counts.wrong_exchanges, total.counts.differed);
  if (!campaign.residuals.empty()) {
    total.expected_at_most =
        static_cast<double>(total.counts.differed) * campaign.residuals.front().worst_share;
  }
  return total;
}

std::vector<std::string> unverified_of(const EmcCampaign& campaign) {
  if (campaign.has_bursts) return emc::caveats_of(campaign.profile);
  return campaign.channel_caveats;
}

}  // namespace fieldproof::cli
