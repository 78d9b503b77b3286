// Subject: the exchange on channel_manager.md is what the reference does when it is called as an
// implementation outside is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "protocols/token_bus/attached_dual_channel.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/translator_dissector.hpp"

namespace fieldproof::token_bus {
namespace {

// Calls an implementation, and writes down what is said in both directions.
class WrittenExchange final : private iut::Bench {
 public:
  WrittenExchange()
      : served_([](const ChannelManagerConfiguration& of) { return std::make_unique<ChannelManager>(of); }) {
    served_.begin({"case", 1, channel_manager_settings({})}, *this);
    served_.set_power(true, kernel::kStart);
    says("> power, on, now 0 s");
  }

  void receive(segment::PortIndex port, const line::Waveform& wave) {
    pass_time(wave.start);
    says(fmt::format("> receive_levels, port {}, start {}: {}", port, kernel::describe(wave.start),
                     shown(wave)));
    served_.receive(port, wave);
  }
  void pass_time(kernel::Time until) {
    for (kernel::Time next = served_.next_time(); next < until; next = served_.next_time()) {
      says(fmt::format("> on_time, now {}", kernel::describe(next)));
      served_.on_time(next);
    }
  }
  std::string text() const { return text_; }

 private:
  void says(const std::string& line) { text_ += line + "\n"; }
  static std::string shown(const line::Waveform& wave) { return TranslatorDissector(Rules{}).brief(wave); }
  void transmit(unsigned port, line::Waveform& wave) override {
    says(fmt::format("< transmit_levels, port {}, start {}: {}", port, kernel::describe(wave.start),
                     shown(wave)));
  }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override {
    says(fmt::format("< write, item {}, {:X}h, when {}", item, value, kernel::describe(when)));
  }
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override { ADD_FAILURE(); }
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }

  ServedChannelManager served_;
  std::string text_;
};

TEST(ChannelManagerPage, HasTheExchange) {
  MacSymbols symbols;
  append_framed(symbols, with_check(octets_of(Frame{.destination = 4, .source = 0x0A}, Rules{})), {});
  line::Waveform wave{kernel::kStart + octets(Rules{}, 10), mac_side_rate(Rules{}.phy_bit_rate), {}};
  for (const MacSymbol symbol : symbols)
    append(wave.levels, MacIndication{symbol == MacSymbol::pad_idle ? MacSymbol::one : symbol, {}});
  WrittenExchange exchange;
  exchange.receive(port_of(Channel::b), wave);
  exchange.pass_time(kernel::kStart + octets(Rules{}, 60));
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/token_bus/channel_manager.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find("```\n" + exchange.text() + "```\n"), std::string::npos)
      << "channel_manager.md must have:\n"
      << exchange.text();
}

}  // namespace
}  // namespace fieldproof::token_bus
