#include "protocols/interbus/cycle_frame.hpp"

#include <algorithm>

namespace fieldproof::interbus {

namespace {
constexpr unsigned kRunTelegrams = 32;
}  // namespace

CycleWriter::CycleWriter(const Rules& rules)
    : code_(line::shared_telegram_code(rules.telegram)),
      gap_(rules.telegram_gap_millibits),
      status_clean_(rules.status_clean),
      end_telegrams_(rules.end_telegrams),
      status_pitch_(std::max(rules.status_pitch_bits, line::kStatusTelegramLevels + 1)),
      bit_rate_(rules.bit_rate),
      status_levels_(code_.levels_of(0, 0)) {
  for (unsigned n = 0; n < kRunTelegrams; ++n) {
    code_.append(status_run_, 0, 0);
    status_run_.append_idle(status_pitch_ - line::kStatusTelegramLevels);
  }
}

kernel::Duration CycleWriter::frame_time(std::size_t telegrams) const {
  const auto millibits = telegrams * (line::kDataTelegramLevels * 1000 + gap_);
  return kernel::levels_duration(static_cast<std::int64_t>(millibits), bit_rate_ * 1000);
}

void CycleWriter::append_frame(line::Levels& levels, std::span<const std::uint8_t> octets,
                               std::uint16_t check, CycleHeaders headers) const {
  std::size_t at = levels.size();
  std::uint64_t thousandths = 0;  // of the gaps so far, beyond whole levels
  levels.make_room(at + first_status_level(telegram_count(octets.size())));
  const auto put = [&](std::uint8_t header, std::uint8_t octet) {
    levels.place(at, code_.levels_of(header, octet), line::kDataTelegramLevels);
    thousandths += gap_;
    const std::uint64_t idle = thousandths / 1000;
    thousandths -= idle * 1000;
    at += line::kDataTelegramLevels + idle;
  };
  for (const std::uint8_t octet : octets) put(headers.transfer, octet);
  put(headers.check, static_cast<std::uint8_t>(check >> 8));
  put(headers.check, static_cast<std::uint8_t>(check & 0xFF));
  put(headers.check, static_cast<std::uint8_t>(status_clean_ >> 8));
  put(headers.check, static_cast<std::uint8_t>(status_clean_ & 0xFF));
  for (unsigned n = 0; n < end_telegrams_; ++n) put(headers.check, 0);
  levels.resize(at);
}

std::size_t CycleWriter::first_status_level(std::size_t telegrams) const {
  return (telegrams * (line::kDataTelegramLevels * 1000 + static_cast<std::size_t>(gap_)) + 999) / 1000;
}

void CycleWriter::append_status(line::Levels& levels, std::size_t end) const {
  const std::size_t from = levels.size();
  if (from + line::kStatusTelegramLevels > end) return;
  std::size_t left = (end - from - line::kStatusTelegramLevels) / status_pitch_ + 1;
  levels.make_room(end);
  for (; left > kRunTelegrams; left -= kRunTelegrams) levels.append(status_run_);
  std::size_t at = levels.size();
  for (; left > 0; --left, at += status_pitch_) {
    levels.place(at, status_levels_, line::kStatusTelegramLevels);
  }
}

}  // namespace fieldproof::interbus
