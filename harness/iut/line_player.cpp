#include "harness/iut/line_player.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::iut {
namespace {

constexpr std::size_t kMostReports = 100'000;

}  // namespace

bool LinePlayer::start(const CaseBegin& begin) {
  station_.reset();
  line_.set_clock(clock_);
  is_supplied_ = false;
  set_line(begin);
  line_.forget_arrived();
  now_ = driven_until_ = kernel::kStart;
  blocks_.clear();
  reports_.clear();
  received_ = sent_ = 0;
  station_ = make_station_(begin);
  return station_->begin(begin, *this);
}

void LinePlayer::set_line(const CaseBegin& begin) {
  uart_ = make_uart_(begin);
  code_ = std::make_unique<line::CharacterCode>(uart_.format);
  receiver_ = std::make_unique<line::CharacterReceiver>(uart_.format, uart_.bit_rate);
  line_.set(uart_.bit_rate, uart_.eight_bit_format());
}

void LinePlayer::look_at_inputs() {
  if (bench_ == nullptr) return;
  for (const Item item : inputs_) values_[item] = bench_->read(item, now_);
}

void LinePlayer::begin_alone(const CaseBegin& begin) {
  clock_ = WallClock();
  start(begin);
  is_supplied_ = true;
  station_->set_power(true, kernel::kStart);
}

bool LinePlayer::begin(const CaseBegin& begin, Bench& bench) {
  bench_ = &bench;
  const auto origin =
      std::ranges::find(begin.settings, kClockOrigin, [](const auto& one) { return one.first; });
  clock_ = origin == begin.settings.end() ? WallClock() : WallClock(origin->second);
  return start(begin);
}

void LinePlayer::end() {
  station_->end();
  station_.reset();
  bench_ = nullptr;
}

void LinePlayer::set_power(bool is_on, kernel::Time now) {
  now_ = std::max(now_, now);
  look_at_inputs();
  is_supplied_ = is_on;
  blocks_.clear();
  driven_until_ = now_;
  station_->set_power(is_on, now_);
  report();
}

// What is asked at another port than the line, at once.
void LinePlayer::receive(unsigned port, std::span<const Character> characters, kernel::Time) {
  FIELDPROOF_CHECK(port != 0, "a station on a real line receives from that line");
  if (!is_supplied_) return;
  look_at_inputs();
  advance(clock_.now());
  now_ = std::max(now_, clock_.now());
  station_->receive(port, characters, now_);
  report();
}
void LinePlayer::receive(unsigned, const line::Waveform&) {
  FIELDPROOF_CHECK(false, "a station on a real line receives from that line");
}

kernel::Time LinePlayer::next_time() const {
  if (station_ == nullptr || !is_supplied_) return kernel::kNever;
  kernel::Time next = std::max(station_->next_time(), now_);
  if (!blocks_.empty()) next = std::min(next, blocks_.front().end);
  return next;
}

void LinePlayer::on_time(kernel::Time until) {
  // A station that has something to do has looked at its inputs before.
  const bool is_idle = blocks_.empty() && station_ != nullptr && station_->next_time() == kernel::kNever;
  if (is_idle) look_at_inputs();
  do turn(until, -1);
  while (clock_.now() < until);
  report();
}

void LinePlayer::play(int descriptor) {
  while (true) {
    turn(kernel::kNever, descriptor);
    if (descriptor >= 0 && can_be_read(descriptor)) return;
  }
}

// ---- the line and the clock ----

void LinePlayer::turn(kernel::Time until, int descriptor) {
  const kernel::Time next = std::min(next_time(), until);
  while (const auto arrival = line_.read(next, descriptor)) {
    receive(*arrival);
    if (next_time() < next) break;
  }
  advance(clock_.now());
}

// Characters that were read together followed each other, and the last one was over by then.
void LinePlayer::receive(const Arrival& arrival) {
  if (station_ == nullptr || !is_supplied_) return;
  const kernel::Duration character = uart_.character_time();
  const auto length = static_cast<std::int64_t>(arrival.octets.size()) * character;
  // What has been done stays: a station does not receive what lies before that.
  kernel::Time start = std::max(arrival.stamp.latest - length, now_ - character);
  for (const std::uint8_t octet : arrival.octets) {
    line::Waveform wave;
    wave.rate = uart_.bit_rate * uart_.levels_per_bit();
    wave.start = start;
    code_->append(wave.levels, uart_.character_of(octet));
    const kernel::Time end = wave.end();
    advance(end - kernel::kPicosecond);
    now_ = std::max(now_, end);
    station_->receive(0, wave);
    start = end;
  }
  received_ += arrival.octets.size();
  add(Write{kReceivedOctets, received_, now_});
}

void LinePlayer::advance(kernel::Time until) {
  while (station_ != nullptr && is_supplied_) {
    const kernel::Time station_at = std::max(station_->next_time(), now_);
    const kernel::Time block_at = blocks_.empty() ? kernel::kNever : blocks_.front().end;
    if (std::min(station_at, block_at) > until) return;
    if (block_at < station_at) {
      const Block block = std::move(blocks_.front());
      blocks_.pop_front();
      put_on_line(block);
    } else {
      now_ = station_at;
      station_->on_time(station_at);
    }
  }
}

void LinePlayer::put_on_line(const Block& block) {
  std::vector<std::uint8_t> octets;
  for (const std::uint16_t character : block.transmission.characters)
    octets.push_back(static_cast<std::uint8_t>(character));
  if (octets.empty()) return;
  const Stamp written = line_.write(octets);
  sent_ += octets.size();
  if (reports_.size() >= kMostReports) return;
  add(block.transmission);
  add(Write{kSentOctets, sent_, written.latest});
}

// Alone there is nobody to report to.
void LinePlayer::add(Report report) {
  if (bench_ != nullptr && reports_.size() <= kMostReports) reports_.push_back(std::move(report));
}

void LinePlayer::report() {
  for (; bench_ != nullptr && !reports_.empty(); reports_.pop_front()) {
    if (const auto* write = std::get_if<Write>(&reports_.front())) {
      bench_->write(write->item, write->value, write->when);
    } else {
      const auto& sent = std::get<UartTransmission>(reports_.front());
      bench_->set_driver(0, true, sent.driver_on);
      bench_->send(0, sent.start, sent.characters);
      bench_->set_driver(0, false, sent.driver_off);
    }
  }
}

// ---- the station ----

void LinePlayer::send(unsigned, kernel::Time, std::span<const std::uint16_t>) {
  FIELDPROOF_CHECK(false, "a station on a real line is one of levels");
}

void LinePlayer::transmit(unsigned, line::Waveform& wave) {
  const auto follows = [](kernel::Time start, kernel::Time end) {
    return std::chrono::abs(start - end) <= kernel::kNanosecond;
  };
  const bool is_driving = follows(wave.start, driven_until_);
  if (!is_driving) driver_on_ = wave.start;
  std::vector<line::CharacterReceiver::Received> characters;
  receiver_->receive(wave, characters);
  for (const auto& one : characters) {
    const bool goes_on = is_driving && !blocks_.empty() && follows(one.start, blocks_.back().end);
    if (!goes_on) {
      blocks_.push_back({{driver_on_, one.start, {}, {}}, {}});
      driver_on_ = wave.start;  // what comes after it without a pause has a driver that is on already
    }
    blocks_.back().transmission.characters.push_back(one.character.data);
    blocks_.back().end = one.busy_until;
  }
  driven_until_ = wave.end();
  const bool has_sent = !blocks_.empty() && blocks_.back().end > driver_on_;
  if (has_sent) blocks_.back().transmission.driver_off = driven_until_;
  wave.levels.clear();
}

void LinePlayer::write(Item item, std::uint64_t value, kernel::Time when) {
  add(Write{item, value, std::max(when, now_)});
}

std::uint64_t LinePlayer::read(Item item, kernel::Time) {
  return values_[item];
}

}  // namespace fieldproof::iut
