#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/token_bus/line_code.hpp"
#include "protocols/token_bus/rules.hpp"

// The frames of the MAC: control, destination, source, data, frame check, between two delimiters.
//
// Addresses are numbers: the first bit on the line, individual or group, is the lowest, the last one the
// highest. That is the order of the ring.
namespace fieldproof::token_bus {

using Octets = std::vector<std::uint8_t>;
using Address = std::uint64_t;

inline constexpr std::size_t kCheckOctets = 4;

inline bool is_group(Address address) {
  return (address & 1) != 0;
}
Address broadcast(const Rules& rules);
// "000A"; 48 bits have twelve digits.
std::string text_of(Address address, const Rules& rules);
Octets octets_of(Address address, const Rules& rules);
Address address_of(std::span<const std::uint8_t> octets);

enum class FrameKind : std::uint8_t {
  claim_token,
  solicit_successor_1,
  solicit_successor_2,
  who_follows,
  resolve_contention,
  token,
  set_successor,
  data,
  management_data
};
std::string_view text_of(FrameKind kind);

// MMM of a data frame.
enum class Action : std::uint8_t { request_with_no_response, request_with_response, response };
std::string_view text_of(Action action);

// 6, 4, 2 or 0 of a priority 7 to 0: two priorities share a class.
inline unsigned access_class(unsigned priority) {
  return priority & 6U;
}

struct Frame {
  FrameKind kind = FrameKind::token;
  Action action = Action::request_with_no_response;  // of data frames
  unsigned priority = 0;                             // of data frames, 7 to 0
  Address destination = 0;
  Address source = 0;
  Octets data{};

  friend bool operator==(const Frame&, const Frame&) = default;
};

// The octet of frame control as it is stored: the code's bits as they go on the line, lowest first.
std::uint8_t control_octet(const Frame& frame);
// The number that the code is read as from left to right: 08 of a token.
std::uint8_t code_of(std::uint8_t control);

// Octets without the check.
Octets octets_of(const Frame& frame, const Rules& rules);
// Nothing where there is no such frame: an unknown control code, a source that is a group, a data unit of
// another length than frames of this kind have, addresses of another length.
std::optional<Frame> frame_of(std::span<const std::uint8_t> octets, const Rules& rules);
// "token 0004 <- 000A".
std::string describe(const Frame& frame, const Rules& rules);

// ---- the check ----

// CRC-32, complemented, the lowest octet of the stored value first.
Octets with_check(std::span<const std::uint8_t> octets);
bool has_right_check(std::span<const std::uint8_t> octets);

// ---- between delimiters ----

struct Delimiting {
  unsigned preamble_octets = 4;
  bool more_follows = false;  // I of the end delimiter
  bool has_error = false;     // E
};

// Octets with their check, framed. `octets` may be none: an abort sequence.
void append_framed(MacSymbols& symbols, std::span<const std::uint8_t> octets, const Delimiting& delimiting);
// The half bits of a whole transmission.
line::Levels levels_of(const Frame& frame, const Rules& rules);

// ---- reception ----

// What a receiver makes of a transmission: RFC 1230 names the errors.
enum class ReceptionKind : std::uint8_t {
  frame,        // its check fits and its E bit is 0
  non_silence,  // something, and no start delimiter in it
  fragment,     // a start delimiter, then something that is no frame before an end delimiter
  fcs_error,
  e_bit_error,
  too_long
};
// "FCS error".
std::string_view text_of(ReceptionKind kind);

struct Reception {
  ReceptionKind kind = ReceptionKind::non_silence;
  Octets octets{};                 // without the check where it is a frame
  bool more_follows = false;       // I
  std::size_t first_half_bit = 0;  // of the start delimiter
  std::size_t end_half_bit = 0;    // after what belongs to it
};

// All receptions of one transmission in their order, at least one.
class FrameReader {
 public:
  explicit FrameReader(const Rules& rules) : rules_(rules) {}
  FrameReader(const FrameReader&) = default;
  FrameReader& operator=(const FrameReader&) = delete;
  virtual ~FrameReader() = default;

  std::vector<Reception> read(std::span<const Indication> indications) const;
  std::vector<Reception> read(const line::Waveform& wave) const;

 protected:
  const Rules& rules() const { return rules_; }

  // ---- decisions ----
  virtual bool is_too_long(std::size_t octets) const { return octets > rules_.most_octets; }
  virtual bool counts_error_bit() const { return true; }
  virtual bool is_check_right(std::span<const std::uint8_t> octets) const { return has_right_check(octets); }

 private:
  std::size_t read_one(std::span<const Indication> indications, std::size_t at, Reception& reception) const;
  void close(Reception& reception, bool has_error) const;

  Rules rules_;
};

}  // namespace fieldproof::token_bus
