#include "conformance/interbus/slave_frame_seeded_faults.hpp"

#include <algorithm>
#include <cstdlib>

namespace fieldproof::conformance::slave_seeded_faults {

void ExpectsTheUsualLoopbackWord::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port == interbus::kFromUpstream && reception.rate == rules().bit_rate) {
    const line::TelegramCode code(rules().telegram);
    has_word_.clear();
    std::size_t transfer = 0;
    std::size_t checks = 0;
    std::uint8_t before = 0;
    bool has_word = false;
    code.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
      if (!telegram.is_data()) return;
      if ((telegram.header & line::kControl) != 0) {
        if (++checks == 4) has_word_.push_back(has_word);
        return;
      }
      if (checks > 0) {
        transfer = checks = 0;
        has_word = false;
      }
      const auto word = static_cast<std::uint16_t>(before << 8 | telegram.data);
      if (transfer++ % 2 == 1 && word == rules().loopback_word) has_word = true;
      before = telegram.data;
    });
  }
  Slave::receive(port, reception);
}

bool ExpectsTheUsualLoopbackWord::accepts_cycle(bool own_check_good, bool upstream_clean) const {
  bool has_word = true;
  if (!has_word_.empty()) {
    has_word = has_word_.front();
    has_word_.pop_front();
  }
  return has_word && Slave::accepts_cycle(own_check_good, upstream_clean);
}

void IgnoresSelectInsideACycle::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (port != interbus::kFromUpstream) return Slave::receive(port, reception);
  const auto found = std::find(layout_.header.begin(), layout_.header.end(), line::HeaderLevel::select);
  const auto select = 1 + static_cast<std::size_t>(found - layout_.header.begin());
  line::Waveform patched = reception;
  bool is_in_cycle = false;
  std::uint8_t first = 0;
  code_.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
    if (!telegram.is_data()) return;
    const bool is_check = (telegram.header & line::kControl) != 0;
    if (!is_in_cycle) first = telegram.header;
    is_in_cycle = !is_check;
    if (((telegram.header ^ first) & line::kSelect) != 0) patched.levels.flip(telegram.level + select);
  });
  Slave::receive(port, patched);
}

void NeedsIdleBetweenTelegrams::receive(segment::PortIndex port, const line::Waveform& reception) {
  line::Waveform heard = reception;
  std::size_t end = 0;
  code_.decode(reception.levels, 0, [&](const line::Telegram& telegram) {
    const std::size_t begin = telegram.level;
    if (end > 0 && begin == end) {
      for (std::size_t n = begin; n < begin + telegram.levels(); ++n) heard.levels.set(n, true);
    }
    end = begin + telegram.levels();
  });
  Slave::receive(port, heard);
}

void FollowsAnyRate::receive(segment::PortIndex port, const line::Waveform& reception) {
  const std::int64_t own = rules().bit_rate;
  if (reception.rate == own || std::abs(reception.rate - own) > own / 10)
    return Slave::receive(port, reception);
  line::Waveform adapted = reception;
  adapted.rate = own;
  Slave::receive(port, adapted);
}

}  // namespace fieldproof::conformance::slave_seeded_faults
