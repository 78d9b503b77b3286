// What `fieldproof emc` found, as a table for a person and as JSON (reports/schema/emc.schema.json).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emc/interbus/frame_residual.hpp"
#include "emc/interbus/immunity.hpp"
#include "emc/profile.hpp"

namespace fieldproof::cli {

struct EmcTest {
  emc::Level level = emc::Level::standard(emc::PortKind::signal, 1);
  emc::Repetition repetition = emc::Repetition::khz_5;
  emc::Polarity polarity = emc::Polarity::positive;
  // Instead of bursts, the binary symmetric channel that disturbs each cable. 0: bursts.
  double flip_probability = 0;
  emc::UndetectedCycle undetected;  // on that channel
  emc::ImmunityResult result;

  bool has_bursts() const { return flip_probability == 0; }
  // Cycles that receivers may accept wrong on such a channel: no more come on average.
  double expected_wrong_cycles() const {
    return static_cast<double>(result.ledger.sent * result.receivers) * undetected.any();
  }
  // Of so many wrong cycles as were counted, or more, if that is true.
  double chance_of_count() const {
    return emc::chance_of_at_least(result.ledger.wrong_cycles, expected_wrong_cycles());
  }
};

struct EmcCampaign {
  std::string network;
  std::string implementations;  // "ref", or the options as they were given
  emc::Profile profile;
  double threshold_volts = 0;  // the lowest setting at which an output can be wrong at all
  std::uint64_t seed = 0;
  kernel::Duration duration{};
  std::vector<EmcTest> tests;
  emc::FrameResidual residual;
  bool has_bursts = true;  // else channels of the textbooks
};

// The ledger of all tests together, and how much a count of wrong words can still hide.
struct EmcTotal {
  std::uint64_t corrupted = 0;
  std::uint64_t detected = 0;
  std::uint64_t accepted_wrong = 0;
  double upper_bound_of_share = 1;  // of the corrupted cycles, one-sided 95 %; 1 where none was
  // Cycles that may pass wrong by the theory of the frame check, at the worst bit-error rate.
  double expected_at_most = 0;
};
EmcTotal total_of(const EmcCampaign& campaign);

std::string emc_table_head(bool has_bursts);
std::string emc_line(const EmcTest& test);
// The ledger and what it rests on.
std::string emc_summary(const EmcCampaign& campaign);
std::string emc_json(const EmcCampaign& campaign);

}  // namespace fieldproof::cli
