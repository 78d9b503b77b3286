#pragma once

#include <memory>
#include <string>

#include "harness/trace/dissector.hpp"
#include "protocols/token_bus/rules.hpp"

// What was on a line of the token bus, for a person: all frames of a transmission.
//
//   token, 000A -> 0004
//   data, request with no response, priority 6, 000A -> 0004: 01 02 | token, 000A -> 0004
//   FCS error: 10 04 00 0A 00 42 1F 4F D2
//   non-silence
namespace fieldproof::token_bus {

// Of captures. The variant is the octets of an address.
inline constexpr std::uint8_t kCaptureNumber = 4;

class BusDissector final : public trace::Dissector {
 public:
  explicit BusDissector(const Rules& rules) : rules_(rules) {}

  std::int64_t bit_rate() const override { return rules_.phy_bit_rate; }
  std::uint8_t capture_number() const override { return kCaptureNumber; }
  std::uint8_t capture_variant() const override { return static_cast<std::uint8_t>(rules_.address_length); }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  Rules rules_;
};

}  // namespace fieldproof::token_bus
