#include "protocols/token_bus/dual_channel.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocols/token_bus/test_dual_channel.hpp"

namespace fieldproof::token_bus {
namespace {

using enum Channel;

constexpr std::int64_t kLong = 400;  // symbols

std::string frame_of_letters(std::uint8_t content = 0xA5, bool more_follows = false, bool is_right = true) {
  MacSymbols symbols;
  Octets octets = with_check(Octets(5, content));
  if (!is_right) octets.back() ^= 1;
  append_framed(symbols, octets, {.more_follows = more_follows});
  std::string text = written(symbols);
  std::ranges::replace(text, 'P', '1');
  return text;
}
std::string from_delimiter(const std::string& frame) {
  return frame.substr(frame.find('N'));
}

TEST(ChannelManager, SendsOnBothChannels) {
  TestChannelManager test;
  test.request("PPNN0NN00001S1");
  test.wait(kLong);
  EXPECT_EQ(test.take_requested(a), "BBNN0NN000011") << "pad_idle shares its code with bad_signal";
  test.request("PPNN0NN00001");
  test.wait(kLong);
  test.take_requested(a);
  EXPECT_EQ(test.take_requested(b), "BBNN0NN000011BBNN0NN00001");
  EXPECT_TRUE(test.is_in_order());
}

TEST(ChannelManager, IndicatesOneOfTwoEqualTransmissions) {
  TestChannelManager test;
  const std::string frame = frame_of_letters();
  for (const std::int64_t later : {0, 3, 8}) {
    for (const Channel first : kChannels) {
      test.indicate(first, frame);
      test.indicate(other_than(first), frame, later);
      const kernel::Time begin = test.now() + mac_symbols(Rules{}, first == a ? 0 : later);
      test.wait(kLong);
      EXPECT_EQ(test.first_indicated(), begin + mac_symbols(Rules{}, 24));
      EXPECT_EQ(test.take_indicated(), frame);
    }
  }
  EXPECT_EQ(test.take_events(), "");
  EXPECT_TRUE(test.is_in_order());
}

TEST(ChannelManager, GoesOnWithTheChannelThatIsLeft) {
  TestChannelManager test;
  const std::string frame = frame_of_letters();
  test.indicate(b, frame);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), from_delimiter(frame)) << "A was preferred, and silent";
  EXPECT_EQ(test.take_events(), "A no start delimiter\n");
  test.indicate(b, frame);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), frame);
  for (unsigned n = 0; n < 3; ++n) {
    test.indicate(a, frame);
    test.indicate(b, frame, 2);
    test.wait(kLong);
    EXPECT_EQ(test.take_indicated(), frame);
  }
  EXPECT_EQ(test.take_events(), "A clean again\n");
}

TEST(ChannelManager, NeverSwitchesWithinATransmission) {
  TestChannelManager test;
  const std::string frame = frame_of_letters();
  const std::string cut = frame.substr(0, 60);
  test.indicate(a, cut);
  test.indicate(b, frame);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), cut);
  test.indicate(a, cut + std::string(frame.size() - cut.size(), 'B'));
  test.indicate(b, frame, 4);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), cut + std::string(frame.size() - cut.size(), 'B'));
  EXPECT_EQ(test.take_events(), "A bad signal\n");
  test.indicate(a, frame);
  test.indicate(b, frame, 4);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), frame);
}

TEST(ChannelManager, KeepsATrainTogether) {
  TestChannelManager test;
  const std::string train = frame_of_letters(1, true) + frame_of_letters(2, true) + frame_of_letters(3);
  test.indicate(b, train);
  test.indicate(a, train, 7);
  test.wait(3 * kLong);
  EXPECT_EQ(test.take_indicated(), train);
  EXPECT_EQ(test.take_events(), "");
}

TEST(ChannelManager, LeavesAChannelAfterThreeWrongChecks) {
  TestChannelManager test;
  const std::string right = frame_of_letters();
  const std::string wrong = frame_of_letters(0xA5, false, false);
  for (unsigned n = 0; n < 5; ++n) {
    test.indicate(a, wrong);
    test.indicate(b, right);
    test.wait(kLong);
    EXPECT_EQ(test.take_indicated(), n < 3 ? wrong : right) << n;
  }
  EXPECT_EQ(test.take_events(), "A frame errors\n");
}

TEST(ChannelManager, AnswersOfTheManagementModeAreThoseOfTheChannelThatGivesThem) {
  TestChannelManager test;
  test.manage(ManagementCommand::reset, 8);
  test.wait(20);
  EXPECT_EQ(test.take_requested(a).size(), 8U);
  EXPECT_EQ(test.take_requested(b).size(), 8U);
  test.answer(a, ManagementAnswer::ack, 8);
  test.answer(b, ManagementAnswer::nack, 8);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), "aaaaaaaa");
  test.answer(b, ManagementAnswer::ack, 8);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), "aaaaaaaa");
}

TEST(ChannelManager, ForgetsEverythingWithoutSupply) {
  TestChannelManager test;
  const std::string frame = frame_of_letters();
  test.indicate(b, frame);
  test.wait(kLong);
  test.set_power(false);
  test.request("PPPP");
  test.indicate(b, frame);
  test.wait(kLong);
  test.take_indicated();
  test.take_events();
  EXPECT_EQ(test.take_requested(a), "");
  test.set_power(true);
  test.indicate(b, frame);
  test.wait(kLong);
  EXPECT_EQ(test.take_indicated(), from_delimiter(frame)) << "A is preferred again";
  EXPECT_EQ(test.take_events(), "A no start delimiter\n");
}

// Whatever two channels show: the MAC is given start delimiters only where a channel had them, and each level
// in order.
RC_GTEST_PROP(ChannelManager, GivesNothingThatNoChannelHad, ()) {
  TestChannelManager test;
  std::size_t on_a = 0;
  std::size_t on_b = 0;
  std::size_t indicated = 0;
  for (unsigned n = 0; n < 4; ++n) {
    const auto symbols = [] {
      const std::string frame = frame_of_letters();
      std::string text = frame.substr(0, *rc::gen::inRange<std::size_t>(1, frame.size()));
      text += *rc::gen::container<std::string>(rc::gen::element('0', '1', 'N', 'B', 'S'));
      return text;
    };
    const std::string first = symbols();
    const std::string second = symbols();
    test.indicate(a, first, *rc::gen::inRange(0, 20));
    test.indicate(b, second, *rc::gen::inRange(0, 20));
    on_a += static_cast<std::size_t>(std::ranges::count_if(first, [](char one) { return one != 'S'; }));
    on_b += static_cast<std::size_t>(std::ranges::count_if(second, [](char one) { return one != 'S'; }));
    test.wait(2 * kLong);
    indicated += test.take_indicated().size();
  }
  RC_ASSERT(indicated <= on_a + on_b);
  RC_ASSERT(test.is_in_order());
}

}  // namespace
}  // namespace fieldproof::token_bus
