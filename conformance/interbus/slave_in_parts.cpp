#include "conformance/interbus/slave_in_parts.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {

SlaveInParts::SlaveInParts(std::unique_ptr<interbus::SlaveDevice> slave, const interbus::Rules& rules,
                           ReturnParts returns)
    : slave_(std::move(slave)),
      receivers_{line::TelegramReceiver{line::shared_telegram_code(rules.telegram), rules.bit_rate},
                 line::TelegramReceiver{line::shared_telegram_code(rules.telegram), rules.bit_rate},
                 line::TelegramReceiver{line::shared_telegram_code(rules.telegram), rules.bit_rate}},
      returns_(returns) {}

void SlaveInParts::set_power(bool is_on, kernel::Time now) {
  for (line::TelegramReceiver& receiver : receivers_) receiver.reset();
  phase_ = Phase::none;
  later_.clear();
  slave_->set_power(is_on, now);
}

void SlaveInParts::receive(segment::PortIndex port, const line::Waveform& reception) {
  forget(port);
  if (port != interbus::kFromUpstream && returns_ == ReturnParts::whole)
    return slave_->receive(port, reception);
  starts_.clear();
  receivers_.at(port).receive(reception, [&](const line::Waveform& wave, const line::Telegram& telegram) {
    const bool begins = begins_part(port, telegram);
    // One that began before this reception came with it.
    if (begins && &wave == &reception && telegram.level > 0) starts_.push_back(telegram.level);
  });
  if (starts_.empty()) return slave_->receive(port, reception);
  cut(port, reception);
}

bool SlaveInParts::begins_part(segment::PortIndex port, const line::Telegram& telegram) {
  if (port != interbus::kFromUpstream) return true;
  const bool is_id_cycle = (telegram.header & line::kSelect) != 0;
  if (!telegram.is_data()) {
    const bool begins = phase_ == Phase::check;
    if (begins) phase_ = Phase::pause;
    return begins;
  }
  if ((telegram.header & line::kControl) != 0) {
    if (is_id_cycle) phase_ = Phase::check;
    return false;
  }
  return std::exchange(phase_, Phase::none) != Phase::none;
}

void SlaveInParts::cut(segment::PortIndex port, const line::Waveform& reception) {
  const line::Waveform first{reception.start, reception.rate, reception.levels.slice(0, starts_.front())};
  for (std::size_t n = 0; n < starts_.size(); ++n) {
    const std::size_t end = n + 1 < starts_.size() ? starts_[n + 1] : reception.levels.size();
    Part part{port,
              {reception.time_of(starts_[n]), reception.rate,
               reception.levels.slice(starts_[n], end - starts_[n])}};
    const auto place = std::ranges::upper_bound(later_, part.wave.start, {},
                                                [](const Part& other) { return other.wave.start; });
    later_.insert(place, std::move(part));
  }
  slave_->receive(port, first);
}

void SlaveInParts::forget(segment::PortIndex port) {
  std::erase_if(later_, [port](const Part& part) { return part.port == port; });
}

void SlaveInParts::on_time(kernel::Time now) {
  while (!later_.empty() && later_.front().wave.start <= now) {
    const Part part = std::move(later_.front());
    later_.pop_front();
    slave_->receive(part.port, part.wave);
  }
  if (slave_->next_time() <= now) slave_->on_time(now);
}

kernel::Time SlaveInParts::next_time() const {
  return later_.empty() ? slave_->next_time() : std::min(slave_->next_time(), later_.front().wave.start);
}

}  // namespace fieldproof::conformance
