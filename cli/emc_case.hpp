// A test of `emc` that ended worse than it may, as a file that `replay` and `shrink` run again: network and
// who is in it, seed, what disturbs and for how long, and what came of it. Paths of a network are as seen
// from the file.
//
// Reading is strict: kernel::Error(configuration) names line and pointer. 64-bit numbers are texts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/flipped_bits.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/verbs.hpp"
#include "conformance/planned_network.hpp"
#include "emc/immunity.hpp"
#include "emc/planned_bursts.hpp"
#include "harness/fault/plan.hpp"
#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::cli {

inline constexpr std::string_view kEmcCaseSchema = "fieldproof/emc_case/1";

// Transmissions that start in it, at their receiver.
struct EmcWindow {
  kernel::Time from{};
  kernel::Time to{};

  bool holds(kernel::Time time) const { return time >= from && time < to; }
};

struct EmcEnd {
  emc::Criterion criterion = emc::Criterion::a;
  std::string reason;      // a word
  std::string decided_by;  // with its number
  std::uint64_t fingerprint = 0;
};

struct EmcCase {
  const ProtocolEntry* protocol = nullptr;
  std::shared_ptr<const conformance::PlannedNetwork> network;
  conformance::NetworkRequest request;  // that it was planned from
  std::string latch;                    // its name; empty: the network has none
  std::uint64_t seed = 1;
  kernel::Duration duration{};
  emc::PlannedBursts bursts;
  double flip_probability = 0;      // where it is not 0, of a binary symmetric channel instead
  std::vector<EmcWindow> windows;   // only what starts in one of these is disturbed; empty: all
  std::optional<fault::Plan> plan;  // in the place of all that
  emc::Criterion worst = emc::Criterion::c;
  EmcEnd end;

  bool is_failure() const { return end.criterion > worst; }
};

EmcEnd end_of(const emc::ImmunityResult& result);
emc::ImmunitySettings immunity_settings(const EmcCase& test, std::stop_token stop = {});
// Of the test that is disturbed like this one in a campaign of that seed, whichever other tests the campaign
// has.
std::uint64_t seed_of(const EmcCase& test, std::uint64_t campaign_seed);

void write_emc_case(const std::filesystem::path& file, const EmcCase& test);
// Its network is planned; with the limits of the session, and where that is asked for with its `--iut`.
EmcCase load_emc_case(const std::filesystem::path& file, const Session& session, bool has_other_iut = false);

// The plan with these bits.
fault::Plan plan_with(const FlippedBits& bits);

// Of an implementation that takes part no more: the installation does not work again.
emc::ImmunityResult end_by(const iut::Misbehaviour& misbehaviour);

}  // namespace fieldproof::cli
