#include "conformance/fieldbus_dll/ff_las_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/ff_las_model.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::array<FfAddress, 3> kItemsOfLas{0x1120, 0x1220, 0xF520};
// Live from the beginning are the first two; the others are polled.
constexpr std::array<std::uint8_t, 5> kNodesOfLas{0x11, 0x12, 0x13, 0x14, 0xF5};
constexpr std::uint32_t kMacrocycleOfLas = 6'400;  // 200 ms
constexpr FfAddress kUserOfLas = 0x1030;
// More than it says in two macrocycles.
constexpr int kMostSaid = 400;

constexpr std::array<std::int64_t, 4> kLasCounts{1, 2, 5, 30};
constexpr std::array<std::int64_t, 4> kLasNodes{0, 0, 1, 2};
constexpr std::array<std::int64_t, 4> kLasSizes{0, 1, 8, 64};
constexpr std::array<std::int64_t, 3> kLasDelays{0, 0, 16};

enum class LasWord : std::uint8_t {
  obey,
  silent,
  join,
  ignore,
  refuse,
  publish,
  use,
  spend,
  ask_time,
  submit
};

void network_of_las(FfConfiguration& configuration) {
  configuration.live = {kNodesOfLas[0], kNodesOfLas[1]};
  configuration.rules.first_unpolled = 0x15;
  configuration.rules.unpolled = 0xE0;
  // More than a circulation takes whose tokens are returned at once, whatever is compelled and told in it;
  // less than one with a token that is spent.
  configuration.rules.target_rotation = 330 * kOctetAt31250;
  configuration.rules.time_distribution_period = 2 * kernel::kSecond;
  // The third is due while the second is answered.
  configuration.schedule = {.version = 1,
                            .macrocycle = kMacrocycleOfLas,
                            .items = {{330, kItemsOfLas[0], Priority::normal},
                                      {3'200, kItemsOfLas[1], Priority::urgent},
                                      {3'300, kItemsOfLas[2], Priority::time_available}}};
}

SequenceNumber las_item() {
  return {"item", 0, kItemsOfLas.size() - 1, 0};
}
SequenceNumber las_node() {
  return {"node", 0, kNodesOfLas.size() - 1, 0, kLasNodes};
}
SequenceNumber las_delay() {
  return {"later", 0, 20, 0, kLasDelays};
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
  const auto latest = static_cast<unsigned>(kLasDelays.back());
  const unsigned taken = link.inter_pdu_delay_octets + std::max(latest, las.rules.scheduling_overhead_octets);
  if (link.response_delay_slots * link.slot_time_octets >= taken + octets_around(link) + 1 &&
      las.rules.least_token_octets <= las.rules.token_holding_octets)
    return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("within V(MRD) x V(ST) lie V(MID), V(MSO) and the {} octets after which nodes of "
                  "sequences answer; V(DMDT) is at most V(DTHT)",
                  latest));
}

SequenceVocabulary ff_las_vocabulary() {
  fieldbus_dll::FfConfiguration as_given;
  network_of_las(as_given);
  // In the order of LasWord.
  return {.words = {{.word = "obey",
                     .meaning = "so many DLPDUs of the scheduler are answered as nodes do",
                     .numbers = {{"count", 1, 60, 1, kLasCounts}},
                     .weight = 6},
                    {.word = "silent",
                     .meaning = "a node does not answer its next tokens",
                     .numbers = {las_node(), {"tokens", 1, 2, 1}},
                     .weight = 8},
                    {.word = "join",
                     .meaning = "a node answers its next probe",
                     .numbers = {las_node()},
                     .weight = 4},
                    {.word = "ignore",
                     .meaning = "the next CD of an item is not answered",
                     .numbers = {las_item()},
                     .weight = 3},
                    {.word = "refuse",
                     .meaning = "the next CD of an item is answered by SR",
                     .numbers = {las_item(), las_delay()},
                     .units = 6,
                     .weight = 1},
                    {.word = "publish",
                     .meaning = "the next CD of an item is answered with so many octets",
                     .numbers = {las_item(), {"size", 0, 64, 8, kLasSizes}, las_delay()},
                     .units = 8,
                     .weight = 2},
                    {.word = "use",
                     .meaning = "under the next token one DT1 is sent, which returns it or not",
                     .numbers = {{"size", 2, 32, 2}, {"final", 0, 1, 1}, las_delay()},
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
                     .weight = 4}},
          .unit = "octet",
          .levels_per_unit = kFlipsOfAnOctet,
          .settings = sequence_settings(fieldbus_dll::kFfTable, &as_given, kFixedOfLink, kBoundsOfLas),
          .objection = objection_of(fieldbus_dll::kFfTable, as_given, expect_judgeable_las)};
}

class FfLasSequenceRun {
 public:
  FfLasSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.configuration()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    // Each datum that waits may take a macrocycle of its own.
    constexpr kernel::Duration kMacrocycle = std::int64_t{kMacrocycleOfLas} * fieldbus_dll::kTick;
    const kernel::Time end = bench_.now() + 3 * kMacrocycle;
    const kernel::Time last = end + static_cast<std::int64_t>(sequence.commands.size()) * kMacrocycle;
    while (bench_.now() < end || (model_.end() && bench_.now() < last)) answer(next_said());
    object(model_.end(), "silence", bench_.now());
    std::vector<Octets> delivered;
    for (const auto& one : bench_.user().data) delivered.push_back(one.data);
    judge_.expect(delivered == data_, "data_not_delivered", "the user gets the data of each DT1 for it",
                  "other data, or none");
  }

 private:
  using Is = std::function<bool(const DrivenDlpdu&)>;

  void execute(const SequenceCommand& command) {
    const auto number = [&](std::size_t n) { return command.numbers.at(n); };
    const auto at = [&](std::size_t n) { return static_cast<std::size_t>(number(n)); };
    switch (static_cast<LasWord>(command.word)) {
      case LasWord::obey:
        for (std::int64_t n = 0; n < number(0); ++n) answer(next_said());
        return;
      case LasWord::silent:
        tokens_missed_[kNodesOfLas.at(at(0))] += number(1);
        return;
      case LasWord::join:
        joining_.insert(kNodesOfLas.at(at(0)));
        return;
      case LasWord::ignore:
        (void)next_cd(kItemsOfLas.at(at(0)));
        return;
      case LasWord::refuse:
        return refuse(next_cd(kItemsOfLas.at(at(0))), command);
      case LasWord::publish:
        return publish(next_cd(kItemsOfLas.at(at(0))), command);
      case LasWord::use:
        return with_token([&](const DrivenDlpdu& pt) { use(pt, command); });
      case LasWord::spend:
        return with_token([&](const DrivenDlpdu& pt) { spend(pt); });
      case LasWord::ask_time:
        return with_token([&](const DrivenDlpdu& pt) { ask_time(pt, command); });
      case LasWord::submit:
        return submit(static_cast<Priority>(number(0)), at(1));
    }
  }

  // ---- what the scheduler says ----

  DrivenDlpdu next_said() {
    const auto one = bench_.next(model_.silent_until());
    if (!one)
      judge_.fail("line_left_silent", {{"silence for less than V(ST) x 16"}, "silence", bench_.now()});
    object(model_.say(*one), one->text(), one->begin);
    return *one;
  }

  // Answers what comes before.
  std::optional<DrivenDlpdu> next_that(const Is& is) {
    for (int said = 0; said < kMostSaid; ++said) {
      const DrivenDlpdu one = next_said();
      if (is(one)) return one;
      answer(one);
    }
    return std::nullopt;
  }

  DrivenDlpdu next_cd(FfAddress address) {
    const auto cd = next_that([&](const DrivenDlpdu& one) {
      return is_cd(bench_, one) && (one.octet(1) << 8 | one.octet(2)) == static_cast<int>(address);
    });
    if (!cd) judge_.fail("not_compelled", {{fmt::format("a CD for {:04X}", address)}, "none", bench_.now()});
    return *cd;
  }

  // Of a node that answers; nothing when there is none for so long.
  void with_token(const std::function<void(const DrivenDlpdu&)>& hold) {
    const auto pt = next_that(
        [&](const DrivenDlpdu& one) { return is_pt(bench_, one) && tokens_missed_[one.octet(1)] == 0; });
    if (pt) return hold(*pt);
    const bool is_any_live = std::ranges::any_of(kNodesOfLas, [&](std::uint8_t node) {
      return model_.is_surely_live(node) && tokens_missed_[node] == 0;
    });
    if (is_any_live) judge_.fail("no_token", {{"a PT for who is live"}, "none", bench_.now()});
  }

  void object(const FfLasModel::Found& objection, const std::string& actual, kernel::Time when) {
    if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
  }

  // ---- what others say ----

  // V(MID) after the end of what was said last, or later.
  kernel::Time say(const Octets& octets, std::int64_t later = 0) {
    bench_.wait(bench_.least_gap() + bench_.octets(later));
    return bench_.send(octets);
  }

  // False: with faults.
  bool say_as(const SequenceCommand& command, const Octets& octets) {
    bench_.wait(bench_.least_gap() + bench_.octets(command.numbers.back()));
    const bool is_whole = send_link_command(bench_, octets, command);
    if (!is_whole) model_.hear_noise(bench_.now());
    return is_whole;
  }

  // As nodes do.
  void answer(const DrivenDlpdu& said) {
    const std::uint8_t node = said.octet(1);
    if (is_of(said, bench_.rules().codes.pn)) {
      if (joining_.erase(node) > 0) model_.hear_probe_response(say({bench_.rules().codes.pr, node}));
      return;
    }
    if (is_pt(bench_, said) && tokens_missed_[node] > 0) {
      --tokens_missed_[node];
      return;
    }
    if (const auto reply = bench_.returned(said)) model_.hear_answer(say(reply->octets));
  }

  void refuse(const DrivenDlpdu&, const SequenceCommand& command) {
    const auto sr = static_cast<std::uint8_t>(bench_.rules().codes.sr | fieldbus_dll::kFinalBit);
    if (say_as(command, {sr, 1})) model_.hear_answer(bench_.now());
  }

  void publish(const DrivenDlpdu& cd, const SequenceCommand& command) {
    const FfAddress address = static_cast<FfAddress>(cd.octet(1) << 8 | cd.octet(2));
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[1]));
    if (say_as(command, bench_.dt3(address, data))) model_.hear_answer(bench_.now());
  }

  Octets dt1_of(const DrivenDlpdu& pt, const Octets& data, bool is_final) const {
    return bench_.dt1(Priority::urgent, kUserOfLas, fieldbus_dll::address_of(pt.octet(1), 1), data, is_final);
  }

  void use(const DrivenDlpdu& pt, const SequenceCommand& command) {
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[0]));
    const bool is_final = command.numbers[1] == 1;
    const bool is_whole = say_as(command, dt1_of(pt, data, is_final));
    if (is_whole) data_.push_back(data);
    if (is_whole && is_final) return model_.hear_answer(bench_.now());
    if (is_whole) model_.hear_data(bench_.now());
    if (!is_final) return_token();
  }

  void return_token() { model_.hear_answer(say({bench_.rules().codes.rt})); }

  // Urgent data as long as another DT1 fits.
  void spend(const DrivenDlpdu& pt) {
    const std::int64_t around = std::int64_t{bench_.link().inter_pdu_delay_octets} + 5 + 2 + 3;
    const auto most = static_cast<std::int64_t>(bench_.link().most_data.at(2));
    std::int64_t left = duration_in(pt);
    bool is_returned = false;
    while (!is_returned) {
      const std::int64_t size = std::min(most, left - around);
      left -= size + around;
      is_returned = left < around + 2;
      const Octets data = bench_.numbered_data(static_cast<std::size_t>(size));
      const kernel::Time end = say(dt1_of(pt, data, is_returned));
      data_.push_back(data);
      is_returned ? model_.hear_answer(end) : model_.hear_data(end);
    }
  }

  void ask_time(const DrivenDlpdu& pt, const SequenceCommand& command) {
    if (say_as(command, {bench_.rules().codes.ct, pt.octet(1)})) {
      model_.hear_time_request(bench_.now());
      (void)next_said();
    }
    return_token();
  }

  void submit(Priority priority, std::size_t size) {
    const Octets data = bench_.numbered_data(size);
    const bool is_taken = bench_.submit(priority, data);
    const bool is_right = model_.submit(priority, data);
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", size, is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  FfBench& bench_;
  CaseJudge& judge_;
  FfLasModel model_;
  std::map<std::uint8_t, std::int64_t> tokens_missed_;
  std::set<std::uint8_t> joining_;
  std::vector<Octets> data_;
};

std::vector<PartialSource> ff_las_sequence_details() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  std::vector<PartialSource> details = ff_details();
  details.push_back({own("what a scheduler says when"),
                     {"does_not_wait", "order_wrong", "begin_not_marked", "token_for_removed",
                      "token_shorter_than_the_time", "priority_wrong", "time_request_ignored",
                      "data_not_sent", "sends_other_data"}});
  details.push_back({own("what has changed is sent within two circulations"),
                     {"not_activated", "live_list_not_told", "live_list_wrong"}});
  details.push_back(
      {vendors("V(DMDT), V(DTHT), V(MSO), V(FUN), V(NUN), V(TDP)"),
       {"token_too_short", "token_too_long", "compelled_late", "probes_unpolled", "time_not_told"}});
  details.push_back({memory("IDLE"), {"line_left_silent"}});
  return details;
}

}  // namespace

const SequenceRole& ff_las_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/ff_las/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever nodes do in whatever order, a scheduler runs its schedule, passes the token to who is "
           "live, with the priority that rotations lead to, and sends what has changed.",
       .reference = link_sources::ff_paper("the scheduler: CD by its schedule, tokens in between"),
       .details = ff_las_sequence_details(),
       .stimulus =
           "Commands at random, with half bits and bits that are flipped and octets that are missing.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      ff_las_vocabulary(),
      {{DerivedKind::values, {"steps_to_the_extreme", "priority_wrong"}},
       {DerivedKind::faults, {"steers_the_wrong_way", "priority_wrong"}},
       {DerivedKind::words, {"token_over_due", "token_over_due"}},
       {DerivedKind::states, {"steps_back_to_the_extreme", "priority_wrong"}},
       {DerivedKind::repetitions, {"target_ignored", "priority_wrong"}},
       {DerivedKind::settings, {"time_at_half_speed", "time_wrong"}},
       {DerivedKind::drawn, {"token_over_due", "token_over_due"}}}};
  return role;
}

FfNeeds ff_las_sequence_needs() {
  return {.change = network_of_las};
}

void run_ff_las_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfLasSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
