#include "conformance/token_bus/translator_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/token_bus/translator_declarations.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kUnitLevels = 4;

token_bus::TranslatorConfiguration configuration_for(const TranslatorNeeds& needs,
                                                     const TranslatorSetting& setting) {
  token_bus::TranslatorConfiguration configuration =
      translator_declared_in(setting.pics.value_or(judge::Pics{}).completed_by(declared_translator()));
  if (needs.adjust != nullptr) needs.adjust(configuration);
  return configuration;
}

}  // namespace

// Nothing that is sent is shorter than a symbol.
TranslatorBench::TranslatorBench(const TranslatorNeeds& needs, const TranslatorSetting& setting)
    : CaseBench(setting.seed, setting.volume, setting.stresses,
                LineWatch(token_bus::mac_symbols(configuration_for(needs, setting).rules, 1))),
      configuration_(configuration_for(needs, setting)),
      sent_(SideLog::Side::phy, configuration_.rules.phy_bit_rate),
      indicated_(SideLog::Side::mac, token_bus::mac_symbol_rate(configuration_.rules)),
      translator_(setting.make_device(configuration_)),
      tester_(segment().attach(*this, "tester")),
      seat_(segment().attach(*translator_, "translator")),
      phy_in_(segment().connect("translator/receive", seat_, token_bus::kPhySide, {})),
      mac_in_(segment().connect("translator/request", seat_, token_bus::kMacSide, {})),
      phy_out_(segment().connect("translator/transmit", tester_, token_bus::kPhySide, {})),
      mac_out_(segment().connect("translator/indicate", tester_, token_bus::kMacSide, {})) {
  start_recording(setting, configuration_.rules);
  phy_out_.tap_driven(sent_);
  mac_out_.tap_driven(indicated_);
  watch(phy_out_);
  watch(mac_out_);
  if (fault::InstalledPlan* const made = make_plan(setting.plan)) {
    phy_in_.set_channel(made->channel_for(
        {phy_in_.name(), phy_in_.trace_channel(), kUnitLevels * configuration_.rules.phy_bit_rate}));
  }
  translator_->wire(phy_out_, mac_out_);
  set_power(true);
}

void TranslatorBench::ask() {
  constexpr std::size_t kLongEnough = 64;
  command(SideCommand::reset, kLongEnough);
  settle();
}

void TranslatorBench::set_power(bool is_on) {
  translator_->set_power(is_on, now());
  segment().refresh(seat_);
}

kernel::Time TranslatorBench::drive_request(line::Levels levels) {
  line::Waveform wave{now(), kUnitLevels * token_bus::mac_symbol_rate(configuration_.rules),
                      std::move(levels)};
  const kernel::Time end = wave.end();
  mac_in_.drive(wave);
  return end;
}

kernel::Time TranslatorBench::drive_bits(const SideBits& bits) {
  constexpr std::int64_t kMillion = 1'000'000;
  const std::int64_t nominal = kUnitLevels * configuration_.rules.phy_bit_rate;
  line::Waveform wave{now(), nominal + nominal / kMillion * parts_per_million_, phy_levels_of(bits)};
  const kernel::Time end = wave.end();
  phy_in_.drive(wave);
  return end;
}

void TranslatorBench::request(std::string_view symbols) {
  segment().run_until(drive_request(request_levels_of(symbols)));
}

void TranslatorBench::command(SideCommand command, std::size_t symbols) {
  segment().run_until(drive_request(request_levels_of(command, symbols)));
}

void TranslatorBench::receive(const SideBits& bits) {
  segment().run_until(drive_bits(bits));
}

void TranslatorBench::request_and_receive(std::string_view symbols, const SideBits& bits) {
  const kernel::Time end = drive_request(request_levels_of(symbols));
  segment().run_until(std::max(end, drive_bits(bits)));
}

void TranslatorBench::command_and_receive(SideCommand command, std::size_t symbols, const SideBits& bits) {
  const kernel::Time end = drive_request(request_levels_of(command, symbols));
  segment().run_until(std::max(end, drive_bits(bits)));
}

std::vector<std::uint8_t> TranslatorBench::random_octets(std::size_t count) {
  std::vector<std::uint8_t> octets;
  while (octets.size() < count) octets.push_back(random_octet());
  return octets;
}

std::vector<std::string> TranslatorBench::decode_lines() const {
  constexpr std::size_t kMostShown = 160;
  std::vector<std::string> lines;
  const auto add = [&](std::string_view what, const std::string& text) {
    const std::size_t first = text.size() - std::min(text.size(), kMostShown);
    lines.push_back(fmt::format("{}: {}{}", what, first > 0 ? "..." : "", text.substr(first)));
  };
  add("the translator sent", sent_.text());
  add("the translator indicated", indicated_.text());
  return lines;
}

}  // namespace fieldproof::conformance
