#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "harness/trace/dissector.hpp"
#include "protocols/interbus/rules.hpp"

// The dissector of INTERBUS lines for recordings: `brief` is `describe`, a teller follows the cycles of its
// line and holds each frame check against the octets that it covers:
//
//   ID cycle: SL 1, LBW A55A, ID 0003, FCS 7B9F ok, status word 0000; 49 status telegrams
//   data cycle: SL 0, data 4ADC, LBW A55A, data 40CE, FCS DC28 wrong (DC29 fits), status word FFFF marked
//   data cycle goes on: SL 0, data 1234        a cycle that earlier transmissions began
//
// The loopback word is taken to be the first word of the transfer that has its value. A check phase whose
// cycle began before the teller was asked is told without a verdict.
namespace fieldproof::interbus {

// Of captures; the dissector in reports/wireshark has the same.
inline constexpr std::uint8_t kCaptureNumber = 1;

class CycleDissector final : public trace::Dissector {
 public:
  explicit CycleDissector(Rules rules) : rules_(std::move(rules)) {}

  std::int64_t bit_rate() const override { return rules_.bit_rate; }
  std::uint8_t capture_number() const override { return kCaptureNumber; }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<trace::Teller> teller() const override;

 private:
  Rules rules_;
};

}  // namespace fieldproof::interbus
