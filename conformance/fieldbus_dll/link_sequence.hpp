#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/sequence_settings.hpp"

// What sequences of every profile of the data link have in common: the silence after a command, and how it
// is put on the line with its faults. A unit is an octet of a frame, its delimiters included; the preamble is
// none, because of a frame with a part of it any receiver may hear the rest.
namespace fieldproof::conformance {

inline constexpr unsigned kHalfBitsOfAnOctet = 16;
// What a flip can hit: a half bit, which breaks the code, and after those a whole bit, which only the frame
// check sees. Of whole bits two are flipped at most: the check sees any three of a frame.
inline constexpr unsigned kFlipsOfAnOctet = kHalfBitsOfAnOctet + 8;

// The tester waits until the station has nothing more to say. Else it goes on after so many octet durations,
// less than V(MID), before the station may begin.
inline constexpr std::int64_t kLinkSettles = 100;

// Who is on the link and what a DLPDU is called is the tester's, too.
inline constexpr std::array<std::string_view, 9> kFixedOfLink{
    "code_*", "first_node", "last_node",  "first_address",      "last_address",
    "node",   "address",    "schedule_*", "begins_as_scheduler"};

// Throws kernel::Error(configuration) where a station may not begin within the time in which it has to.
void expect_time_for_answers(const fieldbus_dll::LinkRules& link);

// After what the command sends, to the next.
SequenceNumber link_silence();
// Octets that a DLPDU has too much, or that its end lacks, before its check.
SequenceNumber link_length();
// What becomes of the supply.
inline constexpr std::int64_t kSupplyGoes = 0;
inline constexpr std::int64_t kSupplyComes = 1;
inline constexpr std::int64_t kSupplyReturns = 2;  // it goes and comes
SequenceWord link_supply();
template <typename Bench, typename Model>
void switch_supply(std::int64_t how, Bench& bench, Model& model) {
  for (const bool is_on : {false, true}) {
    if (how == (is_on ? kSupplyGoes : kSupplyComes) || is_on == model.has_supply()) continue;
    bench.set_supply(is_on);
    model.set_supply(is_on);
  }
}
// Silence of timers of 16 bits in microseconds, of a second, of ten.
SequenceWord link_wait();
SequenceWord link_noise();
SequenceWord link_one();

// Settings that are codes of DLPDUs, "code_*", and others that no DLPDU has.
struct OtherCodes {
  std::string_view names;
  std::vector<std::int64_t> values;
};
// Those of the table that a sequence may begin with; and the codes at the end, so that what was stored before
// keeps its places.
std::vector<SequenceSetting> link_settings(const field::AnyTable& table, const void* as_made,
                                           std::span<const SettingBound> bounds,
                                           std::span<const OtherCodes> codes);
Octets with_length(Octets dlpdu, std::int64_t more);
// Of so many octets: levels that are no frame.
void send_noise(LinkBench& bench, std::int64_t octets);

// What its user was given is what it must have been given, in that order.
template <typename Report>
void judge_reported(CaseJudge& judge, const std::vector<Report>& right, const std::vector<Report>& actual,
                    kernel::Time now) {
  const auto [wrong, other] = std::ranges::mismatch(right, actual);
  const bool is_all = wrong == right.end();
  const bool is_none = other == actual.end();
  if (is_all && is_none) return;
  judge.fail(is_none  ? "not_delivered"
             : is_all ? "delivered_unasked"
                      : "delivered_otherwise",
             {{is_all ? "nothing more is given to its user" : "its user is given: " + wrong->text()},
              is_none ? "nothing" : other->text(),
              now});
}

// Sends the octets in a frame, their check after them. False: with faults, after which it is no frame to
// anybody.
bool send_link_command(LinkBench& bench, const Octets& octets, const SequenceCommand& command);

// How data of a user lie in their transmission, before the silence. 1 to 7: with so many bits more in front
// of the end delimiter, which is no frame; then after a start delimiter and some octets of a frame that does
// not end, and after a whole frame for another.
inline constexpr std::int64_t kAfterAStart = 8;
inline constexpr std::int64_t kAfterAnother = 9;
// A start delimiter within an octet of another frame; behind another frame for the station; in levels of an
// eighth of a half bit; after two frames for another.
inline constexpr std::int64_t kWithinAnOctet = 10;
inline constexpr std::int64_t kTwoOfThem = 11;
inline constexpr std::int64_t kFinely = 12;
inline constexpr std::int64_t kAfterTwoOthers = 13;
SequenceWord link_framed();
// Sends `octets` so, `other` before it where two are sent; gives the DLPDUs that every receiver has to take.
std::vector<Octets> send_framed(LinkBench& bench, std::int64_t framing, const Octets& other,
                                const Octets& octets);

}  // namespace fieldproof::conformance
