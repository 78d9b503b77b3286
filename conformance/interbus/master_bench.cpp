#include "conformance/interbus/master_bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "protocols/interbus/master_settings.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/observation.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::conformance {

using interbus::CycleFaults;
using interbus::MasterState;
using interbus::RingEmulator;
using interbus::VirtualStation;

std::vector<VirtualStation> paper_ring() {
  return {{0x0008, 0, -1, false}, {0x01BE, 1, 0, true}, {0x01BD, 1, 1, false}};
}

namespace {

// A master of telegrams drives each as a transmission of its own.
kernel::Duration shortest_telegram_with(const field::Settings& settings) {
  interbus::MasterConfiguration configuration;
  field::take_settings(interbus::kMasterTable, settings, configuration);
  return interbus::shortest_telegram(configuration.rules);
}

}  // namespace

MasterBench::MasterBench(const NoNeeds&, const MasterSetting& setting)
    : CaseBench(setting.seed, setting.volume, setting.stresses,
                LineWatch(shortest_telegram_with(setting.settings))),
      make_master_(setting.make_device),
      pics_(setting.pics.value_or(judge::Pics{})) {
  field::take_settings(interbus::kMasterTable, setting.settings, configuration_);
  rules_ = configuration_.rules;
  start_recording(setting, rules_);
}

MasterBench::~MasterBench() = default;

void MasterBench::power_up(std::vector<VirtualStation> ring, const std::function<void()>& tap) {
  if (master_ != nullptr) {
    stop();
    // What is still on its way arrives, and the last cycle ends; no station of the old ring is driven any
    // more.
    back_->set_connected(false);
    master_->on_cycle_end({});
    ring_->set_script({});
    run_for(std::max<kernel::Duration>(10 * kernel::kMillisecond, 2 * cycle_time()));
    master_->end();
  }
  configuration_.rules = rules_;
  places_.push_back({make_master_(configuration_), std::make_unique<RingEmulator>(rules_, std::move(ring))});
  master_ = places_.back().master.get();
  ring_ = places_.back().ring.get();
  const std::string number = places_.size() == 1 ? "" : fmt::format("#{}", places_.size());
  master_seat_ = segment().attach(*master_, "master" + number);
  master_place_ = segment().trace().add_channel("master" + number);
  const std::size_t ring_seat = segment().attach(*ring_, "ring" + number);
  segment::Link& out = segment().connect("ring/in" + number, ring_seat, 0, kernel::Duration{});
  watch(out);
  out_ = &out;
  master_->wire(out);
  back_ = &segment().connect("master/in" + number, master_seat_, 0, kernel::Duration{});
  ring_->wire(*back_);
  ring_->set_script(
      [this](const RingEmulator::CycleInfo& info, CycleFaults& faults) { ask_script(info, faults); });
  master_->on_cycle_end(
      [this](kernel::Time now, bool data, bool accepted) { on_cycle_end(now, data, accepted); });
  finished_ = {};
  armed_.reset();
  faulted_number_.reset();
  if (tap) tap();
  start();
}

void MasterBench::start() {
  master_->start(now());
  segment().refresh(master_seat_);
}

void MasterBench::stop() {
  master_->stop(now());
  segment().refresh(master_seat_);
}

void MasterBench::write_output(unsigned word, std::uint16_t value) {
  master_->write_output(word, value, now());
  segment().refresh(master_seat_);
}

void MasterBench::request_id_cycle() {
  ++ordered_id_cycles_;
  master_->request_id_cycle(now());
  segment().refresh(master_seat_);
}

void MasterBench::bring_up(CaseJudge& judge, std::vector<VirtualStation> ring) {
  power_up(std::move(ring));
  judge.expect(wait_for_run(), "not_in_run", [this] {
    return Mismatch{{"the master recognises the ring and runs"},
                    fmt::format("state {}, {} stations found, error \"{}\"", static_cast<int>(status().state),
                                status().stations.size(), status().configuration_error)};
  });
}

// A cycle with every octet that the ring can need, with time for all delays: before it runs, for those of the
// longest cable.
kernel::Duration MasterBench::longest_cycle() const {
  const auto octets =
      static_cast<std::int64_t>(16 + 2 * std::max(ring_->stations().size() + 1, ring_->word_count()));
  const std::int64_t telegram = std::max<std::int64_t>(18, 15 + rules_.telegram_gap_millibits / 1'000);
  const kernel::Duration cables{2 * std::int64_t{rules_.max_cable_m} * rules_.cable_delay_ps_per_m};
  const auto stations = static_cast<std::int64_t>(ring_->stations().size());
  // The master may take it for longer than it is.
  const std::int64_t delay =
      (std::int64_t{rules_.forward_delay_half_bits} + rules_.return_delay_half_bits) / 2 * (stations + 2);
  return kernel::levels_duration((octets + rules_.end_telegrams) * telegram, rules_.bit_rate) +
         rules_.software_time +
         kernel::levels_duration(
             std::max(stations * 3,
                      rules_.forward_delay_half_bits > 3 || rules_.return_delay_half_bits > 3 ? delay : 0),
             rules_.bit_rate) +
         std::max<kernel::Duration>(kernel::kMillisecond, cables) + configuration_.cycle_time;
}

kernel::Duration MasterBench::cycle_time() const {
  return std::clamp(status().cycle_time, kernel::levels_duration(1, rules_.bit_rate), longest_cycle());
}

std::int64_t MasterBench::cycles_of_recognition() const {
  return static_cast<std::int64_t>(8 + 5 * ring_->stations().size());
}

bool MasterBench::wait_for_run() {
  bool is_running = false;
  const auto is_over = [&] {
    const MasterState state = status().state;
    is_running = state == MasterState::run && finished_.data_count > 0;
    return is_running || state == MasterState::bus_stop;
  };
  // Each cycle begins after what was said ahead before.
  if (!run_until(is_over, 200 * kernel::kMillisecond + cycles_of_recognition() * longest_cycle()))
    run_until(is_over, cycles_of_recognition() * said_ahead());
  return is_running;
}

bool MasterBench::run_until(const std::function<bool()>& condition, kernel::Duration at_most) {
  const kernel::Time end = now() + at_most;
  // The condition can only change with a finished cycle or with the state of a waiting master; both are
  // looked at once a step of the scheduler would be too dear for what they cost.
  std::uint64_t seen = finished_.count;
  kernel::Time look = now();
  while (true) {
    if (finished_.count != seen || now() >= look) {
      if (condition()) return true;
      seen = finished_.count;
      look = now() + 5 * kernel::kMillisecond;
    }
    if (segment().scheduler().next() > end) break;
    segment().step();
  }
  segment().run_until(end);
  return condition();
}

void MasterBench::on_cycle_end(kernel::Time now, bool data_cycle, bool accepted) {
  segment().trace().observe(master_place_, now, interbus::observed_cycle_end(data_cycle, accepted));
  ++finished_.count;
  if (data_cycle) ++finished_.data_count;
  if (!accepted) ++finished_.rejected_count;
  finished_.is_data = data_cycle;
  finished_.is_accepted = accepted;
  finished_.end = now;
  if (on_cycle_) on_cycle_();
}

bool MasterBench::run_cycle() {
  const std::uint64_t before = finished_.count;
  const kernel::Time end = now() + said_ahead() + 2 * longest_cycle();
  while (finished_.count == before) {
    if (segment().scheduler().next() > end) return false;
    segment().step();
  }
  id_cycles_in_a_row_ = finished_.is_data ? 0 : id_cycles_in_a_row_ + 1;
  if (finished_.is_data) bad_id_cycles_ = 0;
  if (!finished_.is_data && !finished_.is_accepted) ++bad_id_cycles_;
  if (finished_.is_data) ordered_id_cycles_ = 0;
  // ID cycles that come back bad go on until they stop the bus.
  const std::size_t owed = std::min<std::size_t>(bad_id_cycles_, rules_.stop_after_bad_cycles);
  return id_cycles_in_a_row_ <= kMostIdCycles + owed + 8 * ring_->stations().size() + ordered_id_cycles_;
}

void MasterBench::run_to_cycle(std::uint64_t number) {
  const kernel::Time end = now() + said_ahead() + 2 * longest_cycle();
  while (ring_->cycle_count() <= number && segment().scheduler().next() <= end) segment().step();
}

void MasterBench::run_data_cycles(CaseJudge& judge, std::uint64_t count) {
  const std::uint64_t until = finished_.data_count + count;
  while (finished_.data_count < until) {
    judge.expect(run_cycle(), "no_data_cycle", "the master goes on with data cycles",
                 "no cycle ends any more");
    judge.expect(finished_.is_data || is_in_run(), "no_data_cycle", "the master goes on with data cycles",
                 "it has left the state run");
  }
}

void MasterBench::ask_script(const RingEmulator::CycleInfo& info, CycleFaults& faults) {
  if (armed_ && !info.is_id_cycle) {
    faults = *std::exchange(armed_, std::nullopt);
    faulted_number_ = info.number;
    return;
  }
  if (script_) script_(info, faults);
}

std::vector<unsigned> MasterBench::input_words() const {
  std::vector<unsigned> words;
  unsigned first = 0;
  for (const VirtualStation& station : ring_->stations()) {
    for (unsigned word = 0; word < station.words && interbus::has_inputs(station.id_code); ++word) {
      words.push_back(first + word);
    }
    first += station.words;
  }
  return words;
}

// At least one cycle; the last one is a data cycle that the application is told to be good.
void MasterBench::run_to_accepted_data_cycle(CaseJudge& judge) {
  for (int n = 0; n < 8; ++n) {
    judge.expect(run_cycle(), "no_data_cycle", "the master goes on with cycles", "no cycle ends any more");
    if (finished_.is_data && finished_.is_accepted) return;
  }
  judge.fail("no_data_cycle", {{"an accepted data cycle within 8 cycles"}, "none"});
}

void MasterBench::expect_inputs(CaseJudge& judge, const std::vector<std::uint16_t>& expected) {
  const std::vector<std::uint16_t> seen = inputs();
  judge.expect(seen == expected, "new_inputs_missed", [&] {
    return Mismatch{{fmt::format("the inputs of the last good cycle, {:04X}h", fmt::join(expected, "h "))},
                    fmt::format("{:04X}h", fmt::join(seen, "h "))};
  });
}

std::vector<std::uint16_t> MasterBench::inputs() const {
  std::vector<std::uint16_t> values;
  for (const unsigned word : input_words()) values.push_back(master_->input(word));
  return values;
}

MasterBench::Suffered MasterBench::suffer(CaseJudge& judge, CycleFaults faults) {
  const std::vector<unsigned> words = input_words();
  const auto offer = [&](const std::vector<std::uint16_t>& values) {
    for (std::size_t n = 0; n < words.size(); ++n) ring_->set_input(words[n], values[n]);
  };
  Suffered suffered;
  for (const unsigned word : words) {
    suffered.offered.push_back(ring_->input(word));
    // A change of one bit is enough to be told from the other, and nothing that a master could find
    // implausible.
    suffered.held.push_back(static_cast<std::uint16_t>(ring_->input(word) ^ 1U));
  }
  offer(suffered.held);
  // The first of them may have been under way.
  for (int n = 0; n < 2; ++n) run_to_accepted_data_cycle(judge);
  expect_inputs(judge, suffered.held);
  offer(suffered.offered);
  armed_ = std::move(faults);
  faulted_number_.reset();
  for (int n = 0; n < 8 && !faulted_number_; ++n) {
    judge.expect(run_cycle(), "no_data_cycle", "the master goes on with cycles", "no cycle ends any more");
  }
  judge.expect(faulted_number_.has_value(), "no_data_cycle", "a data cycle within 8 cycles", "none");
  suffered.is_told_accepted = finished_.is_accepted;
  suffered.seen = inputs();
  const std::uint64_t id_cycles = ring_->statistics().id_cycles;
  run_to_accepted_data_cycle(judge);
  suffered.id_cycles = ring_->statistics().id_cycles - id_cycles;
  expect_inputs(judge, suffered.offered);
  return suffered;
}

}  // namespace fieldproof::conformance
