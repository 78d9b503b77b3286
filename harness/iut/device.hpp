#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/uart.hpp"
#include "harness/line/waveform.hpp"

// An implementation under test as the bench calls it, whatever it is: a shared library, a process, a peer
// after a socket, a station of our own. A protocol wraps it as one of its devices.
//
// Contract: calls come in order of time, one at a time. Within a call the implementation acts through the
// `Bench` that `begin` gave it: it transmits, moves its outputs, asks for its inputs, at instants that are
// now or later. After each call `next_time` says when it wants to be called again. Time is virtual and
// begins with the case; nothing happens between two calls.
//
// An implementation that does not keep to this throws Misbehaviour out of the call (see misbehaviour.hpp).
namespace fieldproof::iut {

// How what is on a line is told to an implementation and by it.
enum class UnitKind : std::uint8_t {
  characters = 1,  // of an asynchronous line, with their errors
  levels = 2,      // packed, at any rate
  telegrams = 3,   // of a line code that the role has, as characters
};

// "telegrams"
constexpr std::string_view name(UnitKind kind) {
  if (kind == UnitKind::characters) return "characters";
  return kind == UnitKind::levels ? "levels" : "telegrams";
}

// A telegram travels as one, too.
using Character = line::UartCharacter;

// A word of the process side, by its number within the role.
using Item = std::uint16_t;

// How far what was seen may lie from what was: its instant is at least `earlier` before and at most `later`
// after the one that was reported. Zero in virtual time.
struct TimingUncertainty {
  kernel::Duration earlier{};
  kernel::Duration later{};

  friend bool operator==(const TimingUncertainty&, const TimingUncertainty&) = default;
};

// What a bench can see of an implementation and do to it. In virtual time that is everything; of one at a
// real line it may be less.
struct Capabilities {
  bool process_side = true;      // its outputs can be seen, its inputs set
  bool moving_inputs = true;     // and moved while it works
  bool driver_control = true;    // when its driver comes on and goes off can be seen
  bool distance = true;          // it can be put farther away
  bool power = true;             // its supply can be switched
  bool is_wall_clock = false;    // a real line: only right characters at the nominal rate can be driven
  bool senses_activity = false;  // it has asked for the activity on its lines
};

// A role by the names of its protocol and of itself.
struct RoleName {
  std::string protocol;
  std::string role;

  std::string path() const { return protocol + "/" + role; }
  friend bool operator==(const RoleName&, const RoleName&) = default;
};

// What an implementation can do while it is called, at instants that are now or later. On each port they come
// in order of time.
class Bench {
 public:
  Bench() = default;
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  virtual ~Bench() = default;

  // The driver of a line that has one goes on or off. How long it will be on nobody needs to know. Throws
  // Misbehaviour for a port without a driver.
  virtual void set_driver(unsigned port, bool is_on, kernel::Time at);
  // Characters that follow each other without a gap at the bit rate of the line, the first start bit at
  // `start`; or telegrams, or the octets of whoever is at that port.
  virtual void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) = 0;
  virtual void transmit(unsigned port, line::Waveform& wave) = 0;
  virtual void write(Item item, std::uint64_t value, kernel::Time when) = 0;
  virtual std::uint64_t read(Item item, kernel::Time when) = 0;
  // Of all that it does from now on.
  virtual void set_uncertainty(TimingUncertainty /*uncertainty*/) {}
};

// What an implementation is told about a case: its id, which a name of a protocol and a role begins, and the
// settings of the role by name ("bit_rate", 375000).
struct CaseBegin {
  std::string id;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::int64_t>> settings;
};

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  virtual UnitKind unit_kind() const = 0;
  virtual Capabilities capabilities() const { return {}; }

  // False when the implementation does not serve such a case. `bench` is used until `end`.
  virtual bool begin(const CaseBegin& begin, Bench& bench) = 0;
  virtual void set_power(bool is_on, kernel::Time now) = 0;
  virtual void receive(unsigned port, std::span<const Character> characters, kernel::Time now) = 0;
  virtual void receive(unsigned port, const line::Waveform& reception) = 0;
  // Others begin to drive the line at this port, or nobody of them does any more. Only of one that
  // senses_activity, and in a role whose line is shared.
  virtual void on_activity(unsigned /*port*/, bool /*begins*/, kernel::Time /*now*/) {}
  virtual void on_time(kernel::Time now) = 0;
  virtual kernel::Time next_time() const = 0;
  virtual void end() = 0;
};

}  // namespace fieldproof::iut
