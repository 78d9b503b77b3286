#include "conformance/interbus/ring_emulator.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::interbus {

namespace {

// Telegrams that are nearer to one another than this many levels leave no silence worth noting.
constexpr std::size_t kStatusLongest = 4 * line::kDataTelegramLevels;

}  // namespace

std::vector<VirtualStation> line_of(std::size_t count, std::uint16_t id_code, unsigned words) {
  std::vector<VirtualStation> stations;
  for (std::size_t n = 0; n < count; ++n)
    stations.push_back({id_code, words, static_cast<int>(n) - 1, false});
  return stations;
}

bool CycleFaults::is_none() const {
  return flips.empty() && level_flips.empty() && longer_bits == 0 && dropped < 0 && duplicated < 0 &&
         inserted < 0 && stop_missing < 0 && flag_flipped < 0 && header_flipped < 0 && !status_flag_flipped &&
         !trailing_telegram && marked_by < 0 && !stuck;
}

RingEmulator::RingEmulator(const Rules& rules, std::vector<VirtualStation> stations)
    : rules_(rules),
      code_(line::shared_telegram_code(rules_.telegram)),
      check_(line::frame_check_named(rules_.frame_check)),
      receiver_(code_, rules_.bit_rate),
      status_levels_(code_.levels_of(0, 0)) {
  for (unsigned n = 0; n < 3; ++n) {
    if (rules_.telegram.header.at(n) == line::HeaderLevel::flag) flag_level_ = n + 1;
  }
  replace_ring(std::move(stations));
  reset_stations();
}

// ---- the ring ----

void RingEmulator::replace_ring(std::vector<VirtualStation> stations) {
  stations_ = std::move(stations);
  first_words_.clear();
  unsigned words = 0;
  for (const VirtualStation& station : stations_) {
    first_words_.push_back(words);
    words += station.words;
  }
  inputs_.resize(words);
  outputs_.assign(words, 0);
  steady_messages_.assign(stations_.size(), 0);
  error_messages_.assign(stations_.size(), 0);
  interfaces_.assign(stations_.size(), 0);
  close_ring();
}

void RingEmulator::reset_stations() {
  std::ranges::fill(outputs_, std::uint16_t{0});
  std::ranges::fill(error_messages_, std::uint16_t{0});
  std::ranges::fill(interfaces_,
                    static_cast<std::uint16_t>(rules_.control_remote_off | rules_.control_local_off));
  close_ring();
  if (on_outputs_) on_outputs_(outputs_, last_end_ + rules_.silence_limit);
}

// Which stations the interfaces that are switched on make a ring of. A station that drops out of it comes
// back in reset.
void RingEmulator::close_ring() {
  active_.clear();
  word_order_.clear();
  std::vector<bool> in_ring(stations_.size());
  for (std::size_t n = 0; n < stations_.size(); ++n) {
    const VirtualStation& station = stations_[n];
    if (station.before >= 0) {
      const auto before = static_cast<std::size_t>(station.before);
      const std::uint16_t off = station.on_branch ? rules_.control_local_off : rules_.control_remote_off;
      if (!in_ring[before] || (interfaces_[before] & off) != 0) {
        interfaces_[n] = static_cast<std::uint16_t>(rules_.control_remote_off | rules_.control_local_off);
        continue;
      }
    }
    in_ring[n] = true;
    active_.push_back(n);
  }
  for (auto n = active_.rbegin(); n != active_.rend(); ++n) {
    for (unsigned word = 0; word < stations_[*n].words; ++word)
      word_order_.push_back(first_words_[*n] + word);
  }
}

bool RingEmulator::is_open() const {
  if (active_.empty()) return true;
  if (!cut_after_) return false;
  return std::ranges::any_of(active_, [this](std::size_t n) { return stations_[n].before == *cut_after_; });
}

kernel::Duration RingEmulator::delay() const {
  const auto half_bits = static_cast<std::int64_t>(active_.size()) *
                         (rules_.forward_delay_half_bits + rules_.return_delay_half_bits);
  return extra_delay_ + kernel::levels_duration(half_bits, 2 * rules_.bit_rate);
}

// ---- the line ----

void RingEmulator::receive(segment::PortIndex, const line::Waveform& reception) {
  if (statistics_.first_telegram != kernel::kNever && reception.start - last_end_ > rules_.silence_limit) {
    reset_stations();
  }
  const bool was_open = is_open();
  begin_answer(reception.start);
  receiver_.receive(reception, [this](const line::Waveform& wave, const line::Telegram& telegram) {
    telegram_bit_ = bit_of(wave, telegram.level);
    // Most telegrams are those of the pauses.
    const bool is_plain = !telegram.is_data() && !expects_status_ && heard_bits_ > 0 &&
                          telegram_bit_ < heard_bits_ + kStatusLongest;
    if (!is_plain) return on_telegram(wave, telegram);
    heard_bits_ = telegram_bit_ + line::kStatusTelegramLevels;
    ++statistics_.status_telegrams;
    emit_status(status_levels_, line::kStatusTelegramLevels);
  });
  if (heard_bits_ > 0) {
    last_end_ = kernel::level_time(heard_from_, static_cast<std::int64_t>(heard_bits_), rules_.bit_rate);
  }
  if (is_faulted_ && faults_.stuck) {
    const auto size =
        static_cast<std::size_t>(kernel::levels_within(reception.end() - reception.start, rules_.bit_rate));
    out_.levels.clear();
    // What a receiver takes for telegrams in it is over before the next transmission begins.
    constexpr std::size_t kTail = 2 * line::kDataTelegramLevels;
    if (!*faults_.stuck && size > kTail) out_.levels.append_fill(false, size - kTail);
  }
  if (!was_open) answer();
}

void RingEmulator::on_time(kernel::Time now) {
  begin_answer(now);
  receiver_.flush([this](const line::Waveform& wave, const line::Telegram& telegram) {
    telegram_bit_ = bit_of(wave, telegram.level);
    on_telegram(wave, telegram);
    last_end_ = kernel::level_time(wave.time_of(telegram.level), telegram.levels(), rules_.bit_rate);
  });
  if (!is_open()) answer();
}

void RingEmulator::begin_answer(kernel::Time from) {
  heard_from_ = from;
  heard_bits_ = 0;
  out_.start = from + delay();
  out_.rate = rules_.bit_rate * rate_per_mille_ / 1000;
  out_.levels.clear();
  const kernel::Duration over = answered_until_ - out_.start + kernel::levels_duration(1, 2 * out_.rate);
  answered_bits_ =
      over > kernel::Duration::zero() ? static_cast<std::size_t>(kernel::levels_within(over, out_.rate)) : 0;
  out_.start += kernel::levels_duration(static_cast<std::int64_t>(answered_bits_), out_.rate);
}

void RingEmulator::answer() {
  if (out_.levels.empty()) return;
  answered_until_ = out_.end();
  back_->drive(out_);
}

// What began before the reception (a telegram that an earlier one left incomplete) leaves with its start.
std::size_t RingEmulator::bit_of(const line::Waveform& wave, std::uint32_t level) const {
  if (wave.start == heard_from_ && wave.rate == rules_.bit_rate) return level;
  const kernel::Duration since = wave.time_of(level) - heard_from_;
  if (since <= kernel::Duration::zero()) return 0;
  const kernel::Duration half_bit = kernel::levels_duration(1, 2 * rules_.bit_rate);
  return static_cast<std::size_t>(kernel::levels_within(since + half_bit, rules_.bit_rate));
}

void RingEmulator::note_gap(kernel::Time start, kernel::Time last_end) {
  if (statistics_.first_telegram == kernel::kNever) {
    statistics_.first_telegram = start;
  } else if (last_end != kernel::Time{kernel::Duration::min()}) {
    statistics_.longest_silence = std::max(statistics_.longest_silence, start - last_end);
  }
}

kernel::Duration RingEmulator::silence_until(kernel::Time now) const {
  if (statistics_.first_telegram == kernel::kNever) return now - kernel::kStart;
  return std::max(now - last_end_, kernel::Duration::zero());
}

void RingEmulator::note_wrong_phase() {
  open_cycle().in_phase = false;
  ++statistics_.wrong_phases;
}

void RingEmulator::on_telegram(const line::Waveform& wave, const line::Telegram& telegram) {
  if (heard_bits_ == 0) {
    note_gap(wave.time_of(telegram.level), last_end_);
  } else if (telegram_bit_ >= heard_bits_ + kStatusLongest) {
    note_gap(wave.time_of(telegram.level),
             kernel::level_time(heard_from_, static_cast<std::int64_t>(heard_bits_), rules_.bit_rate));
  }
  heard_bits_ = telegram_bit_ + telegram.levels();
  if (!telegram.is_data()) return on_status();
  const bool is_check = (telegram.header & line::kControl) != 0;
  const bool is_id = (telegram.header & line::kSelect) != 0;
  if (!is_check && (phase_ != Phase::transfer || is_id != is_id_cycle_)) {
    if (phase_ == Phase::transfer) note_wrong_phase();  // the cycle that is broken off
    begin_cycle(wave, telegram);
  }
  if (cycle_count_ == 0) return;  // a check phase without a cycle
  open_cycle().octets.push_back(telegram.data);
  if (is_check) {
    if (is_id != is_id_cycle_) note_wrong_phase();
    on_check(wave, telegram);
  } else {
    on_transfer(telegram);
  }
}

void RingEmulator::on_status() {
  ++statistics_.status_telegrams;
  std::uint64_t levels = status_levels_;
  unsigned count = line::kStatusTelegramLevels;
  if (std::exchange(expects_status_, false) && is_faulted_ && faults_.status_flag_flipped) {
    // The receiver takes the idle line after it for data.
    levels = (levels | ~std::uint64_t{0} << count) ^ (std::uint64_t{1} << flag_level_);
    count = line::kDataTelegramLevels;
  }
  emit_status(levels, count);
}

}  // namespace fieldproof::interbus
