#include "harness/network/attendance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::network {

void Attendance::begin() {
  for (Station& station : stations_) station.last_.reset();
}

bool Attendance::is_complete() const {
  return std::ranges::all_of(stations_, &Station::has_taken_part);
}

bool Attendance::is_lasting(kernel::Time now, kernel::Duration longest_absence) const {
  return std::ranges::none_of(stations_,
                              [&](const Station& station) { return is_gone(station, now, longest_absence); });
}

std::string Attendance::complaint() const {
  std::string absent;
  std::string uncalled;
  for (const Station& station : stations_) {
    if (station.has_taken_part()) continue;
    if (station.why_silent_.empty()) {
      absent += (absent.empty() ? "" : ", ") + station.name_;
    } else {
      uncalled += fmt::format("{}nothing can be seen of {}: {}", uncalled.empty() ? "" : "; ", station.name_,
                              station.why_silent_);
    }
  }
  if (absent.empty()) return uncalled;
  return fmt::format("{} did not take part: never seen to drive the line since power-up{}{}", absent,
                     uncalled.empty() ? "" : "; ", uncalled);
}

std::string Attendance::complaint_about_gone(kernel::Time now, kernel::Duration longest_absence) const {
  std::string gone;
  for (const Station& station : stations_) {
    if (!is_gone(station, now, longest_absence)) continue;
    gone += fmt::format("{}{} takes part no more: last seen to drive the line {} ago",
                        gone.empty() ? "" : ", ", station.name_, kernel::describe(now - *station.last_));
  }
  return gone;
}

}  // namespace fieldproof::network
