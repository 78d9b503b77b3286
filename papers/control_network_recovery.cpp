// The ring of Lee, Moon, Moon, Kwon, Lee and Park's control network when something happens to it. The paper
// prints no figure; what is asked for is what the timers of IEEE 802.4 allow.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "harness/traffic/milliseconds.hpp"
#include "papers/sections.hpp"
#include "protocols/token_bus/ring_recovery.hpp"

namespace fieldproof::papers {
namespace {

using kernel::Duration;
using reports::PublishedRow;
using reports::PublishedSection;
using token_bus::Disturbance;

constexpr unsigned kRingStations = 8;
constexpr std::uint64_t kFewestInstants = 30;
// Of a minute, for 13 rows: 10^4 instants.
constexpr Duration kTimeOfAnInstant = 77 * kernel::kMillisecond;

std::string ms_text(std::int64_t picoseconds) {
  return fmt::format("{:.3f}", traffic::ms(Duration{picoseconds}));
}

// What the timers and the rules of the token do not allow.
double exceeded(const token_bus::RecoveryFigures& figures) {
  const bool is_double = figures.longest_double > token_bus::slots(token_bus::Rules{}, 1);
  return static_cast<double>(figures.beyond + figures.delivered_twice + figures.out_of_order +
                             (is_double ? 1 : 0));
}

PublishedRow recovery_row(Disturbance disturbance, bool has_bursts, unsigned instants, std::uint64_t seed) {
  const token_bus::Rules rules;
  const token_bus::RecoveryFigures figures = token_bus::recover(disturbance, {.stations = kRingStations,
                                                                              .instants = instants,
                                                                              .has_bursts = has_bursts,
                                                                              .rules = rules,
                                                                              .seed = seed});
  const measure::Distribution& after = figures.whole_after;
  return {
      fmt::format("{}{}", text_of(disturbance), has_bursts ? ", and a burst" : ""), "",
      fmt::format("mean {:.3f}, 1 of 100 over {}, longest {} ms", after.mean() / traffic::kPicosecondsPerMs,
                  ms_text(after.quantile(0.99)), ms_text(after.max())),
      fmt::format("{} instants; {} over the {} ms that the timers allow; two tokens for at most {}; {} data, "
                  "{} twice, "
                  "{} out of order",
                  after.count(), figures.beyond, ms_text(figures.limit.count()),
                  kernel::describe(figures.longest_double), figures.delivered, figures.delivered_twice,
                  figures.out_of_order),
      reports::of_samples(reports::own(reports::at_most(0, exceeded(figures), "beyond")), after.count(),
                          kFewestInstants)};
}

}  // namespace

PublishedSection control_network_recovery(const Settings& settings) {
  PublishedSection section;
  section.heading = "The ring at random instants";
  section.note = fmt::format(
      "{} reference stations along 500 m, each frame as half bits. Until the ring is whole again: each "
      "station that is on is in "
      "it, and has had its one token. A burst is 75 pulses at 100 kHz.",
      kRingStations);
  const auto instants =
      static_cast<unsigned>(std::clamp<std::int64_t>(settings.duration / kTimeOfAnInstant, 2, 100'000));
  for (unsigned n = 0; n < token_bus::kDisturbances; ++n) {
    const auto disturbance = static_cast<Disturbance>(n);
    for (const bool has_bursts : {false, true}) {
      if (disturbance == Disturbance::nothing && !has_bursts) continue;
      section.rows.push_back(recovery_row(disturbance, has_bursts, instants, settings.seed));
    }
  }
  reports::PublishedCurves curve{
      "stations that are switched on together", "stations", "ms", {{"until the ring is whole", {}}}};
  for (const unsigned stations : {4U, 8U, 16U, 32U, 64U}) {
    const double time = traffic::ms(token_bus::time_to_form(stations, token_bus::Rules{}));
    curve.curves[0].points.push_back({static_cast<double>(stations), time});
    section.rows.push_back({fmt::format("{} stations that are switched on together", stations), "",
                            fmt::format("in one ring after {:.1f} ms", time), "", std::nullopt});
  }
  section.figures.push_back(std::move(curve));
  return section;
}

}  // namespace fieldproof::papers
