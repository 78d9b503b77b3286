#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// The circulation of the token: order, probes, and the priority that the rotation time steers.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::int64_t kNodes = 4;

// Four nodes return their tokens at once: a circulation is four tokens and a probe that nobody answers, in
// octet durations 4 (PT 9, silence 8, RT 6, silence 8) and PN 7, V(MRD) x V(ST) 32.
constexpr std::int64_t kFastRotation = kNodes * 31 + 39;

template <std::int64_t target_octets>
void four_nodes(FfConfiguration& configuration) {
  configuration.live = {0x11, 0x12, 0x13, 0x14};
  configuration.rules.target_rotation = target_octets * kOctetAt31250;
}

bool begins_circulation(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  return is_pt(bench, dlpdu) && has_final_use(dlpdu);
}

std::string_view priority_text(Priority priority) {
  return fieldbus_dll::text_of(priority);
}

void tokens_go_round(FfBench& bench, CaseJudge& judge) {
  const auto all = bench.serve(kernel::kStart + bench.octets(bench.volume(1'500, 20'000)));
  std::uint8_t next = 0x11;
  std::size_t tokens = 0;
  for (const DrivenDlpdu& one : all) {
    if (!is_pt(bench, one)) continue;
    judge.expect(one.octet(1) == next, "order_wrong",
                 [&] { return Mismatch{{fmt::format("PT for node {:02X}", next)}, one.text(), one.begin}; });
    judge.expect(has_final_use(one) == (next == 0x11), "begin_not_marked", [&] {
      return Mismatch{{"the first token of a circulation marked, and no other"}, one.text(), one.begin};
    });
    next = next == 0x14 ? 0x11 : static_cast<std::uint8_t>(next + 1);
    ++tokens;
  }
  judge.expect(tokens > 20, "no_token", "tokens", fmt::format("{}", tokens));
}

void each_circulation_probes(FfBench& bench, CaseJudge& judge) {
  const auto& rules = bench.rules();
  // Holders have much to say.
  const auto busy = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    if (!is_pt(bench, one)) return bench.returned(one);
    return FfBench::Reply{bench.dt1(Priority::urgent, 0x1030, fieldbus_dll::address_of(one.octet(1), 1),
                                    Octets(40, 0x55), true)};
  };
  std::uint8_t last = 0;
  std::size_t probes = 0;
  std::size_t wraps = 0;
  bool has_probed = true;
  for (const DrivenDlpdu& one :
       bench.serve(kernel::kStart + bench.octets(bench.volume(40'000, 100'000)), busy)) {
    if (begins_circulation(bench, one)) {
      judge.expect(has_probed, "no_probe",
                   [&] { return Mismatch{{"a PN between two circulations"}, one.text(), one.begin}; });
      has_probed = false;
    }
    if (!is_of(one, rules.codes.pn)) continue;
    has_probed = true;
    ++probes;
    const std::uint8_t node = one.octet(1);
    const bool is_unpolled = node >= rules.first_unpolled && node < rules.first_unpolled + rules.unpolled;
    judge.expect(!is_unpolled, "probes_unpolled", [&] {
      return Mismatch{{fmt::format("no PN for {:02X} to {:02X}", rules.first_unpolled,
                                   rules.first_unpolled + rules.unpolled - 1)},
                      one.text(),
                      one.begin};
    });
    const bool is_live = node >= 0x10 && node <= 0x14;
    judge.expect(!is_live, "probes_live_node",
                 [&] { return Mismatch{{"no PN for a live node"}, one.text(), one.begin}; });
    const bool is_ascending = node > last;
    if (!is_ascending) ++wraps;
    judge.expect(is_ascending || node == 0x15, "probes_out_of_order", [&] {
      return Mismatch{{fmt::format("the next address after {:02X}", last)}, one.text(), one.begin};
    });
    last = node;
  }
  judge.measure("probes", "", static_cast<double>(probes));
  judge.expect(wraps >= 2, "probes_do_not_begin_anew", "the addresses are probed again and again",
               fmt::format("{} probes, {} times from the beginning", probes, wraps));
}

void its_own_data_has_its_turn(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = expect_submitted(bench, judge, Priority::urgent, 10);
    bool is_sent = false;
    bench.serve(bench.now() + bench.octets(3 * kFastRotation), [&](const DrivenDlpdu& one) {
      is_sent |= is_dt1(bench, one) && dlsdu_of(one) == data;
      return bench.returned(one);
    });
    judge.expect(is_sent, "own_data_not_sent", "urgent data of its user, once in a circulation", "none");
  }
}

// The next token for a node; those of others are returned at once.
DrivenDlpdu next_token_for(FfBench& bench, CaseJudge& judge, std::uint8_t node) {
  const kernel::Time latest = bench.now() + bench.octets(10 * kFastRotation);
  for (;;) {
    const DrivenDlpdu one =
        expect_next(bench, judge, latest, "no_token", fmt::format("a PT for {:02X}", node));
    if (is_pt(bench, one) && one.octet(1) == node) return one;
    bench.answer_one(one);
  }
}

Octets data_from(const FfBench& bench, std::uint8_t node, bool is_final) {
  return bench.dt1(Priority::urgent, fieldbus_dll::address_of(FfBench::kScheduler, 0x30),
                   fieldbus_dll::address_of(node, 1), Octets(20, 0x55), is_final);
}

// The holder sends for ever, with silences of twice V(MID).
void who_overstays_is_stopped(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const DrivenDlpdu pt = next_token_for(bench, judge, 0x12);
    const kernel::Time over = pt.end + bench.octets(duration_in(pt));
    const kernel::Time latest = over + bench.slot() + 2 * bench.frame(32);
    std::optional<DrivenDlpdu> next;
    for (kernel::Time end = pt.end; !next && end < latest;) {
      end = bench.send_at(end + 2 * bench.least_gap(), data_from(bench, 0x12, false));
      bench.run_until(end);
      next = bench.next(end + 2 * bench.least_gap() - kLinkRounding);
    }
    judge.expect(next.has_value(), "holder_not_stopped", [&] {
      return Mismatch{
          {fmt::format("the token of 12 taken back in a silence after {}", kernel::describe(over))},
          "the station was silent",
          latest};
    });
    expect_begins(judge, *next, over, "holder_stopped_early", latest, "holder_not_stopped");
  }
}

// A DT1 with F of another, and nothing of the holder.
void a_return_of_another_is_none(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const DrivenDlpdu pt = next_token_for(bench, judge, 0x12);
    const kernel::Time end = bench.send_at(pt.end + bench.least_gap(), data_from(bench, 0x13, true));
    bench.run_until(end);
    const kernel::Time over = end + bench.response_delay();
    const DrivenDlpdu next = expect_next(bench, judge, over + 4 * bench.slot(), "goes_on_late",
                                         "the scheduler goes on when the holder says nothing");
    expect_begins(judge, next, over, "takes_return_of_another", over + 2 * bench.slot(), "goes_on_late");
  }
}

// What the first token of each circulation said, and when.
struct Circulation {
  Priority priority;
  kernel::Time begin;
};

// Of nodes that return their tokens at once, those from `first_late` on so much later.
std::vector<Circulation> circulations(FfBench& bench, std::size_t count, kernel::Duration later,
                                      std::uint8_t first_late = 0x14) {
  std::vector<Circulation> all;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    auto reply = bench.returned(one);
    if (begins_circulation(bench, one)) all.push_back({priority_in(one), one.begin});
    if (reply && is_pt(bench, one) && one.octet(1) >= first_late) reply->later = later;
    return reply;
  };
  const kernel::Time end = bench.now() + bench.octets(static_cast<std::int64_t>(count) * 2 * kFastRotation);
  while (all.size() < count && bench.now() < end)
    bench.serve(std::min(end, bench.now() + bench.octets(20)), answers);
  return all;
}

void expect_priorities(CaseJudge& judge, const std::vector<Circulation>& found,
                       const std::vector<Priority>& wanted, std::string_view reason) {
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    judge.expect(n < found.size() && found[n].priority == wanted[n], reason, [&] {
      return Mismatch{{fmt::format("circulation {} with priority {}", n + 1, priority_text(wanted[n]))},
                      n < found.size() ? std::string(priority_text(found[n].priority)) : "no circulation"};
    });
  }
}

void a_fast_rotation_admits_more(FfBench& bench, CaseJudge& judge) {
  using enum Priority;
  expect_priorities(judge, circulations(bench, 6, {}), {urgent, normal, time_available, time_available},
                    "priority_not_lowered");
}

void a_slow_rotation_admits_less(FfBench& bench, CaseJudge& judge) {
  using enum Priority;
  expect_priorities(judge, circulations(bench, 4, {}), {urgent, urgent, urgent, urgent},
                    "priority_not_raised");
}

// V(TTRT) leaves a fast rotation room for a second probe.
void slower_rotations_admit_less_step_by_step(FfBench& bench, CaseJudge& judge) {
  using enum Priority;
  expect_priorities(judge, circulations(bench, 5, {}), {urgent, normal, time_available},
                    "priority_not_lowered");
  const std::vector<Circulation> slow = circulations(bench, 6, bench.octets(20), 0x11);
  const auto first =
      std::ranges::find_if(slow, [](const Circulation& one) { return one.priority != time_available; });
  judge.expect(slow.end() - first >= 2, "priority_not_raised",
               "tokens for less than all data, then for urgent data", "tokens for all");
  expect_priorities(judge, {first, slow.end()}, {normal, urgent}, "priority_not_raised");
}

// Rotations of exactly V(TTRT), then shorter ones.
void an_equal_rotation_is_slow(FfBench& bench, CaseJudge& judge) {
  constexpr std::size_t kUntilSettled = 3;
  const std::vector<Circulation> fast = circulations(bench, 6, {});
  judge.expect(fast.size() == 6, "no_token", "six circulations", fmt::format("{}", fast.size()));
  const kernel::Duration later = bench.rules().target_rotation - (fast[5].begin - fast[4].begin);
  if (later < kernel::Duration{} || bench.least_gap() + later > bench.response_delay())
    judge.inconclusive("rotation_not_adjustable", {{"a rotation that is 0 to 24 octets shorter than V(TTRT)"},
                                                   kernel::describe(fast[5].begin - fast[4].begin)});
  const std::vector<Circulation> equal = circulations(bench, 6 + kUntilSettled, later);
  for (std::size_t n = kUntilSettled; n < equal.size(); ++n) {
    judge.expect(equal[n].priority == Priority::urgent, "equal_rotation_is_fast", [&] {
      return Mismatch{{"a token for urgent data: the rotation before took V(TTRT)"},
                      std::string(priority_text(equal[n].priority)),
                      equal[n].begin};
    });
  }
  const std::vector<Circulation> faster = circulations(bench, 3 + kUntilSettled, later - bench.octets(1));
  judge.expect(faster.size() == 3 + kUntilSettled && faster.back().priority == Priority::time_available,
               "priority_not_lowered", "tokens for all data: the rotation is shorter than V(TTRT)",
               "otherwise");
}

}  // namespace

std::vector<FfCase> ff_circulation_cases() {
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  const PartialSource step{own("one step for each circulation; the first one is urgent"),
                           {"priority_not_lowered", "priority_not_raised"}};
  return {
      {{.id = "fieldbus_dll/ff_las/circulation/tokens_go_round",
        .purpose = "FF-18",
        .requirement =
            "The token is passed to each live node in the order of addresses; the first PT is marked.",
        .reference = ff_paper("token circulation list"),
        .details = {{vendors("the subfield Restart"), {"begin_not_marked"}}},
        .stimulus = "Four live nodes that return the token at once.",
        .expected = "11, 12, 13, 14, again and again, the first one marked.",
        .tags = {"must"},
        .catches = {{"descending_order", "order_wrong"}, {"begin_not_marked", "begin_not_marked"}}},
       tokens_go_round,
       {.change = four_nodes<1'000>}},
      {{.id = "fieldbus_dll/ff_las/circulation/each_probes",
        .purpose = "FF-23",
        .requirement =
            "Between two circulations an address is probed, in ascending order, without those of V(FUN) "
            "and V(NUN).",
        .reference = vendors("probing, V(FUN), V(NUN)"),
        .stimulus = "Four nodes with much to say.",
        .expected = "A PN between two circulations, for 15 to 24 and DF to F7, from the beginning then.",
        .tags = {"must"},
        .catches = {{"probes_unpolled", "probes_unpolled"},
                    {"no_probe_when_busy", "no_probe"},
                    {"probes_live_nodes", "probes_live_node"},
                    {"probes_descending", "probes_out_of_order"}}},
       each_circulation_probes,
       {.change = four_nodes<1'000>}},
      {{.id = "fieldbus_dll/ff_las/circulation/its_own_data_has_its_turn",
        .purpose = "FF-18",
        .requirement = "The scheduler itself has a turn in each circulation.",
        .reference = own("the scheduler's own turn"),
        .stimulus = "Four live nodes that return the token at once; its user submits.",
        .expected = "The data within three rotations.",
        .tags = {"must"},
        .catches = {{"own_data_kept", "own_data_not_sent"}}},
       its_own_data_has_its_turn,
       {.change = four_nodes<1'000>}},
      {{.id = "fieldbus_dll/ff_las/circulation/a_fast_rotation_admits_more",
        .purpose = "FF-19",
        .requirement = "While the rotation is shorter than V(TTRT), data of lower priority is admitted.",
        .reference = ff_paper("ATRT below TTRT"),
        .details = {step},
        .stimulus = "Nodes that return the token at once; V(TTRT) is 1.9 times the shortest rotation.",
        .expected = "Tokens urgent, normal, time-available.",
        .tags = {"must", "timing"},
        .catches = {{"steers_the_wrong_way", "priority_not_lowered"},
                    {"steps_to_the_extreme", "priority_not_lowered"},
                    {"rotation_counted_twice", "priority_not_lowered"}}},
       a_fast_rotation_admits_more,
       {.change = four_nodes<(19 * kFastRotation) / 10>}},
      {{.id = "fieldbus_dll/ff_las/circulation/a_slow_rotation_admits_less",
        .purpose = "FF-20",
        .requirement = "While the rotation is not shorter than V(TTRT), only urgent data is admitted.",
        .reference = ff_paper("ATRT not below TTRT"),
        .details = {step},
        .stimulus = "The same, V(TTRT) an octet shorter than a rotation.",
        .expected = "Tokens for urgent data.",
        .tags = {"must", "timing"},
        .catches = {{"steers_the_wrong_way", "priority_not_raised"},
                    {"target_ignored", "priority_not_raised"}}},
       a_slow_rotation_admits_less,
       {.change = four_nodes<kFastRotation - 1>}},
      {{.id = "fieldbus_dll/ff_las/circulation/slower_rotations_admit_less_step_by_step",
        .purpose = "FF-20",
        .requirement = "When rotations become slower than V(TTRT), the priority rises one step for each.",
        .reference = ff_paper("ATRT not below TTRT"),
        .details = {step},
        .stimulus = "Nodes that return the token at once, then 20 octets later each; V(TTRT) is in between.",
        .expected = "Tokens for all data; normal, urgent.",
        .tags = {"must", "timing"},
        .catches = {{"steps_back_to_the_extreme", "priority_not_raised"}}},
       slower_rotations_admit_less_step_by_step,
       {.change = four_nodes<kFastRotation + 60>}},
      {{.id = "fieldbus_dll/ff_las/circulation/who_overstays_is_stopped",
        .purpose = "FF-18",
        .requirement = "A token comes back to the scheduler when its duration is over.",
        .reference = ff_paper("duration of the token"),
        .details = {{own("the scheduler takes it in a silence of V(MID), a V(ST) after the duration"),
                     {"holder_not_stopped", "holder_stopped_early"}}},
        .stimulus = "A holder that sends for ever, with silences of twice V(MID).",
        .expected = "The scheduler sends in a silence after the duration, not before.",
        .tags = {"must", "timing"},
        .catches = {{"holder_never_stopped", "holder_not_stopped"}}},
       who_overstays_is_stopped,
       {.change = four_nodes<1'000>}},
      {{.id = "fieldbus_dll/ff_las/circulation/a_return_of_another_is_none",
        .purpose = "FF-18",
        .requirement = "A token is returned by who holds it.",
        .reference = own("DT1 with F of another"),
        .stimulus = "A PT for 12; a DT1 with F of 13.",
        .expected = "Silence for V(MRD) x V(ST) after it, no more than two slot times more.",
        .tags = {"must", "timing"},
        .catches = {{"return_of_anybody_taken", "takes_return_of_another"}}},
       a_return_of_another_is_none,
       {.change = four_nodes<1'000>}},
      {{.id = "fieldbus_dll/ff_las/circulation/an_equal_rotation_is_slow",
        .purpose = "FF-21",
        .requirement = "A rotation of exactly V(TTRT) admits urgent data only.",
        .reference = ff_paper("ATRT not below TTRT"),
        .details = {step},
        .stimulus =
            "The last node returns the token so late that a rotation takes V(TTRT); then an octet sooner.",
        .expected = "Tokens for urgent data; then for all.",
        .tags = {"must", "timing"},
        .catches = {{"equal_rotation_is_fast", "equal_rotation_is_fast"}}},
       an_equal_rotation_is_slow,
       {.change = four_nodes<kFastRotation + 16>}},
  };
}

}  // namespace fieldproof::conformance
