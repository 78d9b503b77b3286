#include "harness/network/turnaround.hpp"

#include <utility>

namespace fieldproof::network {

void Turnaround::on_wave(const line::Waveform& wave) {
  if (wave.start > other_begins_) asked_.reset();
  if (!asked_) return;
  std::size_t level = 0;
  while (begin_ == AnswerBegin::start_level && level < wave.levels.size() && wave.levels[level]) ++level;
  if (level == wave.levels.size()) return;
  const kernel::Time answered = wave.time_of(level);
  if (answered < *asked_) return;
  on_answer_(*std::exchange(asked_, std::nullopt), answered);
}

}  // namespace fieldproof::network
