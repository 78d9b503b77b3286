#include "conformance/fieldbus_dll/isa_las_sequence_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

namespace {

constexpr std::uint8_t kHeirOfIsaLas = 0x12;
constexpr int kMostBeforeTransfer = 6;
constexpr std::uint8_t kOrderOfTransfer = 0x03;

IsaConfiguration configuration_of_isa_las(const IsaBench& bench) {
  IsaConfiguration configuration;
  configuration.rules = bench.rules();
  configuration.address = bench.address();
  configuration.schedule = schedule_of_isa_las();
  return configuration;
}

}  // namespace

IsaLasSequenceRun::IsaLasSequenceRun(IsaBench& bench, CaseJudge& judge)
    : bench_(bench), judge_(judge), acceptor_(configuration_of_isa_las(bench), bench.now()) {}

void IsaLasSequenceRun::run(const Sequence& sequence) {
  for (const SequenceCommand& command : sequence.commands) execute(command);
  const kernel::Time end = bench_.now() + 2 * kPeriodOfIsaLas * kOctetAt31250;
  while (bench_.now() < end) obey();
  judge_reports();
}

void IsaLasSequenceRun::execute(const SequenceCommand& command) {
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

std::optional<DrivenDlpdu> IsaLasSequenceRun::next_said() {
  while (const auto one = next_of_any_kind()) {
    if ((one->octet(0) & 0xF0U) != bench_.rules().codes.cd) return one;
    answer(*one);
  }
  return std::nullopt;
}

std::optional<DrivenDlpdu> IsaLasSequenceRun::next_of_any_kind() {
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

void IsaLasSequenceRun::judge_reports() {
  const std::vector<IsaReport> actual = std::exchange(bench_.user().reports, {});
  judge_reported(judge_, acceptor_.take_reports(actual), actual, bench_.now());
}

bool IsaLasSequenceRun::is_token(const DrivenDlpdu& one) const {
  const unsigned code = one.octet(0) & 0xF0U;
  return code == bench_.rules().codes.et || code == bench_.rules().codes.es;
}

void IsaLasSequenceRun::with_token(const Hold& hold) {
  while (const auto one = next_said()) {
    if (is_token(*one)) return hold(*one);
  }
}

void IsaLasSequenceRun::obey() {
  if (const auto one = next_said(); one && is_token(*one)) give_back(*one);
}

void IsaLasSequenceRun::submit(Priority priority, std::size_t size, std::size_t to) {
  const auto& rules = bench_.rules();
  const std::array<std::uint8_t, 4> destinations{IsaBench::kPeer, rules.everybody, rules.first_address,
                                                 rules.last_address};
  // None is the sign of life of who was handed the link.
  const std::size_t least = destinations.at(to) == rules.everybody ? 1 : 0;
  submit_for(IsaService::unit_data, priority, destinations.at(to),
             bench_.numbered_data(std::max(size, least)));
}

void IsaLasSequenceRun::submit_for(IsaService service, Priority priority, std::uint8_t destination,
                                   const Octets& data) {
  const bool is_taken = bench_.submit(service, priority, data, destination);
  const bool is_right = acceptor_.submit(service, priority, destination, data, bench_.now());
  judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
    return Mismatch{{fmt::format("data of {} octets is {}", data.size(), is_right ? "taken" : "refused")},
                    is_taken ? "taken" : "refused"};
  });
  // Who has nothing else to do begins at once.
  if (bench_.next_begins(bench_.now())) obey();
}

void IsaLasSequenceRun::order(std::uint8_t heir) {
  judge_.expect(bench_.order_transfer(heir), "order_refused", "an order to hand the link over is taken",
                "refused");
  acceptor_.order_transfer(heir, bench_.now());
}

void IsaLasSequenceRun::transfer(const SequenceCommand& command) {
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

void IsaLasSequenceRun::take_over(const SequenceCommand& command, std::uint8_t heir) {
  const auto& codes = bench_.rules().codes;
  const auto header_for_third = [&](std::uint8_t code, std::uint8_t from) {
    return header(code, Priority::normal, kThirdSender, from);
  };
  if (command.numbers[3] == 1) say(header_for_third(codes.du, IsaBench::kPeer));
  if (command.numbers[3] == 2) say(header_for_third(codes.du, kNoAddress));
  if (command.numbers[0] == 0) return;
  const std::array shown{header_for_third(codes.du, heir), bench_.ee(heir), header_for_third(codes.et, heir),
                         header_for_third(codes.cd, heir),
                         header(codes.du, Priority::normal, bench_.address(), heir)};
  say(shown.at(static_cast<std::size_t>(command.numbers[1])));
}

void IsaLasSequenceRun::say_at_once(const Octets& octets) {
  bench_.wait(bench_.octets(1));
  acceptor_.hear(octets, bench_.send(octets));
}

void IsaLasSequenceRun::resume(std::int64_t version, bool is_ordered, std::int64_t in) {
  if (!acceptor_.is_standby()) return;
  if (is_ordered) order(kFirstOrdered);
  say(tl(kThirdSender, kLowerScheduler, version));
  (void)next_said();
  if (in == 0) return say(tl(bench_.address(), kLowerScheduler, version));
  const std::uint8_t code = in == 1 ? bench_.rules().codes.et : bench_.rules().codes.cd;
  say(header(code, Priority::time_available, bench_.address(), kLowerScheduler));
  say_at_once(tl(bench_.address(), kLowerScheduler, version));
}

void IsaLasSequenceRun::lose_supply(std::int64_t octets) {
  bench_.set_supply(false);
  judge_.expect(!bench_.next_begins(bench_.now() + bench_.octets(octets)), "says_without_supply",
                "nothing without supply", "a DLPDU");
  if (!acceptor_.may_owe_event(bench_.now())) judge_reports();
  bench_.user().reports.clear();
  bench_.set_supply(true);
  acceptor_ = IsaLasAcceptor(configuration_of_isa_las(bench_), bench_.now());
  outcomes_ = {};
}

}  // namespace fieldproof::conformance
