#include "conformance/valve_bus/host_vocabulary.hpp"

#include <array>
#include <iterator>
#include <string_view>

#include "conformance/sequence_settings.hpp"
#include "conformance/valve_bus/host_bench.hpp"
#include "protocols/valve_bus/host_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 5> kGaps{5, 13, 22, 33, 45};
constexpr std::array<std::int64_t, 4> kNodes{1, 2, 1, 99};
constexpr std::array<std::int64_t, 5> kIds{0, 1, 100, 255, 2};
constexpr std::array<std::int64_t, 4> kCommands{0, 1, 2, 255};
constexpr std::array<std::int64_t, 6> kData{0x00, 0xFF, 0x01, 0x05, 0x80, 0xA5};
constexpr std::array<std::int64_t, 3> kBursts{2, 12, 60};
constexpr std::array<std::int64_t, 2> kFillings{2, 130};
// Nobody waits for less than a time-out in vain, and after all attempts of a read everybody has.
constexpr std::array<std::int64_t, 2> kTalks{1, 8};
constexpr std::array<std::int64_t, 4> kTornWaits{1, 20, 50, 80};
// On either side of what is too early for a response.
constexpr std::array<std::int64_t, 4> kQuarters{3, 5, 7, 10};
constexpr std::array<std::int64_t, 2> kPolled{20, 400};
constexpr std::array<std::int64_t, 4> kBetween{0, 5, 20, 40};
// The last ones take more than 65 s.
constexpr std::array<std::int64_t, 4> kRefreshes{2, 3, 3, 1'400};
constexpr std::array<std::int64_t, 3> kNodeCounts{2, 12, 80};
constexpr std::array<std::int64_t, 4> kLates{1, 2, 3, 300};
constexpr std::array<std::int64_t, 3> kMeanwhile{1, 2, 128};
constexpr std::array<std::int64_t, 4> kWaits{1, 10, 60, 200};
// Bits between a request and its answer: nobody doubts that it begins within the time-out, and the last of
// its octets does so as well, whatever gaps are in it.
constexpr std::array<std::int64_t, 4> kTurnarounds{45, 60, 150, 700};

SequenceNumber octet(std::string_view name) {
  return {name, 0, 0xFF, 0, kData};
}

SequenceNumber node() {
  return {"id", 1, 99, 1, kNodes};
}

SequenceNumber turnaround() {
  return {"turnaround", 45, 700, 60, kTurnarounds, true};
}

// Makes an exclusive or fit: of the first three octets, of the last three, or of none.
SequenceNumber fit() {
  return {"fit", 0, 2, 0};
}

// Turned by a word.
constexpr std::array<std::string_view, 1> kFixedOfHost{"dip"};

// What a host has been ordered, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_a_host() {
  const NamedCommand answered{"answer", {{"data0", 0xA5}, {"data1", 0x3C}}};
  const NamedCommand written{"write", {{"data0", 0x5A}, {"data1", 0xC3}}};
  return {{answered, {"read"}, {"wait"}}, {{"unanswered"}, {"read"}, {"wait"}},
          {{"part", {{"count", 2}}}},     {written, {"read"}, {"read", {{"id", 2}}}},
          {written, {"wait"}, {"power"}}, {{"dip", {{"position", 7}}}, {"power"}}};
}

// Orders and answers, one by one.
std::vector<SequenceWord> single_words() {
  return {{.word = "read", .meaning = "the PC orders a read", .numbers = {node()}, .weight = 6},
          {.word = "write",
           .meaning = "the PC orders a write",
           .numbers = {node(), octet("data0"), octet("data1")},
           .weight = 3},
          {.word = "command",
           .meaning = "the PC orders any command to any address",
           .numbers =
               {{"id", 0, 0xFF, 1, kIds}, {"command", 0, 0xFF, 1, kCommands}, octet("data0"), octet("data1")},
           .weight = 2},
          {.word = "part",
           .meaning = "the PC gives so many octets of a command, and no more",
           .numbers = {{"count", 1, 3, 1}},
           .weight = 1},
          {.word = "answer",
           .meaning = "the next read on the line is answered",
           .numbers = {octet("data0"), octet("data1"), turnaround()},
           .units = kHostAnswerOctets,
           .weight = 6},
          {.word = "octets",
           .meaning = "the next read on the line is answered with octets that are no response, or "
                      "happen to be one",
           .numbers = {fit(), turnaround()},
           .most_octets = 6,
           .weight = 2},
          {.word = "unanswered", .meaning = "the next read on the line is not answered", .weight = 2},
          {.word = "stray",
           .meaning = "octets on the line when everything has ended",
           .numbers = {fit()},
           .most_octets = 8,
           .weight = 1},
          {.word = "wait",
           .meaning = "everything ends, then so many milliseconds pass",
           .numbers = {{"ms", 1, 1'000, 10, kWaits}},
           .weight = 1},
          {.word = "power",
           .meaning = "the supply goes and comes: 0, when everything has ended; 1, with the next "
                      "read on the line",
           .numbers = {{"open", 0, 1, 0}},
           .weight = 1,
           .is_loss = true}};
}

// What takes a host many commands or an exact instant to show.
std::vector<SequenceWord> long_words() {
  return {
      {.word = "burst",
       .meaning = "everything ends, then the PC orders so many commands at once, one for each of the nodes "
                  "from 1 on and the rest for the next, reads or writes, and so many octets of another; "
                  "nothing is answered",
       .numbers =
           {{"count", 2, 60, 2, kBursts, true}, {"nodes", 0, 8, 1}, {"reads", 0, 1, 0}, {"part", 0, 3, 0}},
       .weight = 1},
      {.word = "fill",
       .meaning =
           "while a read waits for its response the PC orders so many writes, of which 128 fit, and so "
           "many octets of another, the rest of which comes when one has been sent",
       .numbers = {{"count", 2, 130, 2, kFillings, true}, {"part", 0, 3, 0}},
       .weight = 1},
      {.word = "torn",
       .meaning = "the PC gives so many octets of a command, and the rest so many milliseconds later",
       .numbers = {{"count", 1, 3, 1}, {"ms", 1, 90, 20, kTornWaits}},
       .weight = 1},
      {.word = "early",
       .meaning = "the next read on the line is answered so many quarters of a character after it",
       .numbers = {octet("data0"), octet("data1"), {"quarters", 3, 10, 7, kQuarters, true}},
       .weight = 2},
      {.word = "second",
       .meaning = "the next read on the line is answered with one octet, and rightly after a delimiter",
       .numbers = {octet("first"), octet("data0"), octet("data1")},
       .weight = 2},
      {.word = "late",
       .meaning = "everything ends, then a read is answered after the time-out of its last attempt, while "
                  "the host rests",
       .numbers = {node(), octet("data0"), octet("data1")},
       .weight = 1},
      {.word = "talk",
       .meaning = "everything ends, then the line is not silent for so many halves of a time-out and the PC "
                  "orders a read; where nothing was written since power-up",
       .numbers = {node(), {"halves", 1, 8, 1, kTalks, true}},
       .weight = 1},
      {.word = "cycle",
       .meaning = "everything ends, then so many nodes are read in turn, three times, and answer alike",
       .numbers = {{"nodes", 1, 8, 1}},
       .weight = 1},
      {.word = "dip",
       .meaning = "the DIP switches are turned, for the next power-up",
       .numbers = {{"position", 0, 7, 0}},
       .weight = 1}};
}

// What lasts, and what happens during an attempt; everything ends before each of them.
std::vector<SequenceWord> lasting_words() {
  return {
      {.word = "acknowledged",
       .meaning =
           "a write; where the host waits for acknowledges, its first attempts get: 0 nothing, 1 other "
           "data, 2 a wrong check, 3 one octet",
       .numbers = {node(), {"attempts", 0, 3, 1}, {"how", 0, 3, 0}},
       .weight = 3},
      {.word = "polled",
       .meaning = "a write, and so many reads, one of which always waits; each is answered",
       .numbers = {node(), {"count", 1, 400, 2, kPolled, true}}},
      {.word = "period",
       .meaning = "two writes to a node, the second so many milliseconds after the first, and so many "
                  "refreshes",
       .numbers = {node(), {"ms", 0, 40, 20, kBetween}, {"count", 1, 1'500, 3, kRefreshes, true}}},
      {.word = "busy",
       .meaning = "where something was written, the line is not silent when refreshes are due"},
      {.word = "many",
       .meaning = "a write to each of so many nodes, and their refreshes",
       .numbers = {{"nodes", 1, 99, 2, kNodeCounts, true}}},
      {.word = "cut",
       .meaning = "the PC gives so many octets of a command, and the supply goes and comes",
       .numbers = {{"count", 1, 3, 1}},
       .is_loss = true},
      {.word = "twice",
       .meaning = "two writes to a node at once; where they are read back, the first (1), the second (2) or "
                  "none (0) is other data",
       .numbers = {node(), {"wrong", 0, 2, 0}},
       .weight = 2},
      {.word = "rejected",
       .meaning = "a read each attempt of which is answered with a wrong check; then another read, or, 1, a "
                  "frame that is late",
       .numbers = {node(), {"late", 0, 1, 0}}},
      {.word = "lates",
       .meaning = "where nothing was written since power-up, a read that nobody answers, and so many frames "
                  "after its end",
       .numbers = {node(), {"count", 1, 300, 2, kLates, true}}},
      {.word = "meanwhile",
       .meaning = "a read that nobody answers; so many tenths of the time-out after its first attempt the PC "
                  "orders so many writes",
       .numbers = {node(), {"tenths", 1, 9, 5}, {"count", 1, 128, 1, kMeanwhile, true}}}};
}

std::vector<SequenceWord> host_words() {
  std::vector<SequenceWord> words = single_words();
  for (auto* make : {long_words, lasting_words}) {
    std::vector<SequenceWord> more = make();
    words.insert(words.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return words;
}

}  // namespace

SequenceVocabulary host_vocabulary() {
  const valve_bus::HostConfiguration host = host_configuration({}, declared_host());
  return with_beginnings({.words = host_words(),
                          .unit = "character",
                          .levels_per_unit = 11,
                          .gaps = kGaps,
                          .settings = sequence_settings(valve_bus::kHostTable, &host, kFixedOfHost)},
                         states_of_a_host());
}

}  // namespace fieldproof::conformance
