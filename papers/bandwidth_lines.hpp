// The lines that the sections about the allocation of bandwidth simulate, and how figures show what goes over
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "papers/sections.hpp"
#include "protocols/bandwidth/allocation.hpp"
#include "protocols/bandwidth/window_link.hpp"

namespace fieldproof::papers {

std::int64_t microseconds_of(kernel::Duration duration);

// 3.75 data in a slot, and beside periodic data three real-time queues.
bandwidth::Demand with_real_time();
// With the longest non-real-time packets by the safe bound.
bandwidth::WindowTraffic safe_traffic(const bandwidth::Demand& demand);
std::string told_longest(const bandwidth::WindowFigures& figures);

// Stations at 1 Mbit/s, and the traffic whose packets are their frames.
bandwidth::WindowLineRules line_rules();
bandwidth::WindowTraffic on_real_line(const bandwidth::Demand& demand);

struct Span {
  std::uint64_t first_slot;
  double slots;
};
// The packets that these stations send in some slots, each as a step to the number of its node and back to
// none.
reports::PublishedCurves figure_of_packets(std::string name, const bandwidth::Demand& demand,
                                           bandwidth::Load others, const Span& span,
                                           const Settings& settings);

}  // namespace fieldproof::papers
