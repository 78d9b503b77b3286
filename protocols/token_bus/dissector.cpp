#include "protocols/token_bus/dissector.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocols/token_bus/frame.hpp"

namespace fieldproof::token_bus {
namespace {

// Long data are of no use in a line of text.
constexpr std::size_t kMostShown = 32;

std::string in_words(const Reception& reception, const Rules& rules) {
  const std::span octets(reception.octets);
  if (reception.kind == ReceptionKind::non_silence) return std::string(text_of(reception.kind));
  if (reception.kind == ReceptionKind::frame) {
    if (auto frame = frame_of(octets, rules)) {
      const std::size_t size = frame->data.size();
      if (size <= kMostShown) return describe(*frame, rules);
      if (frame->kind != FrameKind::claim_token) frame->data.resize(kMostShown);
      return describe(*frame, rules) +
             (frame->kind == FrameKind::claim_token ? "" : fmt::format(" and {} more", size - kMostShown));
    }
  }
  const bool is_cut = octets.size() > kMostShown;
  return fmt::format(
      "{}: {:02X}{}",
      reception.kind == ReceptionKind::frame ? "no frame of this network" : text_of(reception.kind),
      fmt::join(octets.first(std::min(octets.size(), kMostShown)), " "),
      is_cut ? fmt::format(" and {} more", octets.size() - kMostShown) : "");
}

trace::Decoded decoded(const line::Waveform& wave, const Rules& rules) {
  trace::Decoded all;
  for (const Reception& reception : FrameReader(rules).read(wave)) {
    if (!all.text.empty()) all.text += " | ";
    all.text += in_words(reception, rules);
    all.is_check_wrong |= reception.kind == ReceptionKind::fcs_error;
  }
  return all;
}

class BusTeller final : public trace::Teller {
 public:
  explicit BusTeller(const Rules& rules) : rules_(rules) {}
  trace::Decoded tell(const line::Waveform& wave) override { return decoded(wave, rules_); }

 private:
  Rules rules_;
};

}  // namespace

std::string BusDissector::brief(const line::Waveform& wave) const {
  return decoded(wave, rules_).text;
}

std::unique_ptr<trace::Teller> BusDissector::teller() const {
  return std::make_unique<BusTeller>(rules_);
}

}  // namespace fieldproof::token_bus
