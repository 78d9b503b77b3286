#pragma once

#include <cstdint>
#include <string>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/translator_bench.hpp"

// What can be drawn for a translator, and what a word requests of it and brings from the line. Stored inputs
// of fuzzers rest on the order: a new word, or number of one, comes last.
namespace fieldproof::conformance {

enum class TranslatorWord : std::uint8_t {
  request,
  request_cut,
  command,
  on_line,
  receive,
  receive_cut,
  collide,
  receive_managed,
  wait,
  power,
  codes,
  answers,
  commands,
  row,
  heartbeat,
  jabber,
  clocks,
  mask,
  anew,
  phase
};

// What comes from the line directly after each other.
enum class TranslatorRow : std::uint8_t {
  bad_signal,
  errors,
  silence,
  idle_command,
  commands,
  delimiter,
  zeros,
  carrier_alone,
  error_without_carrier,
  command_in_a_frame
};

SequenceVocabulary translator_vocabulary();

std::string translated_frame(std::int64_t content, bool more_follows = false);
// Of "codes": any symbols, in a preamble or alone.
std::string script_of_codes(const std::vector<std::int64_t>& numbers);
// Of "answers" and "commands": commands directly after each other.
std::string script_of_commands(const std::vector<std::int64_t>& numbers);
// Of "commands", directly after these.
std::string requested_after_commands();
// Of "jabber"; nothing where it would last too long.
std::string script_of_jabber(std::int64_t kind, const token_bus::TranslatorConfiguration& configuration);
// Of "row": what the MAC requests meanwhile, and what comes.
std::string script_of_row(TranslatorRow row);
SideBits bits_of_row(TranslatorRow row);

// What can be said of what is sent and indicated after a command of a sequence.
enum class TranslatorLook : std::uint8_t {
  all,          // but not how long an answer stands
  content,      // from the first non_data on, until a bit without carrier
  last,         // from the last start delimiter on
  answers,      // each as long as it stands
  ends,         // the first symbols from the first non_data on, and the last ones
  sent_nearly,  // what is sent, but for a last symbol
  by_rules      // what its own rules say: it is judged already
};
TranslatorLook look_of(const SequenceCommand& command);
// Symbols from the first non_data of a frame on that are sure, whatever is made of a missing carrier.
std::size_t sure_symbols(const SequenceCommand& command);

}  // namespace fieldproof::conformance
