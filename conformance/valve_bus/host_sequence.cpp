#include "conformance/valve_bus/host_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "conformance/sequence_settings.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_side.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "protocols/valve_bus/host_settings.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::Command;

constexpr std::array<std::int64_t, 5> kGaps{5, 13, 22, 33, 45};
constexpr std::array<std::int64_t, 4> kNodes{1, 2, 1, 99};
constexpr std::array<std::int64_t, 5> kIds{0, 1, 100, 255, 2};
constexpr std::array<std::int64_t, 4> kCommands{0, 1, 2, 255};
constexpr std::array<std::int64_t, 6> kData{0x00, 0xFF, 0x01, 0x05, 0x80, 0xA5};
constexpr std::array<std::int64_t, 4> kWaits{1, 10, 60, 200};
// Bits between a request and its answer: nobody doubts that it begins within the time-out, and the last of
// its octets does so as well, whatever gaps are in it.
constexpr std::array<std::int64_t, 4> kTurnarounds{45, 60, 150, 700};
constexpr unsigned kAnswerOctets = 3;

SequenceNumber octet(std::string_view name) {
  return {name, 0, 0xFF, 0, kData};
}

SequenceNumber node() {
  return {"id", 1, 99, 1, kNodes};
}

SequenceNumber turnaround() {
  return {"turnaround", 45, 700, 60, kTurnarounds, true};
}

// Makes an exclusive or fit: of the first three octets, of the last three, or of none.
SequenceNumber fit() {
  return {"fit", 0, 2, 0};
}

std::vector<std::uint8_t> fitted(std::vector<std::uint8_t> octets, std::int64_t fit) {
  if (fit == 0 || octets.size() < kAnswerOctets) return octets;
  const std::size_t first = fit == 1 ? 0 : octets.size() - kAnswerOctets;
  octets[first + 2] = octets[first] ^ octets[first + 1];
  return octets;
}

enum class HostWord : std::uint8_t {
  read,
  write,
  command,
  part,
  answer,
  octets,
  unanswered,
  stray,
  wait,
  power
};

// There are no words for nodes that acknowledge writes.
constexpr std::array<std::string_view, 2> kFixedOfHost{"answers_writes", "dip"};

// What a host has been ordered, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_a_host() {
  const NamedCommand answered{"answer", {{"data0", 0xA5}, {"data1", 0x3C}}};
  const NamedCommand written{"write", {{"data0", 0x5A}, {"data1", 0xC3}}};
  return {{answered, {"read"}, {"wait"}},
          {{"unanswered"}, {"read"}, {"wait"}},
          {{"part", {{"count", 2}}}},
          {written, {"read"}, {"read", {{"id", 2}}}},
          {written, {"wait"}, {"power"}}};
}

SequenceVocabulary host_vocabulary() {
  const valve_bus::HostConfiguration host = host_configuration({}, declared_host());
  // In the order of HostWord.
  return {
      .words = {{.word = "read", .meaning = "the PC orders a read", .numbers = {node()}, .weight = 6},
                {.word = "write",
                 .meaning = "the PC orders a write",
                 .numbers = {node(), octet("data0"), octet("data1")},
                 .weight = 3},
                {.word = "command",
                 .meaning = "the PC orders any command to any address",
                 .numbers = {{"id", 0, 0xFF, 1, kIds},
                             {"command", 0, 0xFF, 1, kCommands},
                             octet("data0"),
                             octet("data1")},
                 .weight = 2},
                {.word = "part",
                 .meaning = "the PC gives so many octets of a command, and no more",
                 .numbers = {{"count", 1, 3, 1}},
                 .weight = 1},
                {.word = "answer",
                 .meaning = "the next read on the line is answered",
                 .numbers = {octet("data0"), octet("data1"), turnaround()},
                 .units = kAnswerOctets,
                 .weight = 6},
                {.word = "octets",
                 .meaning = "the next read on the line is answered with octets that are no response, or "
                            "happen to be one",
                 .numbers = {fit(), turnaround()},
                 .most_octets = 6,
                 .weight = 2},
                {.word = "unanswered", .meaning = "the next read on the line is not answered", .weight = 2},
                {.word = "stray",
                 .meaning = "octets on the line when everything has ended",
                 .numbers = {fit()},
                 .most_octets = 8,
                 .weight = 1},
                {.word = "wait",
                 .meaning = "everything ends, then so many milliseconds pass",
                 .numbers = {{"ms", 1, 1'000, 10, kWaits}},
                 .weight = 1},
                {.word = "power",
                 .meaning = "the supply goes and comes: 0, when everything has ended; 1, with the next "
                            "read on the line",
                 .numbers = {{"open", 0, 1, 0}},
                 .weight = 1,
                 .is_loss = true}},
      .unit = "character",
      .levels_per_unit = 11,
      .gaps = kGaps,
      .settings = sequence_settings(valve_bus::kHostTable, &host, kFixedOfHost)};
}

std::string request_text(std::span<const std::int64_t> octets) {
  return fmt::format("request {:02X}", fmt::join(octets, " "));
}

std::string indication_text(std::span<const std::int64_t> values) {
  const auto id = static_cast<std::uint8_t>(values[1]);
  if (values[0] == 0)
    return fmt::format("error of {:02X}: {}", id, describe(static_cast<valve_bus::HostErrorKind>(values[2])));
  return fmt::format("response of {:02X}: {:02X} {:02X}{}", id, values[2], values[3],
                     values[4] != 0 ? ", old" : "");
}

constexpr EventKind kRequests{"requests", "no_request", "request_unasked", "request_wrong", request_text};
constexpr EventKind kIndications{"indications", "indication_missing", "indication_unasked",
                                 "indication_wrong", indication_text};

// The octets as the bench's line carries them, with the faults of the command.
line::Levels levels_with_faults(const HostBench& bench, std::span<const std::uint8_t> octets,
                                const std::vector<SequenceFault>& faults) {
  line::Levels all;
  for (std::size_t n = 0; n < octets.size(); ++n) {
    line::Levels levels = bench.levels_of(octets[n]);
    std::size_t gap = 0;
    for (const SequenceFault& fault : faults) {
      if (fault.unit != n) continue;
      if (fault.kind == SequenceFaultKind::drop) levels.fill(0, levels.size(), true);
      if (fault.kind == SequenceFaultKind::gap) gap += fault.value;
      if (fault.kind == SequenceFaultKind::flip && fault.value < levels.size()) levels.flip(fault.value);
    }
    all.append(levels);
    all.append_idle(gap);
  }
  return all;
}

class HostSequenceRun {
 public:
  HostSequenceRun(HostBench& bench, CaseJudge& judge)
      : judge_(judge),
        twin_({}, setting_of_twin(bench)),
        sides_{HostSide(bench, &judge), HostSide(twin_, nullptr)} {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      for (HostSide& side : sides_) execute(side, command);
      if (is_late_ || !compare(false)) return;
    }
    for (HostSide& side : sides_) side.drain();
    if (compare(true)) compare_counters();
  }

 private:
  static HostSetting setting_of_twin(const HostBench& bench) {
    HostSetting setting;
    setting.pics = bench.pics();
    return setting;
  }

  void execute(HostSide& side, const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto number = [&](std::size_t n) { return static_cast<std::uint8_t>(numbers.at(n)); };
    const valve_bus::Rules& rules = side.bench().rules();
    switch (static_cast<HostWord>(command.word)) {
      case HostWord::read:
        return side.order({number(0), static_cast<std::uint8_t>(rules.read_command), 0, 0});
      case HostWord::write:
        return side.order({number(0), static_cast<std::uint8_t>(rules.write_command), number(1), number(2)});
      case HostWord::command:
        return side.order({number(0), number(1), number(2), number(3)});
      case HostWord::part: {
        constexpr std::array<std::uint8_t, 3> kPart{0x07, 0x01, 0x55};
        side.drain();
        return side.order_part(std::span(kPart).first(number(0)));
      }
      case HostWord::answer: {
        const auto check = static_cast<std::uint8_t>(number(0) ^ number(1));
        const std::array<std::uint8_t, kAnswerOctets> octets{number(0), number(1), check};
        return answer(side, octets, command);
      }
      case HostWord::octets:
        return answer(side, fitted(command.octets, numbers[0]), command);
      case HostWord::unanswered:
        side.await_request();
        return;
      case HostWord::stray:
        side.drain();
        return side.say(fitted(command.octets, numbers[0]));
      case HostWord::wait:
        side.drain();
        return side.wait(numbers[0] * kernel::kMillisecond);
      case HostWord::power:
        return restart(side, numbers[0] != 0);
    }
  }

  void answer(HostSide& side, std::span<const std::uint8_t> octets, const SequenceCommand& command) {
    if (!side.await_request() || octets.empty()) return;
    const line::Levels levels = levels_with_faults(side.bench(), octets, command.faults);
    const kernel::Duration turnaround_time = side.bench().bits(command.numbers.back());
    side.answer(levels, turnaround_time, command.faults.empty());
    // At a slow rate the time-out is hardly longer than a delimiter: what comes after it ends the sequence.
    const kernel::Duration answer = side.bench().bits(static_cast<std::int64_t>(levels.size()));
    is_late_ |= turnaround_time + answer >= side.bench().time_out();
  }

  static void restart(HostSide& side, bool is_open) {
    if (!is_open || !side.await_request()) side.drain();
    side.restart();
  }

  // False: nobody can say what is right from here on.
  bool compare(bool is_settled) {
    const HostSide& iut = sides_[0];
    if (std::ranges::any_of(sides_, &HostSide::is_doubtful)) return false;
    // What is lost depends on whether the first command is taken at once.
    if (twin_.has_overflowed()) return false;
    const HostSide& twin = sides_[1];
    return compare_events(kRequests, iut.requests(), std::span(&twin.requests(), 1), is_settled, judge_) &&
           compare_events(kIndications, iut.indications(), std::span(&twin.indications(), 1), is_settled,
                          judge_);
  }

  void compare_counters() {
    for (const std::uint8_t id : sides_[0].ids()) {
      const valve_bus::HostCounters counted = sides_[0].bench().counters(id);
      const valve_bus::HostCounters right = twin_.counters(id);
      judge_.expect_equal(counted.timeouts, right.timeouts, "counters_wrong",
                          fmt::format("time-outs of {}", id));
      judge_.expect_equal(counted.rejected, right.rejected, "counters_wrong",
                          fmt::format("rejected responses of {}", id));
      judge_.expect_equal(counted.retries, right.retries, "counters_wrong", fmt::format("retries of {}", id));
    }
  }

  CaseJudge& judge_;
  HostBench twin_;  // with the reference
  std::array<HostSide, 2> sides_;
  bool is_late_ = false;
};

std::vector<PartialSource> host_sequence_details() {
  std::vector<PartialSource> details = host_details();
  details.push_back({valve_sources::own("what a host reports to its PC, and what it counts"),
                     {"indication_missing", "indication_unasked", "indication_wrong", "counters_wrong"}});
  return details;
}

}  // namespace

const SequenceRole& host_sequence_role() {
  static const SequenceRole role{
      {.id = "valve_bus/host/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever is ordered and answered in whatever order, a host sends each order in turn, "
                      "repeats a read that is not answered well, and reports the end of each.",
       .reference = valve_sources::own("requests, repetitions and reports of the host module"),
       .details = host_sequence_details(),
       .stimulus = "Orders and answers at random, with flipped bits, dropped characters and gaps.",
       .expected = "What the reference sends and reports when it is ordered and answered the same.",
       .tags = {},
       .catches = {}},
      with_beginnings(host_vocabulary(), states_of_a_host()),
      {{DerivedKind::values, {"request_check_is_sum", "check_wrong"}},
       {DerivedKind::faults, {"waits_long_behind_errors", "no_request"}},
       {DerivedKind::words, {"request_check_without_id", "check_wrong"}},
       {DerivedKind::states, {"sends_id_100", "indication_wrong"}},
       {DerivedKind::repetitions, {"told_twice", "indication_wrong"}},
       {DerivedKind::settings, {"silence_told_as_data", "indication_wrong"}}}};
  return role;
}

void run_host_sequence(const Sequence& sequence, HostBench& bench, CaseJudge& judge) {
  bench.expect_exact_instants();  // they are compared with those of the reference
  if (bench.rules().answers_writes)
    throw iut::CannotBeDone("sequences have no words for nodes that acknowledge writes");
  HostSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
