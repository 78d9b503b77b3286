#include "emc/burst_channel.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::emc {
namespace {

constexpr TickGrid kBitGrid{BurstChannel::kTicksPerBit};

}  // namespace

BurstStatistics& BurstStatistics::operator+=(const BurstStatistics& other) {
  transmissions += other.transmissions;
  hit_transmissions += other.hit_transmissions;
  changed_transmissions += other.changed_transmissions;
  rewritten_transmissions += other.rewritten_transmissions;
  pulses += other.pulses;
  wrong_levels += other.wrong_levels;
  flipped_bits += other.flipped_bits;
  return *this;
}

BurstChannel::BurstChannel(BurstSchedule schedule, WrongOutput wrong, BurstReceiver receiver,
                           trace::Trace& trace, trace::Channel place)
    : schedule_(schedule),
      wrong_(std::move(wrong)),
      reach_(wrong_.hull()),
      receiver_(std::move(receiver)),
      trace_(trace),
      place_(place),
      impact_(receiver_.framing.get(), receiver_.sampling, receiver_.validates_start) {
  if (receiver_.framing) {
    longest_unit_ = kernel::levels_duration(static_cast<std::int64_t>(receiver_.framing->longest_unit()),
                                            receiver_.bit_rate);
  }
}

// An instant that is not before the end of the transmission, without a division.
kernel::Time BurstChannel::latest_end(const line::Waveform& sent) {
  if (sent.rate != known_rate_) {
    known_rate_ = sent.rate;
    longest_level_ = kernel::levels_duration(1, sent.rate) + kernel::kPicosecond;
  }
  return sent.start + longest_level_ * static_cast<std::int64_t>(sent.levels.size());
}

bool BurstChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  ++statistics_.transmissions;
  if (is_out_of_step_ && is_far_behind_last(sent)) is_out_of_step_ = false;
  const kernel::Time latest = latest_end(sent);
  const kernel::Time last_pulse = latest - reach_.from;
  const bool is_changed = reach_.from < reach_.to &&
                          schedule_.has_pulse_in(sent.start - reach_.to + kernel::kPicosecond, last_pulse) &&
                          corrupt(sent, last_pulse, arrivals);
  last_start_ = sent.start;
  last_levels_ = sent.levels.size();
  last_rate_ = sent.rate;
  last_latest_end_ = latest;
  return is_changed;
}

bool BurstChannel::corrupt(const line::Waveform& sent, kernel::Time last_pulse, line::Waveforms& arrivals) {
  const bool is_of_bits = sent.rate == receiver_.bit_rate;
  spans_.begin(sent, is_of_bits ? kBitGrid : TickGrid(ticks_for(sent.rate)));
  pulses_.clear();
  kernel::Time from = sent.start - reach_.to + kernel::kPicosecond;
  while (schedule_.has_pulse_in(from, last_pulse)) {
    const kernel::Time pulse = schedule_.first_from(from);
    from = pulse + kernel::kPicosecond;
    pulses_.push_back({pulse, spans_.add(pulse, wrong_)});
  }
  const std::vector<Span>& heard = spans_.resolve();
  if (heard.empty()) return false;
  ++statistics_.hit_transmissions;
  count(heard);
  const bool is_known = is_of_bits && is_in_step(sent);
  if (is_known) impact_.judge(sent.levels, heard, kBitGrid);
  if (!is_known || impact_.is_unclear()) {
    rewrite(sent, heard, arrivals);
  } else {
    if (impact_.flipped_bits().empty()) return false;
    flip(sent, arrivals);
  }
  ++statistics_.changed_transmissions;
  return true;
}

// At least as many as bits have, and a whole number of them to a sixteenth of a bit where the rates allow it:
// levels of whole parts of a bit do.
std::int64_t BurstChannel::ticks_for(std::int64_t rate) const {
  const std::int64_t fewest =
      std::max<std::int64_t>(1, (kTicksPerBit * receiver_.bit_rate + rate - 1) / rate);
  for (std::int64_t ticks = fewest; ticks < fewest + 16; ++ticks) {
    if (rate * ticks % (16 * receiver_.bit_rate) == 0) return ticks;
  }
  return fewest;
}

kernel::Time BurstChannel::last_end() const {
  return kernel::level_time(last_start_, static_cast<std::int64_t>(last_levels_), last_rate_);
}

// So far that no receiver is still busy with a unit of the transmission before.
bool BurstChannel::is_far_behind_last(const line::Waveform& sent) const {
  return last_rate_ == 0 || sent.start >= last_latest_end_ + longest_unit_ ||
         sent.start >= last_end() + longest_unit_;
}

bool BurstChannel::is_in_step(const line::Waveform& sent) const {
  if (is_far_behind_last(sent)) return true;
  return receiver_.has_whole_units && !is_out_of_step_ && sent.start >= last_end();
}

// The pulses that reach into one of the spans. Both are in order, and all pulses reach equally far.
template <typename Use>
void BurstChannel::each_pulse_into(const std::vector<Span>& spans, Use&& use) const {
  auto span = spans.begin();
  for (const Pulse& pulse : pulses_) {
    while (span != spans.end() && span->to <= pulse.reach.from) ++span;
    if (span != spans.end() && span->from < pulse.reach.to) use(pulse.time);
  }
}

void BurstChannel::count(const std::vector<Span>& heard) {
  const TickGrid& grid = spans_.grid();
  std::int64_t counted = -1;  // the last level
  for (const Span& span : heard) {
    const std::int64_t first = std::max(counted + 1, grid.level_of(span.from));
    const std::int64_t last = grid.level_of(span.to - 1);
    if (last >= first) statistics_.wrong_levels += static_cast<std::uint64_t>(last - first + 1);
    counted = std::max(counted, last);
  }
  each_pulse_into(heard, [this](kernel::Time) { ++statistics_.pulses; });
}

void BurstChannel::flip(const line::Waveform& sent, line::Waveforms& arrivals) {
  line::Waveform& arrival = arrivals.add(sent);
  flipped_.clear();
  for (const std::size_t bit : impact_.flipped_bits()) {
    arrival.levels.flip(bit);
    const auto n = static_cast<std::int64_t>(bit);
    flipped_.push_back({kBitGrid.begin_of(n), kBitGrid.begin_of(n + 1)});
  }
  statistics_.flipped_bits += flipped_.size();
  tell(flipped_);
}

void BurstChannel::rewrite(const line::Waveform& sent, const std::vector<Span>& heard,
                           line::Waveforms& arrivals) {
  line::Waveform& arrival = arrivals.add();
  arrival.start = sent.start;
  const std::int64_t ticks = spans_.grid().per_level();
  arrival.rate = sent.rate * ticks;
  arrival.levels.append_stretched(sent.levels, static_cast<std::size_t>(ticks));
  for (const Span& span : heard) {
    arrival.levels.invert(static_cast<std::size_t>(span.from), static_cast<std::size_t>(span.to));
  }
  ++statistics_.rewritten_transmissions;
  tell(heard);
  is_out_of_step_ = true;
}

void BurstChannel::tell(const std::vector<Span>& changed) {
  each_pulse_into(changed, [this](kernel::Time pulse) { trace_.fault(place_, pulse, "burst pulse"); });
}

}  // namespace fieldproof::emc
