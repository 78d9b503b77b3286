#include "harness/measure/two_channel_recorder.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {

void TwoChannelRecorder::on_output(kernel::Time when, std::uint16_t word) {
  FIELDPROOF_CHECK(edges_.empty() || edges_.back().when <= when,
                   "an output is recorded in the order of its instants");
  const auto number = code_.edges(word, generator_->edges_until(when));
  if (!number || *number < shown_edge()) {
    foreign_words_.push_back(when);
  } else if (*number > shown_edge()) {
    edges_.push_back({when, *number});
  }
}

}  // namespace fieldproof::measure
