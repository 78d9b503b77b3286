#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// An implementation under test as the bench calls it, whatever it is: a shared library, a process, a peer
// behind a socket, a station of our own. A protocol wraps it as one of its devices.
//
// Contract: calls come in order of time, one at a time. Within a call the implementation acts through the
// `Bench` that `begin` gave it: it transmits, moves its outputs, asks for its inputs, at instants that are
// now or later. Behind each call `next_time` says when it wants to be called again. Time is virtual and
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

struct Character {
  kernel::Time start{};       // of its start bit
  kernel::Time busy_until{};  // end of its last stop bit, or of the low line behind it
  std::uint16_t data = 0;     // with a ninth bit, where the format has one
  bool is_parity_wrong = false;
  bool is_stop_missing = false;

  friend bool operator==(const Character&, const Character&) = default;
};

// Characters that follow each other without a gap at the bit rate of the line.
struct Transmission {
  unsigned port = 0;
  kernel::Time driver_on{};
  kernel::Time start{};  // of the first start bit
  kernel::Time driver_off{};
  std::vector<std::uint16_t> characters;
};

// A word of the process side, by its number within the role.
using Item = std::uint16_t;

// What an implementation can do while it is called.
class Bench {
 public:
  Bench() = default;
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  virtual ~Bench() = default;

  virtual void transmit(const Transmission& transmission) = 0;
  virtual void transmit(unsigned port, line::Waveform& wave) = 0;
  virtual void write(Item item, std::uint64_t value, kernel::Time when) = 0;
  virtual std::uint64_t read(Item item, kernel::Time when) = 0;
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

  // False when the implementation does not serve such a case. `bench` is used until `end`.
  virtual bool begin(const CaseBegin& begin, Bench& bench) = 0;
  virtual void set_power(bool is_on, kernel::Time now) = 0;
  virtual void receive(unsigned port, std::span<const Character> characters, kernel::Time now) = 0;
  virtual void receive(unsigned port, const line::Waveform& reception) = 0;
  virtual void on_time(kernel::Time now) = 0;
  virtual kernel::Time next_time() const = 0;
  virtual void end() = 0;
};

}  // namespace fieldproof::iut
