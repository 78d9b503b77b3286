#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "harness/line/character.hpp"
#include "harness/trace/dissector.hpp"

// Of asynchronous lines whose frames have no words of their own: the octets of each transmission.
namespace fieldproof::trace {

class OctetDissector : public Dissector {
 public:
  explicit OctetDissector(std::int64_t bit_rate, const line::CharacterFormat& format = {})
      : bit_rate_(bit_rate), format_(format) {}

  std::int64_t bit_rate() const override { return bit_rate_; }
  std::uint8_t capture_number() const override { return 0; }
  // "07 5D"
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<Teller> teller() const override;

 private:
  std::int64_t bit_rate_;
  line::CharacterFormat format_;
};

}  // namespace fieldproof::trace
