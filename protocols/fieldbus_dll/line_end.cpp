#include "protocols/fieldbus_dll/line_end.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"
#include "harness/line/checked_frame.hpp"

namespace fieldproof::fieldbus_dll {

std::string no_dlpdu_text(std::span<const std::uint8_t> octets) {
  return fmt::format("no DLPDU: {:02X}", fmt::join(octets, " "));
}

Octets with_check(std::span<const std::uint8_t> octets) {
  return line::with_frame_check(octets);
}

kernel::Time LineEnd::transmit(std::span<const std::uint8_t> octets, kernel::Time start) {
  line::Levels half_bits;
  code_.append(half_bits, with_check(octets), rules_.preamble_octets);
  return drive(std::move(half_bits), start);
}

kernel::Time LineEnd::drive(line::Levels half_bits, kernel::Time start) {
  FIELDPROOF_CHECK(line_ != nullptr, "a station that drives has been wired");
  line::Waveform wave{start, 2 * rules_.bit_rate, std::move(half_bits)};
  driven_until_ = wave.end();
  line_->drive(wave);
  return driven_until_;
}

std::vector<Arrived> LineEnd::receive(const line::Waveform& reception) {
  std::vector<Arrived> arrived;
  if (reception.start < driven_until_) return arrived;
  for (Octets& octets : line::checked_frames_in(reception, rules_.bit_rate))
    arrived.push_back({std::move(octets), reception.start, reception.end()});
  return arrived;
}

void LineEnd::on_activity(bool begins, kernel::Time now) {
  hears_activity_ = begins;
  if (!begins) heard_until_ = now;
}

kernel::Time LineEnd::silent_since() const {
  return hears_activity_ ? kernel::kNever : std::max(heard_until_, driven_until_);
}

}  // namespace fieldproof::fieldbus_dll
