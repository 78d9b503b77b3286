#include "conformance/token_bus/dual_channel_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/dual_channel_cases.hpp"
#include "conformance/token_bus/dual_channel_reasons.hpp"
#include "conformance/token_bus/dual_channel_words.hpp"
#include "conformance/token_bus/sides_sequence.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/dual_channel_settings.hpp"

namespace fieldproof::conformance {
namespace {

class ManagerSequenceRun {
 public:
  ManagerSequenceRun(ManagerBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        twin_(reference_bench<ManagerBench, ManagerNeeds, ManagerSetting, token_bus::ChannelManager>(
            bench.configuration(), token_bus::kChannelManagerTable)) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      for (Begun* one : {&seen_, &right_}) {
        one->bench->clear();
        one->begin = one->bench->now();
        execute(command, *one->bench);
        one->bench->settle();
      }
      if (is_unsaid(command)) {
        for (Begun* one : {&seen_, &right_}) cycle_power(*one->bench);
        continue;
      }
      compare(command);
    }
  }

 private:
  struct Begun {
    ManagerBench* bench;
    kernel::Time begin{};  // of the command
  };

  static void cycle_power(ManagerBench& bench) {
    bench.set_power(false);
    bench.wait(bench.slot());
    bench.set_power(true);
  }

  // What silence in a train ends, and what the next frame on the other channel then is, the page says in two
  // ways; so it does of a start delimiter within a transmission that is none.
  static bool is_unsaid(const SequenceCommand& command) {
    constexpr std::uint32_t kSecond = 120;  // symbol, with which the second frame begins
    constexpr std::uint32_t kHead = 40;
    if (command.word != static_cast<std::size_t>(ManagerWord::train)) return false;
    return std::ranges::any_of(command.faults, [](const SequenceFault& one) {
      const bool is_in_head = one.unit + kHead >= kSecond && one.unit < kSecond + kHead;
      return one.kind == SequenceFaultKind::drop || is_in_head;
    });
  }

  static void carry(ManagerBench& bench, std::int64_t channel, const BothChannels& both) {
    carry(bench, channel, both.named, both.other);
  }
  static void carry(ManagerBench& bench, std::int64_t channel, const ChannelText& named,
                    const ChannelText& other) {
    channel == 0 ? bench.carry(named, other) : bench.carry(other, named);
  }

  static void execute(const SequenceCommand& command, ManagerBench& bench) {
    const auto& numbers = command.numbers;
    const auto faulty = [&](const std::string& text) { return with_faults(text, command.faults, 'B', 'S'); };
    switch (static_cast<ManagerWord>(command.word)) {
      case ManagerWord::both:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[2])), numbers[1]},
                     {received_frame(numbers[2])});
      case ManagerWord::alone:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[1]))}, {});
      case ManagerWord::differ:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[2])), numbers[1]},
                     {received_frame(numbers[2] ^ 0xFF)});
      case ManagerWord::wrong: {
        std::string wrong = received_frame(numbers[1]);
        char& one = wrong.at(wrong.size() - end_delimiter_text().size() - 1);
        one = one == '1' ? '0' : '1';
        return carry(bench, numbers[0], {wrong}, {received_frame(numbers[1])});
      }
      case ManagerWord::collide: {
        std::string collided = received_frame(numbers[1]);
        collided.replace(static_cast<std::size_t>(numbers[0]), 8, 8, 'B');
        return bench.carry({collided}, {collided});
      }
      case ManagerWord::train: {
        const std::string two = received_frame(numbers[1], true) + received_frame(numbers[1]);
        return carry(bench, numbers[0], {faulty(two)}, {two});
      }
      case ManagerWord::noise:
        return carry(bench, numbers[0], {faulty(std::string(static_cast<std::size_t>(numbers[1]), '1'))}, {});
      case ManagerWord::request:
        return bench.request(framed(numbers[0]));
      case ManagerWord::command:
        return bench.command(static_cast<SideCommand>(numbers[0]), 16);
      case ManagerWord::answer: {
        const auto answers = [](std::int64_t which) { return std::string(16, "iane"[which % 4]); };
        return bench.carry({numbers[0] == 1 ? "" : answers(numbers[1])},
                           {numbers[0] == 0 ? "" : answers(numbers[1] + (numbers[0] == 2 ? 1 : 0))});
      }
      case ManagerWord::wait:
        return bench.wait(numbers[0] * bench.slot());
      case ManagerWord::power:
        return cycle_power(bench);
      default:
        return execute_later(command, bench);
    }
  }

  static void execute_later(const SequenceCommand& command, ManagerBench& bench) {
    constexpr std::size_t kLongOctets = 1'000;
    constexpr unsigned kShortSlot = 14;
    constexpr std::int64_t kPartsPerMillion = 100;
    const auto& numbers = command.numbers;
    const auto& configuration = bench.configuration();
    switch (static_cast<ManagerWord>(command.word)) {
      case ManagerWord::limit:
        return carry(bench, numbers[0],
                     at_limit(static_cast<ManagerLimit>(numbers[1]), numbers[2], configuration));
      case ManagerWord::kinds:
        return carry(bench, numbers[0], {train_of(static_cast<TrainKind>(numbers[1]), configuration)},
                     {train_of(static_cast<TrainKind>(numbers[2]), configuration)});
      case ManagerWord::other_codes:
        return carry(bench, numbers[0], {with_other_codes(received_frame(numbers[1]))},
                     {received_frame(numbers[1])});
      case ManagerWord::longest_request:
        return bench.request(framed(0xB1, false, kLongestFrame));
      case ManagerWord::seconds:
        return bench.wait(numbers[0] * kernel::kSecond);
      case ManagerWord::meanwhile: {
        const kernel::Time requested = bench.begin_request(framed(numbers[0]));
        const std::string carried = received_frame(numbers[0] ^ 0xFF, false, 20);
        const kernel::Time end = std::max(requested, bench.begin_carrying({carried}, {carried}));
        return bench.wait(end - bench.now());
      }
      case ManagerWord::two_within:
        // With longer slot times the second one may be the copy of that one; what is counted then is open.
        if (configuration.rules.slot_time_octets > kShortSlot) return;
        carry(bench, numbers[0], two_within_one(numbers[1] == 1, configuration));
        bench.settle();
        return cycle_power(bench);
      case ManagerWord::stuck:
        carry(bench, numbers[0], beside_what_is_stuck(numbers[1] == 1, configuration));
        bench.settle();
        return cycle_power(bench);
      default:
        return carry(bench, numbers[0],
                     {received_frame(0xB1, false, kLongOctets), 0, kPartsPerMillion * numbers[1]}, {});
    }
  }

  void compare(const SequenceCommand& command) {
    for (const Channel channel : token_bus::kChannels) {
      const std::string side = fmt::format("requested of {}", text_of(channel));
      compare_sides(side, bench_.requested(channel), twin_.requested(channel), "request_other", judge_);
      expect_in_time(side, bench_.requested(channel), twin_.requested(channel), "sent_too_late");
    }
    expect_together();
    if (command.word == static_cast<std::size_t>(ManagerWord::stuck)) return compare_last();
    compare_sides("indicated", bench_.indicated(), twin_.indicated(), "indication_other", judge_);
    expect_in_time("indicated", bench_.indicated(), twin_.indicated(), "indicated_too_late");
    if (command.word == static_cast<std::size_t>(ManagerWord::clock)) expect_rate();
    compare_events();
  }

  void compare_events() {
    judge_.expect(bench_.events() == twin_.events(), "report_other",
                  fmt::format("reported: {}", fmt::join(twin_.events(), ", ")),
                  fmt::format("reported: {}", fmt::join(bench_.events(), ", ")));
    if (bench_.events().empty()) return;
    const kernel::Duration most = twin_.last_event() - right_.begin + twin_.indication_delay();
    const kernel::Duration took = bench_.last_event() - seen_.begin;
    judge_.expect(took <= most, "reported_too_late", kernel::describe(most), kernel::describe(took));
  }

  // What a channel that is stuck leaves of the first transmission is not looked at.
  void compare_last() {
    const auto last = [](const SideLog& log) {
      const std::string& text = log.text();
      const std::size_t at = text.rfind(start_delimiter_text());
      return at == std::string::npos ? "" : without_end(text.substr(at), 'S').substr(0, kShown);
    };
    const std::string right = last(twin_.indicated());
    const std::string seen = last(bench_.indicated());
    judge_.expect(seen == right, "indication_other", [&] { return difference(right, seen); });
  }

  // Each at the latest with the twin, which is as late as may be. They are the same letters.
  void expect_in_time(std::string_view side, const SideLog& seen, const SideLog& right,
                      std::string_view reason) {
    constexpr kernel::Duration kRounding = 2 * kernel::kNanosecond;
    const std::size_t count = without_end(right.text(), 'S').size();
    for (std::size_t n = 0; n < std::min(count, seen.text().size()); ++n) {
      if (right.text()[n] == 'S' || is_answer(right.text()[n])) continue;
      const kernel::Duration most = right.time_of(n) - right_.begin;
      const kernel::Duration took = seen.time_of(n) - seen_.begin;
      judge_.expect(took <= most + kRounding, reason, [&] {
        return Mismatch{
            {fmt::format("{}: symbol {} after {} at the latest", side, n, kernel::describe(most))},
            kernel::describe(took)};
      });
    }
  }
  static bool is_answer(char letter) {
    return std::string_view("iane").find(letter) != std::string_view::npos;
  }

  void expect_together() {
    const SideLog& on_a = bench_.requested(Channel::a);
    const SideLog& on_b = bench_.requested(Channel::b);
    if (on_a.empty() || on_b.empty()) return;
    const kernel::Duration apart = std::max(on_a.begin() - on_b.begin(), on_b.begin() - on_a.begin());
    const kernel::Duration most = bench_.symbols(bench_.configuration().channels.skew_symbols);
    judge_.expect(apart <= most + kernel::kNanosecond, "channels_apart", kernel::describe(most),
                  kernel::describe(apart));
  }

  // Each symbol lasts as long as it did on its channel.
  void expect_rate() {
    const std::size_t count = without_end(twin_.indicated().text(), 'S').size();
    if (count < 2 || bench_.indicated().text().size() < count) return;
    const auto length = [&](const SideLog& log) { return log.time_of(count - 1) - log.begin(); };
    const kernel::Duration right = length(twin_.indicated());
    const kernel::Duration took = length(bench_.indicated());
    const kernel::Duration apart = std::max(took - right, right - took);
    judge_.expect(apart < bench_.symbols(1) / 4, "indicated_at_another_rate", kernel::describe(right),
                  kernel::describe(took));
  }

  static constexpr std::size_t kShown = 80;

  ManagerBench& bench_;
  CaseJudge& judge_;
  ManagerBench twin_;
  Begun seen_{&bench_};
  Begun right_{&twin_};
};

}  // namespace

const SequenceRole& channel_manager_sequence_role() {
  static const SequenceRole role{
      {.id = "token_bus/channel_manager/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever two channels carry in whatever order, the MAC is given, the channels are "
                      "requested and faults are reported as the rules of the manager say.",
       .reference = token_sources::own("choice between two channels"),
       .details = {},
       .rules = dual_channel_reasons(),
       .stimulus = "Commands at random, with symbols that are spoiled or missing.",
       .expected = "What a reference does on a bench of its own.",
       .tags = {},
       .catches = {}},
      channel_manager_vocabulary(),
      // Of spoilt symbols the page leaves open what is right: for `check` only.
      {{DerivedKind::values, {"watches_the_preferred_alone", "report_other"}},
       {DerivedKind::words, {"sends_on_a_alone", "request_other"}},
       {DerivedKind::states, {"takes_the_first", "indication_other"}},
       {DerivedKind::walks, {"takes_the_first", "indication_other"}},
       {DerivedKind::repetitions, {"zero_and_one_exchanged_on_b", "request_other"}},
       {DerivedKind::settings, {"sends_on_the_preferred_alone", "request_other"}},
       {DerivedKind::drawn, {"sends_on_a_alone", "request_other"}}}};
  return role;
}

void run_channel_manager_sequence(const Sequence& sequence, ManagerBench& bench, CaseJudge& judge) {
  ManagerSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
