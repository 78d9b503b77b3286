#include "conformance/valve_bus/node_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"
#include "conformance/valve_bus/node_model.hpp"

namespace fieldproof::conformance {
namespace {

// Bits of silence in which no receiver doubts: within a frame, between the two limits, behind a delimiter.
constexpr std::array<std::int64_t, 8> kSilences{0, 11, 22, 33, 45, 45, 80, 500};
constexpr std::array<std::int64_t, 5> kGaps{5, 13, 22, 33, 45};
constexpr std::int64_t kDelimiterBits = 45;
constexpr std::array<std::int64_t, 6> kData{0x00, 0xFF, 0x01, 0x05, 0x80, 0xA5};
constexpr std::array<std::int64_t, 5> kIds{1, 0, 5, 69, 133};
constexpr std::array<std::int64_t, 3> kCommands{0, 1, 2};
constexpr std::array<std::int64_t, 4> kWaits{1, 10, 100, 1000};

SequenceNumber octet(std::string_view name, std::span<const std::int64_t> likely = kData) {
  return {name, 0, 0xFF, 0, likely};
}

// Behind what the command sends, to the next.
SequenceNumber silence() {
  return {"silence", 0, 100'000, kDelimiterBits, kSilences, true};
}

enum class Word : std::uint8_t { write, read, command, response, octets, low, wait, power, switches };

SequenceVocabulary node_vocabulary() {
  // In the order of Word.
  return {.words = {{.word = "write",
                     .meaning = "a write of the node's own",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 5,
                     .weight = 6},
                    {.word = "read",
                     .meaning = "a read of the node's own",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 5,
                     .weight = 4},
                    {.word = "command",
                     .meaning = "a command to any address",
                     .numbers = {octet("id", kIds), octet("command", kCommands), octet("data0"),
                                 octet("data1"), silence()},
                     .units = 5,
                     .weight = 3},
                    {.word = "response",
                     .meaning = "a response of another node",
                     .numbers = {octet("data0"), octet("data1"), silence()},
                     .units = 3,
                     .weight = 2},
                    {.word = "octets",
                     .meaning = "octets that are no frame, or happen to be one",
                     .numbers = {silence()},
                     .most_octets = 8,
                     .weight = 2},
                    {.word = "low",
                     .meaning = "the line is low for so many bits",
                     .numbers = {{"bits", 1, 100'000, 30}, silence()},
                     .weight = 1},
                    {.word = "wait",
                     .meaning = "silence of so many milliseconds",
                     .numbers = {{"ms", 1, 10'000, 10, kWaits}},
                     .weight = 1},
                    {.word = "power",
                     .meaning = "the supply is off for so many bits and comes again",
                     .numbers = {{"off", 10, 100'000, 20}, silence()},
                     .weight = 1},
                    {.word = "switches",
                     .meaning = "limit switches stand like this",
                     .numbers = {octet("data0"), octet("data1")},
                     .weight = 2}},
          .unit = "character",
          .levels_per_unit = 11,
          .gaps = kGaps};
}

std::vector<std::uint8_t> octets_of(Word word, const SequenceCommand& command, const NodeBench& bench) {
  const auto number = [&](std::size_t n) { return static_cast<std::uint8_t>(command.numbers.at(n)); };
  std::vector<std::uint8_t> octets;
  switch (word) {
    case Word::write:
    case Word::read:
      octets = {bench.address(), static_cast<std::uint8_t>(word == Word::write ? 0 : 1), number(0),
                number(1)};
      break;
    case Word::command:
      octets = {number(0), number(1), number(2), number(3)};
      break;
    case Word::response:
      octets = {number(0), number(1)};
      break;
    default:
      return command.octets;
  }
  std::uint8_t check = 0;
  for (const std::uint8_t one : octets) check ^= one;
  octets.push_back(check);
  return octets;
}

class NodeSequenceRun {
 public:
  NodeSequenceRun(NodeBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.configuration()) {
    model_.power_up(bench.now());
    powered_at_ = bench.now() - bench.delimiter() * 2;
  }

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence) {
      execute(command);
      if (is_over_) return;
    }
    bench_.await_response_window();
    judge_silence();
  }

 private:
  void execute(const SequenceCommand& command) {
    const auto word = static_cast<Word>(command.word);
    switch (word) {
      case Word::low:
        drive_low(command.numbers[0]);
        break;
      case Word::wait:
        bench_.wait(command.numbers[0] * kernel::kMillisecond);
        break;
      case Word::power:
        judge_silence();
        if (!is_over_) cycle_power(bench_.bits(command.numbers[0]));
        break;
      case Word::switches:
        set_switches(static_cast<std::uint16_t>(command.numbers[0] | command.numbers[1] << 8));
        break;
      default:
        send(octets_of(word, command, bench_), command.faults);
    }
    const bool has_silence = word != Word::wait && word != Word::switches;
    if (has_silence) bench_.wait(bench_.bits(command.numbers.back()));
    judge_silence();
  }

  // Character by character, as stations do: who listens learns of each when it is over.
  void send(const std::vector<std::uint8_t>& octets, const std::vector<SequenceFault>& faults) {
    for (std::size_t n = 0; n < octets.size(); ++n) {
      line::Waveform wave;
      wave.rate = bench_.rules().bit_rate;
      wave.levels = bench_.levels_of(octets[n]);
      bool is_dropped = false;
      std::int64_t gap = 0;
      for (const SequenceFault& fault : faults) {
        if (fault.unit != n) continue;
        if (fault.kind == SequenceFaultKind::drop) is_dropped = true;
        if (fault.kind == SequenceFaultKind::gap) gap += fault.value;
        if (fault.kind == SequenceFaultKind::flip && fault.value < wave.levels.size()) {
          wave.levels.flip(fault.value);
        }
      }
      if (is_dropped) {
        bench_.wait(bench_.characters(1));
      } else {
        bench_.drive(wave);
      }
      bench_.wait(bench_.bits(gap));
    }
    // A host waits for what is due before it says anything else.
    const auto frames = bench_.arrived();
    if (!frames.empty() && model_.is_answered(frames.back())) bench_.await_response_window();
  }

  // In pieces as long as a character: a line tells a transmission when it is over, and a receiver knows of a
  // missing stop bit no later than that.
  void drive_low(std::int64_t bits) {
    const auto character = static_cast<std::int64_t>(bench_.levels_of(0).size());
    for (std::int64_t left = bits; left > 0; left -= character) {
      line::Waveform piece;  // a line may take away what it is given
      piece.rate = bench_.rules().bit_rate;
      piece.levels.append_fill(false, static_cast<std::size_t>(std::min(left, character)));
      bench_.drive(piece);
    }
  }

  void set_switches(std::uint16_t switches) {
    switches_ = switches;
    bench_.require(&valve_bus::NodeCapabilities::boards);
    bench_.boards().set_input(0, switches);
  }

  void cycle_power(kernel::Duration off) {
    bench_.clear_observations();
    bench_.set_power(false);
    bench_.boards().forget_changes();
    bench_.wait(off);
    expect_ignored(bench_, judge_, "acts_without_power", "it has no supply");
    bench_.clear_observations();
    bench_.set_power(true);
    powered_at_ = bench_.now();
    model_.power_up(bench_.now());
  }

  bool is_line_silent() const {
    const auto frames = bench_.arrived();
    return frames.empty() || bench_.now() - frames.back().end >= bench_.delimiter();
  }

  // Nobody can say what is right from here on.
  bool is_doubtful() const {
    const auto frames = bench_.arrived();
    const bool is_near_limit = std::ranges::any_of(frames, &ArrivedFrame::is_doubtful);
    // What speaks into an answer that is due is no host of this bus.
    const bool is_answer_disturbed =
        std::any_of(frames.begin(), frames.end() - (frames.empty() ? 0 : 1),
                    [&](const ArrivedFrame& frame) { return model_.is_answered(frame); });
    // A node may want a delimiter in front of its first frame.
    const bool is_soon = !frames.empty() && frames.front().is_command() &&
                         frames.front().start < powered_at_ + bench_.delimiter() + bench_.bits(2);
    return is_near_limit || is_answer_disturbed || is_soon || bench_.now() > model_.holds_until();
  }

  void judge_silence() {
    if (is_over_ || !is_line_silent()) return;
    is_over_ = is_doubtful();
    if (is_over_) return;
    std::optional<NodeModel::Answer> due;
    kernel::Time end{};
    for (const ArrivedFrame& frame : bench_.arrived()) {
      due = model_.hear(frame, switches_);
      end = frame.end;
    }
    judge_valves();
    if (due) {
      expect_one_answer(bench_, judge_, due->data0, due->data1, end - bench_.distance());
    } else {
      expect_silence(bench_, judge_, "answers_without_command", "nothing that arrived asks for it");
    }
    bench_.clear_observations();
  }

  void judge_valves() {
    if (!bench_.reach().boards) return;  // nobody sees them
    const auto& changes = bench_.boards().changes();
    for (std::size_t n = 0; n < changes.size(); ++n) {
      const bool goes_on =
          n + 1 < changes.size() && changes[n + 1].when - changes[n].when <= bench_.rules().output_skew;
      if (!goes_on) object(model_.move(changes[n].after, changes[n].when), changes[n].after);
    }
    object(model_.pass(bench_.now()), bench_.valves());
  }

  void object(const std::optional<NodeModel::Objection>& objection, std::uint16_t valves) {
    if (!objection) return;
    judge_.fail(objection->reason, {{objection->expected},
                                    fmt::format("valves {:02X} {:02X}", valves & 0xFFU, valves >> 8U),
                                    objection->when});
  }

  NodeBench& bench_;
  CaseJudge& judge_;
  NodeModel model_;
  std::uint16_t switches_ = 0;
  kernel::Time powered_at_{};
  bool is_over_ = false;
};

// Any silence may stand between two characters of a sequence: what is a frame rests on the delimiter always.
std::vector<PartialSource> sequence_details() {
  std::vector<PartialSource> details = node_details();
  details.push_back({valve_sources::own("silence of 3.5 characters ends a frame, whatever came before it"),
                     {"moves_without_command", "write_not_taken", "answers_without_command", "no_answer"}});
  return details;
}

}  // namespace

const SequenceRole& node_sequence_role() {
  static const SequenceRole role{
      {.id = "valve_bus/node/check/follows_the_model",
       .purpose = "check",
       .requirement = "Whatever comes in whatever order, valves move and answers come by whole frames of the "
                      "node's own, and by nothing else.",
       .reference = valve_sources::paper("frames, block check, what a node does with a command"),
       .details = sequence_details(),
       .stimulus = "Commands at random, with flipped bits, dropped characters and gaps.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      node_vocabulary()};
  return role;
}

void run_node_sequence(const Sequence& sequence, NodeBench& bench, CaseJudge& judge) {
  NodeSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
