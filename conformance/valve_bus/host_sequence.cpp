#include "conformance/valve_bus/host_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_deeds.hpp"
#include "conformance/valve_bus/host_orders.hpp"
#include "conformance/valve_bus/host_reasons.hpp"
#include "conformance/valve_bus/host_side.hpp"
#include "conformance/valve_bus/host_vocabulary.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kStatesOfHost = 12;  // that walks look for: it acts by itself

std::vector<std::uint8_t> fitted(std::vector<std::uint8_t> octets, std::int64_t fit) {
  if (fit == 0 || octets.size() < kHostAnswerOctets) return octets;
  const std::size_t first = fit == 1 ? 0 : octets.size() - kHostAnswerOctets;
  octets[first + 2] = octets[first] ^ octets[first + 1];
  return octets;
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

std::string fifo_text(std::span<const std::int64_t> values) {
  return fmt::format("{} overflow, room for {} octets", values[0] != 0 ? "an" : "no", values[1]);
}

constexpr EventKind kFifoStates{"states of the FIFO", "fifo_wrong", "fifo_wrong", "fifo_wrong", fifo_text};

std::string late_text(std::span<const std::int64_t> values) {
  return fmt::format("{} late frames of {}", values[1], values[0]);
}

constexpr EventKind kLateCounts{"late frames", "counters_wrong", "counters_wrong", "counters_wrong",
                                late_text};

constexpr std::int64_t kSureDelimiterBits = 60;

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
        sides_{HostSide(bench, &judge), HostSide(twin_, nullptr)},
        can_turn_dip_(!for_settable_dip()(bench.pics())) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      for (HostSide& side : sides_) execute(side, command);
      if (is_late_ || !compare(false)) return;
    }
    for (HostSide& side : sides_) {
      side.drain();
      side.note_fifo();
    }
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
        const std::array<std::uint8_t, kHostAnswerOctets> octets{number(0), number(1), check};
        return answer(side, octets, command);
      }
      case HostWord::octets:
        is_noisy_ = true;
        return answer(side, fitted(command.octets, numbers[0]), command);
      case HostWord::unanswered:
        side.await_request();
        return;
      case HostWord::stray:
        is_noisy_ = true;
        side.drain();
        // It might come into an acknowledge.
        if (rules.answers_writes && side.pace().has_written()) return;
        return side.say(fitted(command.octets, numbers[0]));
      case HostWord::wait:
        side.drain();
        return side.wait(numbers[0] * kernel::kMillisecond);
      case HostWord::power:
        return restart(side, numbers[0] != 0);
      default:
        return execute_long(side, command);
    }
  }

  void execute_long(HostSide& side, const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto number = [&](std::size_t n) { return static_cast<std::uint8_t>(numbers.at(n)); };
    switch (static_cast<HostWord>(command.word)) {
      case HostWord::burst:
        return order_burst(side, {number(0), number(1), numbers[2] != 0, number(3)});
      case HostWord::fill:
        return fill_up(side, number(0), number(1));
      case HostWord::torn:
        return order_torn(side, number(0), numbers[1] * kernel::kMillisecond);
      case HostWord::early:
        return answer_early(side, {number(0), number(1)}, numbers[2]);
      case HostWord::second:
        return answer_twice(side, number(0), {number(1), number(2)});
      case HostWord::late:
        return serve_late(side, number(0), {number(1), number(2)});
      case HostWord::talk:
        is_noisy_ = has_talked_ = true;
        return talk_over(side, number(0), number(1));
      case HostWord::cycle:
        return read_in_turn(side, number(0), &side == sides_.data() ? &judge_ : nullptr);
      case HostWord::dip:
        if (can_turn_dip_) side.turn_dip(number(0));
        return;
      default:
        return execute_lasting(side, command);
    }
  }

  void execute_lasting(HostSide& side, const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto number = [&](std::size_t n) { return static_cast<unsigned>(numbers.at(n)); };
    const auto id = static_cast<std::uint8_t>(numbers.empty() ? 0 : numbers.front());
    CaseJudge* const judge = &side == sides_.data() ? &judge_ : nullptr;
    switch (static_cast<HostWord>(command.word)) {
      case HostWord::acknowledged:
        return order_acknowledged(side, id, number(1), static_cast<Acknowledge>(numbers[2]));
      case HostWord::polled:
        return poll_without_end(side, id, number(1));
      case HostWord::period:
        return follow_refreshes(side, id, numbers[1] * kernel::kMillisecond, number(2), judge);
      case HostWord::busy:
        is_noisy_ = has_talked_ = true;
        return talk_over_refreshes(side);
      case HostWord::many:
        return write_to_many(side, number(0));
      case HostWord::cut:
        return cut_part(side, number(0));
      case HostWord::twice:
        return write_twice(side, id, number(1));
      case HostWord::rejected:
        return reject_all(side, id, numbers[1] != 0, judge);
      case HostWord::lates:
        return say_late(side, id, number(1));
      default:
        return order_meanwhile(side, id, number(1), number(2));
    }
  }

  void answer(HostSide& side, std::span<const std::uint8_t> octets, const SequenceCommand& command) {
    is_noisy_ |= !command.faults.empty();
    if (!side.await_request() || octets.empty()) return;
    answer_levels(side, levels_with_faults(side.bench(), octets, command.faults),
                  side.bench().bits(command.numbers.back()), command.faults.empty());
  }

  void answer_levels(HostSide& side, const line::Levels& levels, kernel::Duration turnaround_time,
                     bool is_whole) {
    side.answer(levels, turnaround_time, is_whole);
    // At a slow rate the time-out is hardly longer than a delimiter: what comes after it ends the sequence.
    const kernel::Duration length = side.bench().bits(static_cast<std::int64_t>(levels.size()));
    is_late_ |= turnaround_time + length >= side.bench().time_out();
  }

  void answer_early(HostSide& side, const valve_bus::Response& response, std::int64_t quarters) {
    if (side.await_request()) side.answer(response, side.bench().characters(1) * quarters / 4);
  }

  // What comes after a wrong response is not looked at.
  void answer_twice(HostSide& side, std::uint8_t first, const valve_bus::Response& response) {
    if (!side.await_request()) return;
    line::Levels levels = side.bench().levels_of(first);
    levels.append_idle(kSureDelimiterBits);
    levels.append(levels_of_response(side.bench(), response));
    answer_levels(side, levels, side.bench().bits(kSureDelimiterBits), true);
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
    if (sides_[1].is_overflow_doubtful()) return false;
    const HostSide& twin = sides_[1];
    return compare_events(kRequests, iut.requests(), std::span(&twin.requests(), 1), is_settled, judge_) &&
           compare_events(kIndications, iut.indications(), std::span(&twin.indications(), 1), is_settled,
                          judge_) &&
           compare_events(kIndications, iut.fifo_errors(), std::span(&twin.fifo_errors(), 1), is_settled,
                          judge_) &&
           compare_events(kFifoStates, iut.fifo_states(), std::span(&twin.fifo_states(), 1), is_settled,
                          judge_) &&
           compare_events(kLateCounts, iut.late_counts(), std::span(&twin.late_counts(), 1), is_settled,
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
      if (!is_noisy_)
        judge_.expect_equal(counted.late, right.late, "counters_wrong", fmt::format("late frames of {}", id));
      if (!has_talked_)
        judge_.expect_equal(counted.retries, right.retries, "counters_wrong",
                            fmt::format("retries of {}", id));
    }
  }

  CaseJudge& judge_;
  HostBench twin_;  // with the reference
  std::array<HostSide, 2> sides_;
  bool is_late_ = false;
  bool is_noisy_ = false;    // what came from the nodes may be a frame to one host and none to another
  bool has_talked_ = false;  // a read is tried then as often as the host likes
  bool can_turn_dip_;
};

std::vector<PartialSource> host_sequence_details() {
  std::vector<PartialSource> details = host_details();
  details.push_back(
      {valve_sources::own("what a host reports to its PC, and what it counts"),
       {"indication_missing", "indication_unasked", "indication_wrong", "counters_wrong", "fifo_wrong"}});
  return details;
}

}  // namespace

constexpr std::size_t kCostOfHost = 4;  // refreshes at length, in some

const SequenceRole& host_sequence_role() {
  static const SequenceRole role{
      {.id = "valve_bus/host/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever is ordered and answered in whatever order, a host sends each order in turn, "
                      "repeats a read that is not answered well, and reports the end of each.",
       .reference = valve_sources::own("requests, repetitions and reports of the host module"),
       .details = host_sequence_details(),
       .rules = host_reasons(),
       .stimulus = "Orders and answers at random, with flipped bits, dropped characters and gaps.",
       .expected = "What the reference sends and reports when it is ordered and answered the same.",
       .tags = {},
       .catches = {}},
      host_vocabulary(),
      {{DerivedKind::values, {"request_check_is_sum", "check_wrong"}},
       {DerivedKind::faults, {"waits_long_behind_errors", "no_request"}},
       {DerivedKind::words, {"request_check_without_id", "check_wrong"}},
       {DerivedKind::states, {"request_check_without_id", "check_wrong"}},
       {DerivedKind::walks, {"never_resyncs", "indication_missing"}},
       {DerivedKind::repetitions, {"told_twice", "indication_wrong"}},
       {DerivedKind::settings, {"silence_told_as_data", "indication_wrong"}},
       {DerivedKind::drawn, {"request_check_without_id", "check_wrong"}}},
      kCostOfHost,
      kStatesOfHost};
  return role;
}

void run_host_sequence(const Sequence& sequence, HostBench& bench, CaseJudge& judge) {
  bench.expect_exact_instants();  // they are compared with those of the reference
  HostSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
