#include "harness/segment/medium.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"
#include "harness/segment/past_drive.hpp"
#include "harness/segment/stop.hpp"

namespace fieldproof::segment {
namespace {

// Levels per level of the fastest member, when the members of a group are not on one grid.
constexpr std::int64_t kFiner = 16;

kernel::Duration between(kernel::Duration a, kernel::Duration b) {
  return a < b ? b - a : a - b;
}

constexpr std::int64_t kLevelsOfWord = 64;

// Of 64 levels, those that somebody drives to 1 and those to 0.
struct DrivenLevels {
  std::uint64_t ones = 0;
  std::uint64_t zeros = 0;

  // Levels of which number `first` is the first of the 64.
  void add(const line::Levels& levels, std::int64_t first) {
    const auto size = static_cast<std::int64_t>(levels.size());
    if (first >= size || first <= -kLevelsOfWord) return;
    const bool begins_here = first < 0;
    const std::int64_t from = begins_here ? 0 : first;
    std::uint64_t driven =
        size - from < kLevelsOfWord ? (std::uint64_t{1} << (size - from)) - 1 : ~std::uint64_t{0};
    std::uint64_t window = levels.window(static_cast<std::size_t>(from));
    if (begins_here) {
      driven <<= -first;
      window <<= -first;
    }
    ones |= window & driven;
    zeros |= ~window & driven;
  }
};

}  // namespace

MediumPort::MediumPort(Medium& medium, std::size_t index, std::string_view name, std::size_t station,
                       PortIndex port, kernel::Duration position, bool receives_own_echo)
    : medium_(medium),
      index_(index),
      trace_channel_(medium.segment_.trace().add_channel(std::string(name))),
      station_(station),
      port_(port),
      position_(position),
      receives_own_echo_(receives_own_echo),
      random_(medium.random_.split(name)) {}

const std::string& MediumPort::name() const {
  return medium_.segment_.trace().channel_name(trace_channel_);
}

void MediumPort::drive(line::Waveform& wave) {
  medium_.drive(*this, wave);
}

void MediumPort::sense_activity() {
  senses_activity_ = true;
  medium_.due_.set(index_, next());
}

bool MediumPort::is_busy(kernel::Time now) const {
  const auto covers = [&](const Flight& flight) { return flight.start <= now && now < flight.end; };
  return std::any_of(flights_.begin(), flights_.end(), covers) ||
         std::any_of(own_.begin(), own_.end(), covers);
}

void MediumPort::expect(const Flight& flight) {
  const auto behind = std::find_if(flights_.begin(), flights_.end(),
                                   [&](const Flight& other) { return other.start > flight.start; });
  flights_.insert(behind, flight);
}

// How many flights, from the first on, hang together by overlapping, and when the last of them ends.
std::size_t MediumPort::first_group(kernel::Time& end) const {
  end = flights_.front().end;
  std::size_t count = 1;
  for (; count < flights_.size() && flights_[count].start < end; ++count) {
    end = std::max(end, flights_[count].end);
  }
  return count;
}

kernel::Time MediumPort::next() const {
  kernel::Time at = late_.empty() ? kernel::kNever : late_.front().end();
  if (flights_.empty()) return at;
  if (senses_activity_ && !is_active_) return std::min(at, flights_.front().start);
  kernel::Time end;
  first_group(end);
  return std::min(at, end);
}

void MediumPort::tell_due(kernel::Time now) {
  while (!late_.empty() && late_.front().end() <= now) {
    const line::Waveform wave = std::move(late_.front());
    late_.erase(late_.begin());
    tell(wave);
  }
  if (senses_activity_) tell_activity(now);
  kernel::Time end;
  while (!flights_.empty()) {
    const std::size_t count = first_group(end);
    if (end > now) return;
    tell_group(count, end);
    if (senses_activity_) tell_activity(now);
  }
}

void MediumPort::tell_activity(kernel::Time now) {
  // What is over and not told yet is activity still: its end is told after it.
  const bool is_active = !flights_.empty() && flights_.front().start <= now;
  if (is_active == is_active_) return;
  is_active_ = is_active;
  medium_.segment_.tell_activity(station_, port_, is_active);
}

void MediumPort::tell_group(std::size_t count, kernel::Time end) {
  const auto last = flights_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<Flight> group = std::exchange(group_, {});
  group.assign(flights_.begin(), last);
  flights_.erase(flights_.begin(), last);
  if (count == 1) {
    line::Waveform& wave = group.front().transmission->wave;
    wave.start = group.front().start;
    pass(wave, end);
  } else {
    line::Waveform resolved;
    medium_.contend(*this, group, end, resolved);
    pass(resolved, end);
  }
  for (const Flight& flight : group) medium_.release(*flight.transmission);
  group.clear();
  group_ = std::move(group);
}

void MediumPort::pass(const line::Waveform& wave, kernel::Time now) {
  line::Waveforms arrivals = std::exchange(arrivals_, {});
  if (channel_ == nullptr || !channel_->pass(wave, arrivals)) {
    tell(wave);
  } else {
    medium_.segment_.trace().changed(trace_channel_, wave.start, wave, arrivals);
    for (line::Waveform& arrival : arrivals) {
      if (arrival.end() <= now) {
        tell(arrival);
        continue;
      }
      const auto behind = std::find_if(late_.begin(), late_.end(), [&](const line::Waveform& other) {
        return other.end() > arrival.end();
      });
      late_.insert(behind, std::move(arrival));
    }
  }
  arrivals.clear();
  arrivals_ = std::move(arrivals);
}

void MediumPort::tell(const line::Waveform& wave) {
  for (Tap* tap : taps_) tap->on_wave(wave);
  if (station_ != kNobody) medium_.segment_.deliver(station_, port_, wave);
}

Medium::Medium(Segment& segment, std::string name, ContentionRule rule, const kernel::Random& random)
    : segment_(segment),
      name_(std::move(name)),
      rule_(rule),
      random_(random.split("medium").split(name_)),
      slot_(segment.scheduler().add(*this)) {}

Medium::~Medium() {
  segment_.scheduler().remove(slot_);
}

MediumPort& Medium::attach(std::string_view name, std::size_t station, PortIndex port,
                           kernel::Duration position, bool receives_own_echo) {
  due_.add();
  return ports_.emplace_back(*this, ports_.size(), name, station, port, position, receives_own_echo);
}

MediumPort& Medium::listen(std::string_view name, kernel::Duration position) {
  return attach(name, MediumPort::kNobody, 0, position, true);
}

void Medium::drive(MediumPort& from, line::Waveform& wave) {
  expect_not_past(from.name(), wave, segment_.now());
  segment_.trace().driven(from.trace_channel_, wave);
  for (Tap* tap : driven_taps_) tap->on_wave(wave);
  for (Tap* tap : from.driven_taps_) tap->on_wave(wave);
  if (wave.levels.empty()) return;
  if (free_.empty()) free_.push_back(&transmissions_.emplace_back());
  MediumPort::Transmission& transmission = *free_.back();
  free_.pop_back();
  std::swap(transmission.wave, wave);
  wave.levels.clear();
  transmission.places = ports_.size();
  const kernel::Time start = transmission.wave.start;
  const kernel::Time end = transmission.wave.end();
  for (MediumPort& port : ports_) {
    const kernel::Duration delay = between(port.position_, from.position_);
    const MediumPort::Flight flight{&transmission, start + delay, end + delay};
    if (&port != &from || from.receives_own_echo_) {
      port.expect(flight);
      due_.set(port.index_, port.next());
      continue;
    }
    const kernel::Time now = segment_.now();
    std::erase_if(port.own_, [&](const MediumPort::Flight& own) { return own.end <= now; });
    port.own_.push_back(flight);
    release(transmission);
  }
  arm();
}

void Medium::release(MediumPort::Transmission& transmission) {
  if (--transmission.places > 0) return;
  transmission.wave.levels.clear();
  free_.push_back(&transmission);
}

void Medium::on_time(kernel::Time now) {
  give_up_if_stopped();
  for (std::size_t i = due_.first_due(0, now); i < ports_.size(); i = due_.first_due(i + 1, now)) {
    ports_[i].tell_due(now);
    due_.set(i, ports_[i].next());
  }
  arm();
}

void Medium::arm() {
  const kernel::Time at = due_.earliest();
  if (at != segment_.scheduler().armed(slot_)) segment_.scheduler().arm(slot_, at);
}

void Medium::contend(MediumPort& at, const std::vector<MediumPort::Flight>& group, kernel::Time end,
                     line::Waveform& resolved) {
  resolved.start = group.front().start;
  resolved.rate = 0;
  for (const auto& flight : group) resolved.rate = std::max(resolved.rate, flight.transmission->wave.rate);
  const bool is_one_grid = std::all_of(group.begin(), group.end(), [&](const MediumPort::Flight& flight) {
    const line::Waveform& wave = flight.transmission->wave;
    if (wave.rate != resolved.rate || kernel::kSecond.count() % wave.rate != 0) return false;
    return (flight.start - resolved.start).count() % (kernel::kSecond.count() / wave.rate) == 0;
  });
  if (is_one_grid) {
    resolve_on_grid(group, end, at.random_, resolved);
  } else {
    resolve_by_instants(group, end, at.random_, resolved);
  }
  segment_.trace().observe(at.trace_channel_, resolved.start, kContention, group.size());
  const Contention contention{at.trace_channel_, resolved.start, end, group.size()};
  for (ContentionWatcher* watcher : watchers_) watcher->on_contention(contention);
}

// Level for level: many stations may contend, as those that claim a token together.
void Medium::resolve_on_grid(const std::vector<MediumPort::Flight>& group, kernel::Time end,
                             kernel::Random& random, line::Waveform& resolved) const {
  const kernel::Duration level{kernel::kSecond.count() / resolved.rate};
  const std::int64_t count = (end - resolved.start + level - kernel::kPicosecond) / level;
  for (std::int64_t first = 0; first < count; first += kLevelsOfWord) {
    DrivenLevels driven;
    for (const MediumPort::Flight& flight : group)
      driven.add(flight.transmission->wave.levels, first - (flight.start - resolved.start) / level);
    std::uint64_t levels = ~driven.zeros;
    for (std::uint64_t left = driven.ones & driven.zeros; left != 0; left &= left - 1)
      if (one_wins(random)) levels |= left & (0 - left);
    resolved.levels.append(levels, static_cast<unsigned>(std::min(kLevelsOfWord, count - first)));
  }
}

void Medium::resolve_by_instants(const std::vector<MediumPort::Flight>& group, kernel::Time end,
                                 kernel::Random& random, line::Waveform& resolved) const {
  resolved.rate *= kFiner;
  // Every flight is asked at its own place in time.
  for (const auto& flight : group) flight.transmission->wave.start = flight.start;
  for (std::int64_t n = 0; kernel::level_time(resolved.start, n, resolved.rate) < end; ++n) {
    const kernel::Time middle = kernel::level_time(resolved.start, 2 * n + 1, 2 * resolved.rate);
    bool has_one = false;
    bool has_zero = false;
    for (const MediumPort::Flight& flight : group) {
      if (middle < flight.start || middle >= flight.end) continue;
      (flight.transmission->wave.at(middle) ? has_one : has_zero) = true;
    }
    resolved.levels.append((has_one && has_zero ? one_wins(random) : !has_zero) ? 1 : 0, 1);
  }
}

// Whether a 1 stays a 1 beside a 0.
bool Medium::one_wins(kernel::Random& random) const {
  if (rule_ == ContentionRule::noise) return (random.next() >> 63) != 0;
  return rule_ == ContentionRule::one_wins;
}

}  // namespace fieldproof::segment
