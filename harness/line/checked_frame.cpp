#include "harness/line/checked_frame.hpp"

#include <utility>

#include "harness/line/frame_check_16.hpp"

namespace fieldproof::line {
namespace {

const FrameCheck16& check_of_frames() {
  static const FrameCheck16& check = shared_frame_check_16("CRC-16/PROFIBUS");
  return check;
}

}  // namespace

std::vector<std::uint8_t> with_frame_check(std::span<const std::uint8_t> octets) {
  const FrameCheck16& check = check_of_frames();
  std::vector<std::uint8_t> all(octets.begin(), octets.end());
  const auto check_octets = check.check_octets(check.update(check.start(), octets));
  all.insert(all.end(), check_octets.begin(), check_octets.end());
  return all;
}

std::vector<std::vector<std::uint8_t>> checked_frames_in(const Waveform& wave, std::int64_t bit_rate) {
  const FrameCheck16& check = check_of_frames();
  std::vector<std::vector<std::uint8_t>> frames;
  for (DelimitedFrame& frame : delimited_frames_in(wave, bit_rate)) {
    if (frame.end != FrameEnd::whole || frame.octets.size() <= kFrameCheckOctets) continue;
    if (!check.is_residue(check.update(check.start(), frame.octets))) continue;
    frame.octets.resize(frame.octets.size() - kFrameCheckOctets);
    frames.push_back(std::move(frame.octets));
  }
  return frames;
}

}  // namespace fieldproof::line
