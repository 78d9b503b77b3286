#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <set>
#include <vector>

#include "conformance/comparison/observation.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence.hpp"
#include "conformance/valve_bus/node_bench.hpp"
#include "conformance/valve_bus/node_twin.hpp"

// One sequence for a local node: what its commands do to it and to references that hear the same, and what
// is compared after each.
namespace fieldproof::conformance {

class NodeSequenceRun final : private segment::Tap {
 public:
  NodeSequenceRun(NodeBench& bench, CaseJudge& judge);
  ~NodeSequenceRun() override { bench_.arrivals().pass_to(nullptr); }
  NodeSequenceRun(const NodeSequenceRun&) = delete;
  NodeSequenceRun& operator=(const NodeSequenceRun&) = delete;

  void run(const Sequence& sequence);

 private:
  void on_wave(const line::Waveform& wave) override;
  void execute(const SequenceCommand& command);
  // False: it is another one.
  bool execute_frame(const SequenceCommand& command);
  bool execute_state(const SequenceCommand& command);

  // ---- the line ----
  std::vector<SequenceFault> faults_of(const SequenceCommand& command) const;
  void send(const std::vector<std::uint8_t>& octets, const std::vector<SequenceFault>& faults,
            std::int64_t rate_percent = 100);
  void send_command(std::uint8_t id, std::uint8_t command, std::uint8_t inverted = 0);
  void send_with_moved_edges(const std::vector<std::uint8_t>& octets, std::int64_t sixteenths);
  void drive_low(std::int64_t bits);
  void drive_break(std::int64_t characters);
  void drive_glitch(std::int64_t sixteenths);

  // ---- what takes several frames, or an instant ----
  void poll();
  void send_wrong(std::int64_t count);
  void give_sign_of_life(std::int64_t kind);
  void talk_to_others();
  void cancel(const SequenceCommand& command);
  void collide(const SequenceCommand& command);
  void read_clock();
  // A read, up to where the node drives; false: it does not.
  bool read_until_driven();

  // ---- terminals and supply ----
  void set_switches(std::uint16_t switches);
  void cycle_power(kernel::Duration off);
  void lose_power_in_an_answer(std::int64_t characters);
  void begin_valves();

  // ---- what is right ----
  bool is_own(const ArrivedFrame& frame, unsigned command) const;
  bool is_answered(const ArrivedFrame& frame) const;
  bool is_line_silent() const;
  bool is_doubtful() const;
  void compare();
  void judge_invariants();
  void compare_valves();
  [[noreturn]] void fail_valves(const LevelKind& kind, const LevelMismatch& mismatch);
  void compare_answers();
  // Of what was driven since then nothing more is compared.
  void forget_answers();

  NodeBench& bench_;
  CaseJudge& judge_;
  std::deque<NodeTwin> twins_;
  LevelHistory valves_;              // of the node under test
  std::set<std::uint16_t> written_;  // since power-up
  std::uint16_t switches_ = 0;
  kernel::Time judged_until_{};
  kernel::Time powered_at_{};
  bool may_cancel_ = false;  // what is sent in front of an answer is sent on purpose
  bool is_over_ = false;
};

}  // namespace fieldproof::conformance
