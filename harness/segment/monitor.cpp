#include "harness/segment/monitor.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::segment {
namespace {

bool has_change(const line::Levels& levels) {
  for (std::size_t n = 1; n < levels.size(); ++n)
    if (levels[n] != levels[0]) return true;
  return false;
}

}  // namespace

std::string_view text_of(ViolationKind kind) {
  switch (kind) {
    case ViolationKind::overlap:
      return "monitor: overlap";
    case ViolationKind::long_silence:
      return "monitor: silence too long";
    case ViolationKind::short_gap:
      return "monitor: gap too short";
    case ViolationKind::long_drive:
      return "monitor: drives too long";
    case ViolationKind::too_many:
      return "monitor: too many transmissions";
  }
  return "";
}

LineMonitor::LineMonitor(const MonitorRules& rules, trace::Trace& trace, trace::Channel place)
    : rules_(rules), trace_(trace), place_(place) {
  FIELDPROOF_CHECK((rules.most_transmissions > 0) == (rules.window > kernel::Duration{}),
                   "a monitor counts transmissions within a window, or not at all");
  violations_.reserve(kKept);
}

void LineMonitor::on_wave(const line::Waveform& wave) {
  const kernel::Time end = end_of(wave);
  has_changed_ = has_changed_ || has_change(wave.levels);
  if (has_heard_ && is_before_the_last(wave.start, end)) {
    before_until_ = end;
    if (rules_.most_transmissions > 0) check_number(last_since_);
    return;
  }
  if (has_heard_) check_pause(wave.start);
  last_since_ = wave.start;
  before_until_ = has_heard_ ? heard_until_ : kernel::kStart;
  if (!has_heard_ || wave.start > heard_until_) {
    drive_since_ = wave.start;
    is_drive_told_ = false;
  }
  has_heard_ = true;
  heard_until_ = std::max(heard_until_, end);
  if (rules_.longest_drive) check_drive(wave.start, end);
  if (rules_.most_transmissions > 0) check_number(wave.start);
}

// A division less for the usual rates.
kernel::Time LineMonitor::end_of(const line::Waveform& wave) {
  if (wave.rate != known_rate_) {
    known_rate_ = wave.rate;
    const bool is_whole = kernel::kSecond.count() % wave.rate == 0;
    level_ = kernel::Duration{is_whole ? kernel::kSecond.count() / wave.rate : 0};
  }
  if (level_ == kernel::Duration{} || wave.levels.size() > 1'000'000) return wave.end();
  return wave.start + level_ * static_cast<std::int64_t>(wave.levels.size());
}

bool LineMonitor::is_before_the_last(kernel::Time start, kernel::Time end) const {
  return before_until_ <= start && start < last_since_ && end <= last_since_;
}

void LineMonitor::check_pause(kernel::Time start) {
  const kernel::Duration gap = start - heard_until_;
  if (gap == kernel::Duration{}) return;
  if (gap < kernel::Duration{}) {
    if (-gap > rules_.rounding) note(ViolationKind::overlap, start, -gap);
  } else if (rules_.shortest_gap && gap < *rules_.shortest_gap) {
    note(ViolationKind::short_gap, start, gap);
  } else if (rules_.longest_silence && gap > *rules_.longest_silence) {
    note(ViolationKind::long_silence, start, gap);
  }
}

void LineMonitor::check_drive(kernel::Time start, kernel::Time end) {
  if (is_drive_told_ || end - drive_since_ <= *rules_.longest_drive) return;
  is_drive_told_ = true;
  note(ViolationKind::long_drive, start, end - drive_since_);
}

void LineMonitor::check_number(kernel::Time start) {
  // It grows with the line: most cases are over long before there are too many.
  if (begins_.size() < rules_.most_transmissions) {
    begins_.push_back(start);
    return;
  }
  kernel::Time& oldest = begins_[oldest_];
  if (start - oldest < rules_.window) note(ViolationKind::too_many, start, start - oldest);
  oldest = start;
  oldest_ = (oldest_ + 1) % begins_.size();
}

void LineMonitor::on_contention(const Contention& contention) {
  if (contention.place == place_) {
    note(ViolationKind::overlap, contention.from, contention.to - contention.from);
  }
}

void LineMonitor::finish(kernel::Time now) {
  if (!has_heard_ || !rules_.longest_silence || now <= heard_until_) return;
  const kernel::Duration silence = now - heard_until_;
  if (silence > *rules_.longest_silence) note(ViolationKind::long_silence, now, silence);
}

void LineMonitor::note(ViolationKind kind, kernel::Time time, kernel::Duration measured) {
  ++count_;
  if (violations_.size() < kKept) violations_.push_back({kind, time, measured});
  trace_.observe(place_, time, text_of(kind), static_cast<std::uint64_t>(measured.count()));
}

}  // namespace fieldproof::segment
