#include "conformance/token_bus/station_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_twin.hpp"
#include "conformance/token_bus/station_words.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kReactionOctets = 8;

std::string octets_in_words(std::span<const std::int64_t> values) {
  constexpr std::size_t kMost = 24;
  return fmt::format("{:02X}{}", fmt::join(values.first(std::min(values.size(), kMost)), " "),
                     values.size() > kMost ? fmt::format(" and {} more", values.size() - kMost) : "");
}

constexpr EventKind kTokenFrames{"frames", "frame_missing", "frame_unasked", "frame_other", octets_in_words};
constexpr EventKind kTokenIndications{"indications", "indication_missing", "indication_unasked",
                                      "indication_other", octets_in_words};

std::string event_in_words(std::span<const std::int64_t> values) {
  return fmt::format("{} {:04X}", token_bus::text_of(static_cast<token_bus::EventKind>(values[0])),
                     values[1]);
}
constexpr EventKind kTokenEvents{"events", "event_missing", "event_unasked", "event_other", event_in_words};

class TokenSequenceRun {
 public:
  TokenSequenceRun(TokenBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), twin_(bench.configuration(), bench.tester_place(), bench.now()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      execute(command);
      settle();
      compare();
      if (is_over_) return;
    }
  }

 private:
  void execute(const SequenceCommand& command) {
    const auto word = static_cast<TokenWord>(command.word);
    const auto& numbers = command.numbers;
    switch (word) {
      case TokenWord::noise:
        bench_.send_noise(static_cast<std::size_t>(numbers[0]));
        break;
      case TokenWord::wait:
        bench_.wait(bench_.slots(numbers[0]));
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
      case TokenWord::peer:
        does_peer_act_ = numbers[0] == 1;
        break;
      case TokenWord::power:
        cycle_power(bench_.octets(numbers[0]));
        break;
      default:
        send(half_bits_of(octets_of(word, numbers, bench_), flaw_of(word, numbers)), command.faults);
    }
  }

  void cycle_power(kernel::Duration off) {
    settle();
    compare();
    if (is_over_) return;
    bench_.set_power(false);
    twin_.set_power(false, bench_.now());
    bench_.wait(off);
    bench_.set_power(true);
    twin_.set_power(true, bench_.now());
  }

  void send(line::Levels levels, const std::vector<SequenceFault>& faults) {
    constexpr std::size_t kPreamble = 4;
    for (const SequenceFault& fault : faults) {
      const std::size_t first = (kPreamble + fault.unit) * kHalfBitsOfOctet;
      if (first + kHalfBitsOfOctet > levels.size()) continue;
      if (fault.kind == SequenceFaultKind::drop) levels.fill(first, first + kHalfBitsOfOctet, true);
      if (fault.kind == SequenceFaultKind::flip && fault.value < kHalfBitsOfOctet)
        levels.flip(first + fault.value);
    }
    bench_.send_half_bits(std::move(levels));
  }

  void submit(const token_bus::DataRequest& request) {
    const bool is_right = twin_.submit(request, bench_.now());
    const bool is_taken = bench_.submit(request);
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_taken_unasked",
                  fmt::format("data of {} octets is {}", request.data.size(), is_right ? "taken" : "refused"),
                  is_taken ? "taken" : "refused");
  }

  // Until the station has nothing more to say; the tester does what its neighbours do.
  void settle() {
    constexpr unsigned kMostFrames = 60;
    for (unsigned n = 0; n < kMostFrames; ++n) {
      const auto one = bench_.next(bench_.now() + bench_.slots(5));
      if (!one) {
        if (!is_twin_ahead()) return;
        bench_.wait(margin());
        continue;
      }
      is_over_ |= one->is(TokenControl::solicit_1) || one->is(TokenControl::solicit_2);
      // The last claim is as long as chance says.
      claims_ = one->is(TokenControl::claim) ? claims_ + 1 : 0;
      constexpr unsigned kPassesByAddress = 8;
      is_over_ |= claims_ >= kPassesByAddress;
      if (is_over_) return;
      if (does_peer_act_) react(*one);
    }
    is_over_ = true;
  }

  // What a timer begins may come a gap and an octet after the twin's.
  kernel::Duration margin() const { return bench_.octets(bench_.rules().response_gap_octets + 1); }
  bool is_twin_ahead() {
    twin_.run_until(bench_.now());
    return twin_.last_begin() + margin() >= bench_.now();
  }

  void react(const DrivenFrame& one) {
    constexpr unsigned kRequestBits = 0x1F;
    constexpr unsigned kRequest = 0x12;  // 01 001
    if (one.is(TokenControl::token)) {
      bench_.wait(bench_.octets(kReactionOctets));
      bench_.send(bench_.frame(TokenControl::token, TokenBench::kAbove, one.destination()));
    } else if ((one.control() & kRequestBits) == kRequest) {
      bench_.wait(bench_.octets(kReactionOctets));
      bench_.send(bench_.data_frame(0x6A, bench_.address(), one.destination(), bench_.numbered_data(2)));
    }
  }

  void compare() {
    twin_.run_until(bench_.now());
    const std::array frames{twin_.frames()};
    const std::array indications{twin_.indications()};
    if (is_over_) return;
    is_over_ |= !compare_events(kTokenFrames, frames_of(bench_.driven()), frames, true, judge_);
    is_over_ |= !compare_events(kTokenIndications, indications_of(bench_.user(), bench_.rules()), indications,
                                true, judge_);
    const std::array events{twin_.events()};
    is_over_ |= !compare_events(kTokenEvents, events_of(bench_.user()), events, true, judge_);
    compare_counters();
  }

  void compare_counters() {
    if (is_over_) return;
    const token_bus::Counters right = twin_.counters();
    const token_bus::Counters counted = bench_.counters();
    judge_.expect(counted == right, "counters_wrong", [&] {
      return Mismatch{{fmt::format("counters {}", fmt::join(right, ", "))},
                      fmt::format("counters {}", fmt::join(counted, ", "))};
    });
  }

  TokenBench& bench_;
  CaseJudge& judge_;
  TokenTwin twin_;
  bool does_peer_act_ = true;
  unsigned claims_ = 0;
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
      {{DerivedKind::values, {"reports_about_a_stranger", "event_other"}},
       {DerivedKind::faults, {"noise_reported", "event_unasked"}},
       {DerivedKind::words, {"noise_not_counted", "counters_wrong"}},
       {DerivedKind::repetitions, {"whole_preamble_needed", "counters_wrong"}},
       {DerivedKind::settings, {"successor_with_each_token", "event_unasked"}}}};
  return role;
}

void run_token_station_sequence(const Sequence& sequence, TokenBench& bench, CaseJudge& judge) {
  TokenSequenceRun(bench, judge).run(sequence);
  // What has led to an event may be a frame that the tester itself cannot read.
  bench.user().all_events.clear();
}

}  // namespace fieldproof::conformance
