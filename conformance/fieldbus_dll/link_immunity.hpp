#pragma once

#include <string_view>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/judging.hpp"

// Bursts at the receiver of a station of either profile. What it says under them must follow from what was
// sent to it, or from what has arrived with a check that fits all the same: no station can know better.
namespace fieldproof::conformance {

inline constexpr std::string_view kBurstStimulus =
    "Bursts of IEC 61000-4-4, 5 and 100 kHz, both polarities, the two highest levels";

struct LinkBurstLedger {
  std::uint64_t sent = 0;
  std::uint64_t asked = 0;       // of those: that ask the station to say something
  std::uint64_t unanswered = 0;  // of these
};

// Each stress in turn, again and again, each from some instant within a frame on: `act` until it is over,
// then `after`, when the line is quiet.
template <typename Act, typename Behind>
void under_each_stress(LinkBench& bench, int rounds, Act act, Behind behind) {
  constexpr std::uint64_t kOctetsOfAFrame = 20;
  for (int round = 0; round < rounds; ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      const kernel::Duration later =
          bench.octets(static_cast<std::int64_t>(bench.random().below(kOctetsOfAFrame)));
      bench.begin_stress(stress, later);
      const kernel::Time until = bench.now() + later + stress.duration;
      while (bench.now() < until) act();
      bench.end_stress();
      behind();
    }
  }
}

// What the station has said to the last that was sent, under stress: `speaks_unasked`.
std::vector<DrivenDlpdu> listen_under_stress(LinkBench& bench, CaseJudge& judge, bool is_asked,
                                             LinkBurstLedger& ledger);

// For the end of a procedure; inconclusive, `nothing_was_hit`, where no transmission arrived otherwise.
void measure_stress(const LinkBench& bench, CaseJudge& judge, const LinkBurstLedger& ledger);

}  // namespace fieldproof::conformance
