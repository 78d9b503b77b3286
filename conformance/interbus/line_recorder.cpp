#include "conformance/interbus/line_recorder.hpp"

#include <fmt/format.h>

#include "protocols/interbus/notation.hpp"

namespace fieldproof::conformance {

bool LineRecorder::has_room() {
  is_truncated_ = is_truncated_ || lines_.size() == kMostLines;
  return !is_truncated_;
}

void LineRecorder::add(trace::Channel channel, kernel::Time time, std::string_view text) {
  lines_.push_back(fmt::format("{}  {}  {}", kernel::describe(time), trace_.channel_name(channel), text));
}

void LineRecorder::on_driven(trace::Channel channel, const line::Waveform& wave) {
  if (!has_room()) return;
  std::string text = interbus::describe(wave, rules_);
  if (wave.rate != rules_.bit_rate) text += fmt::format("  at {} levels/s", wave.rate);
  if (wave.levels.size() <= kMostLevels) text += fmt::format("  [{}]", wave.levels.text());
  add(channel, wave.start, text);
}

void LineRecorder::on_fault(trace::Channel channel, kernel::Time time, std::string_view what) {
  if (has_room()) add(channel, time, fmt::format("fault: {}", what));
}

void LineRecorder::on_observation(trace::Channel channel, kernel::Time time, std::string_view what,
                                  std::uint64_t value) {
  if (has_room()) add(channel, time, fmt::format("{} = {}", what, value));
}

}  // namespace fieldproof::conformance
