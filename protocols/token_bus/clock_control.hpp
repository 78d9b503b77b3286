#pragma once

#include <cstddef>
#include <cstdint>

#include "protocols/token_bus/mac_symbol.hpp"

// CLKCTRL of the paper, as far as it is about the phase: which bit of the line is the first of a pair.
//
// Nothing on the line says it. A preamble read one bit late is a row of zeros: the clock slips by one bit
// until it reads ones, and never again after the first non_data of a transmission, because pairs across the
// border of two symbols look like non_data in any field of data.
//
// The paper has the clock slip; that two zeros are enough, and two ones a lock, is this project's choice.
namespace fieldproof::token_bus {

class ClockControl {
 public:
  ClockControl() = default;
  ClockControl(const ClockControl&) = default;
  ClockControl& operator=(const ClockControl&) = default;
  virtual ~ClockControl() = default;

  // The line is silent: the phase of the next transmission is another one.
  virtual void lose_lock();
  // A pair with bits in it: a transmission begins where none is under way.
  void notice_bits();
  // What was indicated for a pair.
  void follow(MacSymbol symbol);
  // True for each bit of the line that goes into no pair.
  bool drops_bit();

  bool is_hunting() const { return phase_ == Phase::hunting; }
  std::size_t slips() const { return slips_; }  // since the transmission began

 protected:
  // ---- decisions ----
  virtual bool slips_after(unsigned zeros_in_a_row) const { return zeros_in_a_row >= 2; }
  virtual bool locks_after(MacSymbol symbol, unsigned ones_in_a_row) const {
    return symbol == MacSymbol::non_data || ones_in_a_row >= 2;
  }
  virtual bool may_slip() const { return is_hunting(); }
  virtual unsigned slip_bits() const { return 1; }

 private:
  enum class Phase : std::uint8_t { silent, hunting, locked };

  Phase phase_ = Phase::silent;
  unsigned to_drop_ = 0;
  unsigned zeros_ = 0;
  unsigned ones_ = 0;
  std::size_t slips_ = 0;
};

}  // namespace fieldproof::token_bus
