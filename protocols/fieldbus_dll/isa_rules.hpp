#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocols/fieldbus_dll/link_rules.hpp"

// Every number of the data link of the ISA draft of 1993 (dS50.02 part 4) as this project runs it: the
// profile ISA-D.
//
// What the paper on it says is who may speak when: a scheduler that delegates its token for one frame (ET) or
// for a duration (ES), holders that return it (EE), stations that are compelled to answer (CD), four timers.
// It gives no encoding, no address and no number; all of those are this project's own choice.
namespace fieldproof::fieldbus_dll {

// The upper half of the first octet of each DLPDU.
struct IsaCodes {
  std::uint8_t cd = 0x10;
  std::uint8_t dt = 0x20;
  std::uint8_t du = 0x30;
  std::uint8_t et = 0x40;
  std::uint8_t es = 0x50;
  std::uint8_t ee = 0x60;
  std::uint8_t tl = 0x70;

  friend bool operator==(const IsaCodes&, const IsaCodes&) = default;
};

struct IsaRules {
  LinkRules link;
  IsaCodes codes;
  std::uint8_t first_address = 0x01;
  std::uint8_t last_address = 0xF7;
  std::uint8_t everybody = 0xFF;  // DU only

  // Timers, in octet durations, all from the end of a frame.
  unsigned reply_wait_octets = 32;         // V(RR): V(MRD) x V(ST)
  unsigned reply_forming_octets = 24;      // V(FD)
  unsigned supervision_margin_octets = 8;  // VC(UC) = duration + V(ST)

  friend bool operator==(const IsaRules&, const IsaRules&) = default;
};

// A sentence about the first number outside of the range of its row, as for FF-P.
std::optional<std::string> impossible(const IsaRules& rules);

}  // namespace fieldproof::fieldbus_dll
