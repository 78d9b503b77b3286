#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/octet_reader.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/link_rules.hpp"

// A link of IEC 61158-2 with one place from which an input drives: what the targets of the data link share.
// The subject is at a place of its own, which the target attaches.
//
// In each of these functions `flip` is a half bit that is turned over, as flip_level counts it.
namespace fieldproof::fuzz {

using LinkOctets = std::vector<std::uint8_t>;

// What a station has driven.
struct LinkSaid {
  kernel::Time begin;
  LinkOctets octets;  // without the check
  friend bool operator==(const LinkSaid&, const LinkSaid&) = default;
};

// The whole frames of a transmission whose check is right, without it. The check is computed bit by bit; what
// is a frame says the receiver of the house.
std::vector<LinkOctets> link_frames_in(const line::Waveform& wave, const fieldbus_dll::LinkRules& rules);
// Levels of a frame around these octets and their check, behind what is there.
void append_link_frame(line::Levels& levels, std::span<const std::uint8_t> octets, unsigned preamble_octets);

// Hears what a station drives. Each transmission is one frame with a right check, or an invariant is broken.
class LinkEar final : public segment::Tap {
 public:
  explicit LinkEar(const fieldbus_dll::LinkRules& rules) : rules_(rules) {}
  void on_wave(const line::Waveform& wave) override;
  const std::vector<LinkSaid>& said() const { return said_; }

 private:
  fieldbus_dll::LinkRules rules_;
  std::vector<LinkSaid> said_;
};

class LinkLine {
 protected:
  LinkLine(const fieldbus_dll::LinkRules& rules, std::uint8_t seed);
  ~LinkLine() = default;

  segment::Segment& segment() { return segment_; }
  segment::Medium& medium() { return medium_; }
  kernel::Time now() const { return segment_.now(); }
  kernel::Duration octet_times(std::int64_t count) const { return fieldbus_dll::octets(link_, count); }

  // Nothing but the subject has driven until now: the model of it comes along.
  virtual void follow(kernel::Time now) = 0;
  // From now on the input drives.
  virtual void on_begin(kernel::Time now) = 0;

  void pass(kernel::Duration duration);
  // From now on; behind it the time is that of its end.
  void drive(line::Levels levels, std::int64_t rate, std::uint8_t flip);
  void send(std::span<const std::uint8_t> octets, std::uint8_t flip, unsigned preamble_octets = 1);
  // Several frames in one transmission, each an octet with its length and preamble, and its octets.
  void send_together(OctetReader& input, std::uint8_t flip);
  // Levels as they lie in the input, as wide as half bits or of another width.
  void levels(OctetReader& input, std::int64_t rate, std::uint8_t flip);

 private:
  // Nobody listens there.
  class Tester final : public segment::Station {
   public:
    void receive(segment::PortIndex, const line::Waveform&) override {}
    void on_time(kernel::Time) override {}
    kernel::Time next_time() const override { return kernel::kNever; }
  };

  fieldbus_dll::LinkRules link_;
  segment::Segment segment_;
  segment::Medium medium_;
  Tester tester_;
  segment::MediumPort* place_of_tester_;
};

}  // namespace fieldproof::fuzz
