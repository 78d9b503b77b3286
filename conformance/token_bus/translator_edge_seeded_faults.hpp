#pragma once

#include <limits>
#include <utility>

#include "protocols/token_bus/translator.hpp"

// Blocks of a translator that are wrong at an edge: one symbol more or less, or over a silence, a command, a
// RESET or a failure of the supply that ends what they know.
namespace fieldproof::conformance::translator_seeded_faults {

using namespace token_bus;

// ---- CLKCTRL ----

using Locks = bool (*)(MacSymbol symbol, unsigned ones_in_a_row);

class LocksOtherwise final : public ClockControl {
 public:
  explicit LocksOtherwise(Locks locks) : locks_(locks) {}

 private:
  bool locks_after(MacSymbol symbol, unsigned ones_in_a_row) const override {
    return locks_(symbol, ones_in_a_row);
  }

  Locks locks_;
};
inline bool locked_by_one_one(MacSymbol symbol, unsigned ones) {
  return symbol == MacSymbol::non_data || ones >= 1;
}
inline bool ones_lock_nothing(MacSymbol symbol, unsigned) {
  return symbol == MacSymbol::non_data;
}
inline bool non_data_lock_nothing(MacSymbol, unsigned ones) {
  return ones >= 2;
}
inline bool bad_signal_locks(MacSymbol symbol, unsigned ones) {
  return symbol == MacSymbol::non_data || symbol == MacSymbol::bad_signal || ones >= 2;
}

// Over other symbols, or over silence.
class ZerosAddUp final : public ClockControl {
 public:
  explicit ZerosAddUp(bool is_in_a_row) : is_in_a_row_(is_in_a_row) {}

 private:
  bool slips_after(unsigned zeros_in_a_row) const override {
    if (zeros_in_a_row > 0) ++zeros_;
    if (zeros_in_a_row == 0 && is_in_a_row_) zeros_ = 0;
    return zeros_ >= 2 && std::exchange(zeros_, 0) > 0;
  }

  bool is_in_a_row_;
  mutable unsigned zeros_ = 0;
};

class OnesOutliveSilence final : public ClockControl {
  bool locks_after(MacSymbol symbol, unsigned) const override {
    ones_ = symbol == MacSymbol::one ? ones_ + 1 : 0;
    return symbol == MacSymbol::non_data || ones_ >= 2;
  }

  mutable unsigned ones_ = 0;
};

class SlipsOnceInATransmission final : public ClockControl {
  bool may_slip() const override { return is_hunting() && slips() == 0; }
};

class HuntsFor16Symbols final : public ClockControl {
  void lose_lock() override {
    symbols_ = 0;
    ClockControl::lose_lock();
  }
  bool may_slip() const override { return is_hunting() && ++symbols_ <= 16; }

  mutable unsigned symbols_ = 0;
};

class LockOutlivesShortSilence final : public ClockControl {
  void lose_lock() override {
    if (std::exchange(is_silent_, true)) ClockControl::lose_lock();
  }
  bool locks_after(MacSymbol symbol, unsigned ones_in_a_row) const override {
    is_silent_ = false;
    return ClockControl::locks_after(symbol, ones_in_a_row);
  }

  mutable bool is_silent_ = true;
};

// After one with I = 1 the phase is searched anew.
class EndDelimiterUnlocks final : public ClockControl {
  bool locks_after(MacSymbol symbol, unsigned ones_in_a_row) const override {
    last_ = (last_ << 3 | static_cast<unsigned>(symbol)) & 07'777'777;
    constexpr unsigned kMoreFollows = 04'434'433;  // N N 1 N N 1 1
    has_ended_ = !ClockControl::is_hunting() && (has_ended_ || last_ == kMoreFollows);
    return ClockControl::locks_after(symbol, ones_in_a_row);
  }
  bool may_slip() const override { return is_hunting() || has_ended_; }

  mutable unsigned last_ = 0;
  mutable bool has_ended_ = false;
};

// ---- MACRX ----

class SilentUntilLocked final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    const MacSymbol right = MacDecoder::indication(pair, status);
    return is_hunting() && is_data(right) ? MacSymbol::silence : right;
  }
};

class ErrorWithoutCarrier final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    return status.has_signal_error ? MacSymbol::bad_signal : MacDecoder::indication(pair, status);
  }
};

class ThirdPairIsBadSignal final : public MacDecoder {
  MacSymbol indication(PhyPair pair, LineStatus status) const override {
    const MacSymbol right = MacDecoder::indication(pair, status);
    in_a_row_ = right == MacSymbol::non_data ? in_a_row_ + 1 : 0;
    return in_a_row_ > 4 ? MacSymbol::bad_signal : right;
  }

  mutable unsigned in_a_row_ = 0;
};

using Due = bool (*)(MacSymbol symbol, bool is_due);

class DueOtherwise final : public MacDecoder {
 public:
  explicit DueOtherwise(Due due) : due_(due) {}

 private:
  bool expects_second_after(MacSymbol symbol) const override {
    return due_(symbol, expects_second_non_data());
  }

  Due due_;
};
inline bool due_until_it_comes(MacSymbol symbol, bool is_due) {
  return is_due ? symbol != MacSymbol::non_data : symbol == MacSymbol::non_data;
}

// ---- RBLK ----

class NoBlankingAfterAnError final : public ReceiverBlanking {
  bool begins_with(MacSymbol symbol) override {
    return ReceiverBlanking::begins_with(symbol) && symbol != MacSymbol::one;
  }
};

class BlankingOutlivesReset final : public ReceiverBlanking {
  void reset() override {}
};

// The second half of an end delimiter is enough.
class ShortEndDelimiter final : public ReceiverBlanking {
  bool begins_with(MacSymbol symbol) override {
    last_ = (last_ << 3 | static_cast<unsigned>(symbol)) & 077'777;
    constexpr unsigned kHalf = 044'320;  // N N 1 0, and E
    return (last_ & 077'770) == kHalf;
  }

  unsigned last_ = 0;
};

class EndDelimiterOverSilence final : public ReceiverBlanking {
  bool begins_with(MacSymbol symbol) override {
    return symbol != MacSymbol::silence && ReceiverBlanking::begins_with(symbol);
  }
};

class BadSignalWithinBlanking final : public ReceiverBlanking {
  MacSymbol pass(MacSymbol symbol, kernel::Time begin, kernel::Time end, const Rules& rules) override {
    const MacSymbol right = ReceiverBlanking::pass(symbol, begin, end, rules);
    return symbol == MacSymbol::bad_signal ? symbol : right;
  }
};

// As long as there is anything on the line.
class BlanksWhileCarrier final : public ReceiverBlanking {
  MacSymbol pass(MacSymbol symbol, kernel::Time begin, kernel::Time end, const Rules& rules) override {
    const MacSymbol right = ReceiverBlanking::pass(symbol, begin, end, rules);
    const bool was_blanked = std::exchange(is_blanked_, symbol != right);
    is_blanked_ |= was_blanked && symbol != MacSymbol::silence;
    return is_blanked_ ? MacSymbol::silence : right;
  }

  bool is_blanked_ = false;
};

class BlankingEndsWithSilence final : public ReceiverBlanking {
  MacSymbol pass(MacSymbol symbol, kernel::Time begin, kernel::Time end, const Rules& rules) override {
    if (symbol == MacSymbol::silence) reset();
    return ReceiverBlanking::pass(symbol, begin, end, rules);
  }
};

// ---- the jabber ----

class JabberOverOneSilence final : public Jabber {
  bool counts(MacSymbol symbol, bool is_transmitter_on) override {
    const bool was_silence = std::exchange(last_, symbol) == MacSymbol::silence;
    return is_transmitter_on && !(was_silence && symbol == MacSymbol::silence);
  }

  MacSymbol last_ = MacSymbol::silence;
};

class JabberOverACommand final : public Jabber {
  void reset() override {}
};

class JabberWithoutTransmitter final : public Jabber {
  bool counts(MacSymbol symbol, bool) override { return symbol != MacSymbol::silence; }
};

class OneJabberOnly final : public Jabber {
  bool counts(MacSymbol symbol, bool is_transmitter_on) override {
    const bool is_one = Jabber::counts(symbol, is_transmitter_on);
    if (was_too_long_ && !is_one) has_been_ = true;
    was_too_long_ = false;
    symbols_ = is_one ? symbols_ + 1 : 0;
    return is_one;
  }
  unsigned most_symbols(const TranslatorConfiguration& configuration) const override {
    was_too_long_ |= symbols_ > configuration.jabber_symbols;
    return has_been_ ? std::numeric_limits<unsigned>::max() : configuration.jabber_symbols;
  }

  unsigned symbols_ = 0;
  mutable bool was_too_long_ = false;
  bool has_been_ = false;
};

}  // namespace fieldproof::conformance::translator_seeded_faults
