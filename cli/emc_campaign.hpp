// The tests of one call of `fieldproof emc`, and what they say together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/emc_search.hpp"
#include "cli/protocol_entry.hpp"
#include "emc/frame_residual.hpp"
#include "emc/immunity.hpp"
#include "emc/profile.hpp"
#include "emc/pulse_picture.hpp"

namespace fieldproof::cli {

inline double microseconds(double picoseconds) {
  constexpr double kPerMicrosecond = 1e6;
  return picoseconds / kPerMicrosecond;
}

struct EmcTest {
  emc::Level level = emc::Level::standard(emc::PortKind::signal, 1);
  emc::Repetition repetition = emc::Repetition::khz_5;
  emc::Polarity polarity = emc::Polarity::positive;
  // One of the search, with its own time and seed; nothing: one of the table.
  struct OfSearch {
    kernel::Duration duration{};
    std::uint64_t seed = 0;
  };
  std::optional<OfSearch> of_search{};
  // Instead of bursts, the binary symmetric channel that disturbs each cable. 0: bursts.
  double flip_probability = 0;
  std::vector<UndetectedPart> undetected;  // on that channel
  emc::ImmunityResult result;
  // Of the same network with references alone; where an implementation of the call plays.
  std::optional<emc::ImmunityResult> reference{};

  bool has_bursts() const { return flip_probability == 0; }
  // Where there is no closed form of exchanges: the share of corrupted frames that their check lets pass at
  // this rate, of the kind of frame that lets pass most.
  double undetected_share = 0;
  void bound_by(const std::vector<network::ProtectedFrame>& frames);
  bool has_theory() const { return !undetected.empty() || undetected_share > 0; }
  // Exchanges that receivers may accept wrong on such a channel: no more come on average.
  double expected_wrong() const;
  // Of so many wrong exchanges as were counted, or more, if that is true.
  double chance_of_count() const {
    return emc::chance_of_at_least(result.counts.wrong_exchanges, expected_wrong());
  }
};

// A receiver of the network, and why bursts do not reach it where they do not.
struct EmcPlace {
  std::string name;
  bool is_exposed = true;
  std::string why_not;
  kernel::Duration level{};  // that its senders drive
  line::Sampling sampling{};
};

// A pulse of the highest level at a receiver that bursts reach.
struct EmcPulse {
  emc::PulsePicture picture;
  EmcPlace place;
};

struct EmcCampaign {
  std::string protocol;
  std::string network;
  std::string implementations;  // "ref", or the options as they were given
  emc::Profile profile;
  double threshold_volts = 0;                // the lowest setting at which an output can be wrong at all
  emc::Criterion worst = emc::Criterion::b;  // that is no failure
  std::uint64_t seed = 0;
  kernel::Duration duration{};
  std::vector<EmcTest> tests;
  bool is_complete = true;  // false: it ended before all tests were made
  std::vector<EmcPlace> places;
  std::vector<std::string> channel_caveats;  // of the theory of undetected errors
  network::RecoveryLimit recovery;
  network::AcceptanceRules acceptance;
  std::string exchange;  // what one is called: "cycle"
  // Of each kind of frame with a check; the first is the one that carries data.
  std::vector<emc::FrameResidual> residuals;
  bool has_bursts = true;  // else channels of the textbooks
  std::optional<EmcSearch> search;
  std::optional<EmcSensitivity> sensitivity;
  std::optional<EmcPulse> pulse;
};

// The errors of all tests together, and how much a count of wrong words can still hide.
struct EmcTotal {
  network::ErrorStatistics counts;
  double upper_bound_of_share = 1;  // of the exchanges whose data differed, one-sided 95 %; 1 where none was
  // Exchanges that may pass wrong by the theory of the frame check, at the worst bit-error rate.
  double expected_at_most = 0;
};
EmcTotal total_of(const EmcCampaign& campaign);

// What a reader of the results has to know of their standing.
std::vector<std::string> unverified_of(const EmcCampaign& campaign);

}  // namespace fieldproof::cli
