#pragma once

#include "harness/line/waveforms.hpp"

// What lies between a transmission and one receiver. A link or a medium asks the channel of each receiver
// once per transmission; a receiver without a channel gets what was driven. A plan of declared faults and a
// burst generator are channels; channels compose in order of installation (see plan.hpp).
namespace fieldproof::fault {

class Channel {
 public:
  Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;
  virtual ~Channel() = default;

  // `sent.start` is the instant at which the transmission reaches this receiver. Gives false when the
  // receiver gets exactly `sent`. Gives true after having appended to `arrivals` what it gets instead, in
  // order of their start: nothing when it is lost, several when it is repeated or torn. No arrival starts
  // before `sent.start`.
  virtual bool pass(const line::Waveform& sent, line::Waveforms& arrivals) = 0;
};

}  // namespace fieldproof::fault
