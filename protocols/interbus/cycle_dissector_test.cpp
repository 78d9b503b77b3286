// Subject: the sentences that a recording's reader gets of INTERBUS lines, and the verdict on frame checks.
#include "protocols/interbus/cycle_dissector.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/line/telegram.hpp"
#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::interbus {
namespace {

// CRC-16/IBM-3740 bit by bit, as the catalogue words it.
unsigned check_of(const std::vector<std::uint8_t>& octets) {
  unsigned check = 0xFFFF;
  for (const std::uint8_t octet : octets) {
    check ^= static_cast<unsigned>(octet) << 8;
    for (int bit = 0; bit < 8; ++bit) check = (check << 1) ^ ((check & 0x8000) != 0 ? 0x11021 : 0);
  }
  return check;
}

class CycleDissectorTest : public ::testing::Test {
 protected:
  void put(std::uint8_t header, const std::vector<std::uint8_t>& octets) {
    for (const std::uint8_t octet : octets) code.append(wave.levels, header, octet);
  }
  void put_check(std::uint8_t header, unsigned check, unsigned status) {
    put(header, {static_cast<std::uint8_t>(check >> 8), static_cast<std::uint8_t>(check),
                 static_cast<std::uint8_t>(status >> 8), static_cast<std::uint8_t>(status)});
  }
  trace::Decoded tell() {
    trace::Decoded told = teller->tell(wave);
    wave.start = wave.end() + kernel::kMillisecond;
    wave.levels.clear();
    return told;
  }

  Rules rules;
  CycleDissector dissector{rules};
  std::unique_ptr<trace::Teller> teller = dissector.teller();
  const line::TelegramCode& code = line::shared_telegram_code(rules.telegram);
  line::Waveform wave{kernel::kStart, rules.bit_rate, {}};
};

TEST_F(CycleDissectorTest, TellsACycleByItsFields) {
  put(kIdCycle.transfer, {0x01, 0xBE, 0xA5, 0x5A, 0x00, 0x03});
  put_check(kIdCycle.check, check_of({0x01, 0xBE, 0xA5, 0x5A, 0x00, 0x03}), 0);
  put(0, {0, 0});
  const trace::Decoded told = tell();
  EXPECT_EQ(
      told.text,
      fmt::format("ID cycle: SL 1, ID 01BE, LBW A55A, ID 0003, FCS {:04X} ok, status word 0000; 2 status "
                  "telegrams",
                  check_of({0x01, 0xBE, 0xA5, 0x5A, 0x00, 0x03})));
  EXPECT_FALSE(told.is_check_wrong);
}

TEST_F(CycleDissectorTest, EveryFlippedOctetMakesTheCheckWrong) {
  const std::vector<std::uint8_t> good = {0xA5, 0x5A, 0x12, 0x34};
  const unsigned check = check_of(good);
  for (std::size_t n = 0; n < good.size(); ++n) {
    std::vector<std::uint8_t> bad = good;
    bad[n] ^= 0x10;
    put(kDataCycle.transfer, bad);
    put_check(kDataCycle.check, check, 0xFFFF);
    const trace::Decoded told = tell();
    EXPECT_TRUE(told.is_check_wrong) << n;
    EXPECT_NE(told.text.find(fmt::format("FCS {:04X} wrong ({:04X} fits), status word FFFF marked", check,
                                         check_of(bad))),
              std::string::npos)
        << told.text;
  }
}

TEST_F(CycleDissectorTest, ACycleGoesOnInTheNextTransmission) {
  put(kDataCycle.transfer, {0xA5, 0x5A, 0x12});
  EXPECT_EQ(tell().text, "data cycle: SL 0, LBW A55A, data 12");
  put(kDataCycle.transfer, {0x34, 0x56, 0x78});
  put_check(kDataCycle.check, check_of({0xA5, 0x5A, 0x12, 0x34, 0x56, 0x78}), 0);
  const trace::Decoded told = tell();
  EXPECT_EQ(told.text,
            fmt::format("data cycle goes on: SL 0, data 1234 5678, FCS {:04X} ok, status word 0000",
                        check_of({0xA5, 0x5A, 0x12, 0x34, 0x56, 0x78})));
  put(kDataCycle.check, {0, 0});
  EXPECT_EQ(tell().text, "data cycle goes on: SL 0, end 0000");
}

TEST_F(CycleDissectorTest, ACheckWithoutItsCycleIsNotJudged) {
  put_check(kDataCycle.check, 0x1234, 0);
  const trace::Decoded told = tell();
  EXPECT_EQ(told.text, "data cycle: SL 0, FCS 1234, status word 0000");
  EXPECT_FALSE(told.is_check_wrong);
}

TEST_F(CycleDissectorTest, ATrainIsToldToItsSixteenthPart) {
  for (int n = 0; n < 18; ++n) {
    put(kDataCycle.transfer, {0xA5, 0x5A});
    put_check(kDataCycle.check, n == 17 ? 0 : check_of({0xA5, 0x5A}), 0);
  }
  const trace::Decoded told = tell();
  EXPECT_TRUE(told.text.ends_with("; and 2 parts more")) << told.text;
  EXPECT_TRUE(told.is_check_wrong) << "the last one is judged all the same";
}

TEST_F(CycleDissectorTest, ALongCycleIsToldToItsSixtyFourthWord) {
  std::vector<std::uint8_t> octets(2 * 65, 0);
  put(kDataCycle.transfer, octets);
  EXPECT_TRUE(tell().text.ends_with(" 0000 and 1 words more"));
}

TEST_F(CycleDissectorTest, TellsWhatIsBroken) {
  EXPECT_EQ(tell().text, "idle");
  put(0, {0});
  wave.levels.flip(4);
  wave.levels.append_idle(2);
  wave.levels.append(0b0100, 4);
  EXPECT_EQ(tell().text, "1 status telegram; 1 stop bits missing; cut telegram");
}

}  // namespace
}  // namespace fieldproof::interbus
