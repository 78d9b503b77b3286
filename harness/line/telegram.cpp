#include "harness/line/telegram.hpp"

#include <list>
#include <mutex>
#include <utility>

namespace fieldproof::line {
namespace {

bool level_of(const TelegramLayout& layout, HeaderLevel which, unsigned header) {
  switch (which) {
    case HeaderLevel::select:
      return ((header & kSelect) != 0) == layout.select_level;
    case HeaderLevel::control:
      return ((header & kControl) != 0) == layout.control_level;
    case HeaderLevel::flag:
      return ((header & kDataTelegram) != 0) == layout.data_flag_level;
  }
  return true;
}

std::uint8_t reversed(unsigned octet) {
  unsigned result = 0;
  for (unsigned bit = 0; bit < 8; ++bit) result |= ((octet >> bit) & 1U) << (7 - bit);
  return static_cast<std::uint8_t>(result);
}

}  // namespace

TelegramCode::TelegramCode(const TelegramLayout& layout) {
  for (unsigned header = 0; header < 8; ++header) {
    unsigned levels = 0;
    for (unsigned n = 0; n < 3; ++n) {
      if (level_of(layout, layout.header.at(n), header)) levels |= 1U << n;
    }
    header_levels_.at(header) = static_cast<std::uint8_t>(levels << 1);
    headers_.at(levels) = static_cast<std::uint8_t>(header);
  }
  for (unsigned octet = 0; octet < 256; ++octet) {
    const std::uint8_t levels =
        layout.most_significant_first ? reversed(octet) : static_cast<std::uint8_t>(octet);
    data_levels_.at(octet) = levels;
    octets_.at(levels) = static_cast<std::uint8_t>(octet);
  }
}

std::size_t TelegramCode::next_idle(const Levels& levels, std::size_t at) {
  while (at < levels.size() && !levels[at]) ++at;
  return at;
}

const TelegramCode& shared_telegram_code(const TelegramLayout& layout) {
  static std::mutex mutex;
  static std::list<std::pair<TelegramLayout, TelegramCode>> codes;
  const std::lock_guard lock(mutex);
  for (const auto& [known, code] : codes) {
    if (known == layout) return code;
  }
  return codes.emplace_back(layout, TelegramCode(layout)).second;
}

}  // namespace fieldproof::line
