#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/judging.hpp"
#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"

// The testers' view of the sides of a translator and of a channel manager, as text. It has tables of codes of
// its own, and uses no code of those that it judges.
//
//   MAC side       S silence, P pad_idle, 0, 1, N non_data, B bad_signal; in management mode the answers
//                  i IDLE, a ACK, n NACK, e physical error
//   MAC's requests P in the place of B, and the commands r RESET, l DISABLE LOOPBACK, t ENABLE TRANSMITTER,
//                  i SM idle, d serial data; ? is none. s, p, n: the same symbols, the circuit that may be
//                  anything the other way round
//                  to a manager testers indicate b, m, s, too: B, N, S with that circuit the other way round
//   physical side  1 CD1, 0 CD0, I IDL
namespace fieldproof::conformance {

// ---- what testers drive ----

// A bit on its way to the translator; carrier and error are what IEEE 802.3 reports of it.
struct SideBit {
  char symbol = 'I';
  bool has_carrier = true;
  bool has_error = false;
};
using SideBits = std::vector<SideBit>;

SideBits side_bits_of(std::string_view text);
line::Levels phy_levels_of(const SideBits& bits);

enum class SideCommand : std::uint8_t { reset, disable_loopback, enable_transmitter, idle, serial_data };
std::string_view text_of(SideCommand command);

// Symbols and commands.
line::Levels request_levels_of(std::string_view symbols);
line::Levels request_levels_of(SideCommand command, std::size_t symbols);
char letter_of(SideCommand command);
// As a translator indicates them.
line::Levels indication_levels_of(std::string_view symbols);

// ---- what follows from the tables of the paper ----

// Two bits for each symbol that is requested; a command is silence, and B two bits that are none.
std::string encoded(std::string_view symbols);
// Octets between the delimiters.
inline constexpr std::size_t kLongestFrame = 8'191;
std::string start_delimiter_text();
std::string end_delimiter_text(bool more_follows = false);
// Octets with their lowest bit first, as they are.
std::string data_text(const std::vector<std::uint8_t>& octets);
// Preamble, delimiters, and octets between them.
std::string frame_text(const std::vector<std::uint8_t>& octets, bool more_follows = false,
                       unsigned preamble_octets = 4);
// How a request reads when it is indicated: pad_idle arrives as one.
std::string indicated_as(std::string requested);

// ---- what the translator drives ----

// Everything that is driven on one side, one letter for each unit. A gap is silence, or idle bits; one that
// is shorter than three quarters of a unit is a clock that was stretched.
class SideLog final : public segment::Tap {
 public:
  enum class Side : std::uint8_t { phy, mac, requests };
  SideLog(Side side, std::int64_t unit_rate) : side_(side), unit_rate_(unit_rate) {}

  void on_wave(const line::Waveform& wave) override;
  void clear();
  const std::string& text() const { return text_; }
  // For a report: where nothing was driven since, what `clear` took away.
  const std::string& last_text() const { return text_.empty() ? cleared_ : text_; }
  bool empty() const { return text_.empty(); }
  // Anything but idle in units that begin in this span.
  bool was_driven(kernel::Time from, kernel::Time until) const;
  // Of the first unit since `clear`.
  kernel::Time begin() const { return begin_; }
  // Of unit n.
  kernel::Time time_of(std::size_t n) const { return times_.at(n); }

 private:
  char idle() const { return side_ == Side::phy ? 'I' : 'S'; }

  Side side_;
  std::int64_t unit_rate_;
  std::string text_;
  std::string cleared_;
  std::vector<kernel::Time> times_;
  kernel::Time begin_ = kernel::kNever;
  kernel::Time end_ = kernel::kNever;
};

// ---- two texts ----

// 1 in place of 0, and the other way round.
std::string flipped_at(std::string text, std::size_t at);
std::string without_end(std::string text, char idle);
std::string without_ends(std::string text, char idle);
// Both from shortly in front of where they differ.
Mismatch difference(const std::string& right, const std::string& seen);

}  // namespace fieldproof::conformance
