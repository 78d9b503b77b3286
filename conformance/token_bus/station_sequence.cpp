#include "conformance/token_bus/station_sequence.hpp"

#include <utility>

#include "conformance/token_bus/ring_around.hpp"
#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_comparison.hpp"
#include "conformance/token_bus/station_reasons.hpp"
#include "conformance/token_bus/station_tester.hpp"
#include "conformance/token_bus/station_twin.hpp"

namespace fieldproof::conformance {
namespace {

// That walks look for: with its timers, what it knows of its neighbours and what waits it has more than can
// be visited.
constexpr std::size_t kStatesOfStation = 20;

class TokenSequenceRun {
 public:
  TokenSequenceRun(TokenBench& bench, CaseJudge& judge)
      : bench_(bench),
        tester_(bench),
        twin_(bench.configuration(), bench.tester_place(), bench.driven_frames(), bench.now()),
        comparison_(bench, twin_, judge),
        ring_(bench, tester_, twin_) {}

  void run(const Sequence& sequence) {
    for (std::size_t n = 0; n < sequence.commands.size(); ++n) {
      const std::int64_t soon = std::exchange(soon_symbols_, 0);
      execute(sequence.commands[n]);
      // What the user does while the station decides is taken into account or not.
      if (soon > 0 && is_line_next(sequence, n + 1)) {
        bench_.wait(token_bus::mac_symbols(bench_.rules(), static_cast<unsigned>(soon)));
        continue;
      }
      if (is_for_later(sequence.commands[n])) continue;
      const bool is_settled = sequence.commands[n].word == static_cast<std::size_t>(TokenWord::failures);
      if (!is_settled) ring_.settle();
      compare();
      if (is_over_) return;
    }
  }

 private:
  // Silence after each of several would be long enough to claim the token.
  static bool is_for_later(const SequenceCommand& command) {
    switch (static_cast<TokenWord>(command.word)) {
      case TokenWord::reply:
      case TokenWord::form:
      case TokenWord::peer:
      case TokenWord::respond:
      case TokenWord::load:
        return true;
      default:
        return false;
    }
  }

  // What the next command that does something at once is.
  static bool is_line_next(const Sequence& sequence, std::size_t n) {
    const auto is_preparation = [](const SequenceCommand& command) {
      const auto word = static_cast<TokenWord>(command.word);
      return word == TokenWord::form || word == TokenWord::reply || word == TokenWord::peer;
    };
    while (n < sequence.commands.size() && is_preparation(sequence.commands[n])) ++n;
    return n < sequence.commands.size() && is_of_line(sequence.commands[n]);
  }

  static bool is_of_line(const SequenceCommand& command) {
    switch (static_cast<TokenWord>(command.word)) {
      case TokenWord::submit:
      case TokenWord::submit_request:
      case TokenWord::ask:
      case TokenWord::in_ring:
      case TokenWord::respond:
      case TokenWord::power:
      case TokenWord::many:
      case TokenWord::load:
      case TokenWord::beside:
      case TokenWord::failures:
      case TokenWord::claims:
      case TokenWord::slow_rounds:
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
        ring_.live(bench_.slots(numbers[0]));
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
      case TokenWord::load:
        for (std::int64_t n = 0; n < numbers[1]; ++n)
          submit(datum(numbers[0], static_cast<std::size_t>(numbers[2])));
        break;
      case TokenWord::beside:
        for (Octets& one : frames_beside(static_cast<TokenBeside>(numbers[0]), bench_)) {
          tester_.send(std::move(one));
          ring_.settle();
        }
        break;
      case TokenWord::failures:
        ring_.fail(numbers[0]);
        break;
      case TokenWord::claims:
        ring_.claim(numbers[0]);
        break;
      case TokenWord::slow_rounds:
        for (std::int64_t n = 0; n < numbers[1] && ring_.goes_slowly(numbers[0]);) ++n;
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
        submit(datum(numbers[0], static_cast<std::size_t>(numbers[1])));
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

  token_bus::DataRequest datum(std::int64_t priority, std::size_t size) {
    return {.priority = static_cast<unsigned>(priority),
            .destination = TokenBench::kBelow,
            .data = bench_.numbered_data(size)};
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
      if (!ring_.goes_round()) return;
    }
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

  void compare() {
    twin_.catch_up(bench_.now());
    comparison_.compare_sure_frames();
    is_over_ |= twin_.is_doubtful();
    if (!is_over_) comparison_.compare(ring_.is_alone());
  }

  TokenBench& bench_;
  TokenTester tester_;
  TokenTwin twin_;
  TokenComparison comparison_;
  RingAround ring_;
  std::int64_t soon_symbols_ = 0;
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
       .rules = station_reasons(),
       .stimulus = "Commands at random, with half bits that are flipped and octets that are missing.",
       .expected = "What a reference station does on its twin of the line.",
       .tags = {},
       .catches = {}},
      token_station_vocabulary(),
      {{DerivedKind::values, {"delivers_from_another", "indication_other"}},
       {DerivedKind::faults, {"data_of_members_only", "indication_missing"}},
       {DerivedKind::words, {"delivers_with_another_priority", "indication_other"}},
       {DerivedKind::states, {"response_of_the_asked_only", "frame_missing"}},
       {DerivedKind::walks, {"joins_unreported", "event_missing"}},
       {DerivedKind::repetitions, {"offer_kept", "frame_other"}},
       {DerivedKind::settings, {"preamble_of_four_octets", "preamble_short"}},
       {DerivedKind::drawn, {"delivers_with_another_priority", "indication_other"}}},
      1,
      kStatesOfStation};
  return role;
}

void run_token_station_sequence(const Sequence& sequence, TokenBench& bench, CaseJudge& judge) {
  TokenSequenceRun(bench, judge).run(sequence);
  // What has led to an event may be a frame that the tester itself cannot read.
  bench.user().all_events.clear();
}

}  // namespace fieldproof::conformance
