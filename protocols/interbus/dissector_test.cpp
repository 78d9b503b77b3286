#include "protocols/interbus/dissector.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "harness/line/telegram.hpp"
#include "protocols/interbus/cycle_fields.hpp"
#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::interbus {
namespace {

class DissectorTest : public ::testing::Test {
 protected:
  void put(std::uint8_t header, std::vector<std::uint8_t> octets) {
    for (const std::uint8_t octet : octets) code.append(wave.levels, header, octet);
  }
  void put_cycle() {
    put(kDataCycle.transfer, {0xA5, 0x5A, 0x12, 0x34});
    put(kDataCycle.check, {0xBE, 0xEF, 0x00, 0x00});
  }

  Rules rules;
  const line::TelegramCode& code = line::shared_telegram_code(rules.telegram);
  line::Waveform wave{kernel::kStart, rules.bit_rate, {}};
};

TEST_F(DissectorTest, WritesACycleInWords) {
  put_cycle();
  put(0, {0, 0, 0});
  EXPECT_EQ(describe(wave, rules), "data A55A 1234 | check BEEF 0000 | 3 status");
}

TEST_F(DissectorTest, ShowsWhatIsBroken) {
  put(kDataCycle.transfer, {0xA5});
  wave.levels.flip(12);
  wave.levels.append_idle(1);
  put(kDataCycle.transfer, {0x5A});
  wave.levels.append_idle(2);
  wave.levels.append(0b0100, 4);
  EXPECT_EQ(describe(wave, rules), "data A5!5A | cut, last levels " + wave.levels.text());
}

TEST_F(DissectorTest, AnIdleLineIsIdle) {
  EXPECT_EQ(describe(wave, rules), "idle");
}

TEST_F(DissectorTest, FieldsAreNamedByWhatTheyCarryAtTheirPlace) {
  put_cycle();
  CycleFields fields(rules, {.data_octets = 2, .id_octets = 2});
  std::vector<fault::Span> spans;
  fields.locate(wave, spans);
  std::string text;
  for (const fault::Span& span : spans) {
    if (span.count == 8) {
      text += std::string(span.frame_kind) + " " + std::to_string(span.frame) + "." +
              std::to_string(span.unit) + " " + std::string(span.field) + " at " +
              std::to_string(span.first) + "\n";
    }
  }
  EXPECT_EQ(text,
            "data_cycle 1.0 data at 4\ndata_cycle 1.1 data at 17\ndata_cycle 1.2 lbw at 30\ndata_cycle 1.3 "
            "lbw at 43\n"
            "data_cycle 1.4 check at 56\ndata_cycle 1.5 check at 69\n"
            "data_cycle 1.6 status_word at 82\ndata_cycle 1.7 status_word at 95\n");
}

TEST_F(DissectorTest, CyclesAreCountedAlsoAcrossTransmissions) {
  put_cycle();
  CycleFields fields(rules, {});
  std::vector<fault::Span> spans;
  fields.locate(wave, spans);
  spans.clear();
  fields.locate(wave, spans);
  ASSERT_FALSE(spans.empty());
  EXPECT_EQ(spans.front().frame, 2U);
  EXPECT_EQ(spans.front().unit, 0U);
}

}  // namespace
}  // namespace fieldproof::interbus
