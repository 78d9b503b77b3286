#include "protocols/token_bus/translator_dissector.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "protocols/token_bus/dissector.hpp"
#include "protocols/token_bus/frame.hpp"
#include "protocols/token_bus/service_signals.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::size_t kMostSymbolsShown = 80;

std::string cut(const std::string& text) {
  if (text.size() <= kMostSymbolsShown) return text;
  return fmt::format("{} and {} more", text.substr(0, kMostSymbolsShown), text.size() - kMostSymbolsShown);
}

std::string phy_text(const line::Waveform& wave, const Rules& rules) {
  line::Waveform on_line{wave.start, 2 * rules.phy_bit_rate, {}};
  std::string bits;
  bool is_whole = true;
  for (std::size_t n = 0; n < units_in(wave.levels); ++n) {
    const PhyCell cell = phy_cell_at(wave.levels, n);
    is_whole &= !cell.status.has_signal_error;
    append(on_line.levels, std::span(&cell.symbol, 1));
    if (cell.status.has_signal_error) bits += '!';
    bits += written(std::span(&cell.symbol, 1));
  }
  const std::string frames = BusDissector(rules).brief(on_line);
  return is_whole && frames != text_of(ReceptionKind::non_silence) ? frames : cut(bits);
}

std::string mac_text(const line::Waveform& wave) {
  std::string text;
  for (std::size_t n = 0; n < units_in(wave.levels);) {
    const MacIndication one = mac_indication_at(wave.levels, n);
    if (!one.answer) {
      text += one.symbol == MacSymbol::bad_signal ? "X" : written(std::span(&one.symbol, 1));
      ++n;
      continue;
    }
    const std::size_t first = n;
    const std::string code = wave.levels.slice(kUnitLevels * n + 1, 3).text();
    while (n < units_in(wave.levels) && wave.levels.slice(kUnitLevels * n, 4).text() == "0" + code) ++n;
    text += fmt::format("[{} x {}]", code, n - first);
  }
  return cut(text);
}

std::string described(const line::Waveform& wave, const Rules& rules) {
  const std::int64_t between = (phy_side_rate(rules.phy_bit_rate) + mac_side_rate(rules.phy_bit_rate)) / 2;
  return wave.rate > between ? phy_text(wave, rules) : mac_text(wave);
}

class SidesTeller final : public trace::Teller {
 public:
  explicit SidesTeller(const Rules& rules) : rules_(rules) {}
  trace::Decoded tell(const line::Waveform& wave) override { return {described(wave, rules_), false}; }

 private:
  Rules rules_;
};

}  // namespace

std::string TranslatorDissector::brief(const line::Waveform& wave) const {
  return described(wave, rules_);
}

std::unique_ptr<trace::Teller> TranslatorDissector::teller() const {
  return std::make_unique<SidesTeller>(rules_);
}

}  // namespace fieldproof::token_bus
