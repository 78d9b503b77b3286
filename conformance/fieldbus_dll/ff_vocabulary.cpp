#include "conformance/fieldbus_dll/ff_vocabulary.hpp"

#include <array>
#include <string_view>

#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"
#include "conformance/sequence_settings.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 16> kFfNodes{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4};
constexpr std::array<std::int64_t, 10> kFfProbedNodes{0, 0, 0, 0, 2, 2, 2, 1, 3, 4};
constexpr std::array<std::int64_t, 28> kFfBuffers{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1,  1,  1,
                                                  1, 2, 2, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
constexpr std::array<std::int64_t, 14> kFfWritten{0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 3, 10, 11, 12};
constexpr std::array<std::int64_t, 20> kFfPublishers{0, 0, 0, 0, 1, 1, 1,  2,  3,  4,
                                                     5, 2, 6, 7, 8, 9, 10, 11, 12, 13};
constexpr std::array<std::int64_t, 12> kFfWriteSizes{0, 1, 2, 8, 9, 64, 65, 99, 100, 101, 127, 128};
constexpr std::array<std::int64_t, 16> kFfPriorities{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 0};
constexpr std::array<std::int64_t, 12> kFfRequestPriorities{1, 2, 3, 1, 2, 3, 2, 3, 2, 3, 0, 4};
constexpr std::array<std::int64_t, 20> kFfDurations{
    1, 12, 13, 14, 15, 20, 28, 29, 30, 31, 60, 61, 127, 200, 256, 1'000, 4'096, 32'768, 33'000, 65'535};
constexpr std::array<std::int64_t, 12> kFfSizes{0, 1, 2, 8, 9, 10, 65, 100, 101, 128, 129, 256};
constexpr std::array<std::int64_t, 8> kFfTimes{1, 1, 1, 1, 1, 1, 40, 150};
constexpr std::array<std::int64_t, 8> kFfWrites{1, 1, 1, 1, 2, 2, 128, 255};
constexpr std::array<std::int64_t, 8> kFfControls{0x38, 0x39, 0x3A, 0x3B, 0x3D, 0x30, 0x35, 0xB1};
constexpr std::array<std::int64_t, 4> kFfAsked{0, 0, 1, 2};
constexpr std::array<std::int64_t, 8> kFfEnding{0, 0, 0, 1, 2, 3, 8, 9};
constexpr std::array<std::int64_t, 8> kFfBeside{-2, -1, -1, 1, 1, 2, -32, 32};
constexpr std::array<std::int64_t, 4> kFfMany{1, 2, 40, 260};
constexpr std::array<std::int64_t, 6> kFfRequests{kOrderOfAMaster, 4, 7, 255, 1, 2};
constexpr std::array<std::int64_t, 2> kFfMinutes{1, 72};
// Each of them so that there is time left for the others as they are.
constexpr std::array kBoundsOfFfDevice{SettingBound{"inter_pdu_delay_octets", {1, 24}}};
SequenceNumber ff_priority(std::string_view name = "priority") {
  return {name, 0, 3, 2, kFfPriorities, true};
}
SequenceNumber ff_truth(std::string_view name) {
  return {name, 0, 1, 0};
}
SequenceNumber ff_node() {
  return {"node", 0, 4, 0, kFfNodes, true};
}

void expect_judgeable_device(const fieldbus_dll::FfConfiguration& device) {
  expect_time_for_answers(device.rules.link);
}

std::vector<SequenceWord> ff_device_words() {
  // In the order of FfWord.
  return {
      {.word = "token",
       .meaning = "a PT for what is at least as urgent; to the device, or to others",
       .numbers = {ff_node(),
                   ff_priority("least"),
                   {"octets", 0, 65'535, 200, kFfDurations},
                   ff_truth("first"),
                   link_length(),
                   link_silence()},
       .units = 8,
       .weight = 20},
      {.word = "compel",
       .meaning = "a CD for a buffer of the device, or for other addresses",
       .numbers = {{"buffer", 0, 12, 0, kFfBuffers, true},
                   ff_priority(),
                   ff_truth("final"),
                   link_length(),
                   link_silence()},
       .units = 7,
       .weight = 18},
      {.word = "probe",
       .meaning = "a PN, to the device, or to others",
       .numbers = {{"node", 0, 4, 0, kFfProbedNodes, true}, link_length(), link_silence()},
       .units = 6,
       .weight = 5},
      {.word = "other",
       .meaning = "TD, CL, TL, RT, SR, RI, PR, CT, IDLE, or what is none, with this in its last octet",
       .numbers = {{"kind", 0, 11, 0}, {"value", 0, 255, 1}, link_length(), link_silence()},
       .units = 7,
       .weight = 8},
      {.word = "data",
       .meaning = "a DT1 to the device, to all or to others, from a user or an entity",
       .numbers = {{"to", 0, 9, 0},
                   {"from", 0, 4, 0},
                   ff_priority(),
                   ff_truth("final"),
                   {"first", 0, kSameAgain, 0},
                   {"size", 0, 260, 8, kFfSizes},
                   link_silence()},
       .units = 11,
       .weight = 9},
      {.word = "published",
       .meaning = "a DT3 to which the device has subscribed, or another",
       .numbers = {{"from", 0, 13, 0, kFfPublishers, true},
                   ff_priority(),
                   ff_truth("final"),
                   {"number", 0, 255, 1},
                   {"size", 0, 260, 8, kFfSizes},
                   link_silence()},
       .units = 10,
       .weight = 6},
      {.word = "activation",
       .meaning = "a DT1 of the scheduler's entity to that of the device: 01, and more",
       .numbers = {ff_priority(), {"long", 0, 1, 0}, {"more", 0, 2, 0}, link_silence()},
       .units = 11,
       .weight = 6},
      link_noise(),
      {.word = "submit",
       .meaning = "the user submits data for another node, so many times",
       .numbers = {{"priority", 0, 4, 2, kFfRequestPriorities},
                   {"to", 0, 4, 0},
                   {"size", 0, 260, 8, kFfSizes},
                   {"times", 1, 300, 1, kFfTimes, true}},
       .weight = 20},
      {.word = "write",
       .meaning = "the user writes a buffer, so many times",
       .numbers = {{"buffer", 0, 12, 0, kFfWritten, true},
                   {"size", 0, 257, 8, kFfWriteSizes},
                   {"times", 1, 300, 1, kFfWrites},
                   ff_truth("same")},
       .weight = 18},
      link_supply(),
      link_one(),
      link_wait(),
      link_framed(),
      link_checked(),
      {.word = "control",
       .meaning = "this first octet, with what makes a PT for the device after it",
       .numbers = {{"octet", 0, 255, 0x38, kFfControls}, link_silence()},
       .units = 8,
       .weight = 4},
      {.word = "ended",
       .meaning = "0: a PT for the device, 1: a CD, 2: a PN; then, before it may begin, what \"other\" sends",
       .numbers = {{"asks", 0, 2, 0, kFfAsked}, {"kind", 0, 11, 0, kFfEnding}, {"value", 0, 255, 1}},
       .weight = 6},
      {.word = "busy",
       .meaning = "a PN or a CD for the device, after which the line is busy, so that V(MID) is over so "
                  "many quarters of a bit after V(MRD) x V(ST)",
       .numbers = {{"asks", 1, 2, 2}, {"quarters", -64, 64, -1, kFfBeside}, ff_truth("check")},
       .weight = 7},
      {.word = "room",
       .meaning = "a PT for the device, after which the line is busy, so that 0: an RT, 1: data of 8 octets "
                  "would end so many quarters of a bit after the token does",
       .numbers = {ff_truth("data"), {"quarters", -64, 64, 1, kFfBeside}},
       .weight = 5},
      {.word = "many",
       .meaning = "a PN for another, so many times, and one for the device",
       .numbers = {{"times", 1, 300, 1, kFfMany, true}},
       .weight = 2},
      {.word = "ask",
       .meaning = "the user asks for what there is not, 3: for what a link master does, with so many octets "
                  "more; 1 and 2: to submit and to write, with 3 octets more at most, which is no address",
       .numbers = {{"request", 0, 255, 7, kFfRequests}, {"more", 0, 6, 1}},
       .weight = 2},
      {.word = "beside",
       .meaning = "a PT for the device; beside what it sends first the user submits data; then another PT",
       .numbers = {{"priority", 1, 3, 2}, {"size", 0, 64, 8, kFfSizes}},
       .weight = 4},
      link_received(),
      link_in_front(),
      {.word = "within",
       .meaning =
           "a PT for the device; when two octets of what it sends are on the line, a DT1 of another for "
           "its user begins, which nobody receives who sends",
       .numbers = {{"size", 0, 260, 60, kFfSizes}},
       .weight = 3,
       .is_no_frame = true},
      {.word = "meanwhile",
       .meaning = "within a DT1 of another to another the user submits data and writes a buffer",
       .numbers = {{"priority", 1, 3, 2}, {"size", 0, 64, 8, kFfSizes}},
       .weight = 3},
      {.word = "idle",
       .meaning = "so many minutes of silence",
       .numbers = {{"minutes", 1, 80, 72, kFfMinutes}},
       .weight = 1}};
}

// First octets that no DLPDU has, for some of them; and nodes of which no other here is one.
std::vector<OtherCodes> ff_other_codes() {
  return {{"code_cd", {0xC0}}, {"code_pt", {0x40}}, {"code_td", {0x19}}, {"node", {0x7F, 0x80, 0xF7, 0xFF}}};
}

}  // namespace

// What a device has to send, holds, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_a_device() {
  const NamedCommand large{"submit", {{"priority", 3}, {"size", 64}}};
  const NamedCommand usual{"submit"};
  const NamedCommand small{"submit", {{"priority", 1}, {"size", 1}}};
  const NamedCommand written{"write"};
  const NamedCommand token_held{"token", {{"silence", 4}}};
  const NamedCommand answer_due{"compel", {{"silence", 4}}};
  const NamedCommand probed{"probe", {{"silence", 4}}};
  const NamedCommand lost{"supply"};
  return {{large, usual, small},  // data of each priority
          {written,
           {"write", {{"buffer", 1}, {"times", 2}, {"same", 1}}},
           {"write", {{"buffer", 2}}}},  // what it publishes
          {written, answer_due},
          {usual, token_held},
          {probed},
          {large, usual, written, token_held, lost},
          {large, usual, written, answer_due, lost, {"activation"}},
          {lost, {"activation", {{"priority", 3}, {"long", 1}, {"more", 2}}}},
          {{"published"}, {"data"}},
          {{"supply", {{"how", kSupplyGoes}}}},
          // What is no activation: another SPDU, and one for everybody.
          {lost, {"data", {{"to", 2}, {"from", 1}, {"first", 3}}}},
          {lost, {"data", {{"to", 1}, {"from", 1}, {"first", 2}}}},
          {written, answer_due, written}};  // and while it is due, another value
}

SequenceVocabulary ff_device_vocabulary() {
  const fieldbus_dll::FfConfiguration as_made;
  return {.words = ff_device_words(),
          .unit = "octet",
          .levels_per_unit = kFlipsOfAnOctet,
          .settings = link_settings(fieldbus_dll::kFfTable, &as_made, kBoundsOfFfDevice, ff_other_codes()),
          .objection = objection_of(fieldbus_dll::kFfTable, as_made, expect_judgeable_device)};
}

}  // namespace fieldproof::conformance
