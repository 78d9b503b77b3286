#pragma once

#include <memory>
#include <string>

#include "harness/trace/notation.hpp"
#include "protocols/fieldbus_dll/isa_rules.hpp"

// What was on a line of the profile ISA-D, for a person.
//
//   ES urgent 10 -> 21 for 1000 octets
//   42 21 10 E1 DD = check wrong
//   42 21 = code violation
namespace fieldproof::fieldbus_dll {

// Of captures. The variant is the profile.
inline constexpr std::uint8_t kCaptureNumber = 3;
inline constexpr std::uint8_t kIsaVariant = 0;

class IsaNotation final : public trace::Notation {
 public:
  explicit IsaNotation(const IsaRules& rules) : rules_(rules) {}

  std::int64_t bit_rate() const override { return rules_.link.bit_rate; }
  std::uint8_t capture_number() const override { return kCaptureNumber; }
  std::uint8_t capture_variant() const override { return kIsaVariant; }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  IsaRules rules_;
};

}  // namespace fieldproof::fieldbus_dll
