#include "protocols/interbus/cycle_fields.hpp"

namespace fieldproof::interbus {
namespace {

constexpr unsigned kDataLevels = 8;

std::string_view header_field(line::HeaderLevel level) {
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

CycleFields::CycleFields(const Rules& rules, InFront in_front)
    : in_front_(in_front), code_(line::shared_telegram_code(rules.telegram)), bit_rate_(rules.bit_rate) {
  for (std::size_t n = 0; n < header_fields_.size(); ++n) {
    header_fields_.at(n) = header_field(rules.telegram.header.at(n));
  }
}

void CycleFields::locate(const line::Waveform& sent, std::vector<fault::Span>& spans) {
  // A fault plan changes what a regular sender drives: telegrams on the grid of the bits. Others have no
  // fields.
  if (sent.rate != bit_rate_) return;
  code_.decode(sent.levels, 0, [&](const line::Telegram& telegram) { add(telegram, spans); });
}

std::vector<std::string> CycleFields::frame_kinds() {
  return {"data_cycle", "id_cycle", "status"};
}

std::vector<std::string> CycleFields::fields() {
  return {"start", "select", "control", "flag", "stop", "data", "id", "lbw", "check", "status_word", "end"};
}

std::string_view CycleFields::data_field(bool is_id) const {
  if (is_checking_) {
    if (check_unit_ < 2) return "check";
    return check_unit_ < 4 ? "status_word" : "end";
  }
  const unsigned in_front = is_id ? in_front_.id_octets : in_front_.data_octets;
  if (unit_ >= in_front && unit_ < in_front + 2) return "lbw";
  return is_id ? "id" : "data";
}

void CycleFields::add(const line::Telegram& telegram, std::vector<fault::Span>& spans) {
  std::string_view kind = "status";
  std::uint64_t frame = 0;
  std::uint32_t unit = 0;
  if (telegram.is_data()) {
    const bool is_id = (telegram.header & line::kSelect) != 0;
    const bool is_check = (telegram.header & line::kControl) != 0;
    if (!is_check && (!is_in_cycle_ || is_checking_ || is_id != is_id_cycle_)) {
      is_in_cycle_ = true;
      is_id_cycle_ = is_id;
      ++(is_id ? id_cycles_ : data_cycles_);
      unit_ = check_unit_ = 0;
    }
    is_checking_ = is_check;
    kind = is_id ? "id_cycle" : "data_cycle";
    frame = is_id ? id_cycles_ : data_cycles_;
    unit = unit_;
  } else {
    frame = ++status_telegrams_;
  }
  const auto put = [&](std::string_view field, std::uint32_t offset, std::uint32_t count) {
    spans.push_back({kind, frame, unit, field, telegram.level + offset, count});
  };
  put("start", 0, 1);
  for (std::uint32_t n = 0; n < header_fields_.size(); ++n) put(header_fields_.at(n), n + 1, 1);
  if (telegram.is_data()) {
    put(data_field((telegram.header & line::kSelect) != 0), 4, kDataLevels);
    put("stop", 4 + kDataLevels, 1);
    ++unit_;
    if (is_checking_) ++check_unit_;
  } else {
    put("stop", 4, 1);
  }
}

}  // namespace fieldproof::interbus
