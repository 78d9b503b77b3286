#include "conformance/fieldbus_dll/ff_las_sequence_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

namespace {

// More than it says in two macrocycles.
constexpr int kMostSaid = 400;

}  // namespace

void FfLasSequenceRun::run(const Sequence& sequence) {
  for (const SequenceCommand& command : sequence.commands) execute(command);
  // Each datum that waits may take a macrocycle of its own.
  constexpr kernel::Duration kMacrocycle = std::int64_t{kMacrocycleOfLas} * fieldbus_dll::kTick;
  const kernel::Time end = bench_.now() + 3 * kMacrocycle;
  const auto most = static_cast<std::int64_t>(sequence.commands.size()) + submitted_;
  const kernel::Time last = end + most * kMacrocycle;
  while (bench_.now() < end || (model_.has_urgent_data() && bench_.now() < last)) answer(next_said());
  object(model_.end(), "silence", bench_.now());
  judge_events();
  std::vector<Octets> delivered;
  for (const auto& one : bench_.user().data) delivered.push_back(one.data);
  judge_.expect(delivered == data_, "data_not_delivered", "the user gets the data of each DT1 for it",
                "other data, or none");
}

void FfLasSequenceRun::judge_events() {
  const auto& told = bench_.user().events;
  const auto& wanted = model_.events();
  const auto text = [](const fieldbus_dll::FfEvent& one) {
    return fmt::format("{} of {:02X}", text_of(one.kind), one.node);
  };
  const auto [other, right] = std::ranges::mismatch(told, wanted);
  if (right != wanted.end())
    judge_.fail("event_wrong", {{fmt::format("event {}: {}", right - wanted.begin() + 1, text(*right))},
                                other == told.end() ? "no other event" : text(*other),
                                bench_.now()});
  if (other != told.end() && model_.are_events_complete())
    judge_.fail("event_wrong", {{"no other event"}, text(*other), bench_.now()});
}

void FfLasSequenceRun::execute(const SequenceCommand& command) {
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
    case LasWord::write:
      return write(kOwnBuffersOfLas.at(at(0)), at(1));
    case LasWord::overstay:
      return with_token([&](const DrivenDlpdu& pt) { overstay(pt, number(0)); });
    case LasWord::usurp:
      return number(0) == 2 ? interrupt(number(1)) : usurp(number(0) != 0, number(1));
    case LasWord::order:
      return order(kNodesOfLas.at(at(0)), static_cast<HeirSends>(number(1)));
    case LasWord::second:
      return second(command);
    case LasWord::told:
      return told(number(0), number(1));
    case LasWord::noise:
      return make_noise(number(0), number(1));
    case LasWord::hand:
      return hand(command);
    case LasWord::flood:
      for (std::int64_t n = 0; n < number(1); ++n) submit(static_cast<Priority>(number(0)), at(2));
      return;
    case LasWord::ask_late:
      return ask_late(number(0), number(1) != 0);
    case LasWord::entity:
      return with_token([&](const DrivenDlpdu& pt) { say_of_entity(pt, number(0) != 0); });
    case LasWord::supply:
      return lose_supply(number(0));
  }
}

DrivenDlpdu FfLasSequenceRun::next_said() {
  const auto one = bench_.next(model_.silent_until());
  if (!one && !model_.is_scheduler())
    judge_.fail("no_claim", {{"a CL after V(ST) x V(TN) of silence"}, "silence", bench_.now()});
  if (!one) judge_.fail("line_left_silent", {{"silence for less than V(ST) x 16"}, "silence", bench_.now()});
  object(model_.say(*one), one->text(), one->begin);
  return *one;
}

std::optional<DrivenDlpdu> FfLasSequenceRun::next_that(const Is& is) {
  for (int said = 0; said < kMostSaid; ++said) {
    const DrivenDlpdu one = next_said();
    if (is(one)) return one;
    answer(one);
  }
  return std::nullopt;
}

DrivenDlpdu FfLasSequenceRun::next_cd(FfAddress address) {
  const auto cd = next_that([&](const DrivenDlpdu& one) {
    return is_cd(bench_, one) && (one.octet(1) << 8 | one.octet(2)) == static_cast<int>(address);
  });
  if (!cd) judge_.fail("not_compelled", {{fmt::format("a CD for {:04X}", address)}, "none", bench_.now()});
  return *cd;
}

void FfLasSequenceRun::with_token(const std::function<void(const DrivenDlpdu&)>& hold) {
  const auto pt = next_that(
      [&](const DrivenDlpdu& one) { return is_pt(bench_, one) && tokens_missed_[one.octet(1)] == 0; });
  if (pt) return hold(*pt);
  const bool is_any_live = std::ranges::any_of(kNodesOfLas, [&](std::uint8_t node) {
    return model_.is_surely_live(node) && tokens_missed_[node] == 0;
  });
  if (is_any_live) judge_.fail("no_token", {{"a PT for who is live"}, "none", bench_.now()});
}

void FfLasSequenceRun::object(const FfLasModel::Found& objection, const std::string& actual,
                              kernel::Time when) {
  if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
}

void FfLasSequenceRun::ask_late(std::int64_t left, bool is_of_another) {
  const auto pt = next_that([&](const DrivenDlpdu& one) {
    return is_pt(bench_, one) && tokens_missed_[one.octet(1)] == 0 &&
           duration_in(one) < bench_.rules().token_holding_octets;
  });
  if (!pt) return;
  const Octets ct{bench_.rules().codes.ct, is_of_another ? kNobody : pt->octet(1)};
  const kernel::Time last = pt->end + bench_.octets(duration_in(*pt) - left) - bench_.frame(ct.size());
  if (last < bench_.now() + bench_.least_gap()) return return_token(*pt);
  // A silence of V(MRD) x V(ST) would be no use of the token.
  while (last - bench_.now() >= bench_.response_delay()) {
    const Octets data = bench_.numbered_data(1);
    const kernel::Time begin = bench_.now() + bench_.least_gap();
    const kernel::Time end = begin + bench_.frame(data_of(*pt, data).size());
    if (end + bench_.least_gap() > last) break;
    data_.push_back(data);
    model_.hear_data(say(data_of(*pt, data)));
  }
  if (last - bench_.now() >= bench_.response_delay()) return return_token(*pt);
  bench_.run_until(last);
  bench_.send(ct);
  model_.hear_time_request(bench_.now());
}

void FfLasSequenceRun::say_of_entity(const DrivenDlpdu& pt, bool is_for_everybody) {
  const fieldbus_dll::FfAddress to =
      is_for_everybody ? fieldbus_dll::kEverybody : fieldbus_dll::address_of(bench_.node());
  constexpr std::uint8_t kUnknown = 7;
  const Octets dt1 =
      bench_.dt1(Priority::urgent, to, fieldbus_dll::address_of(pt.octet(1)), {kUnknown, 1, 2});
  if (is_in_token(pt, dt1.size())) model_.hear_data(say(dt1));
  return_token(pt);
}

void FfLasSequenceRun::lose_supply(std::int64_t octets) {
  bench_.set_supply(false);
  judge_.expect(!bench_.next_begins(bench_.now() + bench_.octets(octets)), "says_without_supply",
                "nothing without supply", "a DLPDU");
  bench_.run_until(bench_.now() + bench_.octets(octets));
  judge_events();
  bench_.user().events.clear();
  bench_.set_supply(true);
  model_.lose_supply(bench_.now());
}

}  // namespace fieldproof::conformance
