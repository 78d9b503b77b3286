#include "protocols/token_bus/clock_control.hpp"

namespace fieldproof::token_bus {

void ClockControl::lose_lock() {
  phase_ = Phase::silent;
  to_drop_ = zeros_ = ones_ = 0;
}

void ClockControl::notice_bits() {
  if (phase_ != Phase::silent) return;
  phase_ = Phase::hunting;
  slips_ = 0;
}

void ClockControl::follow(MacSymbol symbol) {
  zeros_ = symbol == MacSymbol::zero ? zeros_ + 1 : 0;
  ones_ = symbol == MacSymbol::one ? ones_ + 1 : 0;
  if (locks_after(symbol, ones_)) phase_ = Phase::locked;
  if (!may_slip() || !slips_after(zeros_)) return;
  to_drop_ = slip_bits();
  ++slips_;
  zeros_ = 0;
}

bool ClockControl::drops_bit() {
  if (to_drop_ == 0) return false;
  --to_drop_;
  return true;
}

}  // namespace fieldproof::token_bus
