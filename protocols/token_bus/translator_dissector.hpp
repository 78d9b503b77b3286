#pragma once

#include "harness/trace/dissector.hpp"
#include "protocols/token_bus/rules.hpp"

// What was on the two sides of a translator, for a person. Which side it was, the rate says:
//
//   physical side  the frames of what was driven, or its bits: 1, 0, I of idle; ! with a signal error
//   MAC side       symbols, as the standard writes them; X is pad_idle of a request and bad_signal of an
//                  indication, which have one code; [111 x 16] is a code of the management mode
namespace fieldproof::token_bus {

class TranslatorDissector final : public trace::Dissector {
 public:
  explicit TranslatorDissector(const Rules& rules) : rules_(rules) {}

  std::int64_t bit_rate() const override { return rules_.phy_bit_rate; }
  // Captures hold what is on a line; these are circuits between two chips.
  std::uint8_t capture_number() const override { return 0; }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  Rules rules_;
};

}  // namespace fieldproof::token_bus
