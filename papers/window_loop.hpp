// One control loop closed over a line whose server visits nodes: the process, its controller and its actuator
// at the instants at which a simulation of the line samples and delivers.
#pragma once

#include <cstdint>
#include <vector>

#include "protocols/bandwidth/window_traffic.hpp"

namespace fieldproof::papers {

struct LoopCourse {
  struct Point {
    double time_s;
    double setpoint;
    double process;
    double actuator;
  };
  double absolute_error = 0;  // integral of |setpoint - process|, per cent x s
  double travel = 0;          // of the actuator: sum of all its moves, per cent
  std::uint64_t samplings = 0, vacant = 0, lost = 0;
  std::vector<Point> points;  // some in a sampling period
};

// Loop 0 of the traffic, for so many of its sampling periods. The process has lags of 4 and 1.6 sampling
// periods, its setpoint a step each 60.
LoopCourse run_window_loop(const bandwidth::WindowTraffic& traffic, bandwidth::Load others, unsigned periods,
                           std::uint64_t seed);

}  // namespace fieldproof::papers
