#include "conformance/valve_bus/node_sequence.hpp"

#include <algorithm>
#include <deque>
#include <set>

#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_expect.hpp"
#include "conformance/valve_bus/node_twin.hpp"
#include "conformance/valve_bus/node_vocabulary.hpp"

namespace fieldproof::conformance {
namespace {

std::string text_of_valves(std::int64_t valves) {
  return valves_text(static_cast<std::uint16_t>(valves));
}

// The valves may move from the last stop bit of a command on; a reference moves them when it is sure that the
// frame is over.
LevelKind valves_of_node(NodeBench& bench) {
  const valve_bus::Rules& rules = bench.rules();
  const iut::TimingUncertainty doubt = bench.uncertainty_of_valves();
  return {.unasked = "moves_without_command",
          .different = "valves_wrong",
          .not_taken = "write_not_taken",
          .earlier = bench.delimiter() + valve_bus::character_notice(rules) + kRounding + doubt.later,
          .later = actuation_limit(rules) + kRounding + doubt.earlier,
          .skew = rules.output_skew,
          .text = text_of_valves};
}

class NodeSequenceRun final : private segment::Tap {
 public:
  NodeSequenceRun(NodeBench& bench, CaseJudge& judge) : bench_(bench), judge_(judge) {
    for (const auto& extreme : node_extremes(bench.configuration()))
      twins_.emplace_back(extreme, bench.now());
    powered_at_ = bench.now() - bench.delimiter() * 2;
    begin_valves();
    bench_.arrivals().pass_to(this);
  }
  ~NodeSequenceRun() override { bench_.arrivals().pass_to(nullptr); }

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      execute(command);
      if (is_over_) return;
    }
    bench_.await_response_window();
    compare();
  }

 private:
  void on_wave(const line::Waveform& wave) override {
    for (NodeTwin& twin : twins_) twin.line().on_wave(wave);
  }

  void execute(const SequenceCommand& command) {
    const auto word = static_cast<NodeWord>(command.word);
    switch (word) {
      case NodeWord::low:
        drive_low(command.numbers[0]);
        break;
      case NodeWord::wait:
        bench_.wait(command.numbers[0] * kernel::kMillisecond);
        break;
      case NodeWord::power:
        compare();
        if (!is_over_) cycle_power(bench_.bits(command.numbers[0]));
        break;
      case NodeWord::switches:
        set_switches(static_cast<std::uint16_t>(command.numbers[0] | command.numbers[1] << 8));
        break;
      case NodeWord::line_break:
        drive_break(command.numbers[0]);
        break;
      case NodeWord::glitch:
        drive_glitch(command.numbers[0]);
        break;
      case NodeWord::poll:
        for (std::int64_t n = 0; n < command.numbers[0] && !is_over_; ++n) poll();
        break;
      case NodeWord::sign:
        give_sign_of_life(command.numbers[0]);
        break;
      case NodeWord::rate:
        bench_.wait(bench_.delimiter() + bench_.bits(6));
        send(octets_of(word, command, bench_), {}, command.numbers[0]);
        break;
      default:
        send(octets_of(word, command, bench_), faults_of(command));
    }
    const bool has_silence = word != NodeWord::wait && word != NodeWord::switches && word != NodeWord::poll &&
                             word != NodeWord::sign;
    if (has_silence) bench_.wait(bench_.bits(command.numbers.back()));
    compare();
  }

  // With those that a word is about.
  std::vector<SequenceFault> faults_of(const SequenceCommand& command) const {
    const std::size_t length = bench_.levels_of(0).size();
    const auto unit = static_cast<std::uint32_t>(command.numbers.front());
    constexpr std::uint32_t kAfterData = 9;
    constexpr std::size_t kWithParity = 11;
    if (static_cast<NodeWord>(command.word) == NodeWord::parity && length >= kWithParity)
      return {{SequenceFaultKind::flip, unit, kAfterData}};
    if (static_cast<NodeWord>(command.word) == NodeWord::spaced)
      return {{SequenceFaultKind::gap, unit,
               static_cast<std::uint32_t>(length) * static_cast<std::uint32_t>(command.numbers[1]) / 10}};
    return command.faults;
  }

  // Character by character, as stations do: who listens learns of each when it is over.
  void send(const std::vector<std::uint8_t>& octets, const std::vector<SequenceFault>& faults,
            std::int64_t rate_percent = 100) {
    for (std::size_t n = 0; n < octets.size(); ++n) {
      line::Waveform wave;
      wave.rate = bench_.rules().bit_rate * rate_percent / 100;
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
    if (!frames.empty() && is_answered(frames.back())) bench_.await_response_window();
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

  // On a silent line: a receiver would know of it before a line tells it.
  void drive_break(std::int64_t characters) {
    bench_.wait(bench_.delimiter() + bench_.bits(6));
    line::Waveform low;
    low.rate = bench_.rules().bit_rate;
    low.levels.append_fill(false, bench_.levels_of(0).size() * static_cast<std::size_t>(characters));
    bench_.drive(low);
  }

  void drive_glitch(std::int64_t sixteenths) {
    line::Waveform low;
    low.rate = bench_.rules().bit_rate * 16;
    low.levels.append_fill(false, static_cast<std::size_t>(sixteenths));
    bench_.drive(low);
  }

  void send_command(std::uint8_t id, std::uint8_t command, std::uint8_t inverted = 0) {
    const auto check = static_cast<std::uint8_t>(id ^ command ^ 0xA5 ^ 0x3C ^ inverted);
    send({id, command, 0xA5, 0x3C, check}, {});
  }

  void poll() {
    send_command(bench_.address(), static_cast<std::uint8_t>(bench_.rules().read_command));
    bench_.wait(bench_.delimiter() + bench_.bits(6));
    compare();
  }

  void give_sign_of_life(std::int64_t kind) {
    const kernel::Duration limit = bench_.rules().loss_limit;
    if (limit == kernel::Duration{} || bench_.capabilities().is_wall_clock) return;
    const kernel::Duration part = limit / 10 * 7;
    const std::uint8_t own = bench_.address();
    constexpr std::uint8_t kUndefined = 2;
    send_command(own, static_cast<std::uint8_t>(bench_.rules().write_command));
    bench_.wait(part);
    compare();
    if (is_over_) return;
    if (kind == 0) send_command(own, static_cast<std::uint8_t>(bench_.rules().read_command));
    if (kind == 1) send_command(own, kUndefined);
    if (kind == 2) send_command(static_cast<std::uint8_t>(own == 1 ? 2 : 1), 0);
    if (kind == 3) send_command(own, 0, 1);
    bench_.wait(part);
  }

  void set_switches(std::uint16_t switches) {
    bench_.require(&iut::Capabilities::process_side);
    bench_.boards().set_input(0, switches);
    for (NodeTwin& twin : twins_) {
      twin.run_until(bench_.now());
      twin.set_switches(switches);
    }
  }

  void cycle_power(kernel::Duration off) {
    bench_.clear_observations();
    bench_.set_power(false);
    for (NodeTwin& twin : twins_) twin.set_power(false, bench_.now());
    bench_.boards().forget_changes();
    bench_.wait(off);
    expect_ignored(bench_, judge_, "acts_without_power", "it has no supply");
    bench_.clear_observations();
    bench_.power_up();
    for (NodeTwin& twin : twins_) twin.set_power(true, bench_.now());
    powered_at_ = bench_.now();
    begin_valves();
  }

  void begin_valves() {
    valves_.begin(0, bench_.now());
    written_ = {0};
    judged_until_ = bench_.now();
  }

  bool is_own(const ArrivedFrame& frame, unsigned command) const {
    return frame.is_command() && frame.octets[0] == bench_.address() && frame.octets[1] == command;
  }
  // What the tester takes for a question: it asks nothing else meanwhile.
  bool is_answered(const ArrivedFrame& frame) const {
    const valve_bus::Rules& rules = bench_.rules();
    return is_own(frame, rules.read_command) || (rules.answers_writes && is_own(frame, rules.write_command));
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
                    [&](const ArrivedFrame& frame) { return is_answered(frame); });
    // A node may want a delimiter in front of its first frame.
    const bool is_soon = !frames.empty() && frames.front().is_command() &&
                         frames.front().start < powered_at_ + bench_.delimiter() + bench_.bits(2);
    return is_near_limit || is_answer_disturbed || is_soon;
  }

  void compare() {
    if (is_over_ || !is_line_silent()) return;
    is_over_ = is_doubtful();
    if (is_over_) return;
    for (NodeTwin& twin : twins_) twin.run_until(bench_.now());
    judge_invariants();
    compare_valves();
    compare_answers();
    bench_.clear_observations();
  }

  // What holds of every node, and of the reference, too: by what arrived alone.
  void judge_invariants() {
    const auto frames = bench_.arrived();
    for (const ArrivedFrame& frame : frames) {
      if (is_own(frame, bench_.rules().write_command))
        written_.insert(bench_.valves_of(frame.octets[2], frame.octets[3]));
    }
    if (std::ranges::none_of(frames, [&](const ArrivedFrame& one) { return is_answered(one); }))
      expect_silence(bench_, judge_, "answers_without_command", "nothing that arrived asks for it");
    if (bench_.capabilities().process_side) {
      judge_.expect(written_.contains(bench_.boards().valves()), "valves_wrong", [&] {
        return Mismatch{{"what a write has set, or nothing"}, valves_text(bench_.boards().valves())};
      });
    }
  }

  void compare_valves() {
    if (!bench_.capabilities().process_side) return;  // nobody sees them
    for (const auto& change : bench_.boards().changes()) valves_.set(change.after, change.when);
    bench_.boards().forget_changes();
    const LevelKind kind = valves_of_node(bench_);
    std::vector<LevelHistory> extremes;
    for (const NodeTwin& twin : twins_) extremes.push_back(twin.valves());
    const kernel::Time until = std::max(judged_until_, bench_.now() - kind.earlier);
    compare_levels(kind, valves_, extremes, judged_until_, until, judge_);
    judged_until_ = until;
  }

  // Of a question the tester awaits the end, so what has come by now is all that comes.
  void compare_answers() {
    std::vector<Observations> answers;
    for (NodeTwin& twin : twins_) answers.push_back(twin.take_answers());
    if (answers.front().empty())
      return expect_silence(bench_, judge_, "answers_without_command", "nothing that arrived asks for it");
    const auto& octets = answers.front().front().values;
    expect_one_answer(bench_, judge_, static_cast<std::uint8_t>(octets[0]),
                      static_cast<std::uint8_t>(octets[1]), bench_.arrived().back().end - bench_.distance());
  }

  NodeBench& bench_;
  CaseJudge& judge_;
  std::deque<NodeTwin> twins_;
  LevelHistory valves_;              // of the node under test
  std::set<std::uint16_t> written_;  // since power-up
  kernel::Time judged_until_{};
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

// What its valves and switches are, and what it has just received or lost.
std::vector<std::vector<NamedCommand>> states_of_a_node() {
  const NamedCommand written{"write", {{"data0", 0xA5}, {"data1", 0x3C}}};
  return {{written},
          {{"switches", {{"data0", 0x5A}, {"data1", 0xC3}}}, {"read"}},
          {{"command", {{"id", 2}, {"command", 1}}}},  // another node's answer is due
          {written, {"wait", {{"ms", 1'000}}}},
          {written, {"power"}},
          {written, {"octets"}}};
}

}  // namespace

const SequenceRole& node_sequence_role() {
  static const SequenceRole role{
      {.id = "valve_bus/node/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever comes in whatever order, valves move and answers come by whole frames of the "
                      "node's own, and by nothing else.",
       .reference = valve_sources::paper("frames, block check, what a node does with a command"),
       .details = sequence_details(),
       .stimulus = "Commands at random, with flipped bits, dropped characters and gaps.",
       .expected = "What the reference does with what arrived, within the times of the rules.",
       .tags = {},
       .catches = {}},
      with_beginnings(node_vocabulary(), states_of_a_node()),
      {{DerivedKind::values, {"switch_bit_stuck", "answer_data_wrong"}},
       {DerivedKind::faults, {"turns_round_late", "answer_too_late"}},
       {DerivedKind::words, {"turns_round_a_tenth_late", "answer_too_late"}},
       {DerivedKind::states, {"turns_round_3_ms_late", "no_answer"}},
       {DerivedKind::repetitions, {"valves_set_at_power_up", "valves_wrong"}},
       {DerivedKind::settings, {"switch_bit_stuck", "answer_data_wrong"}},
       {DerivedKind::drawn, {"turns_round_a_tenth_late", "answer_too_late"}}}};
  return role;
}

void run_node_sequence(const Sequence& sequence, NodeBench& bench, CaseJudge& judge) {
  NodeSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
