#pragma once

#include <cstdint>

#include "conformance/sequence.hpp"

// The words of sequences for a host module: what its PC orders, what its nodes answer.
namespace fieldproof::conformance {

// In this order, to the end of which new ones are added: stored inputs of the fuzzers know them by it.
enum class HostWord : std::uint8_t {
  read,
  write,
  command,
  part,
  answer,
  octets,
  unanswered,
  stray,
  wait,
  power,
  burst,
  fill,
  torn,
  early,
  second,
  late,
  talk,
  cycle,
  dip,
  acknowledged,
  polled,
  period,
  busy,
  many,
  cut,
  twice,
  rejected,
  lates,
  meanwhile,
};

constexpr unsigned kHostAnswerOctets = 3;

SequenceVocabulary host_vocabulary();

}  // namespace fieldproof::conformance
