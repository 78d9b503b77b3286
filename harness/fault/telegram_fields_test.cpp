#include "harness/fault/telegram_fields.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace fieldproof::fault {
namespace {

std::string text(const Span& span) {
  return std::to_string(span.unit) + " " + std::string(span.field) + " " + std::to_string(span.first) + "+" +
         std::to_string(span.count);
}

TEST(TelegramFields, LieWhereTheCodePutsThem) {
  line::TelegramLayout layout;
  layout.header = {line::HeaderLevel::flag, line::HeaderLevel::select, line::HeaderLevel::control};
  const line::TelegramCode code(layout);
  line::Waveform train;
  code.append(train.levels, line::kDataTelegram | line::kSelect, 0x5A);
  train.levels.append_idle(3);
  code.append(train.levels, line::kControl, 0);
  TelegramFields fields(layout);
  std::vector<Span> spans;
  fields.follow(train);
  fields.locate(train, spans);
  std::string all;
  for (const Span& span : spans) {
    EXPECT_EQ(span.frame_kind, "train");
    EXPECT_EQ(span.frame, 2U);
    all += text(span) + "; ";
  }
  EXPECT_EQ(all,
            "0 start 0+1; 0 flag 1+1; 0 select 2+1; 0 control 3+1; 0 data 4+8; 0 stop 12+1; "
            "1 start 16+1; 1 flag 17+1; 1 select 18+1; 1 control 19+1; 1 stop 20+1; ");
}

RC_GTEST_PROP(TelegramFields, FlippingAFieldChangesThatFieldOnly, (std::uint8_t octet)) {
  const line::TelegramLayout layout;
  const line::TelegramCode code(layout);
  line::Waveform train;
  code.append(train.levels, line::kDataTelegram, octet);
  TelegramFields fields(layout);
  std::vector<Span> spans;
  fields.locate(train, spans);
  const Span data = spans.at(4);
  RC_ASSERT(data.field == "data");
  const auto bit = *rc::gen::inRange<std::uint32_t>(0, 8);
  train.levels.flip(data.first + bit);
  const line::Telegram changed = code.from_levels(train.levels.window(0));
  RC_ASSERT(changed.data == (octet ^ (0x80U >> bit)));
  RC_ASSERT(changed.header == line::kDataTelegram);
}

}  // namespace
}  // namespace fieldproof::fault
