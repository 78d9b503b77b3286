#pragma once

#include <cstdint>
#include <vector>

#include "harness/fault/arrivals.hpp"
#include "harness/fault/fields.hpp"
#include "harness/line/telegram.hpp"

// The fields of telegrams as such: start, the three header levels select, control and flag in the order of
// the layout, data (of a data telegram) and stop. A protocol's map takes the telegrams apart with
// `append_telegram_fields` and says which frame they belong to; without one, each transmission is a frame of
// the kind "train".
//
// Limit: telegrams are found in levels that are exactly bit-wide, which is what stations drive.
namespace fieldproof::fault {

// The spans of one telegram; `telegram.level` is where it lies.
void append_telegram_fields(const line::TelegramLayout& layout, const line::Telegram& telegram,
                            std::string_view frame_kind, std::uint64_t frame, std::uint32_t unit,
                            std::vector<Span>& spans);

class TelegramFields final : public FieldMap {
 public:
  explicit TelegramFields(const line::TelegramLayout& layout) : layout_(layout), code_(layout) {}

  void locate(const line::Waveform& sent, std::vector<Span>& spans) override;
  void follow(const line::Waveform&) override { ++trains_; }

 private:
  line::TelegramLayout layout_;
  line::TelegramCode code_;
  std::uint64_t trains_ = 0;
};

}  // namespace fieldproof::fault
