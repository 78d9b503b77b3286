#include "protocols/token_bus/attached_dual_channel.hpp"

#include <gtest/gtest.h>

#include "harness/iut/acting_device.hpp"
#include "protocols/token_bus/test_dual_channel.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::string_view kFrame = "1111 NN0NN000 11110000 NN1NN100";

iut::Attachment attachment_of_manager(iut::Device& device) {
  iut::Attachment made;
  made.device = &device;
  return made;
}

TEST(ChannelManagerSettings, ComeBackAsTheyWere) {
  ChannelManagerConfiguration configuration{
      .channels = {.skew_symbols = 5, .errors_in_a_row = 2, .clean_in_a_row = 7}, .delay_symbols = 3};
  configuration.rules.slot_time_octets = 77;
  const ChannelManagerConfiguration back =
      channel_manager_configuration_of({"case", 1, channel_manager_settings(configuration)});
  EXPECT_EQ(back.rules, configuration.rules);
  EXPECT_EQ(back.channels, configuration.channels);
  EXPECT_EQ(back.delay_symbols, 3U);
  EXPECT_EQ(ChannelRules{}.skew_symbols, 8U);
  EXPECT_EQ(ChannelRules{}.errors_in_a_row, 3U);
  EXPECT_EQ(ChannelRules{}.clean_in_a_row, 3U);
  EXPECT_EQ(ChannelManagerConfiguration{}.delay_symbols, 8U);
}

// A manager of ours as an implementation outside does what it does inside, to the level.
TEST(AttachedChannelManager, DrivesAndReportsWhatTheManagerInsideDoes) {
  ServedChannelManager served(
      [](const ChannelManagerConfiguration& of) { return std::make_unique<ChannelManager>(of); });
  TestChannelManager outside(std::make_unique<AttachedChannelManager>(
      attachment_of_manager(served), ChannelManagerConfiguration{}, "case", 1));
  TestChannelManager inside;
  for (TestChannelManager* test : {&outside, &inside}) {
    test->request("PPPPNN0NN000");
    test->indicate(Channel::b, kFrame);
    test->wait(500);
  }
  EXPECT_EQ(outside.take_requested(Channel::a), inside.take_requested(Channel::a));
  EXPECT_EQ(outside.take_requested(Channel::b).size(), 12U);
  const std::string indicated = outside.take_indicated();
  EXPECT_EQ(indicated.size(), 24U);
  EXPECT_EQ(indicated, inside.take_indicated());
  EXPECT_EQ(outside.take_events(), "A no start delimiter\n");
  EXPECT_EQ(inside.take_events(), "A no start delimiter\n");
}

TEST(AttachedChannelManager, WhatCannotBeIsMisbehaviour) {
  const std::vector<iut::ActingDevice::Act> acts{
      [](iut::Bench& bench) { bench.send(0, kernel::kStart, {}); },
      [](iut::Bench& bench) { bench.write(2, 0x100, kernel::kStart); },
      [](iut::Bench& bench) { bench.write(1, 0x104, kernel::kStart); },
      [](iut::Bench& bench) { bench.write(1, 0x300, kernel::kStart); },
      [](iut::Bench& bench) { bench.write(1, 0x000, kernel::kStart); },
      [](iut::Bench& bench) { bench.read(1, kernel::kStart); },
      [](iut::Bench& bench) {
        line::Waveform wave{kernel::kStart + kernel::kSecond, 1'000, {}};
        wave.levels.append(0, 1);
        bench.transmit(3, wave);
      }};
  for (const auto& act : acts) {
    iut::ActingDevice device(iut::UnitKind::levels);
    device.at_time = act;
    device.next = kernel::kStart;
    TestChannelManager test(std::make_unique<AttachedChannelManager>(
        attachment_of_manager(device), ChannelManagerConfiguration{}, "case", 1));
    EXPECT_THROW(test.wait(1), iut::Misbehaviour);
  }
}

}  // namespace
}  // namespace fieldproof::token_bus
