#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/line/delimited_frame.hpp"
#include "harness/segment/station.hpp"
#include "protocols/fieldbus_dll/link_rules.hpp"

// The physical layer of one station: octets with their frame check become a transmission and the other way
// round, and it knows since when the line has been silent.
//
// Frame check: CRC-16/PROFIBUS, the high octet first [searched]. While a station drives its receiver is off.
namespace fieldproof::fieldbus_dll {

using Octets = std::vector<std::uint8_t>;

inline constexpr std::size_t kCheckOctets = 2;

// A DLPDU whose check fits, without the check, and when the frame around it was on the line.
struct Arrived {
  Octets octets;
  kernel::Time begin;
  kernel::Time end;
};

class LineEnd {
 public:
  explicit LineEnd(const LinkRules& rules) : rules_(rules) {}

  void wire(segment::Port& line) { line_ = &line; }

  // The octets, their check after them, in a frame that begins at `start`. Gives the frame's end.
  kernel::Time transmit(std::span<const std::uint8_t> octets, kernel::Time start);
  // Half bits as they are.
  kernel::Time drive(line::Levels half_bits, kernel::Time start);

  // The frames that a reception brought, whole and checked; none of one that began while this station drove.
  std::vector<Arrived> receive(const line::Waveform& reception);
  // Nobody knows what was on the line before: silence counts from here.
  void on_supply(kernel::Time now) { heard_until_ = std::max(heard_until_, now); }
  void on_activity(bool begins, kernel::Time now);

  bool hears_activity() const { return hears_activity_; }
  bool is_driving(kernel::Time now) const { return now < driven_until_; }
  kernel::Time driven_until() const { return driven_until_; }
  // The end of the last activity, of this station's or of another's; kNever while others are active.
  kernel::Time silent_since() const;

 private:
  LinkRules rules_;
  line::DelimitedFrameCode code_;
  segment::Port* line_ = nullptr;
  bool hears_activity_ = false;
  kernel::Time heard_until_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
};

// The octets with their check after them.
Octets with_check(std::span<const std::uint8_t> octets);
// "no DLPDU: 26 20 00".
std::string no_dlpdu_text(std::span<const std::uint8_t> octets);

}  // namespace fieldproof::fieldbus_dll
