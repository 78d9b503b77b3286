#include "emc/immunity_course.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::emc {

ImmunityCourse::Window& ImmunityCourse::at(kernel::Time when) {
  const kernel::Duration width = std::max(length_ / kWindows, kernel::kPicosecond);
  const std::int64_t number = when - on_ >= length_ ? kWindows : (when - on_) / width;
  return windows_[static_cast<std::size_t>(std::clamp<std::int64_t>(number, 0, kWindows))];
}

void ImmunityCourse::take(const network::ErrorStatistics& counts, kernel::Time when) {
  if (windows_.empty()) return;
  Window& window = at(when);
  window.exchanges += counts.sent - before_.sent;
  window.rejected += counts.refused - before_.refused;
  window.accepted_wrong += counts.wrong_exchanges - before_.wrong_exchanges;
  before_ = counts;
}

}  // namespace fieldproof::emc
