#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"

// The lower tester's ear for a line of IEC 61158-2: frames as one station drives them, with the octets in
// them. It holds preamble, delimiters and octets against strings of half bits of its own and computes the
// frame check bit by bit: by no code of the stations that it judges.
namespace fieldproof::conformance {

using Octets = std::vector<std::uint8_t>;

struct DrivenDlpdu {
  kernel::Time begin;            // of the preamble
  kernel::Time end;              // of the end delimiter
  bool is_well_formed = false;   // 1 to 8 octets of preamble, both delimiters, octets: exact to the half bit
  bool has_right_check = false;  // the last two octets of the frame
  Octets octets;                 // without the check; whatever was found when it is not well formed

  std::uint8_t octet(std::size_t n) const { return n < octets.size() ? octets[n] : std::uint8_t{0}; }
  // After control octet and both addresses.
  Octets rest() const;
  // "64 10 21 00", with what is wrong about it; of more than 32 octets both ends.
  std::string text() const;
};

// The octets and the frame check after them.
Octets with_frame_check(std::span<const std::uint8_t> octets);
// The half bits of a frame around the octets.
line::Levels half_bits_of_frame(std::span<const std::uint8_t> octets, unsigned preamble_octets = 1);

class DrivenDlpdus final : public segment::Tap {
 public:
  explicit DrivenDlpdus(std::int64_t bit_rate) : bit_rate_(bit_rate) {}

  void on_wave(const line::Waveform& wave) override;
  const std::vector<DrivenDlpdu>& all() const { return all_; }
  // The first one that was not taken yet; there is one.
  DrivenDlpdu take_one() { return all_[taken_++]; }
  // One that has not been taken began until then.
  bool has_new(kernel::Time until) const { return taken_ < all_.size() && all_[taken_].begin <= until; }

 private:
  std::int64_t bit_rate_;
  std::vector<DrivenDlpdu> all_;
  std::size_t taken_ = 0;
};

}  // namespace fieldproof::conformance
