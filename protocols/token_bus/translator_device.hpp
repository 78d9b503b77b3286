#pragma once

#include "harness/segment/station.hpp"
#include "protocols/token_bus/rules.hpp"

// What a bench wires to of a physical layer service translator, whoever implements it: two sides, both as
// service_signals.hpp writes them, both received when they begin.
namespace fieldproof::token_bus {

inline constexpr segment::PortIndex kPhySide = 0;  // the IEEE 802.3 physical layer
inline constexpr segment::PortIndex kMacSide = 1;  // requests come, indications go

struct TranslatorConfiguration {
  Rules rules{};
  unsigned delay_symbols = 8;           // from a symbol on one side to what it becomes on the other
  unsigned answer_symbols = 16;         // within which a management command is answered
  unsigned error_mask_symbols = 20;     // after an own transmission: no signal error is one
  unsigned jabber_symbols = 2'500'000;  // of one transmission, then the transmitter is off
};

class TranslatorDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& phy, segment::Port& mac) = 0;
  // It neither receives nor sends before, and when it is off what it knew is gone.
  virtual void set_power(bool is_on, kernel::Time now) = 0;
};

}  // namespace fieldproof::token_bus
