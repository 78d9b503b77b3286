#include "conformance/token_bus/station_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_twin.hpp"
#include "protocols/token_bus/station_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 4> kTokenWaits{1, 3, 5, 9};
constexpr std::array<std::int64_t, 4> kTokenSizes{0, 1, 20, 300};
constexpr unsigned kHalfBitsOfOctet = 32;
constexpr std::int64_t kReactionOctets = 8;

enum class TokenWord : std::uint8_t {
  token,
  token_elsewhere,
  data,
  request,
  solicit,
  resolve,
  who_follows,
  set_successor,
  claim,
  noise,
  wait,
  submit,
  submit_request,
  in_ring,
  respond,
  peer
};

// Other stations of the tester lie above and below it; and it takes a station for silent after some slots,
// so none of these waits may be longer. Cases of their own have them at their ends.
constexpr std::array<std::string_view, 4> kFixedOfStation{"address", "demand_wait_slots", "bus_idle_slots",
                                                          "lowest_bus_idle_slots"};

// What brings a station into the ring of the tester, and what it then has to do.
std::vector<std::vector<NamedCommand>> states_of_a_station() {
  const NamedCommand offered{"solicit"};
  const NamedCommand passed{"token"};
  const NamedCommand urgent{"submit", {{"size", 20}}};
  const NamedCommand bulk{"submit", {{"priority", 0}, {"size", 300}}};
  return {{offered, passed},                                    // a member
          {urgent, bulk, offered, passed},                      // that has had data of several classes
          {{"respond", {{"size", 10}}}, offered, passed},       // with a response
          {offered, passed, {"peer", {{"does", 0}}}, urgent}};  // among others that are silent
}

SequenceVocabulary token_station_vocabulary() {
  const token_bus::StationConfiguration as_made;
  // In the order of TokenWord.
  return {
      .words =
          {{.word = "token", .meaning = "000E passes the token to the station", .units = 11, .weight = 7},
           {.word = "token_elsewhere", .meaning = "000E passes the token to 0004", .units = 11, .weight = 2},
           {.word = "data",
            .meaning = "data for the station, for all or for another",
            .numbers = {{"to", 0, 2, 0}, {"size", 2, 300, 2}},
            .units = 13,
            .weight = 3},
           {.word = "request",
            .meaning = "a request with response for the station",
            .numbers = {{"priority", 0, 7, 6}},
            .units = 13,
            .weight = 3},
           {.word = "solicit",
            .meaning = "successors are solicited: between 000E and 0004, between 000E and the "
                       "station, by the lowest, by who is alone",
            .numbers = {{"whom", 0, 3, 0}},
            .units = 11,
            .weight = 6},
           {.word = "resolve", .meaning = "000E resolves contention", .units = 11, .weight = 3},
           {.word = "who_follows",
            .meaning = "0020 asks who follows 000E, the station, or 0004",
            .numbers = {{"whom", 0, 2, 0}},
            .units = 13,
            .weight = 2},
           {.word = "set_successor",
            .meaning = "0004 leaves: the successor of the station is 0002, or the station itself",
            .numbers = {{"alone", 0, 1, 0}},
            .units = 13,
            .weight = 1},
           {.word = "claim", .meaning = "0020 claims the token", .units = 11, .weight = 1},
           {.word = "noise",
            .meaning = "signal without a start delimiter, of so many octet durations",
            .numbers = {{"octets", 4, 60, 8}},
            .weight = 2},
           {.word = "wait",
            .meaning = "silence of so many slot times",
            .numbers = {{"slots", 1, 9, 1, kTokenWaits}},
            .weight = 2},
           {.word = "submit",
            .meaning = "the user submits data for 0004",
            .numbers = {{"priority", 0, 7, 6}, {"size", 0, 300, 1, kTokenSizes}},
            .weight = 5},
           {.word = "submit_request",
            .meaning = "the user submits a request with response for 0004",
            .numbers = {{"priority", 0, 7, 6}},
            .weight = 3},
           {.word = "in_ring",
            .meaning = "the user wants the station in the ring, or not",
            .numbers = {{"desired", 0, 1, 1}},
            .weight = 1},
           {.word = "respond",
            .meaning = "the user has a response ready",
            .numbers = {{"size", 0, 40, 2}},
            .weight = 2},
           {.word = "peer",
            .meaning = "who gets the token or a request does what is due, or is silent",
            .numbers = {{"does", 0, 1, 1}},
            .weight = 2}},
      .unit = "octet",
      .levels_per_unit = kHalfBitsOfOctet,
      .settings = sequence_settings(token_bus::kStationTable, &as_made, kFixedOfStation),
      .objection = objection_of(
          token_bus::kStationTable, as_made,
          +[](const token_bus::StationConfiguration& one) { expect_possible(one.rules); })};
}

std::string octets_in_words(std::span<const std::int64_t> values) {
  constexpr std::size_t kMost = 24;
  return fmt::format("{:02X}{}", fmt::join(values.first(std::min(values.size(), kMost)), " "),
                     values.size() > kMost ? fmt::format(" and {} more", values.size() - kMost) : "");
}

constexpr EventKind kTokenFrames{"frames", "frame_missing", "frame_unasked", "frame_other", octets_in_words};
constexpr EventKind kTokenIndications{"indications", "indication_missing", "indication_unasked",
                                      "indication_other", octets_in_words};

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
      default:
        send(octets_of(word, numbers), command.faults);
    }
  }

  Octets octets_of(TokenWord word, const std::vector<std::int64_t>& numbers) {
    const std::uint64_t own = bench_.address();
    constexpr std::uint64_t kAbove = TokenBench::kAbove;
    constexpr std::uint64_t kBelow = TokenBench::kBelow;
    constexpr std::uint64_t kStranger = TokenBench::kStranger;
    switch (word) {
      case TokenWord::token:
        return bench_.frame(TokenControl::token, own, kAbove);
      case TokenWord::token_elsewhere:
        return bench_.frame(TokenControl::token, kBelow, kAbove);
      case TokenWord::data: {
        const std::array<std::uint64_t, 3> to{own, 0xFFFF, kBelow};
        return bench_.data_frame(0x62, to.at(static_cast<std::size_t>(numbers[0])), kAbove,
                                 bench_.numbered_data(static_cast<std::size_t>(numbers[1])));
      }
      case TokenWord::request: {
        // 01 001 PPP, its highest bit first.
        const auto priority = static_cast<unsigned>(numbers[0]);
        const unsigned reversed = (priority & 1) << 2 | (priority & 2) | priority >> 2;
        return bench_.data_frame(static_cast<std::uint8_t>(0x12U | reversed << 5), own, kAbove,
                                 bench_.numbered_data(2));
      }
      case TokenWord::solicit:
        return solicitation(numbers[0]);
      case TokenWord::resolve:
        return bench_.frame(TokenControl::resolve, kAbove, kAbove);
      case TokenWord::who_follows: {
        const std::array<std::uint64_t, 3> whom{kAbove, own, kBelow};
        const std::uint64_t lost = whom.at(static_cast<std::size_t>(numbers[0]));
        return bench_.frame(TokenControl::who_follows, lost, kStranger, lost);
      }
      case TokenWord::set_successor:
        return bench_.frame(TokenControl::set_successor, own, kBelow, numbers[0] == 0 ? 0x0002 : own);
      default:
        return bench_.frame(TokenControl::claim, 0, kStranger);
    }
  }

  Octets solicitation(std::int64_t whom) const {
    const std::uint64_t own = bench_.address();
    switch (whom) {
      case 0:
        return bench_.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove);
      case 1:
        return bench_.frame(TokenControl::solicit_1, own, TokenBench::kAbove);
      case 2:
        return bench_.frame(TokenControl::solicit_2, 0x0008, TokenBench::kBelow);
      default:
        return bench_.frame(TokenControl::solicit_2, TokenBench::kAbove, TokenBench::kAbove);
    }
  }

  void send(const Octets& octets, const std::vector<SequenceFault>& faults) {
    constexpr std::size_t kPreamble = 4;
    line::Levels levels = half_bits_around(with_crc_32(octets));
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
      with_beginnings(token_station_vocabulary(), states_of_a_station()),
      {{DerivedKind::values, {"delivers_from_another", "indication_other"}},
       {DerivedKind::faults, {"data_of_members_only", "indication_missing"}},
       {DerivedKind::words, {"delivers_with_another_priority", "indication_other"}},
       {DerivedKind::states, {"response_of_the_asked_only", "frame_missing"}},
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
