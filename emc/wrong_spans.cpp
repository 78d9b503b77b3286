#include "emc/wrong_spans.hpp"

#include <algorithm>
#include <limits>

namespace fieldproof::emc {
namespace {

bool begins_earlier(const Span& a, const Span& b) {
  return a.from < b.from;
}

void join_several(std::vector<Span>& spans) {
  if (!std::is_sorted(spans.begin(), spans.end(), begins_earlier)) {
    std::sort(spans.begin(), spans.end(), begins_earlier);
  }
  std::size_t last = 0;
  for (std::size_t n = 1; n < spans.size(); ++n) {
    if (spans[n].from <= spans[last].to) {
      spans[last].to = std::max(spans[last].to, spans[n].to);
    } else {
      spans[++last] = spans[n];
    }
  }
  spans.resize(last + 1);
}

// Orders spans and joins those that touch. One pulse after the other they mostly are in order.
inline void join(std::vector<Span>& spans) {
  if (spans.size() > 1) join_several(spans);
}

}  // namespace

void WrongSpans::begin(const line::Waveform& sent, const TickGrid& grid) {
  sent_ = &sent;
  grid_ = grid;
  ticks_per_picosecond_ =
      static_cast<double>(sent.rate * grid.per_level()) / static_cast<double>(kernel::kSecond.count());
  for (auto& spans : of_level_) spans.clear();
}

Span WrongSpans::add(kernel::Time pulse, const WrongOutput& wrong) {
  Span reach{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()};
  for (std::size_t level = 0; level < 2; ++level) {
    for (const Interval& interval : wrong.of_level[level]) {
      const Span span{tick_of(pulse + interval.from), tick_of(pulse + interval.to)};
      reach = {std::min(reach.from, span.from), std::max(reach.to, span.to)};
      if (span.from < span.to) of_level_[level].push_back(span);
    }
  }
  return reach;
}

const std::vector<Span>& WrongSpans::resolve() {
  heard_.clear();
  resolve(false);
  resolve(true);
  join(heard_);
  return heard_;
}

void WrongSpans::resolve(bool level) {
  std::vector<Span>& spans = of_level_[level ? 1 : 0];
  join(spans);
  const line::Levels& levels = sent_->levels;
  const std::int64_t end = grid_.begin_of(static_cast<std::int64_t>(levels.size()));
  for (const Span& span : spans) {
    const std::int64_t from = std::max<std::int64_t>(0, span.from);
    const std::int64_t to = std::min(end, span.to);
    for (std::int64_t at = from; at < to;) {
      const std::int64_t n = grid_.level_of(at);
      const std::int64_t next = std::min(to, grid_.begin_of(n + 1));
      if (levels[static_cast<std::size_t>(n)] == level) heard_.push_back({at, next});
      at = next;
    }
  }
}

}  // namespace fieldproof::emc
