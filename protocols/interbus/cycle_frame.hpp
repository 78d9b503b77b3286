#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/frame_check_16.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"
#include "protocols/interbus/rules.hpp"

// The levels of a cycle as a master drives them: the telegrams of the summation frame with their mean gap,
// and the status telegrams after it up to the start of the next cycle.
//
// Telegram k begins at level 13 * k + floor(k * gap), so the mean pitch is exactly 13 bit plus the gap; a
// frame of `count` telegrams lasts exactly count * (13 + gap) bit, which need not be a whole number of
// levels. Nothing is allocated once the levels have their size.
namespace fieldproof::interbus {

inline constexpr std::size_t kLoopbackOctets = 2;
inline constexpr std::size_t kTrailerOctets = 4;  // frame check and check status

struct CycleHeaders {
  std::uint8_t transfer = 0;
  std::uint8_t check = 0;
};

// Headers of the data telegrams of a data cycle or an ID cycle.
constexpr CycleHeaders cycle_headers(bool is_id_cycle) {
  const auto select = static_cast<std::uint8_t>(is_id_cycle ? line::kSelect : 0);
  const auto transfer = static_cast<std::uint8_t>(line::kDataTelegram | select);
  return {transfer, static_cast<std::uint8_t>(transfer | line::kControl)};
}

inline constexpr CycleHeaders kDataCycle = cycle_headers(false);
inline constexpr CycleHeaders kIdCycle = cycle_headers(true);

class CycleWriter {
 public:
  explicit CycleWriter(const Rules& rules);

  // Telegrams of a cycle that transfers so many octets (the loopback word is not among them).
  std::size_t telegram_count(std::size_t transfer_octets) const {
    return kLoopbackOctets + transfer_octets + kTrailerOctets + end_telegrams_;
  }
  // From the start of the first telegram to the end of the last one's gap.
  kernel::Duration frame_time(std::size_t telegrams) const;

  // Appends the frame: `octets` (loopback word and transfer), the check, a clean status word, end telegrams.
  void append_frame(line::Levels& levels, std::span<const std::uint8_t> octets, std::uint16_t check,
                    CycleHeaders headers) const;

  // Appends status telegrams up to the last one that ends at or before level `end`.
  void append_status(line::Levels& levels, std::size_t end) const;
  // The first whole level after a frame.
  std::size_t first_status_level(std::size_t telegrams) const;

  const line::TelegramCode& code() const { return code_; }

 private:
  // Start level of telegram k and the idle levels between it and the next.
  std::size_t start_level(std::size_t k) const { return line::kDataTelegramLevels * k + k * gap_ / 1000; }

  const line::TelegramCode& code_;
  std::uint64_t gap_;  // thousandths of a bit
  std::uint16_t status_clean_;
  unsigned end_telegrams_;
  unsigned status_pitch_;
  std::int64_t bit_rate_;
  // A run of status telegrams, appended as a whole.
  line::Levels status_run_;
  std::uint64_t status_levels_;  // one status telegram
};

}  // namespace fieldproof::interbus
