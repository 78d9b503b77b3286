#include "conformance/interbus/master_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocols/interbus/network.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::CycleFaults;
using interbus::MasterState;
using interbus::MasterStatus;
using interbus::SeenCycle;
using interbus::VirtualStation;

constexpr int kMostIdles = 20;

std::vector<interbus::FoundStation> found(const std::vector<VirtualStation>& ring) {
  std::vector<interbus::FoundStation> stations;
  for (const VirtualStation& one : ring)
    stations.push_back({one.id_code, one.words, one.before, one.on_branch});
  return stations;
}

// Of the words of a large register no two are alike, and the first ones are those of the command.
std::uint16_t in_turn(unsigned word, std::uint16_t even, std::uint16_t odd) {
  const unsigned pair = word / 2;
  return static_cast<std::uint16_t>((word % 2 == 0 ? even : odd) ^ (pair * 0x0101U));
}

CycleFaults changed_answer() {
  CycleFaults faults;
  faults.flips = {{0, 0x01, false}};
  return faults;
}

}  // namespace

MasterSide::MasterSide(MasterBench& bench, CaseJudge* judge) : bench_(bench), judge_(judge) {}
MasterSide::~MasterSide() {
  bench_.set_script({});
}

void MasterSide::clear_observations() {
  for (Observations* all : {&cycles_, &inputs_, &reports_, &states_}) all->clear();
}

void MasterSide::expect(bool holds, std::string_view reason, std::string_view expected,
                        std::string_view actual) const {
  if (judge_ != nullptr) judge_->expect(holds, reason, expected, actual);
}

// ---- power, start and stop ----

void MasterSide::power(const MasterScene& scene) {
  interbus::MasterConfiguration& configuration = bench_.configuration();
  configuration.expected = found(scene.expected);
  configuration.cycle_time = scene.cycle_time;
  unsigned words = 0;
  for (const VirtualStation& one : scene.ring) words += one.words;
  configuration.copy.clear();
  if (scene.copies == Copies::beyond) configuration.copy = {{words, 0}, {0, words}};
  const bool copies_ends = scene.copies == Copies::ends;
  const bool copies_all = scene.copies == Copies::all;
  for (unsigned word = 0; word < words; ++word) {
    const bool is_end = word == 0 || word + 1 == words;
    if (copies_all || (copies_ends && is_end)) configuration.copy.push_back({word, words - 1 - word});
  }
  if (!bench_.may_answer("request_below_minimum", "clipped")) configuration.cycle_time = {};
  const interbus::Rules usual = bench_.rules();
  limit_ring(scene);
  states_seen_ = 0;
  is_before_data_ = false;
  disturbed_ = scene.disturbed;
  is_stopped_ = false;
  is_ring_right_ = true;
  is_ring_known_ = false;
  armed_.reset();
  returned_ = std::make_shared<ReturnedLine>(bench_.rules());
  bench_.set_script([this](const interbus::RingEmulator::CycleInfo& info, CycleFaults& faults) {
    on_ring_cycle(info.is_id_cycle, faults);
  });
  driven_ = std::make_shared<DrivenTelegrams>(bench_.rules());
  bench_.keep(returned_);
  bench_.keep(driven_);
  kernel::Time powered{};
  // Its first cycle may be driven within the order to start.
  bench_.power_up(scene.ring, [&] {
    powered = bench_.now();
    bench_.tap_arrived(*returned_);
    bench_.tap_driven(*driven_);
  });
  bench_.rules() = usual;
  await_run();
  // A bus stop has a silence of its own.
  if (is_idle()) {
    bench_.ring().forget_statistics();
  } else {
    judge_silence();
  }
  expect(driven_->first() - powered <= bench_.rules().silence_limit, "silence_before_the_first_start",
         "no silence before the first start", kernel::describe(driven_->first() - powered));
}

void MasterSide::limit_ring(const MasterScene& scene) {
  interbus::Rules& rules = bench_.rules();
  unsigned words = 0;
  unsigned deepest = 1;
  std::vector<unsigned> levels;
  for (const VirtualStation& one : scene.ring) {
    words += one.words;
    const unsigned before = one.before < 0 ? 1 : levels.at(static_cast<std::size_t>(one.before));
    levels.push_back(before + (one.on_branch ? 1 : 0));
    deepest = std::max(deepest, levels.back());
  }
  const auto stations = static_cast<unsigned>(scene.ring.size());
  constexpr unsigned kPoints = 16;
  if (scene.limits == Limits::stations_met) rules.max_stations = stations;
  if (scene.limits == Limits::stations_exceeded) rules.max_stations = std::max(1U, stations - 1);
  if (scene.limits == Limits::points_met) rules.max_io_points = kPoints * words;
  if (scene.limits == Limits::points_exceeded) rules.max_io_points = kPoints * words - 1;
  if (scene.limits == Limits::levels_met) rules.max_levels = deepest;
  if (scene.limits == Limits::levels_exceeded) rules.max_levels = std::max(1U, deepest - 1);
}

void MasterSide::on_ring_cycle(bool is_id_cycle, CycleFaults& faults) {
  returned_->begin();
  states_seen_ |= std::uint64_t{1} << static_cast<unsigned>(bench_.status().state);
  if (!is_id_cycle && std::exchange(is_before_data_, false)) has_kept_inputs_ = bench_.inputs() == at_start_;
  if (disturbed_ > 0) {
    --disturbed_;
    faults = changed_answer();
  } else if (armed_) {
    faults = *std::exchange(armed_, std::nullopt);
  }
}

bool MasterSide::is_idle() const {
  const MasterState state = bench_.status().state;
  return state == MasterState::off || state == MasterState::bus_stop;
}

void MasterSide::start(unsigned disturbed) {
  if (!is_idle()) return;
  disturbed_ = disturbed;
  is_stopped_ = false;
  is_ring_right_ = true;
  const std::uint64_t before = bench_.ring().cycle_count();
  driven_->forget_silence();
  bench_.start();
  at_start_ = bench_.inputs();
  has_kept_inputs_ = true;
  is_before_data_ = is_ring_known_;
  await_run();
  expect(has_kept_inputs_, "inputs_not_held", "the end of the recognition of the same ring clears no input",
         "inputs have changed");
  if (bench_.ring().has_cycle(before)) judge_break();
  // Before the first cycle it was silent, as it must.
  bench_.ring().forget_statistics();
  if (!bench_.ring().has_cycle(before)) return;
  expect(bench_.ring().cycle(before).is_id_cycle, "restart_without_id_cycle", "an ID cycle first",
         "a data cycle first");
}

void MasterSide::await_run() {
  bench_.run_until([this] { return !is_idle(); }, 10 * kernel::kMillisecond);
  if (bench_.wait_for_run()) return enter_run();
  if (is_idle()) settle();
  note_state(false);
}

// What the recognition leaves is not compared: the application asks for an ID cycle, writes all
// outputs, and looks when both have been on the line.
void MasterSide::enter_run() {
  has_rejected_ = false;
  disturbed_ = 0;
  write_all(0, 0);
  bench_.request_id_cycle();
  bool has_identified = false;
  unsigned good = 0;
  for (int n = 0; n < 8 && (!has_identified || good < 2); ++n) {
    if (!bench_.run_cycle()) break;
    if (!bench_.finished().is_data) {
      // A ring may ask for ID cycles between them.
      if (!has_identified) good = 0;
      has_identified = true;
    } else if (bench_.finished().is_accepted) {
      ++good;
    }
  }
  expect(has_identified && good == 2, "does_not_work_again",
         "an ID cycle that was asked for and two good data cycles after it within 8 cycles",
         has_identified ? "no good data cycles" : "no ID cycle");
  held_ = bench_.inputs();
  note_end();
  is_next_ = false;
  is_ring_known_ = true;
  rejected_data_ = 0;
  at_entry_ = bench_.status();
  ended_at_entry_ = bench_.finished();
  note_state(false);
}

void MasterSide::stop(bool is_disturbed) {
  if (is_stopped_) return;
  const bool was_running = is_running();
  is_stopped_ = true;
  const std::uint64_t before = bench_.ring().cycle_count();
  const std::uint64_t under_way = has_begun() ? 1 : 0;
  if (is_disturbed && was_running) armed_ = changed_answer();
  bench_.stop();
  if (is_disturbed && was_running) bench_.write_output(0, 0xFFFF);
  bench_.run_until([this] { return bench_.status().state == MasterState::off; },
                   kernel::kSecond + 2 * bench_.longest_cycle());
  bench_.run_for(kernel::kMillisecond);
  armed_.reset();
  if (was_running && is_ring_right_) judge_stop(before, under_way);
  const std::uint64_t cycles = bench_.ring().cycle_count();
  bench_.run_for(kIdle);
  expect(bench_.ring().cycle_count() == cycles, "not_silent", "no cycle when it is stopped", "cycles");
  if (was_running) judge_counters();
  note_state(false);
}

// Until it has nothing more to do with a bus that it has given up.
void MasterSide::settle() {
  const kernel::Time latest = bench_.now() + longest_recognition();
  for (int n = 0; n < kMostIdles || bench_.now() < latest; ++n) {
    const std::uint64_t before = bench_.ring().cycle_count();
    bench_.run_for(idle());
    if (bench_.ring().cycle_count() == before && is_idle()) return;
  }
}

// When after the silence a master looks for the fault is its choice: it is awaited, or that is not even over.
kernel::Duration MasterSide::idle() const {
  const interbus::Rules& rules = bench_.rules();
  constexpr kernel::Duration kUntilFirstCycle = 20 * kernel::kMillisecond;
  if (kIdle < rules.silence_limit + rules.silence_tolerance) return kIdle;
  return std::max(
      kIdle, rules.silence_limit + 2 * rules.silence_tolerance + kUntilFirstCycle + bench_.longest_cycle());
}

void MasterSide::wait(kernel::Duration duration) {
  if (is_running()) return;
  const std::uint64_t before = bench_.ring().cycle_count();
  bench_.run_for(duration);
  if (!is_stopped_) return;
  expect(bench_.ring().cycle_count() == before, "not_silent", "no cycle when it is stopped", "cycles");
}

// ---- application and stations ----

void MasterSide::write(unsigned word, std::uint16_t value) {
  if (!is_ring_right_ || word >= bench_.ring().word_count()) return;
  // Without effect there.
  if (!is_running()) return is_ring_known_ && is_idle() ? bench_.write_output(word, value) : void();
  unsigned first = 0;
  for (const VirtualStation& station : bench_.ring().stations()) {
    const bool is_of_station = word < first + station.words;
    first += station.words;
    if (!is_of_station) continue;
    if (interbus::has_outputs(station.id_code)) bench_.write_output(word, value);
    return;
  }
}

void MasterSide::write_all(std::uint16_t even, std::uint16_t odd) {
  for (unsigned word = 0; word < bench_.ring().word_count(); ++word) write(word, in_turn(word, even, odd));
}

void MasterSide::request_id_cycle() {
  if (is_running()) bench_.request_id_cycle();
}

void MasterSide::offer(std::uint16_t even, std::uint16_t odd) {
  for (unsigned word = 0; word < bench_.ring().word_count(); ++word)
    bench_.ring().set_input(word, in_turn(word, even, odd));
}

void MasterSide::set_messages(std::size_t station, std::uint16_t bits) {
  bench_.ring().set_messages(station % bench_.ring().stations().size(), bits);
}

void MasterSide::cut_before(std::size_t station) {
  // Whether a cut after the stations that are known is seen depends on the interfaces that stay on.
  if (!is_running() || !is_ring_right_) return;
  const auto& stations = bench_.ring().stations();
  bench_.ring().cut_after(stations[station % stations.size()].before);
  is_ring_right_ = false;
  for (unsigned n = 0; n < 2 * bench_.rules().stop_after_bad_cycles && is_running(); ++n) cycle();
  if (!is_running())
    bench_.run_until([this] { return bench_.status().has_fault_location; }, longest_recognition());
  judge_counters();
  note_state(true);
  bench_.ring().mend();
}

void MasterSide::replace_ring(std::vector<VirtualStation> ring) {
  const std::size_t before = bench_.ring().stations().size();
  const bool is_as_long = ring.size() == before;
  // How much later than measured an answer may come is the master's choice.
  const interbus::Rules& rules = bench_.rules();
  if (ring.size() > before &&
      rules.forward_delay_half_bits + rules.return_delay_half_bits > line::kDataTelegramLevels)
    return;
  bench_.ring().replace_ring(std::move(ring));
  is_ring_right_ = is_ring_known_ = false;
  if (is_as_long) return;
  // A disturbed ID cycle may, or may not, switch the interface off after which the new station is.
  constexpr int kUntilSeen = 4;
  for (int n = 0; n < kUntilSeen && is_running(); ++n) cycle();
}

// ---- cycles ----

bool MasterSide::has_begun() const {
  return is_running() && driven_->cycle_start() > ended_start_;
}

void MasterSide::await_begin() {
  if (is_running()) bench_.run_to_cycle(ended_cycles_);
}

void MasterSide::finish_begun() {
  if (is_running() && bench_.ring().has_cycle(ended_cycles_)) end_cycle();
}

void MasterSide::note_end() {
  ended_cycles_ = bench_.ring().cycle_count();
  if (ended_cycles_ > 0) ended_start_ = bench_.ring().last_cycle().start;
}

// One telegram too many is certain to count within a telegram, and where the pause has room for it.
CycleFaults MasterSide::certain(CycleFaults faults) const {
  const interbus::Rules& rules = bench_.rules();
  constexpr std::int64_t kTelegram = line::kDataTelegramLevels;
  const std::int64_t first_status = rules.telegram_gap_millibits / 1'000 + 1 + rules.status_pitch_bits;
  if (first_status > kTelegram) faults.status_flag_flipped = false;
  if (rules.software_time < kernel::levels_duration(3 * kTelegram, rules.bit_rate))
    faults.trailing_telegram = false;
  return faults;
}

void MasterSide::cycle(const CycleFaults& faults) {
  finish_begun();
  if (!is_running()) return;
  armed_ = certain(faults);
  end_cycle();
}

void MasterSide::end_cycle() {
  const std::uint64_t before = bench_.ring().cycle_count();
  driven_->forget_silence();
  if (!run_cycle()) return;
  if (is_running()) return;
  armed_.reset();
  settle();
  if (bench_.ring().cycle_count() > before + 1) judge_break();
  judge_counters();
  note_state(false);
}

bool MasterSide::run_cycle() {
  const bool must_identify = has_rejected_;
  const bool has_ended = bench_.run_cycle();
  expect(has_ended, "no_data_cycle", "the master goes on with cycles", "no cycle ends any more");
  if (!has_ended) return false;
  note_end();
  expect(!must_identify || !bench_.finished().is_data, "no_id_cycle_after_error",
         "an ID cycle after a rejected cycle", "a data cycle");
  has_rejected_ = !bench_.finished().is_accepted;
  if (has_rejected_ && bench_.finished().is_data) ++rejected_data_;
  judge_cycle(bench_.ring().last_cycle());
  judge_line();
  note_cycle();
  judge_counters();
  return true;
}

// How many cycle times lie between the starts of two cycles; -1: not a whole number of them.
std::int64_t MasterSide::cycle_times() {
  const kernel::Duration cycle_time = bench_.cycle_time();
  const kernel::Time start = bench_.ring().last_cycle().start;
  const kernel::Duration span = start - std::exchange(cycle_start_, start);
  if (!std::exchange(is_next_, true)) return 0;
  const std::int64_t count = (span + cycle_time / 2) / cycle_time;
  const kernel::Duration beside = span - count * cycle_time;
  const kernel::Duration bit = kernel::levels_duration(1, bench_.rules().bit_rate);
  return -bit <= beside && beside <= bit ? count : -1;
}

}  // namespace fieldproof::conformance
