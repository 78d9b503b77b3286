#include "protocols/valve_bus/dissector.hpp"

#include <fmt/format.h>

#include "protocols/valve_bus/codec.hpp"

namespace fieldproof::valve_bus {
namespace {

std::string character_text(const line::UartCharacter& character) {
  return fmt::format("{:02X}{}", character.octet(), character.is_good() ? "" : "!");
}

// What the octets so far are, when they are a whole frame. Only silence ends a frame, so a response can still
// become the head of a command: it is told when its check fits.
class FrameTeller final : public trace::Teller {
 public:
  explicit FrameTeller(const Rules& rules) : codec_(rules), collector_(rules) {}

  trace::Decoded tell(const line::Waveform& wave) override {
    trace::Decoded told;
    codec_.decode(wave, [&](const line::UartCharacter& character) {
      if (collector_.ends_at() <= character.start) collector_.clear();
      collector_.add(character);
      if (!told.text.empty()) told.text += ' ';
      told.text += character_text(character);
      told.text += frame_text(told.is_check_wrong);
    });
    return told;
  }

 private:
  std::string frame_text(bool& is_check_wrong) const {
    const CollectedFrame& frame = collector_.frame();
    if (const auto octets = frame.whole(kResponseOctets); octets && block_check(*octets) == 0) {
      return " = " + describe(response_of(*octets));
    }
    const auto octets = frame.whole(kCommandOctets);
    if (!octets) return {};
    if (block_check(*octets) == 0) return " = " + describe(command_of(*octets));
    is_check_wrong = true;
    return " = check wrong";
  }

  CharacterCodec codec_;
  FrameCollector collector_;
};

}  // namespace

std::string FrameDissector::brief(const line::Waveform& wave) const {
  std::string text;
  CharacterCodec(rules_).decode(wave, [&](const line::UartCharacter& character) {
    if (!text.empty()) text += ' ';
    text += character_text(character);
  });
  return text.empty() ? "no character" : text;
}

std::unique_ptr<trace::Teller> FrameDissector::teller() const {
  return std::make_unique<FrameTeller>(rules_);
}

}  // namespace fieldproof::valve_bus
