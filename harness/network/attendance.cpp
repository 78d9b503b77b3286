#include "harness/network/attendance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::network {

bool Attendance::is_complete() const {
  return std::ranges::all_of(stations_, &Station::has_taken_part);
}

std::string Attendance::complaint() const {
  std::string absent;
  for (const Station& station : stations_) {
    if (!station.has_taken_part()) absent += (absent.empty() ? "" : ", ") + station.name();
  }
  if (absent.empty()) return absent;
  return fmt::format("{} did not take part: never seen to drive the line since power-up", absent);
}

}  // namespace fieldproof::network
