#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/iut/device.hpp"

// The messages between the bench and an implementation in another process, on one stream in each direction.
// README.md of this folder describes them so that they can be written from that page alone.
//
//   message   length (u32, of what follows), type (u8), content
//   u8 u16 u32 u64 i64   little endian; a time is an i64 of picoseconds since the case began, never = 2^63 -
//   1 text      length (u16), octets of UTF-8
//
// Contract: a reader refuses what is no such message with MessageError and never reads past it.
namespace fieldproof::iut {

inline constexpr std::uint16_t kMessageVersion = 3;
inline constexpr std::size_t kMessageHead = 4;             // octets of the length
inline constexpr std::size_t kLongestMessage = 1U << 20U;  // octets behind the length

enum class MessageType : std::uint8_t {
  // From the bench.
  hello = 1,
  echo = 2,
  case_begin = 3,
  power = 4,
  receive_characters = 5,
  receive_levels = 6,
  on_time = 7,
  case_end = 8,
  value = 9,
  activity = 10,
  // From the implementation.
  capabilities = 129,
  echoed = 130,
  done = 131,
  unsupported = 132,
  characters = 133,
  transmit_levels = 134,
  write = 135,
  read = 136,
  driver = 137,
};

// "done", "transmit levels"; "type 77".
std::string name(MessageType type);

class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MessageWriter {
 public:
  // Forgets the message before.
  MessageWriter& begin(MessageType type);
  MessageWriter& u8(std::uint8_t value) { return number(value, 1); }
  MessageWriter& u16(std::uint16_t value) { return number(value, 2); }
  MessageWriter& u32(std::uint32_t value) { return number(value, 4); }
  MessageWriter& u64(std::uint64_t value) { return number(value, 8); }
  MessageWriter& i64(std::int64_t value) { return number(static_cast<std::uint64_t>(value), 8); }
  MessageWriter& time(kernel::Time value) { return i64(value.time_since_epoch().count()); }
  // Cut at the longest that the form has.
  MessageWriter& text(std::string_view value);
  MessageWriter& octets(std::span<const std::uint8_t> value);

  // The whole message, ready to be sent.
  std::span<const std::uint8_t> finish();

 private:
  MessageWriter& number(std::uint64_t value, unsigned octets) {
    for (unsigned n = 0; n < octets; ++n) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * n)));
    return *this;
  }

  std::vector<std::uint8_t> bytes_;
};

// Reads one message after its length. All throw MessageError for content that is not there.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::uint8_t> bytes);

  MessageType type() const { return type_; }
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::int64_t i64() { return static_cast<std::int64_t>(number(8)); }
  kernel::Time time() { return kernel::Time{kernel::Duration{i64()}}; }
  std::string text();
  std::span<const std::uint8_t> rest();
  // There is nothing more.
  void finish() const;
  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::uint64_t number(std::size_t octets);
  std::span<const std::uint8_t> take(std::size_t octets);

  std::span<const std::uint8_t> bytes_;
  MessageType type_{};
};

// ---- contents that have a shape of their own ----

// What an implementation answers to `hello`.
struct PeerCapabilities {
  std::uint16_t version = kMessageVersion;
  std::uint8_t unit = 0;  // as it came: a UnitKind, or none
  std::string name;
  std::vector<RoleName> roles;  // that it serves
  bool senses_activity = false;
};
std::span<const std::uint8_t> write_capabilities(MessageWriter& writer, const PeerCapabilities& capabilities);
// Of another version only the number is read.
PeerCapabilities read_capabilities(MessageReader& reader);

// Messages are ready to be sent when these return.
std::span<const std::uint8_t> write_case_begin(MessageWriter& writer, const CaseBegin& begin);
CaseBegin read_case_begin(MessageReader& reader);

std::span<const std::uint8_t> write_reception(MessageWriter& writer, unsigned port,
                                              std::span<const Character> characters, kernel::Time now);
struct ReceivedCharacters {
  unsigned port = 0;
  kernel::Time now{};
  std::vector<Character> characters;
};
ReceivedCharacters read_reception(MessageReader& reader);

// Others begin to drive the line at a port, or cease.
struct LineActivity {
  unsigned port = 0;
  bool begins = false;
  kernel::Time now{};

  friend bool operator==(const LineActivity&, const LineActivity&) = default;
};
std::span<const std::uint8_t> write_activity(MessageWriter& writer, const LineActivity& activity);
LineActivity read_activity(MessageReader& reader);

struct DriverSwitch {
  unsigned port = 0;
  bool is_on = false;
  kernel::Time at{};

  friend bool operator==(const DriverSwitch&, const DriverSwitch&) = default;
};
std::span<const std::uint8_t> write_driver(MessageWriter& writer, const DriverSwitch& driver);
DriverSwitch read_driver(MessageReader& reader);

struct SentCharacters {
  unsigned port = 0;
  kernel::Time start{};
  std::vector<std::uint16_t> characters;

  friend bool operator==(const SentCharacters&, const SentCharacters&) = default;
};
std::span<const std::uint8_t> write_characters(MessageWriter& writer, unsigned port, kernel::Time start,
                                               std::span<const std::uint16_t> characters);
SentCharacters read_characters(MessageReader& reader);

// receive_levels and transmit_levels.
std::span<const std::uint8_t> write_levels(MessageWriter& writer, MessageType type, unsigned port,
                                           const line::Waveform& wave);
unsigned read_levels(MessageReader& reader, line::Waveform& wave);

}  // namespace fieldproof::iut
