#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "conformance/comparison/observation.hpp"
#include "conformance/interbus/driven_telegrams.hpp"
#include "conformance/interbus/master_bench.hpp"
#include "conformance/interbus/returned_line.hpp"

// One of the two benches of a sequence for a master: what the tester does there as ring and as application,
// and what the master makes of each cycle.
//
// What is compared begins in run: how a ring is recognised is the master's choice, its result is not. Between
// commands the master stands right after a cycle, or has no cycles: it is off, or has given up the bus.
//
// Whoever is judged is held to what no master may do, whatever the reference does:
//   what it sends has the headers of its phase and a check that fits, and begins with an ID cycle
//   it accepts what came back if, and only if, that is the cycle that it sent
//   inputs are those of the last accepted data cycle, as a whole
//   it counts the data cycles, and those that it rejected
//   an ID cycle follows a rejected cycle
//   it is never silent for longer than stations wait for a sign of life, unless it has given up the bus
//   once it runs, an ID cycle that is asked for and two good data cycles come within 8 cycles
//   it sends no cycle when it is stopped, and its last one sets the outputs to 0
namespace fieldproof::conformance {

// What the limits of a master are: the usual ones, just met by the ring, or just exceeded.
enum class Limits : std::uint8_t {
  usual,
  stations_met,
  stations_exceeded,
  points_met,
  points_exceeded,
  levels_met,
  levels_exceeded,
};

// Words that a master copies: none, the first and the last one to each other's place, each to the place that
// is as far from the end, or one from and one to a word that the ring does not have.
enum class Copies : std::uint8_t { none, ends, all, beyond };

// What an application orders in another state than run.
enum class EarlyOrder : std::uint8_t { start, stop, id_cycle, output };

// What a master finds when its supply comes.
struct MasterScene {
  std::vector<interbus::VirtualStation> ring;
  std::vector<interbus::VirtualStation> expected{};  // empty: any ring is taken
  Copies copies = Copies::none;
  kernel::Duration cycle_time{};
  unsigned disturbed = 0;  // the first cycles come back changed
  Limits limits = Limits::usual;
};

class MasterSide {
 public:
  // `judge`: of what no master may do; null: it is not judged.
  MasterSide(MasterBench& bench, CaseJudge* judge);
  ~MasterSide();
  MasterSide(const MasterSide&) = delete;
  MasterSide& operator=(const MasterSide&) = delete;

  const Observations& cycles() const { return cycles_; }
  const Observations& inputs() const { return inputs_; }
  const Observations& reports() const { return reports_; }
  const Observations& states() const { return states_; }
  void clear_observations();
  bool is_running() const { return bench_.is_in_run(); }
  MasterBench& bench() { return bench_; }

  void power(const MasterScene& scene);
  // Nothing unless it is off or has given up the bus.
  void start(unsigned disturbed);
  void stop(bool is_disturbed);
  // In run: the master is brought to that state, ordered this, and what comes of it is awaited.
  void order_in(interbus::MasterState state, EarlyOrder order);
  // In run, up to the end of the next cycle, which suffers the faults; one that has begun ends before.
  void cycle(const interbus::CycleFaults& faults = {});
  // In run: the next cycle has begun, be it within the call in which the one before ended, which no order
  // after that call meets any more.
  bool has_begun() const;
  void await_begin();
  // Ends a cycle whose beginning was awaited.
  void finish_begun();
  // The application; nothing unless it is in run.
  void write(unsigned word, std::uint16_t value);
  void write_all(std::uint16_t even, std::uint16_t odd);
  void request_id_cycle();
  // The stations.
  void offer(std::uint16_t even, std::uint16_t odd);
  void set_messages(std::size_t station, std::uint16_t bits);
  // The cable in front of the station is cut until the master has given up the bus.
  void cut_before(std::size_t station);
  // One of another length: until the master has seen it.
  void replace_ring(std::vector<interbus::VirtualStation> ring);
  void wait(kernel::Duration duration);

 private:
  // Who looks for a fault waits until all stations are in reset, and begins with a ring that is ready again.
  static constexpr kernel::Duration kIdle = 60 * kernel::kMillisecond;

  using Values = std::vector<std::int64_t>;

  bool is_idle() const;
  void give(EarlyOrder order);
  void await_stop();
  void await_outputs_of_run();
  void await_three_cycles_of_run();
  void expect_no_start();
  kernel::Duration longest_recognition() const;
  void limit_ring(const MasterScene& scene);
  void on_ring_cycle(bool is_id_cycle, interbus::CycleFaults& faults);
  void await_run();
  void enter_run();
  void settle();
  kernel::Duration idle() const;
  void end_cycle();
  void note_end();
  interbus::CycleFaults certain(interbus::CycleFaults faults) const;
  bool run_cycle();
  void note_cycle();
  void note_state(bool is_located);
  void add_images(Values& values) const;
  void judge_cycle(const interbus::SeenCycle& sent);
  void judge_inputs(const interbus::SeenCycle& sent, Arrival arrival);
  void judge_counters();
  void judge_silence();
  void judge_line();
  void judge_break();
  void judge_stop(std::uint64_t first, std::uint64_t under_way);
  std::int64_t cycle_times();
  void expect(bool holds, std::string_view reason, std::string_view expected, std::string_view actual) const;
  std::vector<std::size_t> input_places() const;

  MasterBench& bench_;
  CaseJudge* judge_;
  std::shared_ptr<ReturnedLine> returned_;
  std::shared_ptr<DrivenTelegrams> driven_;
  kernel::Time cycle_start_{};
  bool is_next_ = false;  // the cycle before was one of this run
  std::uint64_t ended_cycles_ = 0;
  kernel::Time ended_start_{};  // of the last one that has ended
  std::optional<interbus::CycleFaults> armed_;
  unsigned disturbed_ = 0;
  std::uint64_t states_seen_ = 0;        // a bit for each, at the beginnings of cycles
  std::vector<std::uint16_t> at_start_;  // the inputs after the order
  bool has_kept_inputs_ = true;          // up to the first data cycle
  bool is_before_data_ = false;
  bool is_stopped_ = false;
  bool has_rejected_ = false;   // the last cycle
  bool is_ring_known_ = false;  // it has run on this one since its supply came
  bool is_ring_right_ = true;   // the one that it runs on
  std::vector<std::uint16_t> held_;
  std::uint64_t rejected_data_ = 0;  // cycles, in this run
  interbus::MasterStatus at_entry_;
  MasterBench::FinishedCycle ended_at_entry_{};
  Observations cycles_;
  Observations inputs_;
  Observations reports_;
  Observations states_;
};

}  // namespace fieldproof::conformance
