#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "harness/trace/dissector.hpp"
#include "protocols/fieldbus_dll/ff_rules.hpp"
#include "protocols/fieldbus_dll/isa_rules.hpp"

// What was on a line of the data link, for a person, in the DLPDUs of one profile.
//
//   ES urgent 10 -> 21 for 1000 octets
//   42 21 10 E1 DD (check wrong)
//   42 21 (code violation)
namespace fieldproof::fieldbus_dll {

// Of captures. The variant is the profile.
inline constexpr std::uint8_t kCaptureNumber = 3;
inline constexpr std::uint8_t kIsaVariant = 0;
inline constexpr std::uint8_t kFfVariant = 1;

class LinkDissector final : public trace::Dissector {
 public:
  // The octets of a DLPDU without its check, in words; nothing when they are none.
  using Describe = std::function<std::optional<std::string>(std::span<const std::uint8_t>)>;

  explicit LinkDissector(const IsaRules& rules);
  explicit LinkDissector(const FfRules& rules);

  std::int64_t bit_rate() const override { return bit_rate_; }
  std::uint8_t capture_number() const override { return kCaptureNumber; }
  std::uint8_t capture_variant() const override { return variant_; }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  std::int64_t bit_rate_;
  std::uint8_t variant_;
  Describe describe_;
};

}  // namespace fieldproof::fieldbus_dll
