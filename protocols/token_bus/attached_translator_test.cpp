#include "protocols/token_bus/attached_translator.hpp"

#include <gtest/gtest.h>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/token_bus/test_translator.hpp"
#include "protocols/token_bus/translator_dissector.hpp"

namespace fieldproof::token_bus {
namespace {

iut::Attachment attachment(iut::Device& device) {
  iut::Attachment made;
  made.device = &device;
  return made;
}

class NoPort final : public segment::Port {
 public:
  void drive(line::Waveform& wave) override { wave.levels.clear(); }
};

TEST(TranslatorSettings, ComeBackAsTheyWere) {
  TranslatorConfiguration configuration{.delay_symbols = 3, .answer_symbols = 5, .jabber_symbols = 70'000};
  configuration.rules.blanking_symbols = 25;
  const TranslatorConfiguration back =
      translator_configuration_of({"case", 1, translator_settings(configuration)});
  EXPECT_EQ(back.rules, configuration.rules);
  EXPECT_EQ(back.delay_symbols, 3U);
  EXPECT_EQ(back.answer_symbols, 5U);
  EXPECT_EQ(back.error_mask_symbols, 20U);
  EXPECT_EQ(back.jabber_symbols, 70'000U);
}

// A translator of ours as an implementation outside does what it does inside, to the level.
TEST(AttachedTranslator, DrivesWhatTheTranslatorInsideDrives) {
  ServedTranslator served([](const TranslatorConfiguration& of) { return std::make_unique<Translator>(of); });
  TestTranslator outside(
      std::make_unique<AttachedTranslator>(attachment(served), TranslatorConfiguration{}, "case", 1));
  TestTranslator inside;
  MacSymbols symbols;
  append_framed(symbols, Octets(5, 0xA5), {});
  for (TestTranslator* test : {&outside, &inside}) {
    test->bring_up();
    test->request(symbols);
    test->receive_bits(written(phy_symbols_of(symbols)));
    test->wait(100);
  }
  EXPECT_EQ(outside.take_phy(), inside.take_phy());
  const std::string indicated = outside.take_indications();
  EXPECT_EQ(indicated.size(), symbols.size());
  EXPECT_EQ(indicated, inside.take_indications());
}

TEST(AttachedTranslator, WhatCannotBeIsMisbehaviour) {
  const std::vector<iut::ActingDevice::Act> acts{[](iut::Bench& bench) { bench.send(0, kernel::kStart, {}); },
                                                 [](iut::Bench& bench) { bench.write(1, 1, kernel::kStart); },
                                                 [](iut::Bench& bench) { bench.read(1, kernel::kStart); },
                                                 [](iut::Bench& bench) {
                                                   line::Waveform wave{
                                                       kernel::kStart + kernel::kSecond, 1'000, {}};
                                                   wave.levels.append(0, 1);
                                                   bench.transmit(2, wave);
                                                 }};
  for (const auto& act : acts) {
    iut::ActingDevice device(iut::UnitKind::levels);
    device.at_time = act;
    AttachedTranslator attached(attachment(device), {}, "case", 1);
    NoPort port;
    attached.wire(port, port);
    attached.set_power(true, kernel::kStart);
    EXPECT_THROW(attached.on_time(kernel::kStart), iut::Misbehaviour);
  }
}

TEST(AttachedTranslator, ReceivesLevelsOnly) {
  iut::ActingDevice device(iut::UnitKind::characters);
  EXPECT_THROW(AttachedTranslator(attachment(device), {}, "case", 1), kernel::Error);
}

TEST(TranslatorDissector, ReadsBothSides) {
  const TranslatorDissector dissector{Rules{}};
  line::Waveform mac{{}, mac_side_rate(Rules{}.phy_bit_rate), {}};
  for (const MacSymbol symbol : mac_symbols_of("PNN01S")) append(mac.levels, MacRequest{symbol, {}});
  for (unsigned n = 0; n < 3; ++n) append(mac.levels, MacRequest{.command = ManagementCommand::reset});
  EXPECT_EQ(dissector.brief(mac), "XNN01S[111 x 3]");
  line::Waveform phy{{}, phy_side_rate(Rules{}.phy_bit_rate), {}};
  const LineStatus on{};
  for (const PhyCell& cell :
       {PhyCell{PhySymbol::cd1, on}, PhyCell{PhySymbol::cd0, {.has_signal_error = true}}, PhyCell{}})
    append(phy.levels, cell);
  EXPECT_EQ(dissector.brief(phy), "1!0I");
  phy.levels.clear();
  for (const PhySymbol symbol : phy_symbols_of([] {
         MacSymbols symbols;
         append_framed(symbols, with_check(octets_of(Frame{.destination = 4, .source = 10}, Rules{})), {});
         return symbols;
       }()))
    append(phy.levels, PhyCell{symbol, on});
  EXPECT_EQ(dissector.brief(phy), "token, 000A -> 0004");
}

TEST(ServiceSignals, EachCodeIsWrittenAndReadAsItsTable) {
  const auto circuits = [](auto what) {
    line::Levels levels;
    append(levels, what);
    return levels.text();
  };
  EXPECT_EQ(circuits(MacRequest{MacSymbol::zero, {}}), "1000");
  EXPECT_EQ(circuits(MacRequest{MacSymbol::one, {}}), "1001");
  EXPECT_EQ(circuits(MacRequest{MacSymbol::pad_idle, {}}), "1010");
  EXPECT_EQ(circuits(MacRequest{MacSymbol::non_data, {}}), "1100");
  EXPECT_EQ(circuits(MacRequest{}), "1111");
  EXPECT_EQ(circuits(MacRequest{.command = ManagementCommand::reset}), "0111");
  EXPECT_EQ(circuits(MacRequest{.command = ManagementCommand::disable_loopback}), "0101");
  EXPECT_EQ(circuits(MacRequest{.command = ManagementCommand::enable_transmitter}), "0011");
  EXPECT_EQ(circuits(MacRequest{.command = ManagementCommand::idle}), "0001");
  EXPECT_EQ(circuits(MacRequest{.command = ManagementCommand::serial_data}), "0000");
  EXPECT_EQ(circuits(MacIndication{MacSymbol::bad_signal, {}}), "1010");
  EXPECT_EQ(circuits(MacIndication{.answer = ManagementAnswer::idle}), "0001");
  EXPECT_EQ(circuits(MacIndication{.answer = ManagementAnswer::ack}), "0011");
  EXPECT_EQ(circuits(MacIndication{.answer = ManagementAnswer::nack}), "0101");
  EXPECT_EQ(circuits(MacIndication{.answer = ManagementAnswer::physical_error}), "0111");
  EXPECT_EQ(circuits(PhyCell{PhySymbol::cd1, {}}), "0101");
  EXPECT_EQ(circuits(PhyCell{PhySymbol::cd0, {.has_signal_error = true}}), "0010");
  EXPECT_EQ(circuits(PhyCell{}), "1111");
  for (unsigned code = 0; code < 16; ++code) {
    line::Levels levels;
    levels.append(code, 4);
    const MacIndication indication = mac_indication_at(levels, 0);
    EXPECT_EQ(mac_indication_at(line::Levels::of_text(circuits(indication)), 0), indication);
    EXPECT_EQ(mac_request_at(levels, 0).command.has_value(), indication.answer.has_value());
  }
}

}  // namespace
}  // namespace fieldproof::token_bus
