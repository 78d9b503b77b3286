// The time line of the master: what it drives when, and how it collects what comes back.
#include <algorithm>

#include "protocols/interbus/master.hpp"

namespace fieldproof::interbus {

namespace {

constexpr kernel::Duration kStatusRun = kernel::kMillisecond;
// How much later than computed a frame may come back: two telegrams, and this part of the frame for stations
// whose clock runs slower.
constexpr std::int64_t kLateBits = 2 * line::kDataTelegramLevels;
constexpr std::int64_t kSlowPart = 50;

constexpr std::uint8_t high(std::uint16_t word) {
  return static_cast<std::uint8_t>(word >> 8);
}
constexpr std::uint8_t low(std::uint16_t word) {
  return static_cast<std::uint8_t>(word & 0xFF);
}

}  // namespace

kernel::Time Master::next_time() const {
  return std::min({verdict_at_, action_at_, receiver_.pending_until()});
}

void Master::on_time(kernel::Time now) {
  if (receiver_.pending_until() <= now) {
    receiver_.flush([this](const line::Waveform& wave, const line::Telegram& telegram) {
      if (is_collecting_) on_telegram(wave, telegram);
    });
  }
  if (verdict_at_ <= now) finish_cycle(now);
  if (action_at_ <= now) act(now);
}

void Master::act(kernel::Time now) {
  if (now < recognise_at_) return drive_status(now);
  if (state_ == MasterState::ready || state_ == MasterState::bus_stop) enter_recognition();
  start_cycle(now);
}

void Master::drive_status(kernel::Time now) {
  const kernel::Time end = std::min(now + kStatusRun, recognise_at_);
  action_at_ = end;
  wave_.start = now;
  wave_.rate = rules().bit_rate;
  wave_.levels.clear();
  const std::size_t end_level = levels_within(end - now);
  writer_.append_status(wave_.levels, end_level);
  // The idle time after the last telegram belongs to the next run.
  wave_.levels.resize(std::min(wave_.levels.size(), end_level));
  if (wave_.levels.empty()) return;
  driven_until_ = wave_.end();
  out_->drive(wave_);
}

// Whole levels that end within a duration.
std::size_t Master::levels_within(kernel::Duration span) const {
  __extension__ using Wide = __int128;
  return static_cast<std::size_t>(static_cast<Wide>(span.count()) * rules().bit_rate /
                                  kernel::kSecond.count());
}

void Master::start_cycle(kernel::Time now) {
  is_id_cycle_ = state_ != MasterState::run || is_id_cycle_needed_ || id_cycle_requested_;
  cycle_start_ = now;
  wave_.levels.clear();
  if (is_id_cycle_ && !is_stopping_) {
    write_id_cycle();
  } else {
    is_id_cycle_ = false;
    write_data_cycle();
  }
}

void Master::write_data_cycle() {
  const std::size_t words = outputs_.size();
  if (is_stopping_ && clears_outputs_on_stop()) std::ranges::fill(outputs_, std::uint16_t{0});
  take_outputs(outputs_, sent_words_);
  const std::size_t size = kLoopbackOctets + 2 * words;
  if (octets_.size() < size) octets_.resize(size);
  std::uint8_t* at = octets_.data();
  *at++ = high(rules().loopback_word);
  *at++ = low(rules().loopback_word);
  for (const unsigned word : output_order_) {
    *at++ = high(sent_words_[word]);
    *at++ = low(sent_words_[word]);
  }
  const std::span<const std::uint8_t> sent(octets_.data(), size);
  constexpr CycleHeaders headers = kDataCycle;
  writer_.append_frame(wave_.levels, sent, check_of(sent, headers), headers);
  returned_.begin(data_telegrams_, size, false);
  deadline_ = cycle_start_ + std::min(cycle_time_, return_time(data_frame_));
  drive_cycle(cycle_start_, cycle_time_, data_end_level_);
}

void Master::write_id_cycle() {
  const bool in_run = state_ == MasterState::run;
  const std::size_t known = in_run ? stations_.size() : topology_.stations().size();
  octets_.clear();
  const auto put = [this](std::uint16_t word) {
    octets_.push_back(high(word));
    octets_.push_back(low(word));
  };
  put(rules().loopback_word);
  put(topology_.pad_word());
  for (std::size_t n = known; n-- > 0;) {
    const std::uint16_t acknowledge = in_run ? acknowledged_[n] : std::uint16_t{0};
    put(static_cast<std::uint16_t>(topology_.control_words()[n] | acknowledge));
  }
  CycleHeaders headers = kIdCycle;
  headers.transfer = static_cast<std::uint8_t>((headers.transfer & ~line::kSelect) | id_select());
  headers.check = static_cast<std::uint8_t>((headers.check & ~line::kSelect) | id_select());
  writer_.append_frame(wave_.levels, octets_, check_of(octets_, headers), headers);
  const std::size_t telegrams = writer_.telegram_count(octets_.size() - kLoopbackOctets);
  returned_.begin(telegrams, octets_.size(), true);
  const kernel::Duration frame = writer_.frame_time(telegrams);
  const kernel::Duration span = id_cycle_span(frame);
  deadline_ = cycle_start_ + (in_run ? std::min(span, return_time(frame)) : span - rules().software_time);
  drive_cycle(cycle_start_, span, levels_within(span));
  id_cycle_requested_ = false;
}

// Until everything has come back that still comes.
kernel::Duration Master::return_time(kernel::Duration frame) const {
  return frame + frame / kSlowPart + ring_delay_ + kernel::levels_duration(kLateBits, rules().bit_rate);
}

// In run a whole number of cycle times. Before, the delay of the ring is not known: as long as the rules let
// it be.
kernel::Duration Master::id_cycle_span(kernel::Duration frame) const {
  if (state_ == MasterState::run) {
    const kernel::Duration needed = frame + ring_delay_ + rules().software_time;
    return (needed + cycle_time_ - kernel::kPicosecond) / cycle_time_ * cycle_time_;
  }
  const auto stations = static_cast<std::int64_t>(topology_.stations().size() + 1);
  const std::int64_t half_bits =
      stations * (rules().forward_delay_half_bits + rules().return_delay_half_bits);
  const kernel::Duration cables{2 * static_cast<std::int64_t>(rules().max_cable_m) *
                                rules().cable_delay_ps_per_m};
  return frame + frame / kSlowPart + cables + kernel::levels_duration(half_bits, 2 * rules().bit_rate) +
         rules().software_time;
}

void Master::drive_cycle(kernel::Time now, kernel::Duration span, std::size_t end_level) {
  wave_.levels.resize(writer_.first_status_level(returned_.expected()));
  if (fills_pause(span)) append_pause(end_level);
  wave_.start = now;
  wave_.rate = rules().bit_rate;
  verdict_at_ = deadline_;
  is_collecting_ = true;
  driven_until_ = wave_.end();
  ++run_cycles_;
  action_at_ = now + span + lateness(run_cycles_) - lateness(run_cycles_ - 1);
  out_->drive(wave_);
}

// The pause of every data cycle is the same.
void Master::append_pause(std::size_t end_level) {
  if (is_id_cycle_) return writer_.append_status(wave_.levels, end_level);
  if (data_pause_.empty()) {
    const std::size_t frame_end = wave_.levels.size();
    if (end_level > frame_end) writer_.append_status(data_pause_, end_level - frame_end);
  }
  wave_.levels.append(data_pause_);
}

kernel::Duration Master::shortest_cycle_time() const {
  return data_frame_ + ring_delay_ + rules().software_time;
}

kernel::Duration Master::cycle_time_in_force(kernel::Duration shortest) const {
  return std::max(shortest, configuration_.cycle_time);
}

void Master::take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const {
  std::ranges::copy(image, sent.begin());
}

std::uint16_t Master::check_of(std::span<const std::uint8_t> sent, CycleHeaders) const {
  const auto octets = check_.check_octets(check_.update(check_.start(), sent));
  return static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
}

// ---- reception ----

void Master::receive(segment::PortIndex, const line::Waveform& reception) {
  if (!hears(reception)) return;
  receiver_.receive(reception, [this](const line::Waveform& wave, const line::Telegram& telegram) {
    if (is_collecting_ && (telegram.is_data() || telegram.is_stop_missing())) on_telegram(wave, telegram);
  });
}

void Master::on_telegram(const line::Waveform& wave, const line::Telegram& telegram) {
  const std::size_t before = returned_.count();
  if (!telegram.is_data()) {
    // A pause's status telegram says nothing about the cycle; within the frame it is what is left of a
    // telegram.
    if (telegram.is_stop_missing() && before > 0 && before < returned_.expected()) returned_.add_broken();
    return;
  }
  if (before == 0) first_returned_ = wave.time_of(telegram.level);
  if (before + 1 < returned_.expected()) {
    returned_.add(telegram);
    return;
  }
  const kernel::Time start = wave.time_of(telegram.level);
  if (start >= verdict_at_ || !returned_.add(telegram)) return;
  verdict_at_ =
      std::min(start + kernel::levels_duration(line::kDataTelegramLevels + guard_bits(), rules().bit_rate),
               action_at_);
}

}  // namespace fieldproof::interbus
