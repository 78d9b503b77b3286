#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/case_bench.hpp"
#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/ring_emulator.hpp"
#include "conformance/judging.hpp"
#include "protocols/interbus/device.hpp"

// The bench of one case for a master: a segment, the master under test and the ring emulator that is its
// lower tester. The master's application interface is the upper tester.
//
// A procedure sets `rules()`, `configuration()` and then powers up with a ring; afterwards it runs cycles.
// The reasons that a master does not get as far as the case needs are the bench's: `not_in_run`,
// `no_data_cycle`, `new_inputs_missed`.
//
// What a master may do in more than one way it declares, as text items of its PICS:
//   request_below_minimum   of a cycle time:       clipped | refused
//   outputs_after_bus_stop  of a ring that is cut: zero | held
//   line_after_stop         by the command:        silent | status_telegrams
// Of an item that it does not declare, each answer is admissible.
namespace fieldproof::conformance {

using MasterSetting = BenchSetting<interbus::MasterDevice, interbus::MasterConfiguration>;

class MasterBench final : public CaseBench {
 public:
  using MakeMaster = MasterSetting::Make;

  MasterBench(const NoNeeds&, const MasterSetting& setting);
  ~MasterBench();

  // What the next power-up uses. The rules also hold for the emulated ring.
  interbus::Rules& rules() { return rules_; }
  interbus::MasterConfiguration& configuration() { return configuration_; }

  // Whether the master declares this answer, or none.
  bool may_answer(std::string_view item, std::string_view answer) const {
    return pics_.text(item, answer) == answer;
  }

  // A fresh master on a fresh ring; starts it. Everything from an earlier power-up is gone, but time goes on.
  // `tap` is called when its lines are there, and before it may drive them.
  void power_up(std::vector<interbus::VirtualStation> ring, const std::function<void()>& tap = nullptr);
  // The same, and waits for run.
  void bring_up(CaseJudge& judge, std::vector<interbus::VirtualStation> ring);
  bool wait_for_run();
  // The case is over. What the master does then is still its verdict.
  void finish() {
    if (master_ != nullptr) master_->end();
  }

  interbus::MasterDevice& master() { return *master_; }
  interbus::RingEmulator& ring() { return *ring_; }
  // The last cycles of the ring.
  std::vector<std::string> decode_lines() const {
    return ring_ == nullptr ? std::vector<std::string>{} : ring_->describe_last(6);
  }

  // From outside of the segment's run; the master is asked again when it wants to act.
  void start();
  void stop();
  void write_output(unsigned word, std::uint16_t value);
  void request_id_cycle();

  void run_for(kernel::Duration duration) { wait(duration); }
  // How far ahead the master has driven already: that cannot be taken back, and is waited for.
  kernel::Duration said_ahead() const { return std::max(out_->driven_until(), now()) - now(); }
  // False when the duration has passed without the condition.
  bool run_until(const std::function<bool()>& condition, kernel::Duration at_most);

  // ---- cycles, as the application is told of them ----
  struct FinishedCycle {
    std::uint64_t count = 0;  // finished cycles of either kind
    std::uint64_t data_count = 0;
    std::uint64_t rejected_count = 0;
    bool is_data = false;  // the last one
    bool is_accepted = false;
    kernel::Time end{};
  };
  const FinishedCycle& finished() const { return finished_; }
  // Called after each finished cycle; the application of the case.
  void on_cycle(std::function<void()> hook) { on_cycle_ = std::move(hook); }
  void run_data_cycles(CaseJudge& judge, std::uint64_t count);
  // Any cycle that the master finishes next. False when it finishes none any more, or ID cycles and nothing
  // else.
  bool run_cycle();
  kernel::Duration longest_cycle() const;
  // At most so many cycles recognise the ring, whose stations are switched on one after another.
  std::int64_t cycles_of_recognition() const;
  // The one that the master reports, at least a bit and at most the longest that there can be: nobody waits
  // for a number that an implementation has made up.
  kernel::Duration cycle_time() const;
  // Until the ring has seen so many cycles, counted from 0, and the next one begins.
  void run_to_cycle(std::uint64_t number);

  // What the application and the line saw of one disturbed data cycle. Inputs are the words of the stations
  // that have any, in the order of the ring.
  struct Suffered {
    bool is_told_accepted = false;       // what the application was told
    std::vector<std::uint16_t> held;     // inputs before the cycle
    std::vector<std::uint16_t> offered;  // by the stations in the cycle: each other than what is held
    std::vector<std::uint16_t> seen;     // inputs right behind the cycle
    std::uint64_t id_cycles = 0;         // on the line, from there to the next accepted data cycle
  };
  // The next data cycle suffers the faults while the stations offer new inputs: those that the ring has now.
  // Then the master is given the time to finish a good data cycle again, which must bring them.
  Suffered suffer(CaseJudge& judge, interbus::CycleFaults faults);
  // Faults of every cycle from now on, until cleared with nothing.
  void set_script(interbus::RingEmulator::Script script) { script_ = std::move(script); }

  // A stress at the master's receiver, from now on.
  void begin_stress(const fault::Stress& stress) { begin_stress_at(stress, *back_, rules_.bit_rate, now()); }
  // What comes back to the master from now on is shown to the tap as well. For one ring.
  void tap_arrived(segment::Tap& tap) { back_->tap_arrived(tap); }
  // The same of what the master drives.
  void tap_driven(segment::Tap& tap) { out_->tap_driven(tap); }
  // Rings of earlier power-ups go on to show it what they carry.
  void keep(std::shared_ptr<segment::Tap> tap) { taps_.push_back(std::move(tap)); }

  interbus::MasterStatus status() const { return master_->status(); }
  bool is_in_run() const { return status().state == interbus::MasterState::run; }

  // Words of the image that stations with inputs have, and what the master shows there.
  std::vector<unsigned> input_words() const;
  std::vector<std::uint16_t> inputs() const;

 private:
  void on_cycle_end(kernel::Time now, bool data_cycle, bool accepted);
  void ask_script(const interbus::RingEmulator::CycleInfo& info, interbus::CycleFaults& faults);
  void run_to_accepted_data_cycle(CaseJudge& judge);
  void expect_inputs(CaseJudge& judge, const std::vector<std::uint16_t>& expected);

  // Masters and rings of earlier power-ups stay in the segment, with nothing to do.
  struct Place {
    std::unique_ptr<interbus::MasterDevice> master;
    std::unique_ptr<interbus::RingEmulator> ring;
  };

  MakeMaster make_master_;
  judge::Pics pics_;
  interbus::Rules rules_;
  interbus::MasterConfiguration configuration_;
  std::vector<Place> places_;
  std::vector<std::shared_ptr<segment::Tap>> taps_;
  interbus::MasterDevice* master_ = nullptr;
  interbus::RingEmulator* ring_ = nullptr;
  segment::Link* out_ = nullptr;
  segment::Link* back_ = nullptr;
  std::size_t master_seat_ = 0;
  trace::Channel master_place_ = 0;
  static constexpr std::size_t kMostIdCycles = 64;
  std::size_t id_cycles_in_a_row_ = 0;
  std::size_t bad_id_cycles_ = 0;      // of these
  std::size_t ordered_id_cycles_ = 0;  // since the last data cycle
  FinishedCycle finished_;
  std::function<void()> on_cycle_;
  interbus::RingEmulator::Script script_;
  std::optional<interbus::CycleFaults> armed_;
  std::optional<std::uint64_t> faulted_number_;  // of the data cycle that suffered them
};

// The ring of the cycle-time paper: a coupler, after its second interface 16 inputs and 16 outputs.
std::vector<interbus::VirtualStation> paper_ring();

}  // namespace fieldproof::conformance
