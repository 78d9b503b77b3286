#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "protocols/token_bus/translator.hpp"

// Blocks of a translator that take one decision otherwise.
namespace fieldproof::conformance::translator_seeded_faults {

using namespace token_bus;

// ---- MACTX ----

using Encoded = PhyPair (*)(MacSymbol symbol, bool is_second_non_data, PhyPair right);

class EncodesOtherwise final : public MacEncoder {
 public:
  explicit EncodesOtherwise(Encoded how) : how_(how) {}

 private:
  PhyPair encoded(MacSymbol symbol, bool is_second_non_data) const override {
    return how_(symbol, is_second_non_data, MacEncoder::encoded(symbol, is_second_non_data));
  }

  Encoded how_;
};

inline PhyPair turned(PhyPair pair) {
  return {pair.second, pair.first};
}
inline PhyPair non_data_pair_swapped(MacSymbol symbol, bool is_second, PhyPair right) {
  if (symbol != MacSymbol::non_data) return right;
  return is_second ? PhyPair{PhySymbol::cd1, PhySymbol::cd1} : PhyPair{PhySymbol::cd0, PhySymbol::cd0};
}
inline PhyPair pad_idle_as_zero(MacSymbol symbol, bool, PhyPair right) {
  return symbol == MacSymbol::pad_idle ? turned(right) : right;
}
inline PhyPair zero_and_one_exchanged(MacSymbol symbol, bool, PhyPair right) {
  return is_data(symbol) ? turned(right) : right;
}
inline PhyPair non_data_without_edges(MacSymbol symbol, bool, PhyPair right) {
  return symbol == MacSymbol::non_data ? PhyPair{PhySymbol::idl, PhySymbol::idl} : right;
}

class JabberOtherwise final : public Jabber {
 public:
  explicit JabberOtherwise(unsigned most) : most_(most) {}

 private:
  unsigned most_symbols(const TranslatorConfiguration&) const override { return most_; }

  unsigned most_;
};

// The first symbol of a transmission goes into switching the transmitter on.
class FirstSymbolLost final : public MacEncoder {
 public:
  void reset() override {
    MacEncoder::reset();
    is_first_ = true;
  }

 private:
  PhyPair encoded(MacSymbol symbol, bool is_second_non_data) const override {
    const bool is_lost = std::exchange(is_first_, symbol == MacSymbol::silence);
    return is_lost ? PhyPair{PhySymbol::idl, PhySymbol::idl}
                   : MacEncoder::encoded(symbol, is_second_non_data);
  }

  mutable bool is_first_ = true;
};

class NonDataPairOverSilence final : public MacEncoder {
 public:
  void reset() override {}
};

// ---- CLKCTRL ----

class SlipsOtherwise final : public ClockControl {
 public:
  SlipsOtherwise(unsigned zeros, unsigned bits) : zeros_(zeros), bits_(bits) {}

 private:
  bool slips_after(unsigned zeros_in_a_row) const override { return zeros_in_a_row >= zeros_; }
  unsigned slip_bits() const override { return bits_; }

  unsigned zeros_;
  unsigned bits_;
};

class SlipsInData final : public ClockControl {
  bool may_slip() const override { return true; }
  bool slips_after(unsigned zeros_in_a_row) const override {
    return zeros_in_a_row >= (is_hunting() ? 2U : 8U);
  }
};

class SlipsOnceOnly final : public ClockControl {
  bool may_slip() const override { return ClockControl::may_slip() && !has_slipped_; }
  unsigned slip_bits() const override {
    has_slipped_ = true;
    return 1;
  }

  mutable bool has_slipped_ = false;
};

// As the first transmission was.
class KeepsItsPhase final : public ClockControl {
  bool may_slip() const override {
    has_locked_ |= !is_hunting();
    return is_hunting() && !has_locked_;
  }

  mutable bool has_locked_ = false;
};

// ---- MACRX ----

using Indicated = MacSymbol (*)(PhyPair pair, LineStatus status, const MacDecoder& decoder, MacSymbol right);

class IndicatesOtherwise final : public MacDecoder {
 public:
  explicit IndicatesOtherwise(Indicated indicated) : indicated_(indicated) {}

 private:
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    return indicated_(pair, status, *this, MacDecoder::indication(pair, status));
  }

  Indicated indicated_;
};

// A table that is entered without one of its two inputs.
template <bool without_carrier>
class LooksAtLess final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    (without_carrier ? status.has_carrier : status.has_signal_error) = without_carrier;
    return MacDecoder::indication(pair, status);
  }
};

inline bool is_idle(PhyPair pair) {
  return pair.first == PhySymbol::idl && pair.second == PhySymbol::idl;
}
inline MacSymbol error_is_silence(PhyPair, LineStatus status, const MacDecoder&, MacSymbol right) {
  return status.has_carrier && status.has_signal_error ? MacSymbol::silence : right;
}
inline MacSymbol cut_pair_is_silence(PhyPair pair, LineStatus status, const MacDecoder&, MacSymbol right) {
  return pair.second == PhySymbol::idl && !status.has_signal_error ? MacSymbol::silence : right;
}
inline MacSymbol idle_is_bad_signal(PhyPair pair, LineStatus status, const MacDecoder&, MacSymbol right) {
  return is_idle(pair) && status.has_carrier ? MacSymbol::bad_signal : right;
}
inline MacSymbol data_after_non_data_taken(PhyPair pair, LineStatus status, const MacDecoder& decoder,
                                           MacSymbol right) {
  if (!status.has_carrier || status.has_signal_error || !decoder.expects_second_non_data()) return right;
  if (pair == PhyPair{PhySymbol::cd1, PhySymbol::cd0}) return MacSymbol::one;
  return pair == PhyPair{PhySymbol::cd0, PhySymbol::cd1} ? MacSymbol::zero : right;
}
inline MacSymbol non_data_in_any_order(PhyPair pair, LineStatus status, const MacDecoder&, MacSymbol right) {
  const bool is_clean = status.has_carrier && !status.has_signal_error;
  return is_clean && pair.first == pair.second && pair.first != PhySymbol::idl ? MacSymbol::non_data : right;
}
inline MacSymbol non_data_pair_read_swapped(PhyPair pair, LineStatus status, const MacDecoder& decoder,
                                            MacSymbol right) {
  const bool is_clean = status.has_carrier && !status.has_signal_error;
  if (!is_clean || pair.first != pair.second || pair.first == PhySymbol::idl) return right;
  const bool is_first = pair.first == PhySymbol::cd0;
  return is_first != decoder.expects_second_non_data() ? MacSymbol::non_data : MacSymbol::bad_signal;
}

// After a signal error nothing is indicated any more.
class DeafAfterError final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    const MacSymbol right = MacDecoder::indication(pair, status);
    errors_ = right == MacSymbol::bad_signal && status.has_signal_error ? errors_ + 1 : errors_;
    return errors_ > kMostErrors ? MacSymbol::silence : right;
  }

  static constexpr unsigned kMostErrors = 8;
  mutable unsigned errors_ = 0;
};

// A signal error is taken for the end of the transmission.
class ErrorLosesTheLock final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    const MacSymbol right = MacDecoder::indication(pair, status);
    if (!status.has_carrier || is_idle(pair)) is_lost_ = false;
    if (status.has_carrier && status.has_signal_error) {
      is_lost_ = true;
      return right;
    }
    return is_lost_ ? MacSymbol::bad_signal : right;
  }

  mutable bool is_lost_ = false;
};

// A bit is lost when its elastic buffer has run over.
class LosesABit final : public ClockControl {
  bool may_slip() const override {
    symbols_ = is_hunting() ? 0 : symbols_ + 1;
    return ClockControl::may_slip() || symbols_ == kSymbols;
  }
  bool slips_after(unsigned zeros_in_a_row) const override {
    return symbols_ == kSymbols || ClockControl::slips_after(zeros_in_a_row);
  }

  static constexpr unsigned kSymbols = 50'000;
  mutable unsigned symbols_ = 0;
};

// ---- RBLK and INMUX ----

class BlankingOtherwise final : public ReceiverBlanking {
 public:
  explicit BlankingOtherwise(unsigned length) : length_(length) {}

 private:
  unsigned symbols(const Rules&) const override { return length_; }

  unsigned length_;
};

class BlanksAfterEveryFrame final : public ReceiverBlanking {
  bool begins_with(MacSymbol symbol) override {
    const bool more_follows = more_.size() >= 8;
    if (more_follows) more_.erase(more_.begin());
    more_.push_back(symbol);
    using enum MacSymbol;
    const MacSymbols end{non_data, non_data, one, non_data, non_data, one, one};
    const bool is_more = more_.size() == 8 && std::equal(end.begin(), end.end(), more_.begin());
    return ReceiverBlanking::begins_with(symbol) || is_more;
  }

  MacSymbols more_;
};

class SymbolsLeak final : public IndicationMultiplexer {
  bool passes_symbols(bool) const override { return true; }
};

// Once it has been in management mode under way, it never comes back.
class StaysInManagement final : public IndicationMultiplexer {
  bool passes_symbols(bool is_management) const override {
    stays_ |= is_management;
    return !stays_;
  }

  mutable bool stays_ = false;
};

// ---- SMANAGER ----

class EnabledByReset final : public StationManager {
  bool enables_transmitter_at_reset() const override { return true; }
};

// After power-up, not after RESET.
class EnabledFromTheStart final : public StationManager {
  bool enables_transmitter_at_reset() const override { return !std::exchange(has_been_reset_, true); }

  mutable bool has_been_reset_ = false;
};

class EnabledForGood final : public StationManager {
  bool enables_transmitter_at_reset() const override { return has_been_enabled_; }
  ManagementAnswer answer_to(ManagementCommand command) const override {
    has_been_enabled_ |= command == ManagementCommand::enable_transmitter;
    return StationManager::answer_to(command);
  }

  mutable bool has_been_enabled_ = false;
};

class NotLoopedBack final : public StationManager {
  bool loops_back_at_reset() const override { return false; }
};

class LoopedBackForGood final : public StationManager {
  bool disables_loopback() const override { return false; }
};

using Answer = ManagementAnswer (*)(ManagementCommand command, bool has_jabbered, ManagementAnswer right);

class AnswersOtherwise final : public StationManager {
 public:
  explicit AnswersOtherwise(Answer answer) : answer_(answer) {}

 private:
  ManagementAnswer answer_to(ManagementCommand command) const override {
    return answer_(command, has_jabbered(), StationManager::answer_to(command));
  }

  Answer answer_;
};

inline ManagementAnswer reset_not_acknowledged(ManagementCommand command, bool, ManagementAnswer right) {
  return command == ManagementCommand::reset ? ManagementAnswer::idle : right;
}
inline ManagementAnswer idle_acknowledged(ManagementCommand command, bool, ManagementAnswer right) {
  return command == ManagementCommand::idle ? ManagementAnswer::ack : right;
}
inline ManagementAnswer serial_acknowledged(ManagementCommand command, bool, ManagementAnswer right) {
  return command == ManagementCommand::serial_data ? ManagementAnswer::ack : right;
}
inline ManagementAnswer enable_refused(ManagementCommand command, bool, ManagementAnswer right) {
  return command == ManagementCommand::enable_transmitter ? ManagementAnswer::nack : right;
}
inline ManagementAnswer jabber_not_reported(ManagementCommand command, bool, ManagementAnswer right) {
  return command == ManagementCommand::idle ? ManagementAnswer::idle : right;
}

// Idle for longer than a command stands, almost.
class AnswersLate final : public StationManager {
  ManagementAnswer answer_to(ManagementCommand command) const override {
    times_ = command == last_ ? times_ + 1 : 0;
    last_ = command;
    return times_ < kLate ? ManagementAnswer::idle : StationManager::answer_to(command);
  }

  static constexpr unsigned kLate = 30;
  mutable unsigned times_ = 0;
  mutable ManagementCommand last_ = ManagementCommand::unknown;
};

class JabberOutlivesReset final : public StationManager {
  bool ends_jabber_at_reset() const override { return false; }
};

// For `check`: only once the transmitter is on.
class RefusesASecondEnable final : public StationManager {
  ManagementAnswer answer_to(ManagementCommand command) const override {
    if (command == ManagementCommand::reset) has_enabled_ = is_enabling_ = false;
    const bool is_enable = command == ManagementCommand::enable_transmitter;
    if (!is_enable && std::exchange(is_enabling_, false)) has_enabled_ = true;
    if (!is_enable) return StationManager::answer_to(command);
    is_enabling_ = true;
    return has_enabled_ ? ManagementAnswer::nack : StationManager::answer_to(command);
  }

  mutable bool is_enabling_ = false;  // the command stands
  mutable bool has_enabled_ = false;
};

// ---- the whole translator ----

class ErrorsMaskedOtherwise final : public Translator {
 public:
  ErrorsMaskedOtherwise(const TranslatorConfiguration& configuration, bool is_masked)
      : Translator(configuration), is_masked_(is_masked) {}

 private:
  bool is_error_masked(kernel::Duration after) const override {
    return is_masked_ && (after < kernel::Duration{} || Translator::is_error_masked(after));
  }

  bool is_masked_;
};

class DeafWhileItSends final : public Translator {
  using Translator::Translator;
  bool takes_line(bool is_looped_back, bool is_sending) const override {
    return Translator::takes_line(is_looped_back, is_sending) && !is_sending;
  }
};

class DeafInManagementMode final : public Translator {
  using Translator::Translator;
  bool works_in_management_mode() const override { return false; }
};

class LineLeaksIntoLoopback final : public Translator {
  using Translator::Translator;
  bool takes_line(bool, bool) const override { return true; }
};

class SamplesByItsOwnClock final : public Translator {
  using Translator::Translator;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    const std::int64_t rate = phy_side_rate(configuration().rules.phy_bit_rate);
    if (port != kPhySide || reception.rate == rate) return Translator::receive(port, reception);
    line::Waveform taken{reception.start, rate, {}};
    const kernel::Duration half = kernel::levels_duration(1, 2 * rate);
    while (taken.end() + half < reception.end())
      taken.levels.append(reception.at(taken.end() + half) ? 1 : 0, 1);
    Translator::receive(port, taken);
  }
};

class IgnoresPowerFailure final : public Translator {
  using Translator::Translator;
  void set_power(bool is_on, kernel::Time now) override {
    if (is_on && !std::exchange(is_on_, true)) Translator::set_power(is_on, now);
  }

  bool is_on_ = false;
};

// Its data output follows the circuits of the request whatever the mode.
class CommandsAreSent final : public Translator {
 public:
  using Translator::Translator;
  void wire(segment::Port& phy, segment::Port& mac) override {
    phy_ = &phy;
    Translator::wire(phy, mac);
  }
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    Translator::receive(port, reception);
    if (port != kMacSide) return;
    for (std::size_t n = 0; n < units_in(reception.levels); ++n) {
      const auto command = mac_request_at(reception.levels, n).command;
      if (command != ManagementCommand::idle && command != ManagementCommand::disable_loopback) continue;
      const std::int64_t later = static_cast<std::int64_t>(n) + configuration().delay_symbols;
      line::Waveform wave{reception.start + mac_symbols(configuration().rules, later),
                          phy_side_rate(configuration().rules.phy_bit_rate),
                          {}};
      append(wave.levels, PhyCell{PhySymbol::cd0, {}});
      phy_->drive(wave);
    }
  }

 private:
  segment::Port* phy_ = nullptr;
};

}  // namespace fieldproof::conformance::translator_seeded_faults
