#include "conformance/fieldbus_dll/isa_las_sequence.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <vector>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_las_acceptor.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaService;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

constexpr int kPeriodOfIsaLas = 600;
constexpr std::uint8_t kHeirOfIsaLas = 0x12;
constexpr std::uint8_t kLowerScheduler = 0x08;
constexpr std::uint8_t kHigherScheduler = 0x30;
constexpr std::uint8_t kThirdSender = 0x2A;
constexpr int kMostBeforeTransfer = 4;

constexpr std::array<std::int64_t, 4> kIsaLasCounts{1, 2, 6, 12};
constexpr std::array<std::int64_t, 4> kIsaLasSizes{0, 1, 8, 30};
constexpr std::array<std::int64_t, 5> kIsaLasOwnSizes{0, 8, 30, 64, 65};

enum class IsaLasWord : std::uint8_t {
  obey,
  silent,
  use,
  keep,
  compel,
  third,
  spoilt,
  submit,
  transfer,
  second,
  resume
};

// The second of each pair is due while the first is out, the first one later than V(RR): who is handed the
// link has to show itself before.
IsaSchedule schedule_of_isa_las() {
  using enum Priority;
  return {.version = 0x0102,
          .period = kPeriodOfIsaLas * kOctetAt31250,
          .items = {{60 * kOctetAt31250, IsaType::es, 0x21, time_available, 60},
                    {75 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {200 * kOctetAt31250, IsaType::es, 0x23, urgent, 100},
                    {215 * kOctetAt31250, IsaType::et, 0x21, urgent, 0},
                    {420 * kOctetAt31250, IsaType::et, 0x22, normal, 0},
                    {430 * kOctetAt31250, IsaType::es, 0x23, time_available, 300}}};
}

SequenceNumber size_of_holder() {
  return {"size", 0, 30, 8, kIsaLasSizes};
}

// Holders of sequences leave room for a station that says something else, and for a reply that does not come.
constexpr std::array kBoundsOfIsaLas{SettingBound{"preamble_octets", {1, 2}},
                                     SettingBound{"inter_pdu_delay_octets", {2, 8}},
                                     SettingBound{"reply_wait_octets", {32, 40}}};

SequenceVocabulary isa_las_vocabulary() {
  const fieldbus_dll::IsaConfiguration as_made;
  // In the order of IsaLasWord.
  return {
      .words = {{.word = "obey",
                 .meaning = "so many tokens are returned at once",
                 .numbers = {{"count", 1, 30, 1, kIsaLasCounts}},
                 .weight = 6},
                {.word = "silent", .meaning = "the holder of the next token is silent", .weight = 6},
                {.word = "use",
                 .meaning = "the next holder sends data, to the scheduler (0) or to another, and "
                            "returns its token",
                 .numbers = {{"to", 0, 1, 0}, size_of_holder()},
                 .weight = 4},
                {.word = "keep",
                 .meaning = "the next holder sends data and is silent then",
                 .numbers = {size_of_holder()},
                 .weight = 5},
                {.word = "compel",
                 .meaning = "the next holder compels a station that is silent, and returns its token",
                 .weight = 2},
                {.word = "third",
                 .meaning = "a third station sends an EE while a token is out, then its holder does",
                 .weight = 3},
                {.word = "spoilt",
                 .meaning = "the next holder returns its token with faults",
                 .units = 8,
                 .weight = 4},
                {.word = "submit",
                 .meaning = "the scheduler's user submits data",
                 .numbers = {{"priority", 1, 3, 1}, {"size", 0, 260, 8, kIsaLasOwnSizes}},
                 .weight = 5},
                {.word = "transfer",
                 .meaning = "the user orders a TL; its heir is silent (0) or takes over (1)",
                 .numbers = {{"taken", 0, 1, 1}},
                 .weight = 4},
                {.word = "second",
                 .meaning = "a scheduler of a higher (0) or a lower (1) address sends an ET while a token "
                            "is out",
                 .numbers = {{"lower", 0, 1, 1}},
                 .weight = 4},
                {.word = "resume",
                 .meaning = "the link is handed back by a TL, first to another",
                 .weight = 6}},
      .unit = "octet",
      .levels_per_unit = kFlipsOfAnOctet,
      .settings = sequence_settings(fieldbus_dll::kIsaTable, &as_made, kFixedOfLink, kBoundsOfIsaLas),
      .objection = objection_of(fieldbus_dll::kIsaTable, as_made, expect_judgeable_isa)};
}

IsaConfiguration configuration_of_isa_las(const IsaBench& bench) {
  IsaConfiguration configuration;
  configuration.rules = bench.rules();
  configuration.address = bench.address();
  configuration.schedule = schedule_of_isa_las();
  return configuration;
}

class IsaLasSequenceRun {
 public:
  IsaLasSequenceRun(IsaBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), acceptor_(configuration_of_isa_las(bench), bench.now()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    const kernel::Time end = bench_.now() + 2 * kPeriodOfIsaLas * kOctetAt31250;
    while (bench_.now() < end) obey();
    std::vector<Octets> delivered;
    for (const auto& one : bench_.user().deliveries) delivered.push_back(one.dlpdu.data);
    judge_.expect(delivered == data_, "data_not_delivered", "the user gets the data of each DU for it",
                  "other data, or none");
  }

 private:
  void execute(const SequenceCommand& command) {
    const auto number = [&](std::size_t n) { return command.numbers.at(n); };
    switch (static_cast<IsaLasWord>(command.word)) {
      case IsaLasWord::obey:
        for (std::int64_t n = 0; n < number(0); ++n) obey();
        return;
      case IsaLasWord::silent:
        return with_token([](const DrivenDlpdu&) {});
      case IsaLasWord::use:
        return with_token([&](const DrivenDlpdu& token) {
          send_data(token, number(0) == 0, static_cast<std::size_t>(number(1)));
          give_back(token);
        });
      case IsaLasWord::keep:
        return with_token(
            [&](const DrivenDlpdu& token) { send_data(token, false, static_cast<std::size_t>(number(0))); });
      case IsaLasWord::compel:
        return with_token([&](const DrivenDlpdu& token) { compel(token); });
      case IsaLasWord::third:
        return with_token([&](const DrivenDlpdu& token) {
          acceptor_.hear_other(say(bench_.ee(kThirdSender)));
          give_back(token);
        });
      case IsaLasWord::spoilt:
        return with_token([&](const DrivenDlpdu& token) { give_back_as(token, command); });
      case IsaLasWord::submit:
        return submit(static_cast<Priority>(number(0)), static_cast<std::size_t>(number(1)));
      case IsaLasWord::transfer:
        return transfer(number(0) != 0);
      case IsaLasWord::second:
        return with_token([&](const DrivenDlpdu&) {
          another_scheduler(number(0) != 0 ? kLowerScheduler : kHigherScheduler);
        });
      case IsaLasWord::resume:
        return resume();
    }
  }

  // ---- what the scheduler says ----

  // Nothing in standby.
  std::optional<DrivenDlpdu> next_said() {
    const bool is_standby = acceptor_.is_standby();
    const auto one = bench_.next(is_standby ? bench_.now() + kOctetAt31250 * kPeriodOfIsaLas / 4
                                            : acceptor_.silent_until());
    if (!one && !is_standby)
      judge_.fail("line_left_silent", {{"the next item, data that fits, or a TL"}, "silence", bench_.now()});
    if (!one) return std::nullopt;
    if (const auto objection = acceptor_.say(*one))
      judge_.fail(objection->reason, {{objection->expected}, one->text(), one->begin});
    return one;
  }

  bool is_token(const DrivenDlpdu& one) const {
    const unsigned code = one.octet(0) & 0xF0U;
    return code == bench_.rules().codes.et || code == bench_.rules().codes.es;
  }

  void with_token(const std::function<void(const DrivenDlpdu&)>& hold) {
    while (const auto one = next_said()) {
      if (is_token(*one)) return hold(*one);
    }
  }

  void obey() {
    if (const auto one = next_said(); one && is_token(*one)) give_back(*one);
  }

  // ---- what others say ----

  kernel::Time say(const Octets& octets) {
    bench_.wait(bench_.least_gap());
    return bench_.send(octets);
  }

  void give_back(const DrivenDlpdu& token) { acceptor_.hear_return(say(bench_.ee(token.octet(1)))); }

  void give_back_as(const DrivenDlpdu& token, const SequenceCommand& command) {
    bench_.wait(bench_.least_gap());
    const bool is_whole = send_link_command(bench_, bench_.ee(token.octet(1)), command);
    is_whole ? acceptor_.hear_return(bench_.now()) : acceptor_.hear_other(bench_.now());
  }

  void send_data(const DrivenDlpdu& token, bool is_for_scheduler, std::size_t size) {
    const Octets data = bench_.numbered_data(size);
    Octets du{bench_.control(bench_.rules().codes.du, Priority::normal),
              is_for_scheduler ? bench_.address() : kThirdSender, token.octet(1)};
    du.insert(du.end(), data.begin(), data.end());
    acceptor_.hear_data(say(du));
    if (is_for_scheduler) data_.push_back(data);
  }

  void compel(const DrivenDlpdu& token) {
    acceptor_.hear_cd(
        say({bench_.control(bench_.rules().codes.cd, Priority::normal), kThirdSender, token.octet(1)}));
    bench_.wait(bench_.reply_wait() + bench_.octets(1) - bench_.least_gap());
    give_back(token);
  }

  void another_scheduler(std::uint8_t address) {
    acceptor_.hear_scheduler(
        address, say({bench_.control(bench_.rules().codes.et, Priority::normal), kThirdSender, address}));
  }

  void submit(Priority priority, std::size_t size) {
    const Octets data = bench_.numbered_data(size);
    const bool is_taken = bench_.submit_unit_data(priority, data);
    const bool is_right = acceptor_.submit(priority, IsaBench::kPeer, data, bench_.now());
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", size, is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  // What it has begun ends before.
  void transfer(bool is_taken) {
    if (acceptor_.is_standby()) return;
    bench_.order_transfer(kHeirOfIsaLas);
    acceptor_.order_transfer(kHeirOfIsaLas);
    for (int said = 0; said < kMostBeforeTransfer; ++said) {
      const auto one = next_said();
      if (one && (one->octet(0) & 0xF0U) == bench_.rules().codes.tl) {
        if (is_taken)
          acceptor_.hear_heir(
              say({bench_.control(bench_.rules().codes.du, Priority::normal), kThirdSender, kHeirOfIsaLas}));
        return;
      }
      if (one && is_token(*one)) give_back(*one);
    }
    judge_.fail("no_transfer", {{"a TL as soon as no token is out"}, "none", bench_.now()});
  }

  void resume() {
    if (!acceptor_.is_standby()) return;
    const auto tl = [&](std::uint8_t to) {
      return Octets{bench_.rules().codes.tl, to, kLowerScheduler, 0, 1};
    };
    acceptor_.hear_other(say(tl(kThirdSender)));
    (void)next_said();
    acceptor_.hear_transfer(say(tl(bench_.address())));
  }

  IsaBench& bench_;
  CaseJudge& judge_;
  IsaLasAcceptor acceptor_;
  std::vector<Octets> data_;
};

std::vector<PartialSource> isa_las_sequence_details() {
  using link_sources::own;
  return {{own("V(RR) is 32 octets, VC(UC) the duration and V(ST), items within V(ST) of their time"),
           {"talks_into_token", "talks_into_transfer", "answers_too_early", "delegation_early",
            "line_left_silent"}},
          {own("the scheduler's own data, where it ends before the next item"),
           {"sends_other_data", "own_data_over_due", "data_refused", "data_too_long_taken",
            "data_not_delivered"}},
          {own("TL, and the lower address of two schedulers"),
           {"speaks_unasked", "transfer_unasked", "transfer_wrong", "no_transfer"}}};
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
      isa_las_vocabulary(),
      {{DerivedKind::values, {"schedule_late", "line_left_silent"}},
       {DerivedKind::faults, {"schedule_not_begun", "line_left_silent"}},
       {DerivedKind::words, {"schedule_early", "delegation_early"}},
       {DerivedKind::states, {"retakes_early", "answers_too_early"}},
       {DerivedKind::repetitions, {"waits_out_duration", "line_left_silent"}},
       {DerivedKind::settings, {"transfer_without_version", "transfer_wrong"}},
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
