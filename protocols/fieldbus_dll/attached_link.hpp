#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "harness/iut/user_line.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The line of the data link as an implementation outside hears and drives it, whatever its profile and role.
//
//   port 0  the line: levels that are half a bit wide, told when a transmission is over; or telegrams, which
//           are the octets of a frame, its check among them, without preamble and delimiters
//           when others begin to drive it, and when they cease, is activity, which each of them asks for
//   port 2  the user: characters are the octets of what it asks for, and of what it is told
//
// An implementation that hears frames is no receiver of its own: a case that drives anything but whole
// frames, as this link has them, does not apply to it. In a network it is given the whole frames, right or
// wrong, that a right receiver finds in what bursts leave.
namespace fieldproof::fieldbus_dll {

using iut::kEvent;
using iut::kLinePort;
using iut::kRefused;
using iut::kUserPort;
using iut::number_at;
using iut::put_number;

class AttachedLink : public iut::UserLine {
 public:
  // Throws kernel::Error for an implementation that announces characters, and for one that does not ask for
  // activity.
  AttachedLink(iut::AttachedCase& attached, const LinkRules& rules);

  void receive(const line::Waveform& reception);
  // What the implementation drives on the line, now or later.
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters);
  // What is sent at the user's port.
  static Octets told_octets(std::span<const std::uint16_t> characters);
  // Of an implementation that delivers octets that are no `unit`, "DT1"; the first one is the indication.
  [[noreturn]] static void refuse_delivery(std::string_view unit, const Octets& told, const LinkRules& rules);

 private:
  bool hears_frames() { return attached().unit_kind() == iut::UnitKind::telegrams; }
  void tell_frame(const line::Waveform& reception);
  void tell(const line::DelimitedFrame& frame, const line::Waveform& reception);
  line::Waveform wave_of(std::span<const std::uint8_t> octets, kernel::Time start) const;

  LinkRules rules_;
  line::DelimitedFrameCode code_;
};

}  // namespace fieldproof::fieldbus_dll
