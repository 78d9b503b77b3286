#include "protocols/interbus/telegram_speaker.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "protocols/interbus/attached_slave.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::kMicrosecond;
using kernel::kStart;

constexpr kernel::Duration kBit = 2 * kMicrosecond;

class NoBench final : public iut::Bench {
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
  void transmit(unsigned, line::Waveform&) override {}
  void write(iut::Item, std::uint64_t, kernel::Time) override {}
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

// What a device of levels hears of two status telegrams, the second one `apart` after the start of the
// first.
std::vector<line::Waveform> heard_of_two(kernel::Duration apart) {
  auto device = std::make_unique<iut::ActingDevice>(iut::UnitKind::levels);
  const iut::ActingDevice& heard = *device;
  TelegramSpeaker speaker(std::move(device), 3);
  NoBench bench;
  speaker.begin({"interbus/slave/x", 1, slave_settings(SlaveConfiguration{})}, bench);
  const std::array telegrams{iut::Character{kStart, kStart + 5 * kBit, 0},
                             iut::Character{kStart + apart, kStart + apart + 5 * kBit, 0}};
  speaker.receive(0, telegrams, kStart);
  std::vector<line::Waveform> waves;
  for (const auto& one : heard.heard_levels) waves.push_back(one.wave);
  return waves;
}

TEST(TelegramSpeaker, TelegramsOnOneGridAreOneReception) {
  const auto waves = heard_of_two(9 * kBit);
  ASSERT_EQ(waves.size(), 1U);
  EXPECT_EQ(waves[0].levels.text(),
            "00001"
            "1111"
            "00001");
}

TEST(TelegramSpeaker, TelegramsOffTheGridAreTwo) {
  EXPECT_EQ(heard_of_two(9 * kBit + kMicrosecond).size(), 2U);
}

// An hour of idle levels would fill the memory.
TEST(TelegramSpeaker, TelegramsFarApartAreTwo) {
  const auto waves = heard_of_two(3600 * kernel::kSecond);
  ASSERT_EQ(waves.size(), 2U);
  EXPECT_EQ(waves[1].start, kStart + 3600 * kernel::kSecond);
  EXPECT_EQ(waves[1].levels.text(), "00001");
}

}  // namespace
}  // namespace fieldproof::interbus
