#include "conformance/fieldbus_dll/isa_las_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"
#include "conformance/fieldbus_dll/isa_las_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

constexpr std::uint8_t kHeirOfIsaLas = 0x12;
constexpr std::uint8_t kFirstOrdered = 0x13;
constexpr std::uint8_t kLowerScheduler = 0x08;
constexpr std::uint8_t kHigherScheduler = 0x30;
constexpr std::array<std::uint8_t, 4> kOtherSchedulers{kHigherScheduler, kLowerScheduler, 0xF7, 0x0F};
constexpr std::uint8_t kThirdSender = 0x2A;
constexpr std::uint8_t kNoAddress = 0;
constexpr int kMostBeforeTransfer = 6;
constexpr std::size_t kSizeOfReply = 8;
constexpr std::uint8_t kOrderOfTransfer = 0x03;

IsaConfiguration configuration_of_isa_las(const IsaBench& bench) {
  IsaConfiguration configuration;
  configuration.rules = bench.rules();
  configuration.address = bench.address();
  configuration.schedule = schedule_of_isa_las();
  return configuration;
}

Octets operator+(Octets header, const Octets& data) {
  header.insert(header.end(), data.begin(), data.end());
  return header;
}

class IsaLasSequenceRun {
 public:
  IsaLasSequenceRun(IsaBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), acceptor_(configuration_of_isa_las(bench), bench.now()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    const kernel::Time end = bench_.now() + 2 * kPeriodOfIsaLas * kOctetAt31250;
    while (bench_.now() < end) obey();
    judge_reports();
  }

 private:
  using Hold = std::function<void(const DrivenDlpdu&)>;

  void execute(const SequenceCommand& command) {
    const auto number = [&](std::size_t n) { return command.numbers.at(n); };
    const auto size = [&](std::size_t n) { return static_cast<std::size_t>(number(n)); };
    switch (static_cast<IsaLasWord>(command.word)) {
      case IsaLasWord::obey:
        for (std::int64_t n = 0; n < number(0); ++n) obey();
        return;
      case IsaLasWord::silent:
        return with_token([](const DrivenDlpdu&) {});
      case IsaLasWord::use:
        return with_token([&](const DrivenDlpdu& token) {
          use(token, static_cast<HolderData>(number(0)), size(1), number(2));
          give_back(token);
        });
      case IsaLasWord::keep:
        return with_token(
            [&](const DrivenDlpdu& token) { use(token, HolderData::for_another, size(0), number(1)); });
      case IsaLasWord::compel:
        return with_token([&](const DrivenDlpdu& token) { compel(token); });
      case IsaLasWord::third:
        return with_token([&](const DrivenDlpdu& token) {
          say(said_by_third(number(0)));
          give_back(token);
        });
      case IsaLasWord::spoilt:
        return with_token([&](const DrivenDlpdu& token) { give_back_as(token, command); });
      case IsaLasWord::submit:
        return submit(static_cast<Priority>(number(0)), size(1), size(2));
      case IsaLasWord::transfer:
        return transfer(command);
      case IsaLasWord::second:
        return with_token([&](const DrivenDlpdu& token) {
          if (number(3) != 0) order(kHeirOfIsaLas);
          say(said_by_another(kOtherSchedulers.at(size(0)), number(1)));
          if (!acceptor_.is_standby() && number(2) != 0) give_back(token);
        });
      case IsaLasWord::resume:
        return resume(number(0), number(1) != 0, number(2));
      case IsaLasWord::late:
        return with_token([&](const DrivenDlpdu& token) {
          wait_until_over(number(0));
          give_back(token);
        });
      case IsaLasWord::overstay:
        return with_token([&](const DrivenDlpdu& token) { overstay(token, number(0)); });
      case IsaLasWord::ask:
        return with_token(
            [&](const DrivenDlpdu& token) { ask(token, static_cast<Priority>(number(0)), number(1) != 0); });
      case IsaLasWord::prepare:
        return submit_for(IsaService::reply_data, static_cast<Priority>(number(0)), IsaBench::kPeer,
                          bench_.numbered_data(size(1)));
      case IsaLasWord::request:
        outcomes_.at(size(0)).push_back(static_cast<PeerAnswer>(number(1)));
        return submit_for(IsaService::compel, static_cast<Priority>(number(0)), IsaBench::kPeer, {});
      case IsaLasWord::again:
        return with_token([&](const DrivenDlpdu&) { say(tl(bench_.address(), kThirdSender, number(0))); });
      case IsaLasWord::end:
        return with_token([&](const DrivenDlpdu& token) {
          Octets ee = bench_.ee(token.octet(1));
          ee[1] = number(1) == 0 ? ee[1] : kThirdSender;
          ee[3] = static_cast<std::uint8_t>(number(0));
          say_under_token(ee);
        });
      case IsaLasWord::pause:
        if (bench_.next_begins(bench_.now() + bench_.octets(number(0)))) obey();
        return;
      case IsaLasWord::supply:
        return lose_supply(number(0));
    }
  }

  // ---- what the scheduler says ----

  // Nothing in standby. What it compels is answered.
  std::optional<DrivenDlpdu> next_said() {
    while (const auto one = next_of_any_kind()) {
      if ((one->octet(0) & 0xF0U) != bench_.rules().codes.cd) return one;
      answer(*one);
    }
    return std::nullopt;
  }

  std::optional<DrivenDlpdu> next_of_any_kind() {
    const kernel::Time until = acceptor_.silent_until();
    const auto one =
        bench_.next(until == kernel::kNever ? bench_.now() + kOctetAt31250 * kPeriodOfIsaLas / 4 : until);
    if (!one && until != kernel::kNever) {
      const LinkObjection silence = acceptor_.silence();
      judge_.fail(silence.reason, {{silence.expected}, "silence", bench_.now()});
    }
    if (one) {
      judge_.expect(one->end - one->begin == bench_.frame(one->octets.size()), "preamble_wrong", [&] {
        return Mismatch{
            {fmt::format("{} octets of preamble", bench_.link().preamble_octets)}, one->text(), one->begin};
      });
      if (const auto objection = acceptor_.say(*one))
        judge_.fail(objection->reason, {{objection->expected}, one->text(), one->begin});
    }
    if (!acceptor_.may_owe_event(bench_.now())) judge_reports();
    return one;
  }

  void judge_reports() {
    const std::vector<IsaReport> actual = std::exchange(bench_.user().reports, {});
    judge_reported(judge_, acceptor_.take_reports(actual), actual, bench_.now());
  }

  bool is_token(const DrivenDlpdu& one) const {
    const unsigned code = one.octet(0) & 0xF0U;
    return code == bench_.rules().codes.et || code == bench_.rules().codes.es;
  }

  void with_token(const Hold& hold) {
    while (const auto one = next_said()) {
      if (is_token(*one)) return hold(*one);
    }
  }

  void obey() {
    if (const auto one = next_said(); one && is_token(*one)) give_back(*one);
  }

  // ---- what others say ----

  Octets header(std::uint8_t code, Priority priority, std::uint8_t to, std::uint8_t from) const {
    return {bench_.control(code, priority), to, from};
  }
  Octets tl(std::uint8_t to, std::uint8_t from, std::int64_t version) const {
    return {bench_.rules().codes.tl, to, from, static_cast<std::uint8_t>(version >> 8),
            static_cast<std::uint8_t>(version & 0xFF)};
  }

  void say(const Octets& octets) {
    bench_.wait(bench_.least_gap());
    acceptor_.hear(octets, bench_.send(octets));
  }

  // A holder does not talk into what the scheduler may say when its token is over.
  void say_under_token(const Octets& octets) {
    if (bench_.now() + bench_.least_gap() + bench_.octets(1) <= acceptor_.out_until()) say(octets);
  }

  void give_back(const DrivenDlpdu& token) { say_under_token(bench_.ee(token.octet(1))); }

  void give_back_as(const DrivenDlpdu& token, const SequenceCommand& command) {
    bench_.wait(bench_.least_gap());
    const Octets ee = bench_.ee(token.octet(1));
    const bool is_whole = send_link_command(bench_, ee, command);
    is_whole ? acceptor_.hear(ee, bench_.now()) : acceptor_.hear_noise(bench_.now());
  }

  void use(const DrivenDlpdu& token, HolderData data, std::size_t size, std::int64_t frames) {
    const auto& codes = bench_.rules().codes;
    const std::uint8_t to = data == HolderData::for_another     ? kThirdSender
                            : data == HolderData::for_everybody ? bench_.rules().everybody
                                                                : bench_.address();
    const std::uint8_t code = data == HolderData::reply_to_scheduler ? codes.dt : codes.du;
    for (std::int64_t n = 0; n < frames; ++n)
      say_under_token(header(code, Priority::normal, to, token.octet(1)) + bench_.numbered_data(size));
  }

  void compel(const DrivenDlpdu& token) {
    say(header(bench_.rules().codes.cd, Priority::normal, kThirdSender, token.octet(1)));
    bench_.wait(bench_.reply_wait() + bench_.octets(1) - bench_.least_gap());
    give_back(token);
  }

  // So that what comes V(MID) later begins so many octets before.
  void wait_until_over(std::int64_t octets) {
    const kernel::Time begin = acceptor_.out_until() - bench_.octets(octets) - bench_.least_gap();
    if (begin > bench_.now()) bench_.run_until(begin);
  }

  void overstay(const DrivenDlpdu& token, std::int64_t octets) {
    use(token, HolderData::for_another, 1, 1);
    wait_until_over(octets);
    use(token, HolderData::for_another, 30, 1);
  }

  void ask(const DrivenDlpdu& token, Priority priority, bool is_returned) {
    say(header(bench_.rules().codes.cd, priority, bench_.address(), token.octet(1)));
    (void)next_said();
    if (is_returned) give_back(token);
  }

  void answer(const DrivenDlpdu& cd) {
    const auto priority = static_cast<Priority>(cd.octet(0) & 3U);
    const auto number = static_cast<std::size_t>(priority);
    const Octets data =
        bench_.numbered_data(std::min<std::size_t>(kSizeOfReply, bench_.link().most_data.at(number - 1)));
    const Octets reply = bench_.dt(priority, data, cd.octet(1));
    const PeerAnswer outcome = outcomes_.at(number).front();
    outcomes_.at(number).pop_front();
    switch (outcome) {
      case PeerAnswer::replies:
        return say(reply);
      case PeerAnswer::is_silent:
        return;
      case PeerAnswer::sends_data:
        return say(header(bench_.rules().codes.du, priority, bench_.address(), kThirdSender) + data);
      case PeerAnswer::another_replies:
        return say(bench_.dt(priority, data, kThirdSender));
      case PeerAnswer::is_none:
        return say(bench_.dt(priority, data, kNoAddress));
      case PeerAnswer::replies_late:
        bench_.wait(bench_.reply_wait() - bench_.octets(1) - bench_.least_gap());
        return say(reply);
      case PeerAnswer::replies_urgently:
        return say(bench_.dt(Priority::urgent, {}, cd.octet(1)));
      case PeerAnswer::hands_over:
        return say(tl(bench_.address(), kThirdSender, 1));
      case PeerAnswer::higher_scheduler:
        return say(said_by_another(kHigherScheduler, 0));
      case PeerAnswer::lower_scheduler:
        return say(said_by_another(kLowerScheduler, 0));
    }
  }

  Octets said_by_third(std::int64_t kind) const {
    const auto& codes = bench_.rules().codes;
    if (kind == 0) return bench_.ee(kThirdSender);
    if (kind == 1) return header(codes.cd, Priority::normal, kFirstOrdered, kThirdSender);
    return header(codes.du, Priority::normal, bench_.rules().everybody, kThirdSender);
  }

  Octets said_by_another(std::uint8_t scheduler, std::int64_t kind) const {
    const auto& codes = bench_.rules().codes;
    if (kind == 2) return tl(kThirdSender, scheduler, 1);
    const Octets token = header(kind == 0 ? codes.et : codes.es, Priority::normal, kThirdSender, scheduler);
    return kind == 0 ? token : token + Octets{0, 20};
  }

  // ---- the user ----

  void submit(Priority priority, std::size_t size, std::size_t to) {
    const auto& rules = bench_.rules();
    const std::array<std::uint8_t, 4> destinations{IsaBench::kPeer, rules.everybody, rules.first_address,
                                                   rules.last_address};
    // None is the sign of life of who was handed the link.
    const std::size_t least = destinations.at(to) == rules.everybody ? 1 : 0;
    submit_for(IsaService::unit_data, priority, destinations.at(to),
               bench_.numbered_data(std::max(size, least)));
  }

  void submit_for(IsaService service, Priority priority, std::uint8_t destination, const Octets& data) {
    const bool is_taken = bench_.submit(service, priority, data, destination);
    const bool is_right = acceptor_.submit(service, priority, destination, data, bench_.now());
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", data.size(), is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
    // Who has nothing else to do begins at once.
    if (bench_.next_begins(bench_.now())) obey();
  }

  void order(std::uint8_t heir) {
    judge_.expect(bench_.order_transfer(heir), "order_refused", "an order to hand the link over is taken",
                  "refused");
    acceptor_.order_transfer(heir, bench_.now());
  }

  // What it has begun ends before.
  void transfer(const SequenceCommand& command) {
    if (acceptor_.is_standby()) return;
    if (command.numbers[2] > 1) {
      judge_.expect(!bench_.ask_user_request({kOrderOfTransfer}), "order_without_node_taken",
                    "an order without a node is refused", "it is taken");
      order(kFirstOrdered);
    }
    // On a free link a TL may begin at once.
    const bool is_too_late = command.numbers[2] > 1 && bench_.next_begins(bench_.now());
    if (!is_too_late) order(kHeirOfIsaLas);
    const std::uint8_t heir = is_too_late ? kFirstOrdered : kHeirOfIsaLas;
    for (int said = 0; said < kMostBeforeTransfer; ++said) {
      const auto one = next_said();
      if (one && (one->octet(0) & 0xF0U) == bench_.rules().codes.tl) return take_over(command, heir);
      if (one && is_token(*one)) give_back(*one);
    }
    judge_.fail("no_transfer", {{"a TL as soon as no token is out"}, "none", bench_.now()});
  }

  void take_over(const SequenceCommand& command, std::uint8_t heir) {
    const auto& codes = bench_.rules().codes;
    const auto header_for_third = [&](std::uint8_t code, std::uint8_t from) {
      return header(code, Priority::normal, kThirdSender, from);
    };
    if (command.numbers[3] == 1) say(header_for_third(codes.du, IsaBench::kPeer));
    if (command.numbers[3] == 2) say(header_for_third(codes.du, kNoAddress));
    if (command.numbers[0] == 0) return;
    const std::array shown{header_for_third(codes.du, heir), bench_.ee(heir),
                           header_for_third(codes.et, heir), header_for_third(codes.cd, heir),
                           header(codes.du, Priority::normal, bench_.address(), heir)};
    say(shown.at(static_cast<std::size_t>(command.numbers[1])));
  }

  // What it holds or owes is begun V(MID) later at the soonest.
  void say_at_once(const Octets& octets) {
    bench_.wait(bench_.octets(1));
    acceptor_.hear(octets, bench_.send(octets));
  }

  void resume(std::int64_t version, bool is_ordered, std::int64_t in) {
    if (!acceptor_.is_standby()) return;
    if (is_ordered) order(kFirstOrdered);
    say(tl(kThirdSender, kLowerScheduler, version));
    (void)next_said();
    if (in == 0) return say(tl(bench_.address(), kLowerScheduler, version));
    const std::uint8_t code = in == 1 ? bench_.rules().codes.et : bench_.rules().codes.cd;
    say(header(code, Priority::time_available, bench_.address(), kLowerScheduler));
    say_at_once(tl(bench_.address(), kLowerScheduler, version));
  }

  // What was submitted, ordered and out is gone; who begins as the scheduler begins as that again.
  void lose_supply(std::int64_t octets) {
    bench_.set_supply(false);
    judge_.expect(!bench_.next_begins(bench_.now() + bench_.octets(octets)), "says_without_supply",
                  "nothing without supply", "a DLPDU");
    if (!acceptor_.may_owe_event(bench_.now())) judge_reports();
    bench_.user().reports.clear();
    bench_.set_supply(true);
    acceptor_ = IsaLasAcceptor(configuration_of_isa_las(bench_), bench_.now());
    outcomes_ = {};
  }

  IsaBench& bench_;
  CaseJudge& judge_;
  IsaLasAcceptor acceptor_;
  std::array<std::deque<PeerAnswer>, 4> outcomes_;  // by priority
};

std::vector<PartialSource> isa_las_sequence_details() {
  using link_sources::own;
  return {{own("V(RR) is 32 octets, VC(UC) the duration and a margin, items within V(ST) of their time"),
           {"talks_into_token", "talks_into_transfer", "talks_into_reply", "answers_too_early",
            "delegation_early", "line_left_silent", "no_reply", "preamble_wrong", "says_without_supply"}},
          {own("the scheduler's own data, where it ends before the next item"),
           {"sends_other_data", "own_data_over_due", "data_refused", "data_too_long_taken", "reply_wrong"}},
          {own("TL, and the lower address of two schedulers"),
           {"speaks_unasked", "transfer_unasked", "transfer_wrong", "no_transfer", "order_refused",
            "order_without_node_taken"}},
          {own("what its user is given, and in which order"),
           {"not_delivered", "delivered_otherwise", "delivered_unasked"}}};
}

}  // namespace

const SequenceRole& isa_las_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/isa_las/check/follows_the_rules",
       .purpose = "check",
       .requirement =
           "Whatever holders do in whatever order, a scheduler delegates its token as its schedule says, "
           "supervises it, sends its own data in between and hands the link over when it must.",
       .reference = link_sources::isa_paper("the link active scheduler and its timers"),
       .details = isa_las_sequence_details(),
       .stimulus =
           "Holders at random, and returns with half bits and bits that are flipped and octets that are "
           "missing.",
       .expected = "What an acceptor of the rules allows.",
       .tags = {},
       .catches = {}},
      with_beginnings(isa_las_vocabulary(), states_of_an_isa_las()),
      {{DerivedKind::values, {"schedule_late", "line_left_silent"}},
       {DerivedKind::drawn, {"sign_of_life_of_anybody", "line_left_silent"}},
       {DerivedKind::drawn, {"first_order_stays", "transfer_wrong"}},
       {DerivedKind::drawn, {"order_refused_in_standby", "order_refused"}},
       {DerivedKind::states, {"end_with_a_reason_ignored", "delivered_unasked"}},
       {DerivedKind::drawn, {"signed_addresses", "line_left_silent"}},
       {DerivedKind::settings, {"one_octet_of_preamble", "preamble_wrong"}},
       {DerivedKind::words, {"standby_after_supply", "line_left_silent"}},
       {DerivedKind::faults, {"schedule_not_begun", "line_left_silent"}},
       {DerivedKind::words, {"schedule_early", "delegation_early"}},
       {DerivedKind::words, {"each_event_once", "not_delivered"}},
       {DerivedKind::words, {"reclaimed_is_overrun", "delivered_otherwise"}},
       {DerivedKind::words, {"own_data_without_return", "own_data_over_due"}},
       {DerivedKind::words, {"transfer_ignored_by_scheduler", "delegation_wrong"}},
       {DerivedKind::states, {"retakes_early", "answers_too_early"}},
       {DerivedKind::repetitions, {"scheduler_never_replies", "no_reply"}},
       {DerivedKind::settings, {"transfer_without_version", "transfer_wrong"}},
       {DerivedKind::drawn, {"scheduler_for_reply_untold", "not_delivered"}},
       {DerivedKind::drawn, {"schedule_early", "delegation_early"}}}};
  return role;
}

IsaNeeds isa_las_sequence_needs() {
  return {.schedule = schedule_of_isa_las()};
}

void run_isa_las_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge) {
  IsaLasSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
