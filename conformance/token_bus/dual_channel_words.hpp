#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/dual_channel_bench.hpp"

// What can be drawn for a channel manager, and what both channels carry for a word. Stored inputs of fuzzers
// rest on the order: a new word, or number of one, comes last.
namespace fieldproof::conformance {

enum class ManagerWord : std::uint8_t {
  both,
  alone,
  differ,
  wrong,
  collide,
  train,
  noise,
  request,
  command,
  answer,
  wait,
  power,
  limit,
  kinds,
  other_codes,
  longest_request,
  seconds,
  meanwhile,
  two_within,
  stuck,
  clock
};

// Which limit is met to the symbol.
enum class ManagerLimit : std::uint8_t { skew, copy, collision, bad_signal };

// What a train of two frames is made of.
enum class TrainKind : std::uint8_t {
  right,
  longest,
  first_octet_wrong,
  check_wrong,
  first_check_wrong,
  first_endless,
  cut,
  e_bit,
  too_long
};

SequenceVocabulary channel_manager_vocabulary();

struct BothChannels {
  ChannelText named;
  ChannelText other;
};

std::string framed(std::int64_t content, bool more_follows = false, std::size_t octets = 0);
std::string received_frame(std::int64_t content, bool more_follows = false, std::size_t octets = 0);
BothChannels at_limit(ManagerLimit limit, std::int64_t place,
                      const token_bus::ChannelManagerConfiguration& configuration);
std::string train_of(TrainKind kind, const token_bus::ChannelManagerConfiguration& configuration);
std::string with_other_codes(std::string text);
BothChannels two_within_one(bool is_spoiled, const token_bus::ChannelManagerConfiguration& configuration);
BothChannels beside_what_is_stuck(bool is_for_long,
                                  const token_bus::ChannelManagerConfiguration& configuration);

}  // namespace fieldproof::conformance
