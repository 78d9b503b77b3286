#include "reports/utc_time.hpp"

#include <chrono>
#include <ctime>
#include <iomanip>
#include <sstream>

namespace fieldproof::reports {

std::optional<std::int64_t> utc_milliseconds(const std::string& utc) {
  constexpr int kFirstYear = 1900;  // of a std::tm
  std::istringstream text(utc);
  std::tm fields{};
  text >> std::get_time(&fields, "%Y-%m-%dT%H:%M:%SZ");
  if (text.fail() || text.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
  namespace chrono = std::chrono;
  const chrono::year_month_day day{chrono::year(fields.tm_year + kFirstYear),
                                   chrono::month(static_cast<unsigned>(fields.tm_mon + 1)),
                                   chrono::day(static_cast<unsigned>(fields.tm_mday))};
  if (!day.ok()) return std::nullopt;
  const auto time = chrono::sys_days(day) + chrono::hours(fields.tm_hour) + chrono::minutes(fields.tm_min) +
                    chrono::seconds(fields.tm_sec);
  return chrono::duration_cast<chrono::milliseconds>(time.time_since_epoch()).count();
}

}  // namespace fieldproof::reports
