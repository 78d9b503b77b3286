#include "protocols/interbus/telegram_front.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/kernel/error.hpp"

namespace fieldproof::interbus {
namespace {

constexpr unsigned kMostCharacter = 0x7FF;
constexpr unsigned kHeader = line::kSelect | line::kControl | line::kDataTelegram;

}  // namespace

iut::Character character_of(const line::Telegram& telegram, kernel::Time start, std::int64_t bit_rate) {
  const unsigned octet = telegram.is_data() ? telegram.data : 0U;
  return {.start = start,
          .busy_until = kernel::level_time(start, telegram.levels(), bit_rate),
          .data = static_cast<std::uint16_t>(octet | (telegram.header & kHeader) << kTelegramHeaderBit),
          .is_stop_missing = telegram.is_stop_missing()};
}

TelegramFront::TelegramFront(const Rules& rules)
    : code_(line::shared_telegram_code(rules.telegram)),
      receivers_{line::TelegramReceiver{code_, rules.bit_rate}, line::TelegramReceiver{code_, rules.bit_rate},
                 line::TelegramReceiver{code_, rules.bit_rate}} {
  said_.rate = rules.bit_rate;
}

kernel::Time TelegramFront::next_time() const {
  return std::ranges::min_element(receivers_, {}, &line::TelegramReceiver::pending_until)->pending_until();
}

void TelegramFront::reset() {
  for (line::TelegramReceiver& receiver : receivers_) receiver.reset();
}

line::Waveform& TelegramFront::levels_of(kernel::Time start, std::span<const std::uint16_t> characters) {
  said_.start = start;
  said_.levels.clear();
  for (const std::uint16_t character : characters) {
    const auto header = static_cast<std::uint8_t>(character >> kTelegramHeaderBit);
    const auto octet = static_cast<std::uint8_t>(character & 0xFF);
    if (character > kMostCharacter) {
      iut::refuse_impossible(fmt::format(
          "says the telegram {:04X}h; one has an octet, SL (100h), CR (200h) and FL (400h)", character));
    }
    if ((header & line::kDataTelegram) == 0 && octet != 0) {
      iut::refuse_impossible(
          fmt::format("says the telegram {:04X}h, a status telegram with an octet; FL is 400h", character));
    }
    code_.append(said_.levels, header, octet);
  }
  return said_;
}

std::unique_ptr<TelegramFront> front_of(const iut::AttachedCase& attached, const Rules& rules,
                                        std::string_view role) {
  if (attached.unit_kind() == iut::UnitKind::telegrams) return std::make_unique<TelegramFront>(rules);
  if (attached.unit_kind() == iut::UnitKind::levels) return nullptr;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      fmt::format("an INTERBUS {} receives and sends levels or telegrams; this implementation "
                  "announces {}",
                  role, name(attached.unit_kind())));
}

}  // namespace fieldproof::interbus
