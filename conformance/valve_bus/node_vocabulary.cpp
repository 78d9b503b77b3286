#include "conformance/valve_bus/node_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/node_settings.hpp"

namespace fieldproof::conformance {
namespace {

// Bits of silence in which no receiver doubts: within a frame, between the two limits, after a delimiter.
constexpr std::array<std::int64_t, 8> kSilences{0, 11, 22, 33, 45, 45, 80, 500};
constexpr std::array<std::int64_t, 5> kGaps{5, 13, 22, 33, 45};
constexpr std::int64_t kDelimiterBits = 45;
constexpr std::array<std::int64_t, 6> kData{0x00, 0xFF, 0x01, 0x05, 0x80, 0xA5};
constexpr std::array<std::int64_t, 7> kIds{1, 0, 5, 69, 133, 4, 255};
constexpr std::array<std::int64_t, 6> kCommands{0, 1, 2, 128, 129, 255};
constexpr std::array<std::int64_t, 5> kChecks{0xFF, 0x01, 0x80, 0x0F, 0xA5};
// Of a character: allowed inside a frame, and too long for it, whatever the characters are.
constexpr std::array<std::int64_t, 3> kTenths{10, 17, 30};
// Far from any that a receiver may take.
constexpr std::array<std::int64_t, 2> kRates{50, 170};
constexpr std::array<std::int64_t, 2> kGlitchSixteenths{2, 4};
constexpr std::array<std::int64_t, 5> kPolls{2, 20, 2, 20, 410};
constexpr std::array<std::int64_t, 5> kWaits{1, 10, 66, 100, 1000};

constexpr std::array<std::int64_t, 2> kMovedEdges{-5, 5};
constexpr std::array<std::int64_t, 3> kWrongs{2, 20, 130};
constexpr std::array<std::int64_t, 5> kLossLimits{
    kernel::Duration{8 * kernel::kMillisecond}.count(), kernel::Duration{100 * kernel::kMillisecond}.count(),
    kernel::Duration{1 * kernel::kSecond}.count(), kernel::Duration{66 * kernel::kSecond}.count(),
    kernel::Duration{3600 * kernel::kSecond}.count()};

SequenceNumber octet(std::string_view name, std::span<const std::int64_t> likely = kData) {
  return {name, 0, 0xFF, 0, likely};
}

// After what the command sends, to the next.
SequenceNumber silence() {
  return {"silence", 0, 100'000, kDelimiterBits, kSilences, true};
}

// Judged beside references, so that it is enough if a write and the loss of the host can be told apart.
void expect_judgeable_in_a_sequence(const valve_bus::NodeConfiguration& node) {
  constexpr int kSpans = 3;
  const valve_bus::Rules& rules = node.rules;
  const kernel::Duration least =
      kSpans * (valve_bus::delimiter(rules) + valve_bus::turnaround_time_span(rules));
  if (rules.loss_limit == kernel::Duration{} || rules.loss_limit >= least) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("with a \"loss_limit\" of {} the valves of this node go off while they may still move by a "
                  "write; at {} bit/s it can be judged from {} on",
                  kernel::describe(rules.loss_limit), rules.bit_rate, kernel::describe(least)));
}

// Times without a host of which a sequence may see the end.
std::vector<SequenceSetting> settings_of_a_node(const valve_bus::NodeConfiguration& node) {
  std::vector<SequenceSetting> all = sequence_settings(valve_bus::kNodeTable, &node);
  const auto loss = std::ranges::find(all, std::string_view("loss_limit"), &SequenceSetting::name);
  if (loss != all.end()) {
    loss->likely = {kLossLimits.begin(), kLossLimits.end()};
    loss->is_likely_only = true;
  }
  // The first position that is no digit.
  for (SequenceSetting& one : all)
    if (one.name.starts_with("address_")) one.likely.push_back(10);
  return all;
}

SequenceVocabulary vocabulary_of_commands() {
  const valve_bus::NodeConfiguration node = node_configuration({}, declared_node());
  // In the order of NodeWord.
  return {.words = {{.word = "write",
                     .meaning = "a write of the node's own",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 5,
                     .weight = 6},
                    {.word = "read",
                     .meaning = "a read of the node's own",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 5,
                     .weight = 4},
                    {.word = "command",
                     .meaning = "a command to any address",
                     .numbers = {octet("id", kIds), octet("command", kCommands), octet("data0"),
                                 octet("data1"), silence()},
                     .units = 5,
                     .weight = 3},
                    {.word = "response",
                     .meaning = "a response of another node",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 3,
                     .weight = 2},
                    {.word = "octets",
                     .meaning = "octets that are no frame, or happen to be one",
                     .numbers = {silence()},
                     .most_octets = 8,
                     .weight = 2},
                    {.word = "low",
                     .meaning = "the line is low for so many bits",
                     .numbers = {{"bits", 1, 100'000, 30}, silence()},
                     .weight = 1},
                    {.word = "wait",
                     .meaning = "silence of so many milliseconds",
                     .numbers = {{"ms", 1, 10'000, 10, kWaits}},
                     .weight = 1},
                    {.word = "power",
                     .meaning = "the supply is off for so many bits and comes again",
                     .numbers = {{"off", 10, 100'000, 20}, silence()},
                     .weight = 1,
                     .is_loss = true},
                    {.word = "switches",
                     .meaning = "limit switches stand like this",
                     .numbers = {octet("data0"), octet("data1")},
                     .weight = 2}},
          .unit = "character",
          .levels_per_unit = 11,
          .gaps = kGaps,
          .settings = settings_of_a_node(node),
          .objection = objection_of(valve_bus::kNodeTable, node, expect_judgeable_in_a_sequence)};
}

std::vector<SequenceWord> words_of_spoilt_writes() {
  return {{.word = "check",
           .meaning = "a write of the node's own, the bits of its check inverted where these are 1",
           .numbers = {{"bits", 1, 0xFF, 0xFF, kChecks}, octet("data0"), octet("data1"), silence()},
           .weight = 1},
          {.word = "parity",
           .meaning =
               "a write of the node's own with the bit after the eight data bits of one character inverted",
           .numbers = {{"character", 0, 4, 0}, octet("data0"), octet("data1"), silence()},
           .weight = 2},
          {.word = "spaced",
           .meaning = "a write of the node's own with so many tenths of a character of silence after one",
           .numbers = {{"character", 0, 3, 0},
                       {"tenths", 10, 30, 10, kTenths, true},
                       octet("data0"),
                       octet("data1"),
                       silence()},
           .weight = 2},
          {.word = "rate",
           .meaning = "silence, then a write of the node's own at so many hundredths of the bit rate",
           .numbers = {{"percent", 50, 170, 50, kRates, true}, octet("data0"), octet("data1"), silence()},
           .weight = 1}};
}

std::vector<SequenceWord> words_of_lines_and_times() {
  return {
      {.word = "break",
       .meaning = "silence, then the line is low for so many characters without an edge",
       .numbers = {{"characters", 2, 20, 4}, silence()},
       .weight = 1},
      {.word = "glitch",
       .meaning = "the line is low for so many sixteenths of a bit",
       .numbers = {{"sixteenths", 2, 4, 2, kGlitchSixteenths, true}, silence()},
       .weight = 2},
      {.word = "poll",
       .meaning = "so many reads of the node's own, one after the other",
       .numbers = {{"count", 2, 410, 2, kPolls, true}},
       .weight = 1},
      {.word = "sign",
       .meaning = "where valves go off without a command: a write, seven tenths of that time, a read (0), an "
                  "undefined command (1), a command for another (2), one with a wrong check (3), nothing (4) "
                  "or the same write (5), and seven tenths",
       .numbers = {{"kind", 0, 5, 0}},
       .weight = 3}};
}

std::vector<SequenceWord> words_of_characters() {
  return {{.word = "stop",
           .meaning = "a write of the node's own without the stop bit of one character",
           .numbers = {{"character", 0, 4, 0}, octet("data0"), octet("data1"), silence()},
           .weight = 2},
          {.word = "edges",
           .meaning = "a write of the node's own whose edges lie so many sixteenths of a bit beside their "
                      "places: rising ones later, or, below 0, falling ones earlier",
           .numbers = {{"sixteenths", -5, 5, 5, kMovedEdges}, octet("data0"), octet("data1"), silence()},
           .weight = 1}};
}

// What comes before an answer, into it or in its place.
std::vector<SequenceWord> words_of_answers() {
  return {{.word = "cancel",
           .meaning = "a read, or a write, of the node's own and, before anybody is sure that it is over, an "
                      "octet (0), a write for another (1) or a write of its own (2)",
           .numbers = {{"write", 0, 1, 0}, {"next", 0, 2, 0}, octet("data0"), octet("data1"), silence()},
           .weight = 2},
          {.word = "collision",
           .meaning = "a read of the node's own, and a response of another node into its answer",
           .numbers = {octet("data0"), octet("data1"), silence()},
           .weight = 1},
          {.word = "lost",
           .meaning = "a read of the node's own, and the supply goes so many characters after the answer has "
                      "begun, and comes again",
           .numbers = {{"characters", 1, 2, 1}, silence()},
           .weight = 1,
           .is_loss = true},
          {.word = "wrong",
           .meaning = "so many writes of the node's own with a wrong check, one after the other",
           .numbers = {{"count", 2, 130, 2, kWrongs, true}},
           .weight = 1},
          {.word = "others",
           .meaning = "where valves go off without a command: a write, and commands for another beyond that "
                      "time",
           .weight = 1},
          {.word = "clock",
           .meaning = "a read of the node's own while both boards of limit switches show a clock",
           .weight = 1}};
}

}  // namespace

SequenceVocabulary node_vocabulary() {
  SequenceVocabulary vocabulary = vocabulary_of_commands();
  for (auto* make :
       {words_of_spoilt_writes, words_of_lines_and_times, words_of_characters, words_of_answers}) {
    for (SequenceWord& word : make()) vocabulary.words.push_back(std::move(word));
  }
  return vocabulary;
}

std::vector<std::uint8_t> octets_of(NodeWord word, const SequenceCommand& command, const NodeBench& bench) {
  const auto number = [&](std::size_t n) { return static_cast<std::uint8_t>(command.numbers.at(n)); };
  std::vector<std::uint8_t> octets;
  switch (word) {
    case NodeWord::write:
    case NodeWord::read:
      octets = {bench.address(), static_cast<std::uint8_t>(word == NodeWord::write ? 0 : 1), number(0),
                number(1)};
      break;
    case NodeWord::command:
      octets = {number(0), number(1), number(2), number(3)};
      break;
    case NodeWord::check:
    case NodeWord::parity:
    case NodeWord::rate:
    case NodeWord::stop:
    case NodeWord::edges:
      octets = {bench.address(), 0, number(1), number(2)};
      break;
    case NodeWord::spaced:
      octets = {bench.address(), 0, number(2), number(3)};
      break;
    case NodeWord::response:
      octets = {number(0), number(1)};
      break;
    default:
      return command.octets;
  }
  std::uint8_t check = 0;
  for (const std::uint8_t one : octets) check ^= one;
  octets.push_back(word == NodeWord::check ? static_cast<std::uint8_t>(check ^ number(0)) : check);
  return octets;
}

}  // namespace fieldproof::conformance
