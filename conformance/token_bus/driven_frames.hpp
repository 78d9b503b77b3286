#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"

// The lower tester's ear for the token bus: frames as one station drives them. It holds preamble, delimiters
// and octets against half bits of its own and computes the check by the catalogue's engine: by no code of the
// stations that it judges.
namespace fieldproof::conformance {

using Octets = std::vector<std::uint8_t>;

// Frame control as it is stored, the first bit on the line lowest.
enum class TokenControl : std::uint8_t {
  claim = 0x00,
  solicit_1 = 0x80,
  solicit_2 = 0x40,
  who_follows = 0xC0,
  resolve = 0x20,
  token = 0x10,
  set_successor = 0x30
};

struct DrivenFrame {
  kernel::Time begin;            // of the preamble
  kernel::Time end;              // of the end delimiter
  bool is_well_formed = false;   // preamble, delimiters and octets exact to the half bit
  bool has_right_check = false;  // the last four octets
  unsigned preamble_octets = 0;
  unsigned address_octets = 2;
  Octets octets{};  // without the check; whatever was found when it is not well formed

  std::uint8_t control() const { return octets.empty() ? std::uint8_t{0xFF} : octets[0]; }
  // With a data unit of the length that such a control frame has; that of a claim is any.
  bool is(TokenControl control_of) const;
  // 01 MMM PPP in the order of the line; MMM 000 and 001 are requests, 010 is a response.
  bool is_data() const;
  unsigned priority() const;
  std::uint64_t destination() const { return number(1); }
  std::uint64_t source() const { return number(1 + address_octets); }
  Octets data() const;
  std::uint64_t address_in_data() const { return number(1 + 2 * address_octets); }
  // "token 0004 from 000A", with what is wrong about it.
  std::string text() const;

 private:
  std::uint64_t number(std::size_t at) const;
};

// Frame controls of data of priority 6: without an answer, with one, and the answer.
inline constexpr std::uint8_t kDataOfSix = 0x62;      // 01 000 110
inline constexpr std::uint8_t kRequestOfSix = 0x72;   // 01 001 110
inline constexpr std::uint8_t kResponseOfSix = 0x6A;  // 01 010 110

Octets with_crc_32(std::span<const std::uint8_t> octets);
// How a frame is drawn: the bits of the end delimiter, and what a case makes otherwise.
struct FrameForm {
  unsigned preamble_octets = 4;
  bool more_follows = false;
  bool has_error = false;
};
// Half bits around octets whose check is among them.
line::Levels half_bits_around(std::span<const std::uint8_t> octets, const FrameForm& form = {});

class DrivenFrames final : public segment::Tap {
 public:
  DrivenFrames(std::int64_t phy_bit_rate, unsigned address_octets)
      : phy_bit_rate_(phy_bit_rate), address_octets_(address_octets) {}

  void on_wave(const line::Waveform& wave) override;
  const std::vector<DrivenFrame>& all() const { return all_; }
  bool has_new(kernel::Time until) const { return taken_ < all_.size() && all_[taken_].begin <= until; }
  DrivenFrame take_one() { return all_[taken_++]; }

 private:
  std::int64_t phy_bit_rate_;
  unsigned address_octets_;
  std::vector<DrivenFrame> all_;
  std::size_t taken_ = 0;
};

}  // namespace fieldproof::conformance
