#include "protocols/token_bus/line_side.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::token_bus {

void LineSide::begin(kernel::Time now) {
  is_active_ = is_noticed_ = has_ended_unseen_ = false;
  active_until_ = blanked_until_ = now;
  driven_until_ = std::max(driven_until_, now);
}

kernel::Time LineSide::drive(line::Levels half_bits, kernel::Time start) {
  FIELDPROOF_CHECK(line_ != nullptr, "a station that drives has been wired");
  line::Waveform wave{start, 2 * rules_.phy_bit_rate, std::move(half_bits)};
  driven_until_ = wave.end();
  blank_from(driven_until_);
  line_->drive(wave);
  return driven_until_;
}

void LineSide::blank_from(kernel::Time end) {
  blanked_until_ = std::max(blanked_until_, end + mac_symbols(rules_, rules_.blanking_symbols));
}

std::optional<line::Waveform> LineSide::seen(const line::Waveform& reception) {
  is_active_ = false;
  const kernel::Time end = reception.end();
  if (reception.start >= blanked_until_) {
    is_noticed_ = false;
    active_until_ = end;
    return reception;
  }
  if (end <= blanked_until_) return std::nullopt;
  is_noticed_ = false;
  active_until_ = end;
  const std::size_t first = reception.first_level_at(blanked_until_);
  return line::Waveform{reception.time_of(first), reception.rate,
                        reception.levels.slice(first, reception.levels.size() - first)};
}

void LineSide::on_activity(bool begins, kernel::Time now) {
  if (begins) {
    is_active_ = true;
    is_noticed_ = false;
    return;
  }
  if (is_active_ && is_noticed_) {
    has_ended_unseen_ = true;
    active_until_ = now;
  }
  is_active_ = is_noticed_ = false;
}

bool LineSide::takes_notice(kernel::Time now) {
  if (!is_active_ || is_noticed_ || now < blanked_until_) return false;
  is_noticed_ = true;
  return true;
}

kernel::Time LineSide::silent_since() const {
  return is_active() ? kernel::kNever : std::max(active_until_, driven_until_);
}

}  // namespace fieldproof::token_bus
