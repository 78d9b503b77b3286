#include "conformance/valve_bus/node_sequence_run.hpp"

#include <algorithm>

#include "conformance/valve_bus/node_expect.hpp"
#include "conformance/valve_bus/node_lateness.hpp"
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

}  // namespace

NodeSequenceRun::NodeSequenceRun(NodeBench& bench, CaseJudge& judge) : bench_(bench), judge_(judge) {
  for (const auto& extreme : node_extremes(bench.configuration())) twins_.emplace_back(extreme, bench.now());
  powered_at_ = bench.now() - bench.delimiter() * 2;
  begin_valves();
  bench_.arrivals().pass_to(this);
}

void NodeSequenceRun::run(const Sequence& sequence) {
  for (const SequenceCommand& command : sequence.commands) {
    execute(command);
    if (is_over_) return;
  }
  bench_.await_response_window();
  compare();
}

void NodeSequenceRun::on_wave(const line::Waveform& wave) {
  for (NodeTwin& twin : twins_) twin.line().on_wave(wave);
}

void NodeSequenceRun::execute(const SequenceCommand& command) {
  const auto word = static_cast<NodeWord>(command.word);
  const bool has_silence = execute_frame(command) || execute_state(command);
  if (has_silence && !is_over_) bench_.wait(bench_.bits(command.numbers.back()));
  compare();
  if (word == NodeWord::cancel) may_cancel_ = false;
}

bool NodeSequenceRun::execute_frame(const SequenceCommand& command) {
  const auto word = static_cast<NodeWord>(command.word);
  switch (word) {
    case NodeWord::write:
    case NodeWord::read:
    case NodeWord::command:
    case NodeWord::response:
    case NodeWord::octets:
    case NodeWord::check:
    case NodeWord::parity:
    case NodeWord::spaced:
    case NodeWord::stop:
      send(octets_of(word, command, bench_), faults_of(command));
      return true;
    case NodeWord::rate:
      bench_.wait(bench_.delimiter() + bench_.bits(6));
      send(octets_of(word, command, bench_), {}, command.numbers[0]);
      return true;
    case NodeWord::edges:
      send_with_moved_edges(octets_of(word, command, bench_), command.numbers[0]);
      return true;
    case NodeWord::low:
      drive_low(command.numbers[0]);
      return true;
    case NodeWord::line_break:
      drive_break(command.numbers[0]);
      return true;
    case NodeWord::glitch:
      drive_glitch(command.numbers[0]);
      return true;
    case NodeWord::cancel:
      cancel(command);
      return true;
    case NodeWord::collision:
      collide(command);
      return true;
    default:
      return false;
  }
}

bool NodeSequenceRun::execute_state(const SequenceCommand& command) {
  switch (static_cast<NodeWord>(command.word)) {
    case NodeWord::wait:
      bench_.wait(command.numbers[0] * kernel::kMillisecond);
      return false;
    case NodeWord::power:
      compare();
      if (!is_over_) cycle_power(bench_.bits(command.numbers[0]));
      return true;
    case NodeWord::lost:
      lose_power_in_an_answer(command.numbers[0]);
      return true;
    case NodeWord::switches:
      set_switches(static_cast<std::uint16_t>(command.numbers[0] | command.numbers[1] << 8));
      return false;
    case NodeWord::poll:
      for (std::int64_t n = 0; n < command.numbers[0] && !is_over_; ++n) poll();
      return false;
    case NodeWord::sign:
      give_sign_of_life(command.numbers[0]);
      return false;
    case NodeWord::wrong:
      send_wrong(command.numbers[0]);
      return false;
    case NodeWord::others:
      talk_to_others();
      return false;
    default:
      read_clock();
      return false;
  }
}

void NodeSequenceRun::set_switches(std::uint16_t switches) {
  bench_.require(&iut::Capabilities::process_side);
  switches_ = switches;
  bench_.boards().set_input(0, switches);
  for (NodeTwin& twin : twins_) {
    twin.run_until(bench_.now());
    twin.set_switches(switches);
  }
}

void NodeSequenceRun::cycle_power(kernel::Duration off) {
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

void NodeSequenceRun::begin_valves() {
  valves_.begin(0, bench_.now());
  written_ = {0};
  judged_until_ = bench_.now();
}

// ---- what is right ----

bool NodeSequenceRun::is_own(const ArrivedFrame& frame, unsigned command) const {
  return frame.is_command() && frame.octets[0] == bench_.address() && frame.octets[1] == command;
}

// What the tester takes for a question: it asks nothing else meanwhile.
bool NodeSequenceRun::is_answered(const ArrivedFrame& frame) const {
  const valve_bus::Rules& rules = bench_.rules();
  return is_own(frame, rules.read_command) || (rules.answers_writes && is_own(frame, rules.write_command));
}

bool NodeSequenceRun::is_line_silent() const {
  const auto frames = bench_.arrived();
  return frames.empty() || bench_.now() - frames.back().end >= bench_.delimiter();
}

// Nobody can say what is right from here on.
bool NodeSequenceRun::is_doubtful() const {
  const auto frames = bench_.arrived();
  const bool is_near_limit = std::ranges::any_of(frames, &ArrivedFrame::is_doubtful);
  // What speaks into an answer that is due is no host of this bus.
  const bool is_answer_disturbed =
      !may_cancel_ && std::any_of(frames.begin(), frames.end() - (frames.empty() ? 0 : 1),
                                  [&](const ArrivedFrame& frame) { return is_answered(frame); });
  // A node may want a delimiter in front of its first frame.
  const bool is_soon = !frames.empty() && frames.front().is_command() &&
                       frames.front().start < powered_at_ + bench_.delimiter() + bench_.bits(2);
  return is_near_limit || is_answer_disturbed || is_soon;
}

void NodeSequenceRun::compare() {
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
void NodeSequenceRun::judge_invariants() {
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

void NodeSequenceRun::compare_valves() {
  if (!bench_.capabilities().process_side) return;  // nobody sees them
  for (const auto& change : bench_.boards().changes()) valves_.set(change.after, change.when);
  bench_.boards().forget_changes();
  const LevelKind kind = valves_of_node(bench_);
  std::vector<LevelHistory> extremes;
  for (const NodeTwin& twin : twins_) extremes.push_back(twin.valves());
  const kernel::Time until = std::max(judged_until_, bench_.now() - kind.earlier);
  const auto mismatch = first_mismatch(kind, valves_, extremes, judged_until_, until);
  if (mismatch) fail_valves(kind, *mismatch);
  judged_until_ = until;
}

void NodeSequenceRun::fail_valves(const LevelKind& kind, const LevelMismatch& mismatch) {
  if (mismatch.is_change) {
    expect_move_not_late(bench_, judge_, static_cast<std::uint16_t>(mismatch.value), mismatch.when);
  } else {
    for (const std::int64_t value : mismatch.allowed)
      expect_not_late(bench_, judge_, static_cast<std::uint16_t>(value), mismatch.when);
  }
  fail_level(kind, mismatch, judge_);
}

// Of a question the tester awaits the end, so what has come by now is all that comes.
void NodeSequenceRun::compare_answers() {
  std::vector<Observations> answers;
  for (NodeTwin& twin : twins_) answers.push_back(twin.take_answers());
  if (answers.front().empty())
    return expect_silence(bench_, judge_, "answers_without_command", "nothing that arrived asks for it");
  const auto& octets = answers.front().front().values;
  expect_one_answer(bench_, judge_, static_cast<std::uint8_t>(octets[0]),
                    static_cast<std::uint8_t>(octets[1]), bench_.arrived().back().end - bench_.distance());
}

void NodeSequenceRun::forget_answers() {
  for (NodeTwin& twin : twins_) {
    twin.run_until(bench_.now());
    twin.take_answers();
  }
  if (bench_.capabilities().process_side) compare_valves();
  bench_.clear_observations();
}

}  // namespace fieldproof::conformance
