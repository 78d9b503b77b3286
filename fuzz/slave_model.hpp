#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "harness/segment/station.hpp"

// What the outputs of a slave may do, from the telegrams on its forward line and from nothing else: they are
// written at the end of a data cycle whose check (bit by bit) is right, whose status word is clean, all of
// whose telegrams are complete and which comes after a good ID cycle without a silence in between; and they
// become 0 after a silence, which the begin of a telegram ends. It hears the line as a tap, and predicts each
// writing with its instant.
//
// The telegrams themselves come from a receiver of the house: that one is held to a bit-by-bit decoder by a
// target of its own.
namespace fieldproof::fuzz {

struct OutputWrite {
  kernel::Time when;
  unsigned word = 0;
  std::uint16_t value = 0;
  friend bool operator==(const OutputWrite&, const OutputWrite&) = default;
};

class SlaveModel final : public segment::Tap {
 public:
  SlaveModel(unsigned words, std::int64_t bit_rate, kernel::Duration silence_limit);

  void on_wave(const line::Waveform& wave) override;
  // Time has passed without a reception.
  void run_until(kernel::Time now);

  bool is_active() const { return is_active_; }
  const std::vector<OutputWrite>& writes() const { return writes_; }

 private:
  enum class Class : std::uint8_t { data_transfer, id_transfer, data_check, id_check };

  void on_telegram(const line::Waveform& wave, const line::Telegram& telegram);
  void on_data(Class kind, const line::Telegram& telegram, kernel::Time end);
  void finish_cycle(kernel::Time end);
  bool is_cycle_good() const;
  void write_outputs(kernel::Time end);
  void write_all(std::uint16_t value, kernel::Time when);
  // At `when`, if the line has been silent until `now` for too long and no telegram has begun.
  void end_silence(kernel::Time now, kernel::Time when);
  void silence(kernel::Time now);

  unsigned words_;
  std::int64_t bit_rate_;
  kernel::Duration silence_limit_;
  line::TelegramCode code_{line::TelegramLayout{}};
  line::TelegramReceiver receiver_;
  kernel::Time silent_from_ = kernel::kNever;

  bool is_active_ = false;
  bool is_in_cycle_ = false;
  bool is_id_cycle_ = false;
  bool is_broken_ = false;
  std::vector<std::uint8_t> transfer_;
  std::vector<std::uint8_t> trailer_;
  std::vector<OutputWrite> writes_;
};

}  // namespace fieldproof::fuzz
