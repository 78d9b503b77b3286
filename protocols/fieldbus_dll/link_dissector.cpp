#include "protocols/fieldbus_dll/link_dissector.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check_16.hpp"
#include "protocols/fieldbus_dll/ff_dlpdu.hpp"
#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

trace::Decoded told(const line::DelimitedFrame& frame, const LinkDissector::Describe& describe_dlpdu) {
  const auto wrong = [&](std::string_view why) {
    return trace::Decoded{fmt::format("{:02X} ({})", fmt::join(frame.octets, " "), why)};
  };
  if (frame.end != line::FrameEnd::whole) return wrong(text_of(frame.end));
  const line::FrameCheck16& check = line::shared_frame_check_16("CRC-16/PROFIBUS");
  if (!check.is_residue(check.update(check.start(), frame.octets))) {
    trace::Decoded told = wrong("check wrong");
    told.is_check_wrong = true;
    return told;
  }
  const std::span octets(frame.octets);
  const auto dlpdu = describe_dlpdu(octets.first(octets.size() - kCheckOctets));
  return dlpdu ? trace::Decoded{*dlpdu} : wrong("no DLPDU");
}

class FrameTeller final : public trace::Teller {
 public:
  FrameTeller(std::int64_t bit_rate, LinkDissector::Describe describe)
      : bit_rate_(bit_rate), describe_(std::move(describe)) {}

  trace::Decoded tell(const line::Waveform& wave) override {
    trace::Decoded all;
    for (const line::DelimitedFrame& frame : line::delimited_frames_in(wave, bit_rate_)) {
      const trace::Decoded one = told(frame, describe_);
      if (!all.text.empty()) all.text += " | ";
      all.text += one.text;
      all.is_check_wrong |= one.is_check_wrong;
    }
    if (all.text.empty()) all.text = "no frame";
    return all;
  }

 private:
  std::int64_t bit_rate_;
  LinkDissector::Describe describe_;
};

template <typename Dlpdu>
std::optional<std::string> described(const std::optional<Dlpdu>& dlpdu) {
  return dlpdu ? std::optional(describe(*dlpdu)) : std::nullopt;
}

}  // namespace

LinkDissector::LinkDissector(const IsaRules& rules)
    : bit_rate_(rules.link.bit_rate),
      variant_(kIsaVariant),
      describe_([rules](auto octets) { return described(isa_dlpdu_of(octets, rules)); }) {}

LinkDissector::LinkDissector(const FfRules& rules)
    : bit_rate_(rules.link.bit_rate),
      variant_(kFfVariant),
      describe_([rules](auto octets) { return described(ff_dlpdu_of(octets, rules)); }) {}

std::string LinkDissector::brief(const line::Waveform& wave) const {
  return FrameTeller(bit_rate_, describe_).tell(wave).text;
}

std::unique_ptr<trace::Teller> LinkDissector::teller() const {
  return std::make_unique<FrameTeller>(bit_rate_, describe_);
}

}  // namespace fieldproof::fieldbus_dll
