#include "harness/fault/telegram_fields.hpp"

namespace fieldproof::fault {
namespace {

std::string_view name_of(line::HeaderLevel level) {
  switch (level) {
    case line::HeaderLevel::select:
      return "select";
    case line::HeaderLevel::control:
      return "control";
    case line::HeaderLevel::flag:
      return "flag";
  }
  return "";
}

}  // namespace

void append_telegram_fields(const line::TelegramLayout& layout, const line::Telegram& telegram,
                            std::string_view frame_kind, std::uint64_t frame, std::uint32_t unit,
                            std::vector<Span>& spans) {
  std::uint32_t at = telegram.level;
  const auto append = [&](std::string_view field, std::uint32_t count) {
    spans.push_back({frame_kind, frame, unit, field, at, count});
    at += count;
  };
  append("start", 1);
  for (const line::HeaderLevel level : layout.header) append(name_of(level), 1);
  if (telegram.is_data()) append("data", 8);
  append("stop", 1);
}

void TelegramFields::locate(const line::Waveform& sent, std::vector<Span>& spans) {
  ++trains_;
  std::uint32_t unit = 0;
  code_.decode(sent.levels, 0, [&](const line::Telegram& telegram) {
    append_telegram_fields(layout_, telegram, "train", trains_, unit++, spans);
  });
}

}  // namespace fieldproof::fault
