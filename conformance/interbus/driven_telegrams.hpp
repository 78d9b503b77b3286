#pragma once

#include <cstdint>
#include <string>

#include "harness/line/telegram_receiver.hpp"
#include "harness/segment/station.hpp"
#include "protocols/interbus/rules.hpp"

// Where each telegram of a master lies on its line: those of a cycle at their places, status telegrams at
// their pitch in every pause, each of them whole. Keeps the first that does not.
namespace fieldproof::conformance {

class DrivenTelegrams final : public segment::Tap {
 public:
  explicit DrivenTelegrams(const interbus::Rules& rules);

  void on_wave(const line::Waveform& wave) override;

  struct Misplaced {
    std::string reason;  // empty: none
    std::string expected;
    std::string actual;
    kernel::Time when{};
  };
  const Misplaced& misplaced() const { return misplaced_; }
  // Between the starts of two telegrams, since it was forgotten, and of the first telegram of all.
  kernel::Duration longest_silence() const { return longest_silence_; }
  void forget_silence() { longest_silence_ = {}; }
  kernel::Time first() const { return first_; }
  // Of the last cycle that was driven, also before it has arrived.
  kernel::Time cycle_start() const { return cycle_start_; }

 private:
  void add(kernel::Time start, const line::Telegram& telegram);
  void on_data(kernel::Time start, const line::Telegram& telegram);
  void on_status(kernel::Time start, const line::Telegram& telegram);
  void note(std::string reason, std::string expected, std::string actual, kernel::Time when);
  kernel::Duration bits(std::int64_t count) const { return kernel::levels_duration(count, bit_rate_); }

  std::int64_t bit_rate_;
  std::int64_t pitch_;               // of status telegrams, in bits
  std::int64_t telegram_millibits_;  // from telegram to telegram of a cycle
  kernel::Duration break_;           // silence after which the line begins anew
  line::TelegramReceiver receiver_;
  bool has_before_ = false;
  bool was_data_ = false;
  bool is_run_ = false;    // the last cycle was a data cycle
  kernel::Time before_{};  // start of the telegram before
  kernel::Time cycle_start_{};
  std::int64_t place_ = 0;  // of the last telegram of the cycle
  kernel::Duration longest_silence_{};
  kernel::Time first_ = kernel::kNever;
  Misplaced misplaced_;
};

}  // namespace fieldproof::conformance
