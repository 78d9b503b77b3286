#pragma once

#include <optional>
#include <span>
#include <string>

#include "protocols/fieldbus_dll/isa_rules.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The DLPDUs of the profile ISA-D, without the frame check that the line adds.
//
//   CD  0001 00PP  DA SA             DA shall send data: the reply token goes to it for one DT
//   DT  0010 0FPP  DA SA DLSDU       data that was compelled; F: the reply token is returned with it
//   DU  0011 0FPP  DA SA DLSDU       data, sent by who holds the token
//   ET  0100 00PP  DA SA             the token for one frame
//   ES  0101 00PP  DA SA duration    the token for so many octet durations, two octets, the high one first
//   EE  0110 0100  DA SA reason      the token comes back to DA, the scheduler
//   TL  0111 0000  DA SA version     DA is the scheduler from now on; version of the schedule, two octets
namespace fieldproof::fieldbus_dll {

enum class IsaType : std::uint8_t { cd, dt, du, et, es, ee, tl };

// Why a token comes back.
enum class EndReason : std::uint8_t { nothing_to_send, no_time, single_frame_done };

struct IsaDlpdu {
  IsaType type = IsaType::du;
  Priority priority = Priority::time_available;  // of CD, DT, DU; the least that may be sent under ET, ES
  bool is_final = false;                         // of DT and DU
  std::uint8_t destination = 0;
  std::uint8_t source = 0;
  std::uint16_t duration = 0;  // of ES
  EndReason reason = EndReason::nothing_to_send;
  std::uint16_t schedule_version = 0;  // of TL
  Octets data{};                       // of DT and DU

  friend bool operator==(const IsaDlpdu&, const IsaDlpdu&) = default;
};

// What the octets say; nothing when they are no DLPDU: an unknown type, a reserved bit, a priority, address,
// duration or reason that does not exist, a length that does not fit.
std::optional<IsaDlpdu> isa_dlpdu_of(std::span<const std::uint8_t> octets, const IsaRules& rules);
// Fields that the type does not have are not looked at.
Octets octets_of(const IsaDlpdu& dlpdu, const IsaRules& rules);

// Octets of a DLPDU with its check, before which and after which is the frame.
std::size_t octets_on_line(IsaType type, std::size_t data = 0);

// Sent by a scheduler and by nobody else.
bool is_of_scheduler(IsaType type);

// "ES urgent 10 -> 21 for 1000 octets", "DT normal 22 -> 21 final: 41 42".
std::string describe(const IsaDlpdu& dlpdu);
// The same of octets, which may be no DLPDU.
std::string words_of(std::span<const std::uint8_t> octets, const IsaRules& rules);

}  // namespace fieldproof::fieldbus_dll
