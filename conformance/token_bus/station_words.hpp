#pragma once

#include <cstdint>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/station_bench.hpp"

// What can be drawn for a station of the token bus, and which octets a word is. Stored inputs of fuzzers rest
// on the order: a new word, or number of one, comes last.
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
  power,
  frame,
  form,
  reply,
  soon,
  spike,
  many,
  others,
  ask,
  silence,
  load,
  beside,
  failures,
  claims,
  slow_rounds
};

// What follows from "ending" of a form.
enum class TokenEnding : std::uint8_t {
  right,
  error_bit,
  wrong_check,
  check_reversed,
  both_errors,
  bits_too_many,
  no_end,
  abort,
  data_after,
  data_before,
  damaged_before,
  two_before,
  nothing_after,
  longest,
  too_long,
  too_long_and_wrong,
  long_and_wrong
};

// What is done many times.
enum class TokenSeries : std::uint8_t {
  rounds,
  rounds_with_data,
  noise,
  fragments,
  wrong_checks,
  error_bits,
  too_long
};

// What the tester does when the station has driven a frame of some kind.
enum class TokenReply : std::uint8_t {
  nothing,
  what_is_due,
  noise,
  long_noise,
  group_is_successor,
  successor_of_another,
  data,
  token,
  wrong_check,
  own_source,
  response_of_another,
  response_to_another,
  solicitation,
  contest,
  claim,
  request,
  noise_then_token,
  station_is_successor,
  data_for_all,
  who_follows,
  contest_then_noise
};
inline constexpr std::int64_t kMostTokenReply = 20;

// What is nearly a frame that the station acts on: with another address for each octet of one, or with
// another control code for each of its low bits.
enum class TokenBeside : std::uint8_t {
  token_to,
  data_to,
  data_from,
  request_to,
  successor_to,
  solicited_below,
  solicited_above,
  follows_another,
  token_from,
  controls
};

// The frames to which it may reply.
enum class TokenCue : std::uint8_t {
  token,
  request,
  solicitation,
  who_follows,
  contest,
  claim,
  successor,
  data
};
inline constexpr std::size_t kTokenCues = 8;

SequenceVocabulary token_station_vocabulary();
// Those that do a row of things at once.
std::vector<SequenceWord> words_of_many();
// What shows seldom, and with which settings.
std::vector<NamedSituation> situations_of_a_station();

// The frames of "beside", in their order.
std::vector<Octets> frames_beside(TokenBeside kind, TokenBench& bench);
// Of a word that is one frame, without the check.
Octets octets_of(TokenWord word, const std::vector<std::int64_t>& numbers, TokenBench& bench);
// Who is meant by a number of "frame" or "ask".
std::uint64_t address_meant(std::int64_t number, const TokenBench& bench);

}  // namespace fieldproof::conformance
