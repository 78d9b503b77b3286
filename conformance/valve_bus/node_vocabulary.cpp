#include "conformance/valve_bus/node_vocabulary.hpp"

#include <array>

#include "conformance/sequence_settings.hpp"
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
constexpr std::array<std::int64_t, 5> kWaits{1, 10, 66, 100, 1000};

SequenceNumber octet(std::string_view name, std::span<const std::int64_t> likely = kData) {
  return {name, 0, 0xFF, 0, likely};
}

// After what the command sends, to the next.
SequenceNumber silence() {
  return {"silence", 0, 100'000, kDelimiterBits, kSilences, true};
}

}  // namespace

SequenceVocabulary node_vocabulary() {
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
          .settings = sequence_settings(valve_bus::kNodeTable, &node),
          .objection = objection_of(valve_bus::kNodeTable, node, expect_judgeable)};
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
    case NodeWord::response:
      octets = {number(0), number(1)};
      break;
    default:
      return command.octets;
  }
  std::uint8_t check = 0;
  for (const std::uint8_t one : octets) check ^= one;
  octets.push_back(check);
  return octets;
}

}  // namespace fieldproof::conformance
