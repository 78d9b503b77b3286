#include "conformance/valve_bus/node_expect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "conformance/valve_bus/node_lateness.hpp"

namespace fieldproof::conformance {
namespace {

using Change = segment::ProcessWords::Change;

std::string change_text(const Change& change) {
  return fmt::format("{} became {:02X} {:02X} at {}", valves_text(change.before), change.after & 0xFF,
                     change.after >> 8, kernel::describe(change.when));
}

std::string octets_text(const std::vector<std::uint8_t>& octets) {
  return fmt::format("{:02X}", fmt::join(octets, " "));
}

// "2.1 ms", and how far it may be off.
std::string instant_text(kernel::Duration measured, const iut::TimingUncertainty& doubt) {
  if (doubt.earlier + doubt.later == kernel::Duration{}) return kernel::describe(measured);
  return fmt::format("{} to {}", kernel::describe(measured - doubt.earlier),
                     kernel::describe(measured + doubt.later));
}

// What a right node says about itself while it drives.
void expect_driver(NodeBench& bench, CaseJudge& judge, const Transmission& answer) {
  if (!bench.capabilities().driver_control) return;
  const valve_bus::Rules& rules = bench.rules();
  const kernel::Duration before = answer.characters.front().start - answer.driver_on;
  const kernel::Duration behind = answer.driver_off - answer.characters.back().busy_until;
  judge.expect(before + kRounding >= bench.bits(rules.driver_on_bits), "driver_on_late", [&] {
    return Mismatch{
        {fmt::format("the driver is on at least {} bit before the start bit", rules.driver_on_bits)},
        fmt::format("{} before it", kernel::describe(before)),
        answer.driver_on};
  });
  judge.expect(behind <= bench.bits(rules.driver_off_bits) + kRounding, "driver_not_released", [&] {
    return Mismatch{
        {fmt::format("the driver is off at most {} bits after the last stop bit", rules.driver_off_bits)},
        fmt::format("{} after it", kernel::describe(behind)),
        answer.driver_off};
  });
}

void expect_no_gap(NodeBench& bench, CaseJudge& judge, const Transmission& answer) {
  judge.expect(answer.longest_gap() <= valve_bus::longest_gap(bench.rules()) + kRounding, "gap_in_answer",
               [&] {
                 return Mismatch{{fmt::format("at most {} between two characters of an answer",
                                              kernel::describe(valve_bus::longest_gap(bench.rules())))},
                                 kernel::describe(answer.longest_gap()),
                                 answer.characters.front().start};
               });
}

void expect_octets(NodeBench& bench, CaseJudge& judge, const Transmission& answer, std::uint8_t data0,
                   std::uint8_t data1) {
  const std::vector<std::uint8_t> octets = answer.octets();
  const std::array<std::uint8_t, 3> wanted{data0, data1, static_cast<std::uint8_t>(data0 ^ data1)};
  const auto sighting = [&](const char* difference) {
    return [&, difference] {
      return Mismatch{.expected = {fmt::format("{:02X}", fmt::join(wanted, " "))},
                      .actual = octets_text(octets),
                      .time = answer.driver_on,
                      .first_difference = difference};
    };
  };
  judge.expect(octets.size() == wanted.size(), "answer_length_wrong", sighting("number of octets"));
  judge.expect(std::ranges::all_of(answer.characters, &DrivenCharacter::is_good), "answer_garbled",
               sighting("parity or stop bit"));
  // Of a node whose switches cannot be seen, any data with a check that fits.
  const bool is_known = bench.capabilities().process_side;
  judge.expect(!is_known || octets[0] == wanted[0], "answer_data_wrong", sighting("DATA0"));
  judge.expect(!is_known || octets[1] == wanted[1], "answer_data_wrong", sighting("DATA1"));
  judge.expect(octets[2] == (octets[0] ^ octets[1]), "answer_check_wrong", sighting("BCC"));
  const bool has_ninth_bit = std::ranges::all_of(answer.characters, [&](const DrivenCharacter& one) {
    return one.data == uart(bench.rules()).character_of(one.octet());
  });
  judge.expect(has_ninth_bit, "ninth_bit_wrong", "a ninth bit of 1 in each character", "one of 0");
}

// The valves move to these, all at once and in time after a write that has `arrived`.
void expect_moves_of_write(NodeBench& bench, CaseJudge& judge, std::uint16_t wanted, kernel::Time arrived) {
  const kernel::Duration doubt = bench.uncertainty_of_valves().later;
  const kernel::Duration limit = limit_of_moves(bench);
  const auto& changes = bench.boards().changes();
  // What an earlier write asked for says nothing of this one.
  if (!changes.empty()) expect_move_not_late(bench, judge, changes.front().after, changes.front().when);
  if (bench.valves() != wanted) {
    const ValveMove seen{bench.now(), 0, bench.valves()};
    expect_not_late(bench, judge, wanted);
    if (changes.empty())
      judge.fail("write_not_taken", {{valves_text(wanted)}, valves_text(seen.after), seen.when});
    // A wrong value may come late, too.
    const bool is_right_again = bench.valves() == wanted;
    judge.fail("valves_wrong", {{valves_text(wanted)},
                                valves_text(is_right_again ? seen.after : bench.valves()),
                                is_right_again ? seen.when : bench.now()});
  }
  if (changes.empty()) return;
  const Change& first = changes.front();
  const Change& last = changes.back();
  judge.expect(first.when + doubt + kRounding >= arrived, "valves_too_early", [&] {
    return Mismatch{{"no valve moves before the check has come"}, change_text(first), first.when};
  });
  judge.expect(last.when - arrived <= limit + kRounding, "valves_too_late", [&] {
    return Mismatch{
        {limit_of_moves_text(bench)}, late_move_text(bench, last.after, last.when - arrived), last.when};
  });
  bench.note_instant(first.when + kRounding >= arrived && last.when + doubt - arrived <= limit + kRounding,
                     bench.uncertainty_of_valves());
  judge.expect(last.when - first.when <= bench.rules().output_skew, "valves_one_by_one", [&] {
    return Mismatch{{fmt::format("all valves move within {}", kernel::describe(bench.rules().output_skew))},
                    fmt::format("within {}", kernel::describe(last.when - first.when)),
                    last.when};
  });
}

}  // namespace

std::string valves_text(std::uint16_t valves) {
  return fmt::format("valves {:02X} {:02X}", valves & 0xFF, valves >> 8);
}

Transmission expect_one_answer(NodeBench& bench, CaseJudge& judge, std::uint8_t data0, std::uint8_t data1,
                               kernel::Time end) {
  const std::vector<Transmission> answers = bench.answers();
  judge.expect(!answers.empty() && !answers.front().characters.empty(), "no_answer",
               "one answer of three octets", "the node did not say anything");
  const Transmission& answer = answers.front();
  judge.expect(answers.size() == 1, "answered_twice", [&] {
    return Mismatch{{"one answer"}, fmt::format("{} transmissions", answers.size()), answers[1].driver_on};
  });
  expect_octets(bench, judge, answer, data0, data1);
  const kernel::Duration turnaround_time = answer.characters.front().start - (end + bench.distance());
  const iut::TimingUncertainty doubt = bench.doubt_of(answer);
  const kernel::Duration least = bench.delimiter();
  const kernel::Duration most = least + turnaround_time_span(bench.rules());
  const auto sighting = [&] {
    return Mismatch{{fmt::format("the first start bit {} to {} after the last stop bit of the command",
                                 kernel::describe(least), kernel::describe(most))},
                    instant_text(turnaround_time, doubt),
                    answer.characters.front().start};
  };
  judge.expect(turnaround_time + doubt.later + kRounding >= least, "answer_too_early", sighting);
  judge.expect(turnaround_time - doubt.earlier <= most + kRounding, "answer_too_late", sighting);
  bench.note_instant(turnaround_time - doubt.earlier + kRounding >= least &&
                         turnaround_time + doubt.later <= most + kRounding,
                     doubt);
  expect_driver(bench, judge, answer);
  expect_no_gap(bench, judge, answer);
  return answer;
}

void expect_valves(NodeBench& bench, CaseJudge& judge, std::uint16_t valves, std::string_view reason) {
  bench.require(&iut::Capabilities::process_side);
  const std::uint16_t seen = bench.valves();
  if (seen == valves) return;
  const kernel::Time when = bench.now();
  expect_not_late(bench, judge, valves);
  judge.fail(reason, {{valves_text(valves)}, valves_text(seen), when});
}

void expect_no_valve_moved(NodeBench& bench, CaseJudge& judge, std::string_view reason,
                           std::string_view why_not) {
  if (!bench.capabilities().process_side) return;  // what cannot be seen is not judged
  if (bench.boards().changes().empty()) return;
  const Change change = bench.boards().changes().front();
  expect_move_not_late(bench, judge, change.after, change.when);
  judge.fail(reason, {{fmt::format("no valve moves: {}", why_not)}, change_text(change), change.when});
}

void expect_silence(NodeBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why_not) {
  judge.expect(!bench.has_driven(), reason, [&] {
    const Transmission first = bench.answers().front();
    return Mismatch{{fmt::format("the node does not drive the line: {}", why_not)},
                    fmt::format("it said {}", octets_text(first.octets())),
                    first.driver_on};
  });
}

void expect_ignored(NodeBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why_not) {
  expect_no_valve_moved(bench, judge, reason, why_not);
  expect_silence(bench, judge, reason, why_not);
}

void expect_write_taken(NodeBench& bench, CaseJudge& judge, std::uint8_t data0, std::uint8_t data1,
                        kernel::Time end) {
  bench.require(&iut::Capabilities::process_side);
  expect_moves_of_write(bench, judge, bench.valves_of(data0, data1), end + bench.distance());
  if (bench.rules().answers_writes) {
    expect_one_answer(bench, judge, data0, data1, end);
  } else {
    expect_silence(bench, judge, "write_answered", "a write is not answered");
  }
}

Transmission expect_answer(NodeBench& bench, CaseJudge& judge, std::uint16_t switches, kernel::Time end) {
  const std::uint16_t seen = bench.configuration().boards == 1 ? switches & 0xFF : switches;
  return expect_one_answer(bench, judge, static_cast<std::uint8_t>(seen & 0xFF),
                           static_cast<std::uint8_t>(seen >> 8), end);
}

void expect_serves(NodeBench& bench, CaseJudge& judge) {
  constexpr std::string_view kReason = "does_not_recover";
  bench.await_response_window();
  const auto frame = bench.telling_write();
  bench.send(frame);
  bench.await_response_window();
  if (bench.capabilities().process_side)
    expect_valves(bench, judge, bench.valves_of(frame[2], frame[3]), kReason);
  bench.clear_observations();
  const auto switches = static_cast<std::uint16_t>(bench.random().below(0x10000));
  bench.boards().set_input(0, switches);
  const kernel::Time end = bench.read();
  bench.await_response_window();
  judge.expect(bench.has_driven(), kReason, "a read is answered", "the node did not say anything");
  // That it serves is shown here; how fast it does so, by the case itself.
  const InstantLedger before = bench.instants();
  expect_answer(bench, judge, switches, end);
  bench.keep_instants(before);
  bench.clear_observations();
}

}  // namespace fieldproof::conformance
