#include "conformance/token_bus/mac_player.hpp"

#include <algorithm>
#include <utility>

#include "protocols/token_bus/service_signals.hpp"

namespace fieldproof::conformance {

using token_bus::MacSymbol;

MacPlayer::MacPlayer(const token_bus::StationConfiguration& configuration, Request request)
    : rules_(configuration.rules), station_(configuration), request_(std::move(request)) {
  station_.wire(*this, *this);
}

void MacPlayer::start_anew(kernel::Time now) {
  indicated_.clear();
  station_.stop(now);
  station_.start(now);
}

void MacPlayer::indicate(const line::Waveform& wave) {
  if (indicated_.empty()) {
    begin_ = wave.start;
    station_.on_activity(0, true, wave.start);
  }
  for (std::size_t n = 0; n < token_bus::units_in(wave.levels); ++n) {
    const MacSymbol symbol = token_bus::mac_indication_at(wave.levels, n).symbol;
    // There is no level for bad_signal: a bit without an edge is as good.
    indicated_.push_back(symbol == MacSymbol::bad_signal ? MacSymbol::silence : symbol);
  }
  end_ = wave.end();
}

// By then a next symbol would have begun.
kernel::Time MacPlayer::heard_at() const {
  return indicated_.empty() ? kernel::kNever : end_ + token_bus::mac_symbols(rules_, 1);
}

void MacPlayer::hear(kernel::Time now) {
  const line::Waveform wave{begin_, 2 * rules_.phy_bit_rate,
                            token_bus::half_bits_of(std::exchange(indicated_, {}))};
  station_.receive(0, wave);
  station_.on_activity(0, false, now);
}

void MacPlayer::on_time(kernel::Time now) {
  if (heard_at() <= now) hear(now);
  if (station_.next_time() <= now) station_.on_time(now);
}

kernel::Time MacPlayer::next_time() const {
  return std::min(station_.next_time(), heard_at());
}

void MacPlayer::drive(line::Waveform& wave) {
  token_bus::MacSymbols symbols;
  for (const token_bus::Indication& one : token_bus::indications_in(wave, rules_.phy_bit_rate))
    symbols.push_back(one.symbol);
  while (!symbols.empty() && symbols.back() == MacSymbol::silence) symbols.pop_back();
  request_(symbols, wave.start);
}

}  // namespace fieldproof::conformance
