#include "protocols/token_bus/translator.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "protocols/token_bus/test_translator.hpp"

namespace fieldproof::token_bus {
namespace {

using enum ManagementCommand;

constexpr std::string_view kTokenBits =
    "1100011100010101"   // SD
    "0101010110010101";  // 10h, its lowest bit first

MacSymbols token_frame(const Delimiting& delimiting = {}) {
  MacSymbols symbols;
  append_framed(
      symbols,
      with_check(octets_of(Frame{.kind = FrameKind::token, .destination = 4, .source = 10}, Rules{})),
      delimiting);
  return symbols;
}

std::string as_indicated(const MacSymbols& requested) {
  std::string text = written(requested);
  std::ranges::replace(text, 'P', '1');
  return text;
}

TEST(Translator, SendsAndReceivesNothingBeforeItIsManaged) {
  TestTranslator test;
  test.request(token_frame());
  test.wait(40);
  EXPECT_EQ(test.take_phy(), "");
  // Its own symbols, for the loopback is on.
  EXPECT_EQ(test.take_indications(), as_indicated(token_frame()));
  test.receive_bits("10101010");
  test.wait(40);
  EXPECT_EQ(test.take_indications(), "");
}

TEST(Translator, EachCommandIsAnswered) {
  TestTranslator test;
  EXPECT_EQ(
      test.answers_to({reset, disable_loopback, enable_transmitter, idle, serial_data, enable_transmitter}),
      "ACK ACK ACK IDLE NACK ACK");
}

TEST(Translator, EachSymbolGoesOutAsTheTableOfThePaperSays) {
  TestTranslator test;
  test.bring_up();
  test.request(mac_symbols_of("PP01NN0NN1S1"));
  test.wait(40);
  EXPECT_EQ(test.take_phy(),
            "1010"
            "01"
            "10"
            "1100"
            "01"
            "1100"
            "10"
            "II"
            "10");
}

TEST(Translator, ATokenFrameIsTwoHundredAndFortyBits) {
  TestTranslator test;
  test.bring_up();
  test.request(token_frame());
  test.wait(300);
  const std::string bits = test.take_phy();
  EXPECT_EQ(bits.size(), 240U);
  std::string preamble;
  for (unsigned n = 0; n < 32; ++n) preamble += "10";
  EXPECT_EQ(bits.substr(0, 66), preamble + "11");
  EXPECT_EQ(bits.substr(64, kTokenBits.size()), kTokenBits);
  EXPECT_EQ(bits.substr(224), "1100101100100101");
}

TEST(Translator, WhatIsDrivenIsLaterByItsDelay) {
  TestTranslator test;
  test.bring_up();
  const kernel::Time begin = test.now();
  test.request(mac_symbols_of("PP"));
  test.wait(40);
  EXPECT_EQ(test.first_phy() - begin, mac_symbols(Rules{}, 8));
}

TEST(Translator, BothPhasesAreLocked) {
  for (const std::string_view lost : {"", "1"}) {
    TestTranslator test;
    test.bring_up();
    const std::string bits = written(phy_symbols_of(token_frame()));
    test.receive_bits(bits.substr(lost.size()));
    test.wait(300);
    const std::string symbols = test.take_indications();
    const std::string content = as_indicated(token_frame()).substr(32);
    ASSERT_GE(symbols.size(), content.size());
    EXPECT_EQ(symbols.substr(symbols.size() - content.size()), content) << lost;
    EXPECT_EQ(symbols.substr(0, 2), lost.empty() ? "11" : "00");
  }
}

TEST(Translator, ABitBeforeTheCarrierMovesThePhase) {
  TestTranslator test;
  test.bring_up();
  test.receive_bits("I" + written(phy_symbols_of(token_frame())));
  test.wait(300);
  EXPECT_NE(test.take_indications().find(as_indicated(token_frame()).substr(32)), std::string::npos);
}

TEST(Translator, DribbleBitsAfterTheLastFrameAreSilence) {
  for (std::size_t count = 1; count <= 7; ++count) {
    TestTranslator test;
    test.bring_up();
    test.receive_bits(written(phy_symbols_of(token_frame())) + std::string("1011010").substr(0, count));
    test.wait(300);
    EXPECT_EQ(test.take_indications(), as_indicated(token_frame())) << count;
  }
}

TEST(Translator, BlankingHidesWhatFollowsALastFrameForItsTime) {
  for (const bool more_follows : {false, true}) {
    for (const std::int64_t gap : {10, 26, 29}) {
      TestTranslator test;
      test.bring_up();
      test.receive_bits(written(phy_symbols_of(token_frame({.more_follows = more_follows}))));
      test.take_indications();
      test.wait(gap);
      test.receive_bits("1010");
      test.wait(60);
      const std::string symbols = test.take_indications();
      EXPECT_EQ(symbols.ends_with("11"), more_follows || gap > 28) << more_follows << gap;
    }
  }
}

TEST(Translator, ASignalErrorAfterAnOwnTransmissionIsMasked) {
  for (const std::int64_t gap : {4, 40}) {
    TestTranslator test;
    test.bring_up();
    test.request(mac_symbols_of("PPPPPPPP"));
    test.wait(8 + gap);
    test.take_indications();
    test.receive_cells(std::vector<PhyCell>(10, {PhySymbol::idl, {.has_signal_error = true}}));
    test.wait(40);
    EXPECT_EQ(test.take_indications(), gap == 4 ? "" : "BBBBB");
  }
}

// The next one is requested, and not on the line yet: no collision.
TEST(Translator, ASignalErrorBetweenTwoOwnTransmissionsIsMasked) {
  TestTranslator test({.delay_symbols = 16});
  test.bring_up();
  test.request(mac_symbols_of("PPPPPPPP"));
  test.wait(16);
  test.take_indications();
  test.drive(kMacSide, [] {
    line::Levels levels;
    for (unsigned n = 0; n < 8; ++n) append(levels, MacRequest{MacSymbol::pad_idle, {}});
    return levels;
  }());
  // It is sent from the 16th symbol on.
  test.receive_cells(std::vector<PhyCell>(2 * 20, {PhySymbol::idl, {.has_signal_error = true}}));
  test.wait(60);
  EXPECT_EQ(test.take_indications(), "BBBB");
}

TEST(Translator, AnAnswerIsAsLateAsItMayBeAtMost) {
  TestTranslator test({.delay_symbols = 64, .answer_symbols = 2});
  test.manage(reset, 8);
  test.wait(10);
  EXPECT_EQ(test.take_indications(), "aaaaaaaa");
}

TEST(Translator, NoSymbolLeaksIntoManagementMode) {
  TestTranslator test;
  test.bring_up();
  test.manage(idle, 130);
  test.receive_bits(written(phy_symbols_of(token_frame())));
  test.wait(60);
  EXPECT_EQ(test.take_indications(), std::string(130, 'i'));
  // END PHYSICAL.
  test.receive_bits("1010");
  test.wait(60);
  EXPECT_EQ(test.take_indications(), "11");
}

TEST(Translator, AJabberingTransmitterIsOffUntilReset) {
  TestTranslator test({.jabber_symbols = 100});
  test.bring_up();
  test.request(MacSymbols(120, MacSymbol::pad_idle));
  test.wait(200);
  EXPECT_EQ(test.take_phy().size(), 200U);
  EXPECT_EQ(test.answers_to({idle, enable_transmitter, reset, idle}), "physical error NACK ACK IDLE");
}

TEST(Translator, WhatItDoesNotSendIsNoJabber) {
  TestTranslator test({.jabber_symbols = 100});
  test.request(MacSymbols(120, MacSymbol::pad_idle));
  test.wait(60);
  test.take_indications();
  EXPECT_EQ(test.answers_to({idle, enable_transmitter}), "IDLE ACK");
}

TEST(Translator, WithoutPowerItKnowsNothing) {
  TestTranslator test;
  test.bring_up();
  test.set_power(false);
  test.receive_bits("10101010");
  test.request(token_frame());
  test.set_power(true);
  test.wait(300);
  EXPECT_EQ(test.take_phy(), "");
  EXPECT_EQ(test.take_indications(), "");
}

// PST-18: the longest frame, both clocks away as far as IEEE 802.3 lets them be.
TEST(Translator, TheLongestFrameArrivesAtEveryClock) {
  MacSymbols symbols;
  append_framed(symbols, Octets(8'191, 0x55), {});
  const std::string content = as_indicated(symbols).substr(32);
  for (const std::int64_t parts_per_million : {-100, 0, 100}) {
    TestTranslator test;
    test.bring_up();
    test.set_clock(parts_per_million);
    test.receive_bits(written(phy_symbols_of(symbols)));
    test.wait(100);
    EXPECT_TRUE(test.take_indications().ends_with(content)) << parts_per_million;
  }
}

// ---- properties ----

RC_GTEST_PROP(TranslatorProperties, WhatOneIsRequestedTheOtherIndicates, (const Octets& octets)) {
  const auto lost = *rc::gen::inRange<std::size_t>(0, 16);
  const bool is_late = *rc::gen::arbitrary<bool>();
  TestTranslator sender;
  TestTranslator receiver;
  sender.bring_up();
  receiver.bring_up();
  MacSymbols symbols;
  append_framed(symbols, with_check(octets), {});
  sender.request(symbols);
  sender.wait(60);
  receiver.receive_bits((is_late ? "I" : "") + sender.take_phy().substr(lost));
  receiver.wait(60);
  RC_ASSERT(receiver.take_indications().ends_with(as_indicated(symbols).substr(32)));
}

RC_GTEST_PROP(TranslatorProperties, AnyLevelsOnBothSidesAreTaken, (std::vector<std::uint8_t> octets)) {
  TestTranslator test;
  if (*rc::gen::arbitrary<bool>()) test.bring_up();
  for (const std::uint8_t octet : octets) {
    line::Levels levels;
    for (unsigned n = 0; n < 1U + octet % 7; ++n)
      levels.append(std::uint64_t{octet} * (n + 1) * 0x9E37, 16 - n);
    test.drive(octet % 2, levels, octet % 5 == 0 ? 16 : 1);
    if (octet % 3 == 0) test.wait(octet % 11);
  }
  test.wait(400);
  const std::string symbols = test.take_indications();
  RC_ASSERT(symbols.find('P') == std::string::npos);
  RC_ASSERT(test.is_in_order());
}

}  // namespace
}  // namespace fieldproof::token_bus
