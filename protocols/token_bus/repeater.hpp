#pragma once

#include <deque>

#include "harness/segment/medium.hpp"
#include "protocols/token_bus/cable_rules.hpp"
#include "protocols/token_bus/rules.hpp"

// A repeater of IEEE 802.3 between two segments of a line. What is driven at one side goes out at the other,
// bit by bit, a delay later:
//
//   preamble   of 64 bits at least, up to and with the two ones that end it, however many came
//   fragments  and noise are stretched to 96 bits
//   collisions go through as what they are made of, and collide at the other side
//   jabber     what is longer than any frame may be is cut
//
// Limit: it receives what was driven; faults of a line are those of its other receivers.
namespace fieldproof::token_bus {

class Repeater {
 public:
  enum class Side : std::uint8_t { left, right };

  Repeater(const Rules& rules, const CableRules& cable, segment::MediumPort& left, segment::MediumPort& right)
      : rules_(rules), cable_(cable), ports_{&left, &right} {}
  Repeater(const Repeater&) = delete;
  Repeater& operator=(const Repeater&) = delete;
  virtual ~Repeater() = default;

  // From now on it forwards what this place of that side drives, which is so far away from it.
  void hear(Side side, segment::MediumPort& place, kernel::Duration distance);

  // What goes out for these half bits.
  line::Levels repeated(const line::Waveform& wave) const;

 protected:
  // ---- decisions ----
  virtual unsigned preamble_bits() const { return cable_.repeater_preamble_bits; }
  virtual unsigned least_bits() const { return cable_.least_fragment_bits; }
  virtual kernel::Duration jabber() const { return cable_.jabber; }

 private:
  class Ear final : public segment::Tap {
   public:
    Ear(Repeater& repeater, segment::MediumPort& to, kernel::Duration delay)
        : repeater_(repeater), to_(to), delay_(delay) {}
    void on_wave(const line::Waveform& wave) override;

   private:
    Repeater& repeater_;
    segment::MediumPort& to_;
    kernel::Duration delay_;
  };

  Rules rules_;
  CableRules cable_;
  std::array<segment::MediumPort*, 2> ports_;
  std::deque<Ear> ears_{};
};

}  // namespace fieldproof::token_bus
