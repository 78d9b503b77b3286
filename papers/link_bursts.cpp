#include "papers/link_bursts.hpp"

#include "emc/burst_stress.hpp"

namespace fieldproof::papers {

fieldbus_dll::FfDisturb bursts_on_link(const emc::Profile& profile, const emc::BurstSettings& settings,
                                       std::int64_t bit_rate, kernel::Time on, std::uint64_t seed) {
  return [make = emc::lasting_bursts(profile, settings), bit_rate, on, seed](
             segment::Segment& segment, const segment::MediumPort& place) {
    // The levels of the line are half bits.
    return make({2 * bit_rate, on, kernel::Random(seed), segment.trace(), place.trace_channel()});
  };
}

}  // namespace fieldproof::papers
