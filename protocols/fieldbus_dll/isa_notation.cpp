#include "protocols/fieldbus_dll/isa_notation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check_16.hpp"
#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

trace::Told told(const line::DelimitedFrame& frame, const IsaRules& rules) {
  const auto wrong = [&](std::string_view why) {
    return trace::Told{fmt::format("{:02X} = {}", fmt::join(frame.octets, " "), why)};
  };
  if (frame.end != line::FrameEnd::whole) return wrong(text_of(frame.end));
  const line::FrameCheck16& check = line::shared_frame_check_16("CRC-16/PROFIBUS");
  if (!check.is_residue(check.update(check.start(), frame.octets))) {
    trace::Told told = wrong("check wrong");
    told.is_check_wrong = true;
    return told;
  }
  const std::span octets(frame.octets);
  const auto dlpdu = isa_dlpdu_of(octets.first(octets.size() - kCheckOctets), rules);
  return dlpdu ? trace::Told{describe(*dlpdu)} : wrong("no DLPDU");
}

class FrameTeller final : public trace::Teller {
 public:
  explicit FrameTeller(const IsaRules& rules) : rules_(rules) {}

  trace::Told tell(const line::Waveform& wave) override {
    trace::Told all;
    for (const line::DelimitedFrame& frame : line::delimited_frames_in(wave, rules_.link.bit_rate)) {
      const trace::Told one = told(frame, rules_);
      if (!all.text.empty()) all.text += " | ";
      all.text += one.text;
      all.is_check_wrong |= one.is_check_wrong;
    }
    if (all.text.empty()) all.text = "no frame";
    return all;
  }

 private:
  IsaRules rules_;
};

}  // namespace

std::string IsaNotation::brief(const line::Waveform& wave) const {
  return FrameTeller(rules_).tell(wave).text;
}

std::unique_ptr<trace::Teller> IsaNotation::teller() const {
  return std::make_unique<FrameTeller>(rules_);
}

}  // namespace fieldproof::fieldbus_dll
