#include "conformance/token_bus/translator_bench.hpp"

#include <algorithm>
#include <utility>

#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kUnitLevels = 4;

}  // namespace

TranslatorBench::TranslatorBench(const TranslatorNeeds& needs, const TranslatorSetting& setting)
    : SidesBench(sides_configuration(needs, setting, token_bus::kTranslatorTable), setting, "translator"),
      sent_(SideLog::Side::phy, configuration().rules.phy_bit_rate),
      indicated_(SideLog::Side::mac, token_bus::mac_symbol_rate(configuration().rules)),
      phy_in_(into("translator/receive", token_bus::kPhySide)),
      mac_in_(into("translator/request", token_bus::kMacSide)),
      phy_out_(out_of("translator/transmit", token_bus::kPhySide)),
      mac_out_(out_of("translator/indicate", token_bus::kMacSide)) {
  start_recording(setting, configuration().rules);
  phy_out_.tap_driven(sent_);
  mac_out_.tap_driven(indicated_);
  watch(phy_out_);
  watch(mac_out_);
  if (fault::InstalledPlan* const made = make_plan(
          setting.plan, fault::names_of_transmissions({phy_in_.name()}, observations_of_the_watch()))) {
    phy_in_.set_channel(made->channel_for(
        {phy_in_.name(), phy_in_.trace_channel(), kUnitLevels * configuration().rules.phy_bit_rate}));
  }
  device().wire(phy_out_, mac_out_);
  set_power(true);
}

void TranslatorBench::ask() {
  constexpr std::size_t kLongEnough = 64;
  command(SideCommand::reset, kLongEnough);
  settle();
}

kernel::Time TranslatorBench::drive_request(line::Levels levels) {
  return drive(mac_in_, now(), kUnitLevels * token_bus::mac_symbol_rate(configuration().rules),
               std::move(levels), mac_parts_per_million_);
}

// By the rate of the levels, to which the deviation of the clock applies.
kernel::Duration TranslatorBench::requested_symbols(std::size_t count) const {
  constexpr std::int64_t kMillion = 1'000'000;
  const std::int64_t rate = kUnitLevels * token_bus::mac_symbol_rate(configuration().rules);
  return kernel::levels_duration(kUnitLevels * static_cast<std::int64_t>(count),
                                 rate + rate / kMillion * mac_parts_per_million_);
}

kernel::Time TranslatorBench::drive_bits(const SideBits& bits) {
  return drive(phy_in_, now(), kUnitLevels * configuration().rules.phy_bit_rate, phy_levels_of(bits),
               parts_per_million_);
}

void TranslatorBench::request(std::string_view symbols) {
  segment().run_until(drive_request(request_levels_of(symbols)));
}

void TranslatorBench::command(SideCommand command, std::size_t symbols) {
  segment().run_until(drive_request(request_levels_of(command, symbols)));
}

void TranslatorBench::carry(const SideBits& bits) {
  segment().run_until(drive_bits(bits));
}

void TranslatorBench::request_and_receive(std::string_view symbols, const SideBits& bits) {
  kernel::Time end = now();
  if (!symbols.empty()) end = drive_request(request_levels_of(symbols));
  if (!bits.empty()) end = std::max(end, drive_bits(bits));
  segment().run_until(end);
}

void TranslatorBench::command_and_receive(SideCommand command, std::size_t symbols, const SideBits& bits) {
  const kernel::Time end = drive_request(request_levels_of(command, symbols));
  segment().run_until(std::max(end, drive_bits(bits)));
}

std::vector<std::string> TranslatorBench::decode_lines() const {
  std::vector<std::string> lines = driven_lines([&](const segment::Link& link) {
    return &link == &phy_in_
               ? SideLog(SideLog::Side::phy, configuration().rules.phy_bit_rate)
               : SideLog(SideLog::Side::requests, token_bus::mac_symbol_rate(configuration().rules));
  });
  lines.push_back(shown_end("the translator sent", sent_));
  lines.push_back(shown_end("the translator indicated", indicated_));
  return lines;
}

}  // namespace fieldproof::conformance
