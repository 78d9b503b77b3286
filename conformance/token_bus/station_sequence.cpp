#include "conformance/token_bus/station_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <deque>
#include <string>

#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_tester.hpp"
#include "conformance/token_bus/station_twin.hpp"

namespace fieldproof::conformance {
namespace {

std::string octets_in_words(std::span<const std::int64_t> values) {
  constexpr std::size_t kMost = 24;
  return fmt::format("{:02X}{}", fmt::join(values.first(std::min(values.size(), kMost)), " "),
                     values.size() > kMost ? fmt::format(" and {} more", values.size() - kMost) : "");
}

std::string event_in_words(std::span<const std::int64_t> values) {
  return fmt::format("{} about {:04X}", token_bus::text_of(static_cast<token_bus::EventKind>(values[0])),
                     values[1]);
}

constexpr EventKind kTokenFrames{"frames", "frame_missing", "frame_unasked", "frame_other", octets_in_words};
constexpr EventKind kTokenIndications{"indications", "indication_missing", "indication_unasked",
                                      "indication_other", octets_in_words};
constexpr EventKind kTokenEvents{"events", "event_missing", "event_unasked", "event_other", event_in_words};

class TokenSequenceRun {
 public:
  TokenSequenceRun(TokenBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        tester_(bench),
        twin_(bench.configuration(), bench.tester_place(), bench.driven_frames(), bench.now()) {}

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
    submitted_.push_back({request.data.size(), bench_.submit(request)});
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
    if (is_over_) return;
    compare_submissions();
    compare_frames();
    compare_new(kTokenIndications, indications_of(rest(bench_.user().frames, indications_), bench_.rules()),
                indications_of(rest(twin_.user().frames, indications_), bench_.rules()));
    indications_ = bench_.user().frames.size();
    compare_all_events();
    compare_counters();
  }

  template <typename T>
  static std::span<const T> rest(const std::vector<T>& all, std::size_t known) {
    return std::span<const T>(all).subspan(std::min(known, all.size()));
  }

  void compare_new(const EventKind& kind, const Observations& seen, const Observations& right) {
    compare_events(kind, seen, std::array{right}, true, judge_);
  }

  // That it is alone a station knows when it has claimed the token, or when a window was silent: by the end
  // of some windows it has said it as often.
  void compare_all_events() {
    const auto is_sole = [](const TokenUser::Reported& one) {
      return one.event.kind == token_bus::EventKind::sole_station;
    };
    std::vector<TokenUser::Reported> seen(bench_.user().all_events);
    std::vector<TokenUser::Reported> right(twin_.user().all_events);
    const auto sole_seen = std::ranges::count_if(seen, is_sole);
    const auto sole_right = std::ranges::count_if(right, is_sole);
    const bool is_about_another = std::ranges::any_of(seen, [&](const TokenUser::Reported& one) {
      return is_sole(one) && one.event.address != bench_.address();
    });
    // One that is named as its own successor may say that, or that it is alone.
    const auto is_about_alone = [&](const TokenUser::Reported& one) {
      const bool is_change = one.event.kind == token_bus::EventKind::successor_changed;
      return is_sole(one) || (is_change && one.event.address == bench_.address());
    };
    std::erase_if(seen, is_about_alone);
    std::erase_if(right, is_about_alone);
    compare_new(kTokenEvents, events_of(rest(seen, events_)), events_of(rest(right, events_)));
    events_ = seen.size();
    judge_.expect(!is_about_another, kTokenEvents.different, "sole station about itself",
                  "sole station about another");
    judge_.expect(sole_seen <= sole_right, kTokenEvents.surplus, "sole station when it becomes so",
                  "it is reported again");
    if (!is_alone_) return;
    judge_.expect(sole_right == sole_right_ || sole_seen > sole_seen_, kTokenEvents.missing, "sole station",
                  "it is not reported");
    sole_seen_ = sole_seen;
    sole_right_ = sole_right;
  }

  void compare_submissions() {
    for (; !submitted_.empty(); submitted_.pop_front(), ++submissions_) {
      const Submission& one = submitted_.front();
      const bool is_right = twin_.taken().at(submissions_);
      judge_.expect(one.is_taken == is_right, is_right ? "data_refused" : "data_taken_unasked", [&] {
        return Mismatch{{fmt::format("data of {} octets is {}", one.size, is_right ? "taken" : "refused")},
                        one.is_taken ? "taken" : "refused"};
      });
    }
  }

  void compare_frames() {
    const auto seen = rest(bench_.driven_frames().all(), frames_);
    const auto right = rest(twin_.driven(), frames_);
    // What begins at another time is said first: what comes then is often something else.
    for (std::size_t n = 0; n < std::min(seen.size(), right.size()); ++n) {
      if (seen[n].octets != right[n].octets) break;
      expect_in_time(seen[n], twin_.spans().at(frames_ + n));
    }
    compare_new(kTokenFrames, frames_of(seen), frames_of(right));
    frames_ += seen.size();
  }

  void expect_in_time(const DrivenFrame& one, const BeginSpan& span) {
    const auto expect = [&](bool holds, std::string_view reason) {
      judge_.expect(holds, reason, [&] {
        return Mismatch{{fmt::format("{}, begun {} to {}", one.text(), kernel::describe(span.earliest),
                                     kernel::describe(span.latest))},
                        fmt::format("begun {}", kernel::describe(one.begin)),
                        one.begin};
      });
    };
    expect(one.begin >= span.earliest, "begins_too_early");
    expect(one.begin <= span.latest, "begins_too_late");
  }

  void compare_counters() {
    const token_bus::Counters seen = bench_.counters();
    const token_bus::Counters right = twin_.counters();
    judge_.expect(seen == right, "counter_wrong", [&] {
      return Mismatch{{fmt::format("faulty receptions {}", fmt::join(right, " "))},
                      fmt::format("{}", fmt::join(seen, " "))};
    });
  }

  static constexpr std::int64_t kPauseOctets = 8;
  struct Submission {
    std::size_t size;
    bool is_taken;
  };

  TokenBench& bench_;
  CaseJudge& judge_;
  TokenTester tester_;
  TokenTwin twin_;
  std::int64_t soon_symbols_ = 0;
  std::deque<Submission> submitted_{};
  // What has been compared.
  std::size_t submissions_ = 0;
  std::size_t frames_ = 0;
  std::size_t indications_ = 0;
  std::size_t events_ = 0;
  std::ptrdiff_t sole_seen_ = 0;
  std::ptrdiff_t sole_right_ = 0;
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
       {DerivedKind::settings, {"preamble_of_four_octets", "preamble_short"}}}};
  return role;
}

void run_token_station_sequence(const Sequence& sequence, TokenBench& bench, CaseJudge& judge) {
  TokenSequenceRun(bench, judge).run(sequence);
  // What has led to an event may be a frame that the tester itself cannot read.
  bench.user().all_events.clear();
}

}  // namespace fieldproof::conformance
