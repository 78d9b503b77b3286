#include "harness/trace/octet_dissector.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/line/octet_line.hpp"

namespace fieldproof::trace {
namespace {

class OctetTeller final : public Teller {
 public:
  OctetTeller(std::int64_t bit_rate, const line::CharacterFormat& format) : dissector_(bit_rate, format) {}
  Decoded tell(const line::Waveform& wave) override { return {dissector_.brief(wave), false}; }

 private:
  OctetDissector dissector_;
};

}  // namespace

std::string OctetDissector::brief(const line::Waveform& wave) const {
  const auto octets = line::OctetLine(bit_rate_, format_).octets_in(wave);
  return octets ? fmt::format("{:02X}", fmt::join(*octets, " ")) : "a wrong character";
}

std::unique_ptr<Teller> OctetDissector::teller() const {
  return std::make_unique<OctetTeller>(bit_rate_, format_);
}

}  // namespace fieldproof::trace
