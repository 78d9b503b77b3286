#include "protocols/fieldbus_dll/attached_link.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::size_t kMostFrameOctets = 300;  // of IEC 61158-2, with its check

}  // namespace

AttachedLink::AttachedLink(iut::AttachedCase& attached, const LinkRules& rules)
    : UserLine(attached), rules_(rules) {
  if (attached.unit_kind() == iut::UnitKind::characters) {
    throw kernel::Error(
        kernel::ErrorKind::implementation,
        "a station of the data link receives and sends levels or telegrams; this implementation "
        "announces characters");
  }
  expect_activity();
}

// ---- what it is told ----

void AttachedLink::receive(const line::Waveform& reception) {
  if (hears_frames()) {
    tell_frame(reception);
  } else {
    receive_levels(reception);
  }
}

line::Waveform AttachedLink::wave_of(std::span<const std::uint8_t> octets, kernel::Time start) const {
  line::Waveform wave{start, 2 * rules_.bit_rate, {}};
  code_.append(wave.levels, octets, rules_.preamble_octets);
  return wave;
}

void AttachedLink::tell_frame(const line::Waveform& reception) {
  const auto frames = line::delimited_frames_in(reception, rules_.bit_rate);
  const bool is_one = frames.size() == 1 && frames[0].end == line::FrameEnd::whole &&
                      wave_of(frames[0].octets, reception.start).levels == reception.levels;
  if (!is_one && !attached().is_in_network())
    throw iut::CannotBeDone("an implementation that receives telegrams receives whole frames only");
  for (const line::DelimitedFrame& frame : frames) {
    const bool is_frame = frame.end == line::FrameEnd::whole && !frame.octets.empty() &&
                          frame.octets.size() <= kMostFrameOctets;
    if (is_frame) tell(frame, reception);
  }
}

void AttachedLink::tell(const line::DelimitedFrame& frame, const line::Waveform& reception) {
  constexpr std::int64_t kHalfBitsOfAnOctet = 16;
  const kernel::Time delimiter =
      reception.start + static_cast<std::int64_t>(frame.half_bit) * (octets(rules_, 1) / kHalfBitsOfAnOctet);
  std::vector<iut::Character> characters;
  for (const std::uint8_t octet : frame.octets) {
    const auto place = static_cast<std::int64_t>(characters.size()) + 1;
    characters.push_back({delimiter + octets(rules_, place), delimiter + octets(rules_, place + 1), octet});
  }
  attached().call(reception.end(),
                  [&](iut::Device& device) { device.receive(kLinePort, characters, reception.end()); });
}

// ---- what it does ----

void AttachedLink::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  attached().expect_supplied();
  expect_line_port(port);
  if (!hears_frames()) iut::refuse_impossible("drives telegrams, having announced levels");
  const std::size_t count = characters.size();
  if (count == 0 || count > kMostFrameOctets) {
    iut::refuse_impossible(
        fmt::format("drives a frame of {} octets; there are 1 to {}", count, kMostFrameOctets));
  }
  Octets octets;
  for (const std::uint16_t one : characters) {
    if (one > 0xFF) iut::refuse_impossible(fmt::format("drives {} as an octet", one));
    octets.push_back(static_cast<std::uint8_t>(one));
  }
  // No sum of an instant that lies further than time reaches.
  attached().expect_ahead(start, "drives a frame");
  drive(wave_of(octets, start));
}

Octets AttachedLink::told_octets(std::span<const std::uint16_t> characters) {
  return reported_octets(characters, kMostFrameOctets);
}

void AttachedLink::refuse_delivery(std::string_view unit, const Octets& told, const LinkRules& rules) {
  throw iut::Misbehaviour(
      iut::reasons::kNoneDelivered,
      fmt::format(
          "the implementation delivers to its user what is no {} here: its control, its addresses or its "
          "length "
          "are those of none, or its data are more than the {} octets of its priority that the link carries",
          unit, fmt::join(rules.most_data, ", ")),
      {fmt::format("delivered: {:02X}", fmt::join(told.begin() + 1, told.end(), " "))});
}

}  // namespace fieldproof::fieldbus_dll
