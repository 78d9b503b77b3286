#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/octet_reader.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/rules.hpp"

// A line of the valve bus with one place from which an input drives: what the targets `valve_node` and
// `valve_host` share. The subject is at a place of its own, which the target attaches.
//
// In each of these functions `flip` is a level that is turned over, as flip_level counts it; in octets it is
// one of the character with the number `flip`, counted around.
namespace fieldproof::fuzz {

// By the first octet of an input.
valve_bus::CharacterProfile character_profile(std::uint8_t choice);

class ValveLine {
 protected:
  ValveLine(const valve_bus::Rules& rules, std::uint8_t seed);
  ~ValveLine() = default;

  const valve_bus::Rules& rules() const { return rules_; }
  segment::Segment& segment() { return segment_; }
  segment::Medium& medium() { return medium_; }

  // Time has passed in which nothing was driven from here: the model of the subject comes along.
  virtual void follow(kernel::Time now) = 0;

  void pass(kernel::Duration duration);
  // From now on; behind it the time is that of its end.
  void drive(line::Waveform& wave, std::uint8_t flip);
  // Each character on its own, as stations of the bus drive them.
  void send(std::span<const std::uint8_t> octets, std::uint8_t flip);
  void respond(std::uint16_t data, std::uint8_t flip);
  void octets_with_gaps(OctetReader& input, std::uint8_t flip);
  void levels(OctetReader& input, std::int64_t rate, std::uint8_t flip);

 private:
  // Nobody listens there.
  class Tester final : public segment::Station {
   public:
    void receive(segment::PortIndex, const line::Waveform&) override {}
    void on_time(kernel::Time) override {}
    kernel::Time next_time() const override { return kernel::kNever; }
  };

  valve_bus::Rules rules_;
  segment::Segment segment_;
  segment::Medium medium_;
  Tester tester_;
  segment::MediumPort* place_of_tester_;
  valve_bus::CharacterCodec codec_;
};

}  // namespace fieldproof::fuzz
