#include "harness/fault/scripted_channel.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/fault/channel_chain.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/written_wave.hpp"

namespace fieldproof::fault {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kStart;
using line::wave_of;
using line::Waveform;
using line::Waveforms;

std::string pass(Channel& channel, const Waveform& sent) {
  Waveforms arrivals;
  if (!channel.pass(sent, arrivals)) return "as sent";
  std::string text;
  for (const Waveform& arrival : arrivals) {
    text += "@" + std::to_string((arrival.start - kStart) / kMicrosecond) + " " + arrival.levels.text() + " ";
  }
  return text;
}

TEST(ScriptedChannel, ChangesTheNextTransmissionOnly) {
  ScriptedChannel channel;
  EXPECT_EQ(pass(channel, wave_of("0000")), "as sent");
  channel.on_next().flip(0).flip(3).flip(4);
  EXPECT_EQ(pass(channel, wave_of("0000")), "@0 1001 ");
  EXPECT_FALSE(channel.is_armed());
  EXPECT_EQ(pass(channel, wave_of("0000")), "as sent");
}

TEST(ScriptedChannel, WaitsForTheTransmissionThatIsMeant) {
  ScriptedChannel channel;
  pass(channel, wave_of("0"));
  channel.on(2).flip(0);
  channel.on(1).lose();
  EXPECT_EQ(pass(channel, wave_of("0")), "as sent");
  EXPECT_EQ(pass(channel, wave_of("0")), "");
  EXPECT_EQ(pass(channel, wave_of("0")), "@0 1 ");
  channel.flip(0);
  EXPECT_EQ(pass(channel, wave_of("0")), "@0 1 ") << "what was meant has passed: the next one";
}

TEST(ScriptedChannel, TakesTransmissionsApart) {
  const auto changed = [](auto order) {
    ScriptedChannel channel;
    order(channel.on_next());
    return pass(channel, wave_of("001011"));
  };
  EXPECT_EQ(changed([](auto& c) { c.drop(2, 2); }), "@0 00 @4 11 ");
  EXPECT_EQ(changed([](auto& c) { c.remove(2, 2); }), "@0 0011 ");
  EXPECT_EQ(changed([](auto& c) { c.repeat(2, 2); }), "@0 00101011 ");
  EXPECT_EQ(changed([](auto& c) { c.insert(2, 0b111, 3); }), "@0 001111011 ");
  EXPECT_EQ(changed([](auto& c) { c.insert(6, 0b00, 2); }), "@0 00101100 ");
  EXPECT_EQ(changed([](auto& c) { c.insert(7, 0b00, 2); }), "@0 001011 ");
  EXPECT_EQ(changed([](auto& c) { c.cut(5); }), "@0 00101 ");
  EXPECT_EQ(changed([](auto& c) { c.force(true, 0, 2); }), "@0 111011 ");
  EXPECT_EQ(changed([](auto& c) { c.force(false, 4, 99); }), "@0 001000 ");
  EXPECT_EQ(changed([](auto& c) { c.delay(3 * kMicrosecond); }), "@3 001011 ");
  EXPECT_EQ(changed([](auto& c) { c.replace(wave_of("01").levels).flip(1); }), "@0 00 ");
  EXPECT_EQ(changed([](auto& c) { c.remove(4, 2).insert(0, wave_of("1").levels).flip(0); }), "@0 11010 ");
}

TEST(ScriptedChannel, ChangesTheRateFromTheStartOn) {
  ScriptedChannel channel;
  channel.on_next().rate(2'000'000).drop(1, 2);
  Waveforms arrivals;
  ASSERT_TRUE(channel.pass(wave_of("0000"), arrivals));
  ASSERT_EQ(arrivals.size(), 2U);
  EXPECT_EQ(arrivals[1].rate, 2'000'000);
  EXPECT_EQ(arrivals[1].start, kStart + 3 * kMicrosecond / 2);
}

TEST(ScriptedChannel, FindsTelegrams) {
  const line::TelegramCode code{line::TelegramLayout{}};
  Waveform train = wave_of("");
  for (std::uint8_t n = 1; n < 5; ++n) code.append(train.levels, line::kDataTelegram, n);
  const auto octets = [&](auto order) {
    ScriptedChannel channel(&code);
    order(channel.on_next());
    Waveforms arrivals;
    EXPECT_TRUE(channel.pass(train, arrivals));
    std::string text;
    for (const Waveform& arrival : arrivals) {
      code.decode(arrival.levels, 0,
                  [&](const line::Telegram& telegram) { text += std::to_string(telegram.data) + " "; });
      text += "| ";
    }
    return text;
  };
  EXPECT_EQ(octets([](auto& c) { c.drop_telegram(1); }), "1 | 3 4 | ");
  EXPECT_EQ(octets([](auto& c) { c.remove_telegram(1); }), "1 3 4 | ");
  EXPECT_EQ(octets([](auto& c) { c.repeat_telegram(3); }), "1 2 3 4 4 | ");
  EXPECT_EQ(octets([](auto& c) { c.flip_in_telegram(0, 4); }), "129 2 3 4 | ");
  EXPECT_EQ(octets([](auto& c) { c.drop_telegram(4); }), "1 2 3 4 | ");
  EXPECT_EQ(octets([](auto& c) { c.drop_telegram(0).remove_telegram(2).repeat_telegram(3); }), "2 4 4 | ");
  ScriptedChannel blind;
  EXPECT_THROW(blind.drop_telegram(0), kernel::BrokenInvariant);
}

TEST(ScriptedChannel, ForgetsWhatItWasToldWhenDisarmed) {
  ScriptedChannel channel;
  channel.on_next().lose();
  channel.disarm();
  EXPECT_EQ(pass(channel, wave_of("0")), "as sent");
}

TEST(ChannelChain, AsksInOrderOfInstallation) {
  ScriptedChannel first;
  ScriptedChannel second;
  ChannelChain chain;
  EXPECT_EQ(pass(chain, wave_of("0000")), "as sent");
  chain.add(first);
  chain.add(second);
  EXPECT_EQ(pass(chain, wave_of("0000")), "as sent");
  first.on_next().force(true, 0, 2);
  second.on_next().flip(0);
  EXPECT_EQ(pass(chain, wave_of("0000")), "@0 0100 ");
}

TEST(ChannelChain, ShowsEachPieceToTheNextAndKeepsTheOrder) {
  ScriptedChannel first;
  ScriptedChannel second;
  ChannelChain chain;
  chain.add(first);
  chain.add(second);
  first.on_next().drop(1, 1);
  second.on_next().delay(9 * kMicrosecond);
  EXPECT_EQ(pass(chain, wave_of("0000")), "@2 00 @9 0 ");
  second.on_next().lose();
  EXPECT_EQ(pass(chain, wave_of("0000")), "");
  first.on_next().lose();
  EXPECT_EQ(pass(chain, wave_of("0000")), "");
}

}  // namespace
}  // namespace fieldproof::fault
