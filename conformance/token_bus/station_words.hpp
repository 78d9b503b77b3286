#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/station_bench.hpp"

// The words of sequences for a station, and the frames that some of them put on the line.
namespace fieldproof::conformance {

enum class TokenWord : std::uint8_t {
  token,
  token_elsewhere,
  data,
  request,
  solicit,
  resolve,
  who_follows,
  set_successor,
  claim,
  noise,
  wait,
  submit,
  submit_request,
  in_ring,
  respond,
  peer,
  frame,
  power
};

// How a frame of any kind is spoilt.
enum class FrameFlaw : std::uint8_t {
  none,
  wrong_check,
  check_of_other_order,
  octet_less,
  error_bit,
  short_preamble
};

inline constexpr unsigned kHalfBitsOfOctet = 32;

SequenceVocabulary token_station_vocabulary();

// What a word puts on the line, without its check; for words that send.
Octets octets_of(TokenWord word, const std::vector<std::int64_t>& numbers, TokenBench& bench);
FrameFlaw flaw_of(TokenWord word, const std::vector<std::int64_t>& numbers);
// Its half bits, with check and delimiters.
line::Levels half_bits_of(Octets octets, FrameFlaw flaw);

}  // namespace fieldproof::conformance
