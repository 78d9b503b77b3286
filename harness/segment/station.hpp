#pragma once

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// The contract between a segment and whoever takes part in it: reference stations, mutant ones, the lower
// tester, an implementation outside the process.
//
// A station is passive. It is told what it receives and that a time has come, it says when it wants to be
// told again, and it drives through ports that it was given. It owns no clock, no thread, no descriptor.
//
// A reception is told at the instant at which its first level arrives, with all its levels: the station acts
// on each part of it at the time of that part (drives at times that lie ahead, waits with on_time for what it
// must decide later). Nothing that it does may depend on a level before that level's time.
namespace fieldproof::segment {

// Which of its receivers a station hears, in the station's own numbering.
using PortIndex = unsigned;

class Station {
 public:
  Station() = default;
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  virtual ~Station() = default;

  virtual void receive(PortIndex port, const line::Waveform& reception) = 0;
  // On a bus whose place was asked to sense it: others begin to drive the line here, or nobody of them does
  // any more. What they drove is told before its end.
  virtual void on_activity(PortIndex /*port*/, bool /*begins*/, kernel::Time /*now*/) {}
  virtual void on_time(kernel::Time now) = 0;
  // When on_time is wanted, kNever for never. Asked after each receive and on_time. An instant that has
  // passed means now.
  virtual kernel::Time next_time() const = 0;
  // The bench is done with it: nothing is asked of the station any more.
  virtual void end() {}
};

// Where a station drives. `wave.start` is now or later, and not before the end of what the port drove before
// (a violation is seen by the monitors and told to the receiver as it is). The levels are taken out of
// `wave`, which is empty and reusable afterwards.
class Port {
 public:
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  virtual ~Port() = default;

  virtual void drive(line::Waveform& wave) = 0;
};

// Who listens to a line without being a station.
class Tap {
 public:
  virtual ~Tap() = default;
  virtual void on_wave(const line::Waveform& wave) = 0;
};

}  // namespace fieldproof::segment
