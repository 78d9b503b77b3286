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
#include "conformance/fieldbus_dll/ff_las_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kUserOfLas = 0x1030;
// More than it says in two macrocycles.
constexpr int kMostSaid = 400;

class FfLasSequenceRun {
 public:
  FfLasSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.configuration()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    // Each datum that waits may take a macrocycle of its own.
    constexpr kernel::Duration kMacrocycle = std::int64_t{kMacrocycleOfLas} * fieldbus_dll::kTick;
    const kernel::Time end = bench_.now() + 3 * kMacrocycle;
    const auto most = static_cast<std::int64_t>(sequence.commands.size()) + submitted_;
    const kernel::Time last = end + most * kMacrocycle;
    while (bench_.now() < end || (model_.end() && bench_.now() < last)) answer(next_said());
    object(model_.end(), "silence", bench_.now());
    judge_events();
    std::vector<Octets> delivered;
    for (const auto& one : bench_.user().data) delivered.push_back(one.data);
    judge_.expect(delivered == data_, "data_not_delivered", "the user gets the data of each DT1 for it",
                  "other data, or none");
  }

  // In their order; what is told of the last question may be told already.
  void judge_events() {
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

  // ---- what the scheduler says ----

  DrivenDlpdu next_said() {
    const auto one = bench_.next(model_.silent_until());
    if (!one && !model_.is_scheduler())
      judge_.fail("no_claim", {{"a CL after V(ST) x V(TN) of silence"}, "silence", bench_.now()});
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
    const auto reason = static_cast<std::uint8_t>(command.numbers[1]);
    if (!say_as(command, {sr, reason})) return;
    reason > 1 ? model_.hear_none(bench_.now()) : model_.hear_answer(bench_.now());
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
    const bool is_left_open = command.numbers[1] == 2;
    const Octets dt1 = dt1_of(pt, data, is_final);
    if (!is_in_token(pt, dt1.size(), command.numbers.back())) return return_token(pt);
    const bool is_whole = say_as(command, dt1);
    if (is_whole) data_.push_back(data);
    if (is_whole && is_final) return model_.hear_answer(bench_.now());
    if (is_whole) model_.hear_data(bench_.now());
    if (!is_final && !is_left_open) return_token(pt);
  }

  // What a holder says V(MID) from now, or later still, has to end within its token.
  bool is_in_token(const DrivenDlpdu& pt, std::size_t octets, std::int64_t later = 0) const {
    const kernel::Time over = pt.end + bench_.octets(duration_in(pt));
    return bench_.now() + bench_.least_gap() + bench_.octets(later) + bench_.frame(octets) <= over;
  }
  void return_token(const DrivenDlpdu& pt) {
    if (is_in_token(pt, 1)) model_.hear_answer(say({bench_.rules().codes.rt}));
  }

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
    if (!say_as(command, {bench_.rules().codes.ct, pt.octet(1)})) return return_token(pt);
    model_.hear_time_request(bench_.now());
    const DrivenDlpdu said = next_said();
    is_of(said, bench_.rules().codes.td) ? return_token(pt) : answer(said);
  }

  void submit(Priority priority, std::size_t size) {
    const Octets data = bench_.numbered_data(size);
    const bool is_taken = bench_.submit(priority, data);
    ++submitted_;
    const bool is_right = model_.submit(priority, data);
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", size, is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  void write(FfAddress buffer, std::size_t size) {
    const Octets data = bench_.numbered_data(size);
    const bool is_taken = bench_.write(buffer, data);
    const bool is_right = model_.write(buffer, data, bench_.now());
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("a buffer of {} octets is {}", size, is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  // ---- what is not theirs ----

  // It is taken back in the silence behind the last DT1, by whatever has time before what is due.
  void overstay(const DrivenDlpdu& pt, std::int64_t later) {
    const kernel::Time over = pt.end + bench_.octets(duration_in(pt));
    const kernel::Time last = over + bench_.slot() + bench_.octets(later);
    const std::size_t most = bench_.link().most_data.at(0);
    const Octets none = data_of(pt, {});
    const kernel::Duration around = bench_.least_gap() + bench_.frame(none.size());
    if (pt.end + bench_.least_gap() + bench_.slot() >= over) return return_token(pt);
    bool is_over = false;
    while (!is_over) {
      const std::int64_t left = (last - bench_.now() - around) / bench_.octets(1);
      const auto room = static_cast<std::size_t>(std::max<std::int64_t>(0, left)) + 1;
      is_over = room <= most;
      const Octets data = bench_.numbered_data(is_over ? room : std::min(room / 2, most));
      data_.push_back(data);
      model_.hear_data(say(data_of(pt, data)));
    }
    const kernel::Time free = bench_.now() + bench_.least_gap() + bench_.octets(1);
    const DrivenDlpdu one = next_said();
    const auto& codes = bench_.rules().codes;
    // Nothing else may have had time, and a TD have become due later.
    const bool may_wait =
        is_cd(bench_, one) || is_of(one, codes.idle) || is_of(one, codes.dt3) || is_of(one, codes.td);
    judge_.expect(may_wait || one.begin <= free, "holder_not_stopped", [&] {
      return Mismatch{{"the token is taken back as soon as the line is free"}, one.text(), one.begin};
    });
    answer(one);
  }

  Octets data_of(const DrivenDlpdu& pt, const Octets& data) const {
    return bench_.dt1(Priority::time_available, kUserOfLas, fieldbus_dll::address_of(pt.octet(1), 1), data);
  }

  void usurp(bool probe, std::int64_t later) {
    const auto& codes = bench_.rules().codes;
    const auto asked = next_that([&](const DrivenDlpdu& one) {
      return probe ? is_of(one, codes.pn) : is_pt(bench_, one) && tokens_missed_[one.octet(1)] == 0;
    });
    if (!asked) return;
    const auto another = static_cast<std::uint8_t>(asked->octet(1) + 1);
    const Octets said = probe
                            ? Octets{codes.pr, another}
                            : bench_.dt1(Priority::urgent, FfBench::kPeersAddress,
                                         fieldbus_dll::address_of(another, 1), bench_.numbered_data(4), true);
    const kernel::Time end = say(said, later);
    // A PR of another is no answer; a token counts as used, and does not come back.
    probe ? model_.hear_none(end) : model_.hear_data(end);
  }

  // Data of others are no scheduler's: something has come in place of the reply.
  void interrupt(std::int64_t later) {
    const auto asked = next_that([&](const DrivenDlpdu& one) { return is_cd(bench_, one); });
    if (!asked) return;
    const auto another = static_cast<std::uint8_t>(asked->octet(1) + 1);
    model_.hear_data(say(bench_.dt1(Priority::urgent, FfBench::kPeersAddress,
                                    fieldbus_dll::address_of(another, 1), bench_.numbered_data(4)),
                         later));
  }

  // ---- other schedulers ----

  // While it waits for an answer another has the link.
  void displace_by(const std::function<Octets()>& octets) {
    if (!next_that([&](const DrivenDlpdu& one) {
          return is_pt(bench_, one) || is_cd(bench_, one) || is_of(one, bench_.rules().codes.pn);
        }))
      return;
    bench_.wait(bench_.least_gap());
    say_as_scheduler(octets());
  }
  void displace() {
    if (model_.is_scheduler()) displace_by([&] { return Octets{bench_.rules().codes.cl, kSecondOfLas}; });
  }
  void say_as_scheduler(const Octets& octets) {
    bench_.send(octets);
    model_.hear_scheduler(octets, bench_.now());
    if (!model_.owes_answer()) return;
    if (!bench_.next_begins(bench_.now() + bench_.response_delay() + kLinkRounding))
      judge_.fail("not_a_device", {{"an answer: another scheduler asks it"}, "silence", bench_.now()});
    const DrivenDlpdu one = *bench_.next();
    object(model_.say(one), one.text(), one.begin);
  }

  // In standby, of the silence that claims the link, V(MID) at least.
  void wait_in_standby(std::int64_t parts) {
    const kernel::Duration claim = model_.claim_silence() - bench_.octets(bench_.rules().claim_delay_octets);
    const kernel::Duration wanted =
        parts == kPartsOfClaim ? claim - bench_.octets(1) : claim * parts / kPartsOfClaim;
    const kernel::Time until = bench_.now() + std::max(bench_.least_gap(), wanted);
    if (!bench_.next_begins(until)) return bench_.run_until(until);
    const DrivenDlpdu one = *bench_.next();
    object(model_.say(one), one.text(), one.begin);
    answer(one);
  }

  // A duration of 0 is none, and with it the DLPDU.
  void pass_none(std::uint8_t node) {
    bench_.wait(bench_.least_gap());
    model_.hear_none(bench_.send({bench_.control(bench_.rules().codes.pt, Priority::normal), node, 0, 0}));
  }

  void second(const SequenceCommand& command) {
    const auto kind = static_cast<OtherScheduler>(command.numbers[0]);
    if (model_.is_scheduler() && kind == OtherScheduler::passes_none) {
      if (next_that([&](const DrivenDlpdu& one) { return is_cd(bench_, one); }))
        pass_none(kNodesOfLas.at(static_cast<std::size_t>(command.numbers[1])));
      return;
    }
    if (model_.is_scheduler() && kind != OtherScheduler::idles)
      return displace_by([&] { return of_scheduler(kind, command.numbers); });
    displace();
    wait_in_standby(command.numbers[3]);
    if (!model_.is_scheduler()) say_as_scheduler(of_scheduler(kind, command.numbers));
  }

  Octets of_scheduler(OtherScheduler kind, const std::vector<std::int64_t>& numbers) const {
    const auto& codes = bench_.rules().codes;
    const std::uint8_t node = kNodesOfLas.at(static_cast<std::size_t>(numbers[1]));
    switch (kind) {
      case OtherScheduler::claims:
        return {codes.cl, kSecondOfLas};
      case OtherScheduler::passes:
        return {bench_.control(codes.pt, Priority::normal), node, 0, kGrantOfSecond};
      case OtherScheduler::probes:
        return {codes.pn, node};
      case OtherScheduler::probes_this:
        return {codes.pn, bench_.node()};
      case OtherScheduler::compels:
        return bench_.cd(kItemsOfLas[0]);
      case OtherScheduler::tells_time:
        return time_of_second(numbers[2]);
      case OtherScheduler::idles:
        return {codes.idle};
      case OtherScheduler::passes_none:
        return {bench_.control(codes.pt, Priority::normal), node, 0, 0};
      case OtherScheduler::compels_this:
        return bench_.cd(kOwnBuffersOfLas[node % 2]);
    }
    return {};
  }

  // What it is when the frame is over, and more.
  Octets time_of_second(std::int64_t jump) const {
    constexpr std::size_t kTimeOctets = 6;
    Octets td{bench_.rules().codes.td};
    const kernel::Time end = bench_.now() + bench_.frame(1 + kTimeOctets);
    const std::uint64_t ticks = model_.ticks_at(end) + static_cast<std::uint64_t>(jump);
    for (std::size_t n = kTimeOctets; n-- > 0;) td.push_back(static_cast<std::uint8_t>(ticks >> (8 * n)));
    return td;
  }

  void told(std::int64_t nodes, std::int64_t parts) {
    displace();
    wait_in_standby(parts);
    if (model_.is_scheduler()) return;
    std::vector<bool> live(fieldbus_dll::kNodeNumbers);
    for (std::size_t n = 0; n < kNodesOfLas.size(); ++n) live[kNodesOfLas.at(n)] = (nodes >> n & 1) != 0;
    constexpr std::uint8_t kRevision = 9;
    say_as_scheduler(bench_.dt1(Priority::normal, fieldbus_dll::kEverybody,
                                fieldbus_dll::address_of(kSecondOfLas),
                                fieldbus_dll::live_list_spdu(kRevision, live)));
  }

  void make_noise(std::int64_t octets, std::int64_t parts) {
    displace();
    wait_in_standby(parts);
    if (model_.is_scheduler()) return;
    send_noise(bench_, octets);
    model_.hear_noise(bench_.now());
  }

  void hand(const SequenceCommand& command) {
    displace();
    wait_in_standby(command.numbers[2]);
    if (model_.is_scheduler()) return;
    const auto version =
        static_cast<std::uint16_t>(bench_.configuration().schedule.version + command.numbers[1]);
    const Octets tl{bench_.rules().codes.tl, command.numbers[0] != 0 ? kSecondOfLas : bench_.node(),
                    static_cast<std::uint8_t>(version >> 8), static_cast<std::uint8_t>(version)};
    const bool is_whole = send_link_command(bench_, tl, command);
    is_whole ? model_.hear_scheduler(tl, bench_.now()) : model_.hear_noise(bench_.now());
  }

  void order(std::uint8_t heir, HeirSends sends) {
    if (!model_.is_scheduler() && sends != HeirSends::not_awaited) answer(next_said());
    judge_.expect(bench_.order_transfer(heir), "order_refused", "a link master takes the order",
                  "it is refused");
    model_.order_transfer(heir, bench_.now());
    if (sends == HeirSends::not_awaited) return;
    const auto tl = next_that([&](const DrivenDlpdu& one) { return is_of(one, bench_.rules().codes.tl); });
    if (!tl) judge_.fail("not_transferred", {{fmt::format("a TL for {:02X}", heir)}, "none", bench_.now()});
    if (sends == HeirSends::nothing) return;
    bench_.wait(bench_.least_gap());
    const auto& codes = bench_.rules().codes;
    if (sends == HeirSends::token_back) return say_as_scheduler({codes.rt});
    say_as_scheduler({codes.pn, sends == HeirSends::probe ? kSecondOfLas : bench_.node()});
  }

  // ---- time, entities and the supply ----

  void ask_late(std::int64_t left, bool is_of_another) {
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

  void say_of_entity(const DrivenDlpdu& pt, bool is_for_everybody) {
    const fieldbus_dll::FfAddress to =
        is_for_everybody ? fieldbus_dll::kEverybody : fieldbus_dll::address_of(bench_.node());
    constexpr std::uint8_t kUnknown = 7;
    const Octets dt1 =
        bench_.dt1(Priority::urgent, to, fieldbus_dll::address_of(pt.octet(1)), {kUnknown, 1, 2});
    if (is_in_token(pt, dt1.size())) model_.hear_data(say(dt1));
    return_token(pt);
  }

  void lose_supply(std::int64_t octets) {
    bench_.set_supply(false);
    judge_.expect(!bench_.next_begins(bench_.now() + bench_.octets(octets)), "says_without_supply",
                  "nothing without supply", "a DLPDU");
    bench_.run_until(bench_.now() + bench_.octets(octets));
    judge_events();
    bench_.user().events.clear();
    bench_.set_supply(true);
    model_.lose_supply(bench_.now());
  }

  static constexpr std::uint8_t kSecondOfLas = 0x13;
  static constexpr std::uint8_t kGrantOfSecond = 88;
  static constexpr std::uint8_t kNobody = 0x77;

  FfBench& bench_;
  CaseJudge& judge_;
  FfLasModel model_;
  std::map<std::uint8_t, std::int64_t> tokens_missed_;
  std::set<std::uint8_t> joining_;
  std::vector<Octets> data_;
  std::int64_t submitted_ = 0;
};

std::vector<PartialSource> ff_las_sequence_details() {
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  std::vector<PartialSource> details = ff_details();
  details.push_back(
      {own("what a scheduler says when"),
       {"does_not_wait", "order_wrong", "begin_not_marked", "token_for_removed",
        "token_shorter_than_the_time", "priority_wrong", "time_request_ignored", "data_not_sent",
        "sends_other_data", "second_probe", "probes_out_of_order", "time_told_too_often", "idle_early",
        "own_turn_too_long", "over_what_is_due", "says_without_supply"}});
  details.push_back({own("what the user of a scheduler is told"), {"event_wrong"}});
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
      with_beginnings(ff_las_vocabulary(), states_of_a_master()),
      {{DerivedKind::values, {"steps_to_the_extreme", "priority_wrong"}},
       {DerivedKind::faults, {"steers_the_wrong_way", "priority_wrong"}},
       {DerivedKind::words, {"token_over_due", "token_over_due"}},
       {DerivedKind::words, {"reply_missing_of_itself", "event_wrong"}},
       {DerivedKind::words, {"each_event_once", "event_wrong"}},
       {DerivedKind::words, {"data_return_no_token", "event_wrong"}},
       {DerivedKind::values, {"all_admitted_behind_two_slow", "priority_wrong"}},
       {DerivedKind::values, {"own_data_newest_first", "sends_other_data"}},
       {DerivedKind::words, {"own_data_final", "sends_other_data"}},
       {DerivedKind::words, {"activation_time_available", "not_activated"}},
       {DerivedKind::states, {"own_item_normal", "own_buffer_wrong"}},
       {DerivedKind::states, {"live_list_unnumbered", "live_list_wrong"}},
       {DerivedKind::words, {"not_in_its_live_list", "live_list_wrong"}},
       {DerivedKind::words, {"idles_early", "idle_early"}},
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
