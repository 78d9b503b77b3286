#pragma once

#include <vector>

#include "protocols/bandwidth/window_station.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

// A line with its stations that runs: what `run_windows` simulates without frames, as frames.
namespace fieldproof::bandwidth {

// The traffic whose packets and server take as long as the frames of this line.
WindowTraffic on_line(WindowTraffic traffic, const WindowLineRules& rules);

struct LinkRun {
  std::vector<Sent> sent;  // as somebody on the line receives it, its begin with the silence before
  std::vector<WindowSampler::Books> books;  // by stream, as WindowFigures has them
  kernel::Time origin{};                    // of slots: the first visit begins then
};

// Stations of a traffic of `on_line`; for as long as `run_windows`. Throws as that does, and for a run that
// begins in a packet.
LinkRun run_window_link(const WindowTraffic& traffic, const WindowLineRules& rules, const WindowRun& run);

}  // namespace fieldproof::bandwidth
