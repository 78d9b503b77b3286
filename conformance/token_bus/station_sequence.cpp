#include "conformance/token_bus/station_sequence.hpp"

#include <utility>

#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_comparison.hpp"
#include "conformance/token_bus/station_tester.hpp"
#include "conformance/token_bus/station_twin.hpp"

namespace fieldproof::conformance {
namespace {

class TokenSequenceRun {
 public:
  TokenSequenceRun(TokenBench& bench, CaseJudge& judge)
      : bench_(bench),
        tester_(bench),
        twin_(bench.configuration(), bench.tester_place(), bench.driven_frames(), bench.now()),
        comparison_(bench, twin_, judge) {}

  void run(const Sequence& sequence) {
    for (std::size_t n = 0; n < sequence.commands.size(); ++n) {
      const std::int64_t soon = std::exchange(soon_symbols_, 0);
      execute(sequence.commands[n]);
      // What the user does while the station decides is taken into account or not.
      if (soon > 0 && n + 1 < sequence.commands.size() && is_of_line(sequence.commands[n + 1])) {
        bench_.wait(token_bus::mac_symbols(bench_.rules(), static_cast<unsigned>(soon)));
        continue;
      }
      settle(quiet());
      compare();
      if (is_over_) return;
    }
  }

 private:
  static bool is_of_line(const SequenceCommand& command) {
    switch (static_cast<TokenWord>(command.word)) {
      case TokenWord::submit:
      case TokenWord::submit_request:
      case TokenWord::ask:
      case TokenWord::in_ring:
      case TokenWord::respond:
      case TokenWord::power:
      case TokenWord::many:
        return false;
      default:
        return true;
    }
  }

  void execute(const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    switch (static_cast<TokenWord>(command.word)) {
      case TokenWord::noise:
        bench_.send_noise(static_cast<std::size_t>(numbers[0]));
        break;
      case TokenWord::spike:
        tester_.send_noise(static_cast<std::size_t>(numbers[0]));
        break;
      case TokenWord::wait:
      case TokenWord::silence:
        live(bench_.slots(numbers[0]));
        break;
      case TokenWord::others:
        tester_.talk(numbers[0]);
        break;
      case TokenWord::peer:
        tester_.set_peer(numbers[0] == 1);
        break;
      case TokenWord::form:
        tester_.take_form(numbers);
        break;
      case TokenWord::reply:
        tester_.take_reply(numbers);
        break;
      case TokenWord::soon:
        soon_symbols_ = numbers[0];
        break;
      case TokenWord::many:
        do_many(static_cast<TokenSeries>(numbers[0]), numbers[1]);
        break;
      default:
        execute_of_user(command);
    }
  }

  void execute_of_user(const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto word = static_cast<TokenWord>(command.word);
    switch (word) {
      case TokenWord::power:
        cycle_power(bench_.slots(numbers[0]));
        break;
      case TokenWord::submit:
        submit({.priority = static_cast<unsigned>(numbers[0]),
                .destination = TokenBench::kBelow,
                .data = bench_.numbered_data(static_cast<std::size_t>(numbers[1]))});
        break;
      case TokenWord::submit_request:
        submit({.action = token_bus::Action::request_with_response,
                .priority = static_cast<unsigned>(numbers[0]),
                .destination = TokenBench::kBelow,
                .data = bench_.numbered_data(2)});
        break;
      case TokenWord::ask:
        submit({.action = static_cast<token_bus::Action>(numbers[0]),
                .priority = static_cast<unsigned>(numbers[1]),
                .destination = asked(numbers[2]),
                .data = bench_.numbered_data(static_cast<std::size_t>(numbers[3]))});
        break;
      case TokenWord::in_ring:
        twin_.set_in_ring_desired(numbers[0] == 1, bench_.now());
        bench_.set_in_ring_desired(numbers[0] == 1);
        break;
      case TokenWord::respond: {
        const Octets data = bench_.numbered_data(static_cast<std::size_t>(numbers[0]));
        twin_.set_response(data, bench_.now());
        bench_.set_response(data);
        break;
      }
      default:
        tester_.send(octets_of(word, numbers, bench_), command.faults);
    }
  }

  void submit(const token_bus::DataRequest& request) {
    twin_.submit(request, bench_.now());
    comparison_.note_submission(request.data.size(), bench_.submit(request));
  }

  // Nobody asks itself.
  std::uint64_t asked(std::int64_t number) const {
    const std::uint64_t meant = address_meant(number, bench_);
    return meant == bench_.address() ? TokenBench::kStranger : meant;
  }

  void cycle_power(kernel::Duration off) {
    twin_.set_power(false, bench_.now());
    bench_.set_power(false);
    bench_.wait(off);
    twin_.set_power(true, bench_.now());
    bench_.set_power(true);
  }

  void do_many(TokenSeries what, std::int64_t times) {
    constexpr std::int64_t kFewerOfLong = 20;
    constexpr std::size_t kDatum = 3;
    if (what == TokenSeries::too_long) times = 1 + times / kFewerOfLong;
    for (std::int64_t n = 0; n < times; ++n) {
      if (what != TokenSeries::rounds && what != TokenSeries::rounds_with_data) {
        tester_.send_faulty(what);
        continue;
      }
      if (what == TokenSeries::rounds_with_data)
        submit({.destination = TokenBench::kBelow, .data = bench_.numbered_data(kDatum)});
      bench_.send(bench_.frame(TokenControl::token, bench_.address(), TokenBench::kAbove));
      if (!goes_round()) return;
    }
  }

  // Until the successor has passed on the token that it got; false: it did not come to that.
  bool goes_round() {
    constexpr unsigned kMostFrames = 30;
    for (unsigned n = 0; n < kMostFrames; ++n) {
      const auto one = bench_.next(bench_.now() + quiet());
      if (!one) return false;
      const bool is_taken = tester_.reply_to(*one);
      if (!is_taken || !one->is(TokenControl::token)) continue;
      bench_.wait(bench_.octets(kPauseOctets));
      return true;
    }
    return false;
  }

  // Longer than any wait of a station of the table that is no multiple of it.
  kernel::Duration quiet() const { return bench_.slots(5) + bench_.octets(10); }

  // Time goes by, and the tester does what its neighbours do.
  void live(kernel::Duration duration) {
    const kernel::Time end = bench_.now() + duration;
    while (const auto one = bench_.next(end)) tester_.reply_to(*one);
  }

  // Until the station has nothing more to say. One that is alone solicits for ever.
  void settle(kernel::Duration silence) {
    constexpr unsigned kMostFrames = 60;
    constexpr unsigned kMostWindows = 2;
    unsigned windows = 0;
    is_alone_ = false;
    for (unsigned n = 0; n < kMostFrames && windows < kMostWindows; ++n) {
      const auto one = bench_.next(bench_.now() + silence);
      if (one) {
        const bool is_replied_to = tester_.reply_to(*one);
        if (one->is(TokenControl::solicit_2) && !is_replied_to) ++windows;
        continue;
      }
      twin_.catch_up(bench_.now());
      const auto until = twin_.awaited_until();
      if (!until || *until <= bench_.now()) return;
      silence = *until - bench_.now() + bench_.octets(1);
    }
    is_alone_ = windows == kMostWindows;
    bench_.wait(bench_.octets(kPauseOctets));
  }

  void compare() {
    twin_.catch_up(bench_.now());
    is_over_ |= twin_.is_doubtful();
    if (!is_over_) comparison_.compare(is_alone_);
  }

  static constexpr std::int64_t kPauseOctets = 8;

  TokenBench& bench_;
  TokenTester tester_;
  TokenTwin twin_;
  TokenComparison comparison_;
  std::int64_t soon_symbols_ = 0;
  bool is_alone_ = false;  // it has solicited again and again, and nobody has answered
  bool is_over_ = false;
};

}  // namespace

const SequenceRole& token_station_sequence_role() {
  static const SequenceRole role{
      {.id = "token_bus/station/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever comes in whatever order, a station sends and reports what the access control "
                      "machine says, and nothing else.",
       .reference = token_sources::memory("access control machine"),
       .details = token_details(),
       .stimulus = "Commands at random, with half bits that are flipped and octets that are missing.",
       .expected = "What a reference station does on its twin of the line.",
       .tags = {},
       .catches = {}},
      token_station_vocabulary(),
      {{DerivedKind::values, {"delivers_from_another", "indication_other"}},
       {DerivedKind::faults, {"data_of_members_only", "indication_missing"}},
       {DerivedKind::words, {"delivers_with_another_priority", "indication_other"}},
       {DerivedKind::states, {"response_of_the_asked_only", "indication_missing"}},
       {DerivedKind::repetitions, {"offer_kept", "frame_other"}},
       {DerivedKind::settings, {"preamble_of_four_octets", "preamble_short"}},
       {DerivedKind::drawn, {"delivers_with_another_priority", "indication_other"}}}};
  return role;
}

void run_token_station_sequence(const Sequence& sequence, TokenBench& bench, CaseJudge& judge) {
  TokenSequenceRun(bench, judge).run(sequence);
  // What has led to an event may be a frame that the tester itself cannot read.
  bench.user().all_events.clear();
}

}  // namespace fieldproof::conformance
