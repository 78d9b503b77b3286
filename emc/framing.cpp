#include "emc/framing.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::emc {

TelegramFraming::TelegramFraming(const line::TelegramLayout& layout)
    : code_(line::shared_telegram_code(layout)) {
  const auto flag = std::find(layout.header.begin(), layout.header.end(), line::HeaderLevel::flag);
  flag_bit_ = 2U << (flag - layout.header.begin());
}

bool TelegramFraming::find(const line::Levels& levels, std::size_t from, std::size_t until,
                           std::vector<FramedUnit>& units) const {
  unsigned seen = 0;  // of all headers: a loop that asks each of them for its stop takes twice as long
  const std::size_t end = code_.decode_until(levels, 0, until, [&](const line::Telegram& telegram) {
    seen |= telegram.header;
    if (telegram.level + telegram.levels() > from) {
      units.push_back({telegram.level, telegram.levels(), true, flag_bit_});
    }
  });
  return (seen & line::kStopMissing) == 0 && (end == levels.size() || end > until);
}

CharacterFraming::CharacterFraming(const line::CharacterFormat& format) : code_(format) {
  FIELDPROOF_CHECK(code_.levels_per_bit() == 1, "a character whose bits are framed has whole stop bits");
}

bool CharacterFraming::find(const line::Levels& levels, std::size_t, std::size_t,
                            std::vector<FramedUnit>& units) const {
  bool is_whole = true;
  const std::size_t end = code_.decode(levels, 0, [&](const line::Character& character) {
    units.push_back({character.level, longest_unit(), true, 0});
    is_whole = is_whole && !character.is_stop_missing;
  });
  return is_whole && end == levels.size();
}

bool SynchronousFraming::find(const line::Levels& levels, std::size_t, std::size_t,
                              std::vector<FramedUnit>& units) const {
  if (!levels.empty()) units.push_back({0, levels.size(), false, 0});
  return true;
}

}  // namespace fieldproof::emc
