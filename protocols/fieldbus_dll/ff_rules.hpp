#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocols/fieldbus_dll/link_rules.hpp"

// Every number of the data link of Foundation Fieldbus (IEC 61158 type 1) as this project runs it: the
// profile FF-P.
//
// Names, functions and most link parameters are read off vendors' documents. The octets of the DLPDUs are
// from memory or this project's choice where several readings collide: they stand in one table, `FfCodes`,
// that can be exchanged, and no verdict on a product rests on them alone.
namespace fieldproof::fieldbus_dll {

// First octets without the bits that are set in them: 08 long addresses, 04 final use (of PT: the circulation
// begins with it), 03 priority.
struct FfCodes {
  std::uint8_t cd = 0xA0;    // compel data, destination
  std::uint8_t dt1 = 0xD0;   // data, destination and source
  std::uint8_t dt3 = 0x50;   // data of a publisher, source
  std::uint8_t sr = 0x13;    // status response: a CD cannot be honoured
  std::uint8_t ct = 0x14;    // compel time
  std::uint8_t td = 0x11;    // time distribution
  std::uint8_t pn = 0x26;    // probe node
  std::uint8_t pr = 0x27;    // probe response
  std::uint8_t pt = 0x30;    // pass token
  std::uint8_t rt = 0x34;    // return token
  std::uint8_t ri = 0x20;    // request interval
  std::uint8_t cl = 0x01;    // claim LAS
  std::uint8_t tl = 0x06;    // transfer LAS
  std::uint8_t idle = 0x10;  // keeps the line active

  friend bool operator==(const FfCodes&, const FfCodes&) = default;
};

struct FfRules {
  LinkRules link;
  FfCodes codes;

  std::uint8_t first_node = 0x10;
  std::uint8_t last_node = 0xF7;
  std::uint8_t first_unpolled = 0x25;        // V(FUN)
  unsigned unpolled = 0xBA;                  // V(NUN)
  unsigned scheduling_overhead_octets = 16;  // V(MSO)
  unsigned least_token_octets = 88;          // V(DMDT)
  unsigned token_holding_octets = 280;       // V(DTHT): of a node in a circulation
  unsigned claim_delay_octets = 2;           // V(MICD)
  unsigned misses_until_removal = 3;
  kernel::Duration target_rotation = 60 * kernel::kSecond;                   // V(TTRT)
  kernel::Duration time_distribution_period = 5'000 * kernel::kMillisecond;  // V(TDP)
  // The priority of a token goes by all three steps; else from urgent to time-available at once, as in the
  // paper's model.
  bool steers_by_three_steps = true;
  // The last DT1 under a token returns it; else an RT after does.
  bool returns_with_last_data = true;

  friend bool operator==(const FfRules&, const FfRules&) = default;
};

// V(MRD) x V(ST): until then the answer to CD, PT and PN has begun.
inline kernel::Duration response_delay(const LinkRules& link) {
  return octets(link, std::int64_t{link.response_delay_slots} * link.slot_time_octets);
}

// What a schedule and link time count in.
inline constexpr kernel::Duration kTick = kernel::kMillisecond / 32;

// A sentence about the first number outside of the range of its row; V(MID) may besides be at most (V(MRD) -
// 1) x V(ST).
std::optional<std::string> impossible(const FfRules& rules);

}  // namespace fieldproof::fieldbus_dll
