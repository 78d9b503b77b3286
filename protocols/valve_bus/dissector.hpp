#pragma once

#include <memory>
#include <string>

#include "harness/trace/dissector.hpp"
#include "protocols/valve_bus/rules.hpp"

// What was on a line of the valve bus, for a person. Stations drive character by character, so one
// transmission is one character; the teller follows them and says what frame they have made.
//
//   05                      a character
//   9C!                     its parity is wrong, or its stop bit missing
//   9C = write 05: A5 3C    the last character of a command whose check fits
//   00 = check wrong        of five characters whose check does not
namespace fieldproof::valve_bus {

// Of captures; the dissector in reports/wireshark has the same. The variant is the character format.
inline constexpr std::uint8_t kCaptureNumber = 2;

class FrameDissector final : public trace::Dissector {
 public:
  explicit FrameDissector(const Rules& rules) : rules_(rules) {}

  std::int64_t bit_rate() const override { return rules_.bit_rate; }
  std::uint8_t capture_number() const override { return kCaptureNumber; }
  std::uint8_t capture_variant() const override { return static_cast<std::uint8_t>(rules_.characters); }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  Rules rules_;
};

}  // namespace fieldproof::valve_bus
