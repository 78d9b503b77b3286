#pragma once

#include <cstdint>

// What a node does while the server (the token, or the master's poll) is with it, as a state machine without
// time.
//
// The frame control of the server has a periodic byte (PB): its first bit (PSB) says that a periodic interval
// has begun, the other seven which node began it. A node that finds its own address in it clears it; then it
// sends one real-time packet, if there is one; then one periodic datum, for which it begins a periodic
// interval where none is; then, where none is and it had no datum, one non-real-time packet. In which order
// originator, real-time and periodic queue are looked at is this project's reading: the periodic queue is
// looked at after the real-time packet, and a node that has cleared the byte may set it again at once.
namespace fieldproof::bandwidth {

class PeriodicByte {
 public:
  constexpr PeriodicByte() = default;
  constexpr explicit PeriodicByte(std::uint8_t octet) : octet_(octet) {}
  static constexpr PeriodicByte begun_by(std::uint8_t node) {
    return PeriodicByte(static_cast<std::uint8_t>(kServiceBit | node));
  }

  constexpr std::uint8_t octet() const { return octet_; }
  constexpr bool is_periodic() const { return (octet_ & kServiceBit) != 0; }
  constexpr bool is_of(std::uint8_t node) const { return octet_ == begun_by(node).octet_; }

  friend constexpr bool operator==(PeriodicByte, PeriodicByte) = default;

 private:
  static constexpr std::uint8_t kServiceBit = 0x80;
  std::uint8_t octet_ = 0;
};

// What waits at a node at this instant.
struct Waiting {
  bool real_time = false;
  bool periodic = false;
  bool non_real_time = false;
};

enum class Packet : std::uint8_t { none, real_time, periodic, non_real_time };
const char* name_of(Packet packet);

// One visit of the server to a node.
class WindowVisit {
 public:
  // The server comes with this byte.
  constexpr WindowVisit(std::uint8_t node, PeriodicByte byte)
      : node_(node), byte_(byte.is_of(node) ? PeriodicByte{} : byte) {}

  // What goes next, with what waits when it may begin; none ends the visit.
  constexpr Packet next(const Waiting& waiting) {
    if (state_ == State::arrived) {
      state_ = State::real_time_done;
      if (waiting.real_time) return Packet::real_time;
    }
    if (state_ == State::over) return Packet::none;
    state_ = State::over;
    if (waiting.periodic) {
      if (!byte_.is_periodic()) byte_ = PeriodicByte::begun_by(node_);
      return Packet::periodic;
    }
    return waiting.non_real_time && !byte_.is_periodic() ? Packet::non_real_time : Packet::none;
  }

  // With which the server goes on.
  constexpr PeriodicByte byte() const { return byte_; }

 private:
  enum class State : std::uint8_t { arrived, real_time_done, over };
  std::uint8_t node_;
  PeriodicByte byte_;
  State state_ = State::arrived;
};

}  // namespace fieldproof::bandwidth
