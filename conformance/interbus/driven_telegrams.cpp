#include "conformance/interbus/driven_telegrams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kMillibits = 1'000;

}  // namespace

DrivenTelegrams::DrivenTelegrams(const interbus::Rules& rules)
    : bit_rate_(rules.bit_rate),
      pitch_(rules.status_pitch_bits),
      telegram_millibits_(kMillibits * line::kDataTelegramLevels + rules.telegram_gap_millibits),
      break_(rules.silence_limit / 2),
      receiver_(line::shared_telegram_code(rules.telegram), rules.bit_rate) {}

void DrivenTelegrams::on_wave(const line::Waveform& wave) {
  receiver_.receive(
      wave, [this](const line::Waveform& of, const line::Telegram& one) { add(of.time_of(one.level), one); });
}

void DrivenTelegrams::note(std::string reason, std::string expected, std::string actual, kernel::Time when) {
  if (misplaced_.reason.empty())
    misplaced_ = {std::move(reason), std::move(expected), std::move(actual), when};
}

void DrivenTelegrams::add(kernel::Time start, const line::Telegram& telegram) {
  if (telegram.is_stop_missing()) note("stop_missing", "a stop level", "none", start);
  if (first_ == kernel::kNever) first_ = before_ = start;
  longest_silence_ = std::max(longest_silence_, start - before_);
  if (start - before_ > break_) has_before_ = is_run_ = false;
  telegram.is_data() ? on_data(start, telegram) : on_status(start, telegram);
  has_before_ = true;
  was_data_ = telegram.is_data();
  before_ = start;
}

// A place is known to a bit: levels are whole ones.
void DrivenTelegrams::on_data(kernel::Time start, const line::Telegram& telegram) {
  if (has_before_ && was_data_) {
    ++place_;
    const kernel::Time right = cycle_start_ + bits(place_ * telegram_millibits_ / kMillibits);
    if (start < right - bits(1) || right + bits(2) < start) {
      note("gap_wrong",
           fmt::format("telegram {} of a cycle {} after its beginning", place_,
                       kernel::describe(right - cycle_start_)),
           kernel::describe(start - cycle_start_), start);
    }
    return;
  }
  // A whole one more would have had its place.
  if (has_before_ && start - before_ > bits(2 * pitch_ + 1)) {
    note("pause_not_filled", fmt::format("status telegrams each {} bits up to the next cycle", pitch_),
         fmt::format("none for {}", kernel::describe(start - before_)), before_);
  }
  is_run_ = (telegram.header & line::kSelect) == 0;
  place_ = 0;
  cycle_start_ = start;
}

void DrivenTelegrams::on_status(kernel::Time start, const line::Telegram& telegram) {
  if ((telegram.header & (line::kSelect | line::kControl)) != 0)
    note("header_wrong", "status telegrams without SL and CR", "one with them", start);
  // Before run the pauses are made of pieces.
  if (!has_before_ || !is_run_) return;
  const std::int64_t least = was_data_ ? line::kDataTelegramLevels : pitch_;
  const std::int64_t most = was_data_ ? telegram_millibits_ / kMillibits + pitch_ + 1 : pitch_;
  const kernel::Duration tolerance = bits(1) / 2;
  if (start - before_ >= bits(least) - tolerance && start - before_ <= bits(most) + tolerance) return;
  note("status_pitch_wrong",
       fmt::format("a status telegram {} to {} bits after the telegram before", least, most),
       kernel::describe(start - before_), start);
}

}  // namespace fieldproof::conformance
