#pragma once

#include <optional>
#include <span>
#include <string>

#include "protocols/fieldbus_dll/ff_rules.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The DLPDUs of the profile FF-P, without the frame check that the line adds. L, F and PP stand in the first
// octet; multi-octet fields have the high octet first. Addresses are link (2), node (1), selector (1) when L,
// else node and selector; a short address is the long one with link 0.
//
//   CD    1010 LFPP  destination                    the publisher shall send its buffer
//   DT1   1101 LFPP  destination, source, DLSDU
//   DT3   0101 LFPP  source, writes (1), DLSDU      a published buffer; how often it was written, modulo 256
//   SR    0001 0F11  reason (1)
//   PT    0011 0FPP  node (1), duration (2)         F: a circulation begins; octet durations
//   RT    0011 0100
//   RI    0010 0000  duration (2)                   the holder asks for so much more
//   PN    0010 0110  node (1)
//   PR    0010 0111  node (1)
//   TD    0001 0001  link time (6)                  at the end of the frame, in 1/32 ms
//   CT    0001 0100  node (1)
//   CL    0000 0001  node (1)
//   TL    0000 0110  node (1), version of the schedule (2)
//   IDLE  0001 0000
//
// What follows the first octet of SR, RI, TD, CT, CL, TL, and the count of writes, is this project's choice.
namespace fieldproof::fieldbus_dll {

enum class FfType : std::uint8_t { cd, dt1, dt3, sr, pt, rt, ri, pn, pr, td, ct, cl, tl, idle };

// Why a CD is not honoured.
enum class FfStatus : std::uint8_t { unknown_address, nothing_written };

using FfAddress = std::uint32_t;  // link << 16 | node << 8 | selector

inline constexpr FfAddress kEverybody = 0xFFFF;

inline std::uint8_t node_of(FfAddress address) {
  return static_cast<std::uint8_t>(address >> 8);
}
// The selector of the data link entity of the node itself.
inline constexpr std::uint8_t kEntity = 0;
inline constexpr unsigned kNodeNumbers = 256;

inline FfAddress address_of(std::uint8_t node, std::uint8_t selector = kEntity) {
  return static_cast<FfAddress>(node << 8 | selector);
}
inline bool is_long(FfAddress address) {
  return address > 0xFFFF;
}

struct FfDlpdu {
  FfType type = FfType::idle;
  Priority priority = Priority::time_available;  // of CD, DT1, DT3; the least that may be sent under a PT
  bool has_long_addresses = false;               // of CD, DT1, DT3
  bool is_final = false;                         // of DT1, DT3, SR: the token is returned with it
  bool begins_circulation = false;               // of PT
  FfAddress destination = 0;
  FfAddress source = 0;
  std::uint8_t node = 0;
  std::uint16_t duration = 0;  // octet durations
  std::uint16_t schedule_version = 0;
  std::uint64_t link_time = 0;  // 1/32 ms, 48 bits
  std::uint8_t writes = 0;      // of DT3
  FfStatus status = FfStatus::unknown_address;
  Octets data{};

  friend bool operator==(const FfDlpdu&, const FfDlpdu&) = default;
};

// What the octets say; nothing when they are no DLPDU that the profile knows.
std::optional<FfDlpdu> ff_dlpdu_of(std::span<const std::uint8_t> octets, const FfRules& rules);
// Fields that the type does not have are not looked at.
Octets octets_of(const FfDlpdu& dlpdu, const FfRules& rules);
std::size_t octets_on_line(const FfDlpdu& dlpdu, const FfRules& rules);

// Sent by a link active scheduler and by nobody else.
bool is_of_scheduler(FfType type);
// Returns the token with it.
bool returns_token(const FfDlpdu& dlpdu);

// "PT urgent 20 for 280 octets", "DT3 normal 2001 final, write 7: 41 42".
std::string describe(const FfDlpdu& dlpdu);
// The same of octets, which may be no DLPDU.
std::string words_of(std::span<const std::uint8_t> octets, const FfRules& rules);

}  // namespace fieldproof::fieldbus_dll
