#include "conformance/fieldbus_dll/isa_las_vocabulary.hpp"

#include <array>

#include "conformance/fieldbus_dll/isa_bench.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaType;

constexpr std::array<std::int64_t, 4> kIsaLasCounts{1, 2, 6, 12};
constexpr std::array<std::int64_t, 4> kIsaLasSizes{0, 1, 8, 30};
constexpr std::array<std::int64_t, 5> kIsaLasOwnSizes{0, 8, 30, 64, 65};
constexpr std::array<std::int64_t, 3> kIsaLasVersions{0, 0x0102, 0xFFFF};

SequenceNumber size_of_holder() {
  return {"size", 0, 30, 8, kIsaLasSizes};
}
SequenceNumber priority_of_isa_las() {
  return {"priority", 1, 3, 1};
}
SequenceNumber version_of_tl() {
  return {"version", 0, 0xFFFF, 1, kIsaLasVersions};
}

// Holders of sequences leave room for a station that says something else, and for a reply that does not come.
constexpr std::array kBoundsOfIsaLas{SettingBound{"preamble_octets", {1, 2}},
                                     SettingBound{"inter_pdu_delay_octets", {2, 8}},
                                     SettingBound{"reply_wait_octets", {32, 40}}};

}  // namespace

// The second of each pair is due while the first is out, two at one instant, the first one later than V(RR):
// who is handed the link has to show itself before.
IsaSchedule schedule_of_isa_las() {
  using enum fieldbus_dll::Priority;
  return {.version = 0x0102,
          .period = kPeriodOfIsaLas * kOctetAt31250,
          .items = {{60 * kOctetAt31250, IsaType::es, 0x21, time_available, 60},
                    {75 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {200 * kOctetAt31250, IsaType::es, 0x23, urgent, 100},
                    {215 * kOctetAt31250, IsaType::et, 0x21, urgent, 500},
                    {420 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {420 * kOctetAt31250, IsaType::et, 0x21, time_available, 0},
                    {430 * kOctetAt31250, IsaType::es, 0x23, time_available, 300}}};
}

// Holders were silent or kept their tokens, data wait, the link is another's, is retaken, is handed back.
std::vector<std::vector<NamedCommand>> states_of_an_isa_las() {
  return {{{"silent"}},
          {{"keep"}},
          {{"submit"}, {"submit", {{"priority", 3}}}},
          {{"prepare"}},
          {{"request", {{"outcome", 1}}}, {"obey", {{"count", 3}}}},
          {{"transfer", {{"taken", 0}}}},
          {{"transfer"}},
          {{"transfer"}, {"resume"}},
          {{"second"}},
          {{"again"}},
          {{"supply"}}};
}

SequenceVocabulary isa_las_vocabulary() {
  const fieldbus_dll::IsaConfiguration as_made;
  // In the order of IsaLasWord.
  return {
      .words =
          {{.word = "obey",
            .meaning = "so many tokens are returned at once",
            .numbers = {{"count", 1, 30, 1, kIsaLasCounts}},
            .weight = 6},
           {.word = "silent", .meaning = "the holder of the next token is silent", .weight = 6},
           {.word = "use",
            .meaning = "the next holder sends so many DUs, to the scheduler (0), another (1) or "
                       "everybody (2), or DTs that nobody compelled to the scheduler (3), and returns "
                       "its token",
            .numbers = {{"to", 0, 3, 0}, size_of_holder(), {"frames", 1, 3, 1}},
            .weight = 5},
           {.word = "keep",
            .meaning = "the next holder sends so many DUs and is silent then",
            .numbers = {size_of_holder(), {"frames", 1, 3, 1}},
            .weight = 5},
           {.word = "compel",
            .meaning = "the next holder compels a station that is silent, and returns its token",
            .weight = 2},
           {.word = "third",
            .meaning = "a third station sends an EE (0), a CD (1) or a DU for everybody (2) while a token is "
                       "out, then its holder returns it",
            .numbers = {{"kind", 0, 2, 0}},
            .weight = 3},
           {.word = "spoilt",
            .meaning = "the next holder returns its token with faults",
            .units = 8,
            .weight = 4},
           {.word = "submit",
            .meaning = "the scheduler's user submits data for a station (0), everybody (1), the first (2) "
                       "or the last address (3)",
            .numbers = {priority_of_isa_las(), {"size", 0, 260, 8, kIsaLasOwnSizes}, {"to", 0, 3, 0}},
            .weight = 6},
           {.word = "transfer",
            .meaning =
                "the user orders a TL, the last time to its heir, which is silent (0) or takes over "
                "(1) with a DU for another (0) or the scheduler (4), an EE (1), an ET (2) or a CD (3), "
                "after a DU of another (1) or what is no DLPDU (2)",
            .numbers = {{"taken", 0, 1, 1}, {"kind", 0, 4, 0}, {"orders", 1, 2, 1}, {"other", 0, 2, 0}},
            .weight = 4},
           {.word = "second",
            .meaning = "a scheduler of a higher (0), a lower (1), the last (2) or the next lower address (3) "
                       "sends an ET (0), an ES (1) or a TL (2) for another while a token is out, which is "
                       "returned then (1); before, the user orders a TL (1)",
            .numbers = {{"from", 0, 3, 1}, {"kind", 0, 2, 0}, {"returned", 0, 1, 0}, {"ordered", 0, 1, 0}},
            .weight = 4},
           {.word = "resume",
            .meaning = "the link is handed back by a TL, first to another; before, its user orders a TL (1), "
                       "which is too late; it holds a token (1) or owes a reply (2) then",
            .numbers = {version_of_tl(), {"ordered", 0, 1, 0}, {"in", 0, 2, 0}},
            .weight = 6},
           {.word = "late",
            .meaning = "the next holder returns its token so many octets before the wait for it is over",
            .numbers = {{"octets", 1, 8, 1}},
            .weight = 3},
           {.word = "overstay",
            .meaning = "the next holder sends data that begin so many octets before its token is over",
            .numbers = {{"octets", 1, 8, 1}},
            .weight = 4},
           {.word = "ask",
            .meaning =
                "the next holder compels the scheduler, and after the reply returns its token (1) or is "
                "silent (0)",
            .numbers = {priority_of_isa_las(), {"returned", 0, 1, 1}},
            .weight = 4},
           {.word = "prepare",
            .meaning = "the scheduler's user submits data for a CD",
            .numbers = {priority_of_isa_las(), {"size", 0, 64, 8, kIsaLasSizes}},
            .weight = 3},
           {.word = "request",
            .meaning =
                "the scheduler's user submits a CD; the station replies (0), is silent (1), sends a DU "
                "(2), another replies (3), the reply is no DLPDU (4), ends after V(RR) (5), is urgent "
                "(6), there is a TL in its place (7), or an ET of a scheduler with a higher (8) or a lower "
                "address (9)",
            .numbers = {priority_of_isa_las(), {"outcome", 0, 9, 0}},
            .weight = 5},
           {.word = "again",
            .meaning = "a TL for the scheduler while it is that and a token is out",
            .numbers = {version_of_tl()},
            .weight = 3},
           {.word = "end",
            .meaning =
                "the next holder returns its token with this reason to the scheduler (0) or another (1)",
            .numbers = {{"reason", 0, 2, 0}, {"to", 0, 1, 0}},
            .weight = 3},
           {.word = "pause",
            .meaning = "so many octet durations pass, or until the scheduler has said something",
            .numbers = {{"octets", 1, 100, 20}},
            .weight = 3},
           {.word = "supply",
            .meaning = "the supply goes, and comes after so many octet durations",
            .numbers = {{"octets", 1, 100, 20}},
            .weight = 2,
            .is_loss = true}},
      .unit = "octet",
      .levels_per_unit = kFlipsOfAnOctet,
      .settings = sequence_settings(fieldbus_dll::kIsaTable, &as_made, kFixedOfLink, kBoundsOfIsaLas),
      .objection = objection_of(fieldbus_dll::kIsaTable, as_made, expect_judgeable_isa)};
}

}  // namespace fieldproof::conformance
