#include "campaign/growth.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace fieldproof::campaign {
namespace {

constexpr std::size_t kShownPoints = 4;

std::uint64_t edges_after(const Outcome& job, std::uint64_t run) {
  const auto after = std::ranges::upper_bound(job.growth, run, {}, &GrowthPoint::run);
  return after == job.growth.begin() ? 0 : std::prev(after)->edges;
}

JointGrowth growth_after(std::span<const Outcome* const> jobs, std::uint64_t run) {
  JointGrowth point{run, 0, 0};
  for (const Outcome* job : jobs) {
    point.all += std::min(run, job->growth.empty() ? 0 : job->growth.back().run);
    point.edges = std::max(point.edges, edges_after(*job, run));
  }
  return point;
}

// "12,000".
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

bool is_power_of_ten(std::uint64_t run) {
  while (run >= 10 && run % 10 == 0) run /= 10;
  return run == 1;
}

}  // namespace

std::vector<JointGrowth> joint_growth(std::span<const Outcome* const> jobs) {
  std::uint64_t end = 0;
  for (const Outcome* job : jobs) end = std::max(end, job->growth.empty() ? 0 : job->growth.back().run);
  std::vector<JointGrowth> points;
  for (std::uint64_t power = 1; power <= end; power *= 10) {
    for (const std::uint64_t step : {1U, 2U, 5U}) {
      if (step * power < end) points.push_back(growth_after(jobs, step * power));
    }
  }
  if (end > 0) points.push_back(growth_after(jobs, end));
  return points;
}

std::string text_of(std::span<const JointGrowth> growth) {
  std::vector<std::string> points;
  for (std::size_t n = 0; n < growth.size(); ++n) {
    if (n + 1 == growth.size() || (growth[n].run > 1 && is_power_of_ten(growth[n].run)))
      points.push_back(fmt::format("{} after {}", grouped(growth[n].edges), grouped(growth[n].run)));
  }
  if (points.size() > kShownPoints) points.erase(points.begin(), points.end() - kShownPoints);
  return points.empty() ? "" : fmt::format("edges {}", fmt::join(points, ", "));
}

}  // namespace fieldproof::campaign
