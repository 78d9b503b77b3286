#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// The live list: who is found, activated and removed.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;

constexpr std::uint8_t kKnown = 0x11;
constexpr std::uint8_t kNew = 0x13;
constexpr std::size_t kOctetsOfALiveList = 2 + 256 / 8;  // kind, revision, a bit for each node

void one_node(FfConfiguration& configuration) {
  configuration.live = {kKnown};
}

bool is_probe_of(const FfBench& bench, const DrivenDlpdu& one, std::uint8_t node) {
  return is_of(one, bench.rules().codes.pn) && one.octet(1) == node;
}

bool is_token_for(const FfBench& bench, const DrivenDlpdu& one, std::uint8_t node) {
  return is_pt(bench, one) && one.octet(1) == node;
}

// The DLSDU of a DT1 from the scheduler's entity to an address; nothing for another DLPDU.
std::optional<Octets> told(const FfBench& bench, const DrivenDlpdu& one, fieldbus_dll::FfAddress to) {
  const bool is_to = is_dt1(bench, one) && (one.octet(1) << 8 | one.octet(2)) == static_cast<int>(to);
  if (!is_to || one.octet(4) != fieldbus_dll::kEntity) return std::nullopt;
  return dlsdu_of(one);
}

// Is node n live in what a live list says?
bool is_live_in(const Octets& list, std::uint8_t node) {
  const std::size_t octet = 2U + node / 8U;
  return octet < list.size() && (list[octet] >> (7 - node % 8) & 1) != 0;
}

void a_node_that_answers_is_activated(FfBench& bench, CaseJudge& judge) {
  bool has_answered = false;
  std::optional<std::size_t> activated, listed, passed;
  std::size_t circulations = 0;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    if (has_answered && is_pt(bench, one) && has_final_use(one)) ++circulations;
    if (has_answered && is_token_for(bench, one, kNew) && !passed) passed = circulations;
    if (const auto list = told(bench, one, fieldbus_dll::kEverybody); list && has_answered && !listed) {
      judge.expect(list->size() == kOctetsOfALiveList && is_live_in(*list, kNew) &&
                       is_live_in(*list, kKnown) && !is_live_in(*list, 0x12) && !is_live_in(*list, 0xC8),
                   "live_list_wrong",
                   [&] { return Mismatch{{"a live list with 10, 11 and 13"}, one.text(), one.begin}; });
      listed = circulations;
    }
    if (const auto spdu = told(bench, one, fieldbus_dll::address_of(kNew)); spdu && has_answered)
      if (!spdu->empty() && spdu->front() == 1) activated = circulations;
    if (!has_answered && is_probe_of(bench, one, kNew)) {
      has_answered = true;
      return FfBench::Reply{{bench.rules().codes.pr, kNew}};
    }
    return bench.returned(one);
  };
  bench.serve(kernel::kStart + bench.octets(1'500), answers);
  judge.expect(has_answered, "no_probe", "a PN for 13", "none");
  judge.expect(activated.has_value(), "not_activated", "an activation for 13", "none");
  judge.expect(passed.has_value() && *passed <= 1, "no_token_for_new_node", [&] {
    return Mismatch{{"a PT for 13 in the next circulation"},
                    passed ? fmt::format("in circulation {} after its PR", *passed) : "none"};
  });
  judge.expect(listed.has_value(), "live_list_not_told", "the live list for everybody", "none");
}

void a_probe_response_of_another_is_none(FfBench& bench, CaseJudge& judge) {
  constexpr std::uint8_t kElsewhere = 0x30;
  std::size_t probes = 0;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    const bool is_told = is_dt1(bench, one) && fieldbus_dll::node_of(addresses_in(one).to) != kKnown;
    judge.expect(!is_told, "takes_probe_response_of_another", [&] {
      return Mismatch{
          {"no activation and no live list: nobody has answered its own probe"}, one.text(), one.begin};
    });
    if (!is_of(one, bench.rules().codes.pn) || one.octet(1) == kElsewhere) return bench.returned(one);
    ++probes;
    return FfBench::Reply{{bench.rules().codes.pr, kElsewhere}};
  };
  bench.serve(kernel::kStart + bench.octets(1'500), answers);
  judge.expect(probes > 3, "no_probe", "PNs", fmt::format("{}", probes));
}

// The node takes part in the first circulations, then misses tokens as the pattern says: true is a miss.
struct Misses {
  std::size_t tokens = 0;
  std::size_t tokens_until_removal = 0;  // that it missed in a row, at the end
  bool is_removed = false;
  bool is_told = false;
  bool is_probed = false;
};

Misses miss(FfBench& bench, const std::function<bool(std::size_t)>& misses, std::int64_t octet_times) {
  Misses found;
  std::size_t probes_without = 0;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    if (const auto list = told(bench, one, fieldbus_dll::kEverybody); list && found.tokens > 0)
      found.is_told |= !is_live_in(*list, kKnown);
    if (is_probe_of(bench, one, kKnown)) found.is_probed = true;
    // A circulation has a probe, or several.
    constexpr std::size_t kMostProbes = 6;
    if (is_of(one, bench.rules().codes.pn) && found.tokens > 0 && ++probes_without > kMostProbes)
      found.is_removed = true;
    if (!is_token_for(bench, one, kKnown)) return bench.returned(one);
    probes_without = 0;
    if (!misses(found.tokens++)) {
      found.tokens_until_removal = 0;
      return bench.returned(one);
    }
    ++found.tokens_until_removal;
    return std::nullopt;
  };
  bench.serve(bench.now() + bench.octets(octet_times), answers);
  return found;
}

void who_misses_three_tokens_is_removed(FfBench& bench, CaseJudge& judge) {
  const Misses found = miss(bench, [](std::size_t token) { return token >= 4; }, 6'000);
  judge.expect(found.is_removed, "not_removed", "no PT for 11 after the third that it missed", "PTs go on");
  judge.expect(found.tokens_until_removal == 3, "removed_at_other_time", [&] {
    return Mismatch{{"removed after the third token that it missed"},
                    fmt::format("after {}", found.tokens_until_removal)};
  });
  judge.expect(found.is_told, "live_list_not_told", "a live list without 11 for everybody", "none");
  judge.expect(found.is_probed, "not_probed_again", "a PN for 11 later", "none");
}

void who_misses_two_and_answers_stays(FfBench& bench, CaseJudge& judge) {
  // Two misses, one answer, over and over.
  const Misses found =
      miss(bench, [](std::size_t token) { return token % 3 != 2; }, bench.volume(6'000, 60'000));
  judge.expect(!found.is_removed && !found.is_told, "removed_too_early",
               "11 stays in the live list: it has answered in between", "it was removed");
  judge.expect(found.tokens > 3, "no_token", "PTs for 11, over and over",
               fmt::format("{} of them", found.tokens));
}

}  // namespace

std::vector<FfCase> ff_live_list_cases() {
  using link_sources::memory;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/ff_las/live_list/a_node_that_answers_is_activated",
        .purpose = "FF-24",
        .requirement =
            "A node that answers a PN is activated, gets the token in the next circulation, and the live "
            "list is sent to all.",
        .reference = memory("live list maintenance"),
        .details = {{own("how a live list is sent"), {"live_list_wrong"}}},
        .stimulus = "A PR of node 13.",
        .expected = "An activation, a live list with it, a PT for it.",
        .tags = {"must"},
        .catches = {{"no_activation", "not_activated"},
                    {"live_list_reversed", "live_list_wrong"},
                    {"live_list_cut", "live_list_wrong"},
                    {"live_list_not_told", "live_list_not_told"},
                    {"new_node_without_token", "no_token_for_new_node"}}},
       a_node_that_answers_is_activated,
       {.change = one_node}},
      {{.id = "fieldbus_dll/ff_las/live_list/a_probe_response_of_another_is_none",
        .purpose = "FF-24",
        .requirement = "A node is found by its own answer to its own probe.",
        .reference = memory("PN and PR"),
        .stimulus = "PRs of node 30 to the PNs for others.",
        .expected = "Nobody is activated.",
        .tags = {"must"},
        .catches = {{"probe_response_of_anybody_taken", "takes_probe_response_of_another"}}},
       a_probe_response_of_another_is_none,
       {.change = one_node}},
      {{.id = "fieldbus_dll/ff_las/live_list/who_misses_three_tokens_is_removed",
        .purpose = "FF-25",
        .requirement = "A node that uses none of three tokens in a row is removed, and that is sent to all.",
        .reference = memory("removal from the live list"),
        .stimulus = "Node 11 falls silent.",
        .expected = "No PT for it after the third; a live list without it; a PN for it later.",
        .tags = {"must"},
        .catches = {{"removed_after_one_miss", "removed_at_other_time"},
                    {"removed_after_four_misses", "removed_at_other_time"},
                    {"never_removed", "not_removed"},
                    {"live_list_not_told", "live_list_not_told"}}},
       who_misses_three_tokens_is_removed,
       {.change = one_node}},
      {{.id = "fieldbus_dll/ff_las/live_list/who_misses_two_and_answers_stays",
        .purpose = "FF-26",
        .requirement = "A token that is used makes up for those that were missed.",
        .reference = memory("removal from the live list"),
        .stimulus = "Node 11 misses two tokens of three.",
        .expected = "It stays.",
        .tags = {"must"},
        .catches = {{"misses_not_forgotten", "removed_too_early"},
                    {"removed_after_one_miss", "removed_too_early"}}},
       who_misses_two_and_answers_stays,
       {.change = one_node}},
  };
}

}  // namespace fieldproof::conformance
