#include "conformance/fieldbus_dll/isa_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 16> kIsaDurations{1,  9,  10,  17,  30,    31,     33,     34,
                                                     60, 61, 127, 200, 1'000, 32'768, 33'000, 65'535};
constexpr std::array<std::int64_t, 12> kIsaSizes{0, 1, 2, 8, 9, 10, 63, 64, 65, 128, 129, 256};
constexpr std::array<std::int64_t, 8> kIsaTimes{1, 1, 1, 1, 1, 1, 40, 150};
constexpr std::array<std::int64_t, 23> kIsaToStations{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                      0, 0, 0, 0, 1, 1, 2, 3, 4, 5, 6};
constexpr std::array<std::int64_t, 22> kIsaTo{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                              0, 0, 0, 0, 0, 1, 1, 2, 3, 4, 5};
constexpr std::array<std::int64_t, 18> kIsaFrom{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 1, 2, 3, 4, 5};
constexpr std::array<std::int64_t, 16> kIsaPriorities{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 0};
constexpr std::array<std::int64_t, 4> kIsaRequestPriorities{1, 2, 3, 2};
constexpr std::array<std::int64_t, 18> kIsaWorks{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 12, 22, 24, 25, 60};
constexpr std::array<std::int64_t, 12> kIsaControls{0x49, 0x4A, 0x4B, 0x19, 0x1A, 0x48,
                                                    0x59, 0x29, 0x39, 0x4D, 0x81, 0xC1};
constexpr std::array<std::int64_t, 8> kIsaLate{-30, -4, -2, -1, 1, 2, 24, 30};
constexpr std::array<std::int64_t, 6> kIsaAnswered{-2, -1, 1, 1, 2, 4};
constexpr std::array<std::int64_t, 6> kIsaPeers{1, 1, 1, 2, 3, 4};
constexpr std::array<std::int64_t, 6> kIsaPeerAfter{8, 8, 8, 20, 30, 31};
SequenceNumber isa_priority(std::string_view name = "priority") {
  return {name, 0, 3, 2, kIsaPriorities, true};
}
SequenceNumber isa_to() {
  return {"to", 0, 6, 0, kIsaToStations, true};
}
SequenceNumber isa_from() {
  return {"from", 0, 5, 0, kIsaFrom, true};
}
SequenceNumber isa_truth(std::string_view name) {
  return {name, 0, 1, 0};
}

// Of a DU and a DT.
std::vector<SequenceNumber> isa_numbers_of_data() {
  return {isa_to(),      isa_from(), isa_priority(), isa_truth("final"), {"size", 0, 260, 8, kIsaSizes},
          link_silence()};
}

// Each of them so that there is time left for the others as they are.
constexpr std::array kBoundsOfIsaDle{SettingBound{"inter_pdu_delay_octets", {1, 23}},
                                     SettingBound{"reply_forming_octets", {9, 31}},
                                     SettingBound{"reply_wait_octets", {25, 300}}};

// DLPDUs are told by the upper halves of their first octets.
void expect_distinct_isa_codes(const fieldbus_dll::IsaCodes& codes) {
  std::array<unsigned, 7> all{codes.cd, codes.dt, codes.du, codes.et, codes.es, codes.ee, codes.tl};
  std::ranges::sort(all);
  const auto twice =
      std::ranges::adjacent_find(all, [](unsigned one, unsigned other) { return one >> 4 == other >> 4; });
  if (twice == all.end()) return;
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("two DLPDUs have the code {:02X}; each has its own upper half", *twice));
}

std::vector<SequenceWord> isa_dle_words() {
  // In the order of IsaWord.
  return {
      {.word = "single",
       .meaning = "an ET for what is at least as urgent, to the station or to others",
       .numbers = {isa_to(), isa_from(), isa_priority("least"), link_length(), link_silence()},
       .units = 7,
       .weight = 12},
      {.word = "sequence",
       .meaning = "an ES for what is at least as urgent, to the station or to others",
       .numbers = {isa_to(),
                   isa_from(),
                   isa_priority("least"),
                   {"octets", 0, 65'535, 200, kIsaDurations},
                   link_length(),
                   link_silence()},
       .units = 9,
       .weight = 18},
      {.word = "compel",
       .meaning = "a CD, to the station or to others; its user works on data until so many octets after "
                  "it, 0: it does not",
       .numbers = {isa_to(),
                   isa_from(),
                   isa_priority("least"),
                   {"works", 0, 60, 0, kIsaWorks, true},
                   link_length(),
                   link_silence()},
       .units = 7,
       .weight = 15},
      {.word = "other",
       .meaning = "EE, TL, or what is none, with this in its last octet",
       .numbers =
           {{"kind", 0, 6, 0}, isa_to(), isa_from(), {"value", 0, 255, 0}, link_length(), link_silence()},
       .units = 8,
       .weight = 6},
      {.word = "data", .meaning = "a DU", .numbers = isa_numbers_of_data(), .units = 9, .weight = 8},
      {.word = "reply",
       .meaning = "a DT, for which the station has not asked",
       .numbers = isa_numbers_of_data(),
       .units = 9,
       .weight = 5},
      link_noise(),
      {.word = "submit",
       .meaning = "the user submits: 0 data, 1 a CD, 2 data for a CD; so many times",
       .numbers = {{"service", 0, 2, 0},
                   {"priority", 1, 3, 2, kIsaRequestPriorities},
                   {"to", 0, 5, 0, kIsaTo, true},
                   {"size", 0, 260, 0, kIsaSizes},
                   {"times", 1, 300, 1, kIsaTimes, true}},
       .weight = 27},
      {.word = "peer",
       .meaning = "what the tester does so many octets after a CD of the station",
       .numbers = {{"does", 0, 12, 0, kIsaPeers}, {"after", 8, 60, 8, kIsaPeerAfter}},
       .weight = 10},
      link_supply(),
      link_one(),
      link_wait(),
      link_framed(),
      link_received(),
      link_checked(),
      {.word = "control",
       .meaning = "three octets for the station, with this first one",
       .numbers = {{"octet", 0, 255, 0x48, kIsaControls}, link_silence()},
       .units = 7,
       .weight = 4},
      {.word = "late",
       .meaning =
           "a CD to the station, whose user has the data so many quarters of a bit after V(FD) is over",
       .numbers = {{"quarters", -64, 64, -4, kIsaLate}, isa_priority("least")},
       .weight = 6},
      {.word = "answered",
       .meaning =
           "what the tester does so many quarters of a bit after V(RR) is over, after a CD of the station",
       .numbers = {{"does", 0, 12, 1, kIsaPeers}, {"quarters", -64, 64, 1, kIsaAnswered}},
       .weight = 5}};
}

void expect_judgeable_entity(const fieldbus_dll::IsaConfiguration& station) {
  const fieldbus_dll::IsaRules& rules = station.rules;
  expect_time_for_answers(rules.link);
  if (rules.link.inter_pdu_delay_octets < rules.reply_forming_octets &&
      rules.reply_forming_octets < rules.reply_wait_octets)
    return expect_distinct_isa_codes(rules.codes);
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("a reply begins after V(MID), within V(FD), and is waited for longer: V(MID) is {} octets, "
                  "V(FD) {} and V(RR) {}",
                  rules.link.inter_pdu_delay_octets, rules.reply_forming_octets, rules.reply_wait_octets));
}

// Upper halves of first octets that no DLPDU has.
std::vector<OtherCodes> isa_other_codes() {
  return {{"code_*", {0x80, 0xC0, 0xF0}}};
}

}  // namespace

// What an entity has to send, holds, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_an_entity() {
  const NamedCommand data{"submit"};
  const NamedCommand asks{"submit", {{"service", 1}}};
  const NamedCommand reply{"submit", {{"service", 2}}};
  const NamedCommand token_held{"sequence", {{"silence", 4}}};
  const NamedCommand answer_due{"compel", {{"silence", 4}}};
  const NamedCommand lost{"supply"};
  return {{{"submit", {{"priority", 3}, {"size", 64}}}, data, {"submit", {{"priority", 1}}}},
          {reply, reply},
          {data, token_held},
          {reply, answer_due},
          {asks, {"single", {{"silence", 4}}}, {"one"}},  // its CD is out, and nobody has replied
          {asks, token_held, {"one"}},
          {{"peer", {{"does", 1}}}, asks},
          {{"submit", {{"times", 150}}}},
          {data, asks, reply, token_held, lost},
          {data, reply, answer_due, lost},
          {{"supply", {{"how", kSupplyGoes}}}},
          {data, {"sequence", {{"octets", 0}}}},
          // What is more urgent comes while it has the token.
          {data, data, token_held, {"one"}, {"submit", {{"priority", 3}}}},
          {reply, answer_due, {"data", {{"to", 1}, {"from", 2}, {"size", 0}}}}};
}

SequenceVocabulary isa_dle_vocabulary() {
  const fieldbus_dll::IsaConfiguration as_made;
  return {.words = isa_dle_words(),
          .unit = "octet",
          .levels_per_unit = kFlipsOfAnOctet,
          .settings = link_settings(fieldbus_dll::kIsaTable, &as_made, kBoundsOfIsaDle, isa_other_codes()),
          .objection = objection_of(fieldbus_dll::kIsaTable, as_made, expect_judgeable_entity)};
}

}  // namespace fieldproof::conformance
