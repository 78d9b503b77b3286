#pragma once

#include <cstdint>
#include <vector>

#include "harness/measure/edge_code.hpp"
#include "harness/measure/signal_generator.hpp"

// A recorder on an input and on the output that follows it: channel 1 is the generator at the input, channel
// 2 what appears at the output, as words of an edge code.
//
// Contract: `on_output` is told the words of the output in the order of their instants. A word of an edge
// that has happened, and that is not older than the edge shown before, is recorded with the number of that
// edge; one that shows the same edge again is no edge. Any other word was never at the input since then: it
// mixes two words or has wrong bits, and is counted as foreign. The generator must outlive the recorder.
namespace fieldproof::measure {

class TwoChannelRecorder {
 public:
  struct Edge {
    kernel::Time when;
    std::uint64_t number = 0;  // of the input edge that the output shows from now on; odd ones are high
  };

  explicit TwoChannelRecorder(const SignalGenerator& generator, EdgeCode code = EdgeCode())
      : generator_(&generator), code_(code) {}

  // What the generator puts at the input.
  std::uint16_t input(kernel::Time when) const { return code_.word(generator_->edges_until(when)); }
  void on_output(kernel::Time when, std::uint16_t word);

  const SignalGenerator& generator() const { return *generator_; }
  const std::vector<Edge>& output_edges() const { return edges_; }
  std::uint64_t shown_edge() const { return edges_.empty() ? 0 : edges_.back().number; }
  const std::vector<kernel::Time>& foreign_words() const { return foreign_words_; }

 private:
  const SignalGenerator* generator_;
  EdgeCode code_;
  std::vector<Edge> edges_;
  std::vector<kernel::Time> foreign_words_;
};

}  // namespace fieldproof::measure
