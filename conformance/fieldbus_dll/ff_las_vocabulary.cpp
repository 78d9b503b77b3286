#include "conformance/fieldbus_dll/ff_las_vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::array<std::int64_t, 4> kLasCounts{1, 2, 5, 30};
constexpr std::array<std::int64_t, 4> kLasNodes{0, 0, 1, 2};
constexpr std::array<std::int64_t, 4> kLasSizes{0, 1, 8, 64};
constexpr unsigned kMostLater = 20;
constexpr std::array<std::int64_t, 3> kLasDelays{0, 0, 16};

constexpr std::array<std::int64_t, 9> kLasParts{0, 0, 4, 16, 20, 28, 31, kPartsOfClaim, kPartsOfClaim};
// The last ones make link time longer than 32 bits, at once and a part of a second later.
constexpr std::int64_t kMostJump = 0x2'0000'0000;
constexpr std::array<std::int64_t, 12> kLasJumps{
    0, 1, 2, 330, 1'234, 3'300, 6'399, 40'000, kMostJump, 0xFFFF'C000, 0xFFFF'8000, 0xFFFF'0000};
constexpr std::array<std::int64_t, 3> kLasVersions{0, 0, 1};
constexpr std::array<std::int64_t, 6> kLasLeft{0, 4, 12, 19, 20, 28};

SequenceNumber las_item() {
  return {"item", 0, kItemsOfLas.size() - 1, 0};
}
SequenceNumber las_node() {
  return {"node", 0, kNodesOfLas.size() - 1, 0, kLasNodes};
}
SequenceNumber las_parts() {
  return {"silence", 0, kPartsOfClaim, 0, kLasParts};
}
SequenceNumber las_delay() {
  return {"later", 0, kMostLater, 0, kLasDelays};
}

// The schedule of the tester is for this rate, and has room for so much between two items; nobody waits for
// what comes once an hour, and what is told oftener than an item takes cannot be told in time.
constexpr std::array kBoundsOfLas{
    SettingBound{"bit_rate", {31'250, 31'250}}, SettingBound{"slot_time_octets", {1, 16}},
    SettingBound{"least_token_octets", {32, 200}}, SettingBound{"scheduling_overhead_octets", {0, 24}},
    SettingBound{"time_distribution_period", field::between(kernel::kSecond, 3'600 * kernel::kSecond)}};

void expect_judgeable_las(const FfConfiguration& las) {
  expect_time_for_answers(las.rules.link);
  const fieldbus_dll::LinkRules& link = las.rules.link;
  const unsigned taken =
      link.inter_pdu_delay_octets + std::max(kMostLater, las.rules.scheduling_overhead_octets);
  if (link.response_delay_slots * link.slot_time_octets >= taken + octets_around(link) + 1 &&
      las.rules.least_token_octets <= las.rules.token_holding_octets)
    return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("within V(MRD) x V(ST) lie V(MID), V(MSO) and the {} octets after which nodes of "
                  "sequences answer; V(DMDT) is at most V(DTHT)",
                  kMostLater));
}

}  // namespace

void network_of_las(FfConfiguration& configuration) {
  configuration.live = {kNodesOfLas[0], kNodesOfLas[1]};
  configuration.rules.first_unpolled = 0x15;
  configuration.rules.unpolled = 0xE0;
  // More than a circulation takes whose tokens are returned at once, whatever is compelled and told in it;
  // less than one with a token that is spent.
  configuration.rules.target_rotation = 330 * kOctetAt31250;
  configuration.rules.time_distribution_period = 2 * kernel::kSecond;
  // The third is due with the second, and its own buffers while the third is answered.
  configuration.schedule = {.version = 1,
                            .macrocycle = kMacrocycleOfLas,
                            .items = {{0, kItemsOfLas[0], Priority::normal},
                                      {3'200, kItemsOfLas[1], Priority::urgent},
                                      {3'200, kItemsOfLas[2], Priority::time_available},
                                      {3'400, kOwnBuffersOfLas[0], Priority::urgent},
                                      {3'400, kOwnBuffersOfLas[1], Priority::time_available}}};
  configuration.published = {kOwnBuffersOfLas[0], kOwnBuffersOfLas[1]};
}

// Who is live changes, data wait, the link is another's, is claimed, is handed on.
std::vector<std::vector<NamedCommand>> states_of_a_master() {
  const NamedCommand displaced{"second"};
  const NamedCommand told_time{"second", {{"kind", 4}, {"jump", 1'234}, {"silence", 4}}};
  return {{{"silent", {{"tokens", 2}}}, {"obey", {{"count", 5}}}},
          {{"join"}, {"obey", {{"count", 5}}}},
          // Found, and removed again.
          {{"join", {{"node", 2}}},
           {"obey", {{"count", 20}}},
           {"silent", {{"node", 2}, {"tokens", 2}}},
           {"silent", {{"node", 2}}},
           {"obey", {{"count", 20}}},
           {"join", {{"node", 2}}},
           {"obey", {{"count", 20}}}},
          {{"submit"}, {"submit", {{"priority", 1}}}, {"write"}},
          {{"spend"}, {"spend"}},
          {displaced},
          {displaced, told_time},
          {displaced, {"told", {{"nodes", 6}, {"silence", 4}}}},
          {displaced, {"hand"}},
          {displaced, {"order", {{"sends", 4}}}},
          {{"join"}, {"obey", {{"count", 20}}}, {"supply"}},
          {{"order", {{"sends", 4}}}, displaced},
          {{"order", {{"sends", 0}}}},
          {{"order"}}};
}

SequenceVocabulary ff_las_vocabulary() {
  fieldbus_dll::FfConfiguration as_given;
  network_of_las(as_given);
  // In the order of LasWord.
  return {
      .words =
          {{.word = "obey",
            .meaning = "so many DLPDUs of the scheduler are answered as nodes do",
            .numbers = {{"count", 1, 60, 1, kLasCounts}},
            .weight = 6},
           {.word = "silent",
            .meaning = "a node does not answer its next tokens",
            .numbers = {las_node(), {"tokens", 1, 2, 1}},
            .weight = 8},
           {.word = "join", .meaning = "a node answers its next probe", .numbers = {las_node()}, .weight = 4},
           {.word = "ignore",
            .meaning = "the next CD of an item is not answered",
            .numbers = {las_item()},
            .weight = 3},
           {.word = "refuse",
            .meaning = "the next CD of an item is answered by SR, with a reason that there is, or 2: none",
            .numbers = {las_item(), {"reason", 0, 2, 1}, las_delay()},
            .units = 6,
            .weight = 1},
           {.word = "publish",
            .meaning = "the next CD of an item is answered with so many octets",
            .numbers = {las_item(), {"size", 0, 64, 8, kLasSizes}, las_delay()},
            .units = 8,
            .weight = 2},
           {.word = "use",
            .meaning =
                "under the next token one DT1 is sent, which 1: returns it; 0: an RT does, 2: nobody does",
            .numbers = {{"size", 2, 32, 2}, {"final", 0, 2, 1}, las_delay()},
            .units = 11,
            .weight = 3},
           {.word = "spend", .meaning = "the next token is held to its end, with data", .weight = 4},
           {.word = "ask_time",
            .meaning = "under the next token the time is asked for",
            .numbers = {las_delay()},
            .units = 6,
            .weight = 3},
           {.word = "submit",
            .meaning = "the user submits data for another node",
            .numbers = {{"priority", 1, 3, 3}, {"size", 2, 66, 8, kLasSizes}},
            .weight = 4},
           {.word = "write",
            .meaning = "the user writes one of two buffers that the schedule has",
            .numbers = {{"buffer", 0, 1, 0}, {"size", 0, 66, 8, kLasSizes}},
            .weight = 3},
           {.word = "overstay",
            .meaning = "the next token is held beyond its end, and data end so many octets behind "
                       "that and a slot time",
            .numbers = {{"later", 1, 20, 1}},
            .weight = 3},
           {.word = "usurp",
            .meaning = "another node than who is asked 0: returns the next token, 1: answers the "
                       "next probe, 2: sends data in place of the next reply to a CD",
            .numbers = {{"probe", 0, 2, 0}, las_delay()},
            .weight = 4},
           {.word = "order",
            .meaning = "the user orders to hand the link to a node, which is silent (0), probes another (1) "
                       "or this one (2), sends an RT (3); 4: the order is not waited for",
            .numbers = {las_node(), {"sends", 0, 4, 1}},
            .weight = 3},
           {.word = "second",
            .meaning =
                "another scheduler sends 0: CL, 1: PT for a node, 2: PN for it, 3: PN for "
                "this one, 4: TD with a jump of link time, 5: CD, 6: IDLE, 7: PT with a duration of 0, "
                "8: CD for a buffer of this one; in standby after "
                "so many 32nds of the silence that claims the link, 32: an octet less",
            .numbers = {{"kind", 0, 8, 0}, las_node(), {"jump", 0, kMostJump, 0, kLasJumps}, las_parts()},
            .weight = 5},
           {.word = "told",
            .meaning = "another scheduler tells which of the nodes are live, a bit each",
            .numbers = {{"nodes", 0, 31, 3}, las_parts()},
            .weight = 2},
           {.word = "noise",
            .meaning = "in standby, levels that are no frame",
            .numbers = {{"octets", 1, 20, 4}, las_parts()},
            .weight = 3,
            .is_no_frame = true},
           {.word = "hand",
            .meaning = "another scheduler hands the link over, to this one (0) or a node, for the "
                       "schedule (0) or so many versions later",
            .numbers = {{"to", 0, 1, 0}, {"version", 0, 0xFFFF, 0, kLasVersions}, las_parts()},
            .units = 8,
            .weight = 6},
           {.word = "flood",
            .meaning = "the user submits so many data at once",
            .numbers = {{"priority", 1, 3, 3}, {"count", 2, 12, 6}, {"size", 0, 64, 64, kLasSizes}},
            .weight = 3},
           {.word = "ask_late",
            .meaning =
                "the time is asked for, for a node that is live or for another, so many octets before the "
                "end of the next token that an item cuts",
            .numbers = {{"left", 0, 40, 12, kLasLeft}, {"other", 0, 1, 0}},
            .weight = 3},
           {.word = "entity",
            .meaning =
                "under the next token the holder's entity sends what no entity knows, to this one's or "
                "to everybody's",
            .numbers = {{"everybody", 0, 1, 0}},
            .weight = 2},
           {.word = "supply",
            .meaning = "the supply goes, and comes after so many octet durations",
            .numbers = {{"octets", 1, 400, 20}},
            .weight = 1}},
      .unit = "octet",
      .levels_per_unit = kFlipsOfAnOctet,
      .settings = sequence_settings(fieldbus_dll::kFfTable, &as_given, kFixedOfLink, kBoundsOfLas),
      .objection = objection_of(fieldbus_dll::kFfTable, as_given, expect_judgeable_las)};
}

}  // namespace fieldproof::conformance
