#pragma once

#include "harness/segment/station.hpp"
#include "protocols/token_bus/channel_selection.hpp"

// What a bench wires to of a dual channel manager, whoever implements it: three sides that carry MAC symbols,
// as service_signals.hpp writes those of the MAC side of a translator, all received when they begin.
namespace fieldproof::token_bus {

inline constexpr segment::PortIndex kTowardsMac = 0;  // requests come, indications go
// Requests go, indications come.
inline segment::PortIndex port_of(Channel channel) {
  return channel == Channel::a ? 1 : 2;
}
inline constexpr unsigned kManagerPorts = 3;

struct ChannelManagerConfiguration {
  Rules rules{};
  ChannelRules channels{};
  unsigned delay_symbols = 8;  // of a request; of an indication more, see below
};

// From a symbol on a channel to its indication: a start delimiter and the skew later the manager knows whose
// it is.
inline unsigned indication_delay_symbols(const ChannelManagerConfiguration& configuration) {
  return configuration.delay_symbols + configuration.channels.skew_symbols + 8;
}

class ChannelManagerDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& mac, segment::Port& a, segment::Port& b, ChannelListener& listener) = 0;
  // It neither receives nor sends before, and when it is off what it knew is gone.
  virtual void set_power(bool is_on, kernel::Time now) = 0;
};

}  // namespace fieldproof::token_bus
