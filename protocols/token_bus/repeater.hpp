#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "harness/segment/medium.hpp"
#include "protocols/token_bus/cable_rules.hpp"
#include "protocols/token_bus/rules.hpp"

// What divides a line into segments: repeaters, and places where its cable is cut for a time.
//
// Limit: they receive what was driven; faults of a line are those of its other receivers.
namespace fieldproof::token_bus {

class Divider {
 public:
  enum class Side : std::uint8_t { left, right };

  Divider(segment::MediumPort& left, segment::MediumPort& right) : ports_{&left, &right} {}
  Divider(const Divider&) = delete;
  Divider& operator=(const Divider&) = delete;
  virtual ~Divider() = default;

  // From now on it is given what this place of that side drives, which is so far away from it.
  void hear(Side side, segment::MediumPort& place, kernel::Duration distance);

 private:
  class Ear final : public segment::Tap {
   public:
    Ear(Divider& divider, segment::MediumPort& to, kernel::Duration distance)
        : divider_(divider), to_(to), distance_(distance) {}
    void on_wave(const line::Waveform& wave) override {
      if (!wave.levels.empty()) divider_.pass({wave.start + distance_, wave.rate, wave.levels}, to_);
    }

   private:
    Divider& divider_;
    segment::MediumPort& to_;
    kernel::Duration distance_;
  };

  // As it arrives.
  virtual void pass(const line::Waveform& wave, segment::MediumPort& to) = 0;

  std::array<segment::MediumPort*, 2> ports_;
  std::deque<Ear> ears_{};
};

// The cable goes on here, except while it is cut.
class Joint final : public Divider {
 public:
  struct Cut {
    kernel::Time from;
    kernel::Time to;
  };

  using Divider::Divider;
  // In the order of time.
  void set_cuts(std::vector<Cut> cuts) { cuts_ = std::move(cuts); }

 private:
  void pass(const line::Waveform& wave, segment::MediumPort& to) override;

  std::vector<Cut> cuts_{};
};

// A repeater of IEEE 802.3. What is driven at one side goes out at the other, bit by bit, a delay later:
//
//   preamble   of 64 bits at least, up to and with the two ones that end it, however many came
//   fragments  and noise are stretched to 96 bits
//   collisions go through as what they are made of, and collide at the other side
//   jabber     what is longer than any frame may be is cut
class Repeater final : public Divider {
 public:
  Repeater(const Rules& rules, const CableRules& cable, segment::MediumPort& left, segment::MediumPort& right)
      : Divider(left, right), rules_(rules), cable_(cable) {}

 private:
  void pass(const line::Waveform& wave, segment::MediumPort& to) override;
  line::Levels repeated(const line::Waveform& wave) const;

  Rules rules_;
  CableRules cable_;
};

}  // namespace fieldproof::token_bus
