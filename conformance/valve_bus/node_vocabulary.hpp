#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/valve_bus/node_bench.hpp"

// The words of sequences for a local node, and the octets that some of them put on the line.
namespace fieldproof::conformance {

// In this order, to the end of which new ones are added: stored inputs of the fuzzers know them by it.
enum class NodeWord : std::uint8_t {
  write,
  read,
  command,
  response,
  octets,
  low,
  wait,
  power,
  switches,
  check,
  parity,
  spaced,
  rate,
  line_break,
  glitch,
  poll,
  sign,
  stop,
  edges,
  cancel,
  collision,
  lost,
  wrong,
  others,
  clock,
};

SequenceVocabulary node_vocabulary();
// Without faults; none for a word that sends no characters.
std::vector<std::uint8_t> octets_of(NodeWord word, const SequenceCommand& command, const NodeBench& bench);

}  // namespace fieldproof::conformance
