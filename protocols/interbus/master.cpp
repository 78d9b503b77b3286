#include "protocols/interbus/master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocols/interbus/network.hpp"

namespace fieldproof::interbus {

namespace {

// Status telegrams before the first ID cycle: long enough for every station to find the beginning of a
// telegram, and well inside of what a station waits for a sign of life.
constexpr kernel::Duration kReadyTime = 10 * kernel::kMillisecond;

}  // namespace

std::string_view name(MasterState state) {
  switch (state) {
    case MasterState::off:
      return "off";
    case MasterState::ready:
      return "ready";
    case MasterState::identification:
      return "identification";
    case MasterState::run:
      return "run";
    case MasterState::locating:
      return "locating";
    case MasterState::bus_stop:
      return "bus_stop";
  }
  return "";
}

Master::Master(const MasterConfiguration& configuration)
    : configuration_(configuration),
      writer_(configuration_.rules),
      check_(line::shared_frame_check_16(configuration_.rules.frame_check)),
      receiver_(writer_.code(), configuration_.rules.bit_rate),
      topology_(configuration_.rules, *this),
      supervision_(configuration_.rules) {}

std::optional<unsigned> Master::words_of(std::uint16_t id_code) const {
  return words_of_id_code(id_code, rules());
}

// ---- states ----

void Master::start(kernel::Time now) {
  if (state_ != MasterState::off && state_ != MasterState::bus_stop) return;
  supervision_ = CycleSupervision(rules());
  fault_location_.reset();
  configuration_error_.clear();
  is_stopping_ = is_id_cycle_needed_ = is_fault_open_ = id_cycle_requested_ = false;
  // What was driven before left the stations with interfaces that are switched on; silence resets them.
  const bool was_driving = driven_until_ > kernel::Time{kernel::Duration::min()};
  const kernel::Time from = was_driving ? std::max(now, driven_until_ + silence()) : now;
  if (!restarts_with_recognition() && !stations_.empty()) {
    enter_run();
    action_at_ = from;
    return;
  }
  enter_ready(from);
}

void Master::stop(kernel::Time) {
  if (state_ == MasterState::run) {
    is_stopping_ = true;
  } else {
    enter_off();
  }
}

kernel::Duration Master::silence() const {
  return rules().silence_limit + 2 * rules().silence_tolerance;
}

void Master::enter_off() {
  state_ = MasterState::off;
  is_stopping_ = is_collecting_ = false;
  action_at_ = verdict_at_ = recognise_at_ = kernel::kNever;
}

void Master::enter_ready(kernel::Time from) {
  state_ = MasterState::ready;
  stations_.clear();
  peripheral_faults_.clear();
  reconfigurations_.clear();
  set_images();
  action_at_ = from;
  recognise_at_ = from + kReadyTime;
}

void Master::enter_recognition() {
  if (state_ != MasterState::ready) state_ = MasterState::locating;
  topology_.restart();
  supervision_.clear_consecutive();
  ring_delay_ = {};
}

void Master::enter_run() {
  state_ = MasterState::run;
  recognise_at_ = kernel::Time{kernel::Duration::min()};
  supervision_.clear_consecutive();
  run_cycles_ = 0;
  data_telegrams_ = writer_.telegram_count(2 * inputs_.size());
  data_frame_ = writer_.frame_time(data_telegrams_);
  cycle_time_ = cycle_time_in_force(shortest_cycle_time());
  data_end_level_ = levels_within(cycle_time_);
  data_pause_.clear();
}

// Stays stopped, with status telegrams, until a start.
void Master::enter_bus_stop() {
  state_ = MasterState::bus_stop;
  recognise_at_ = kernel::kNever;
}

// The bus is given up: outputs 0, and silence until the stations are in reset; then the fault is looked for.
// Not by a master that is to stop: the data cycle with outputs 0 that it owes would find no bus any more.
void Master::abort_bus(kernel::Time now) {
  std::ranges::fill(outputs_, std::uint16_t{0});
  if (is_stopping_) return enter_off();
  enter_bus_stop();
  action_at_ = std::max(now, driven_until_) + silence();
  if (configuration_error_.empty() && searches_fault()) recognise_at_ = action_at_ + kReadyTime;
}

void Master::refuse(std::string sentence) {
  configuration_error_ = std::move(sentence);
}

void Master::finish_recognition() {
  if (!topology_.error().empty()) {
    refuse(topology_.error());
    return enter_bus_stop();
  }
  stations_ = topology_.stations();
  if (!configuration_.expected.empty()) {
    std::string difference = difference_to(configuration_.expected, stations_);
    if (!difference.empty()) {
      refuse(std::move(difference));
      return enter_bus_stop();
    }
  }
  set_images();
  enter_run();
}

void Master::finish_locating() {
  const auto& found = topology_.stations();
  const auto [configured, seen] = std::ranges::mismatch(
      stations_, found,
      [this](const FoundStation& known, const FoundStation& one) { return is_same_station(one, known); });
  if (configured != stations_.end()) {
    const auto index = static_cast<int>(configured - stations_.begin());
    fault_location_ = FaultLocation{configured->before, index};
  }
  enter_bus_stop();
}

std::string Master::difference_to(std::span<const FoundStation> expected,
                                  std::span<const FoundStation> found) const {
  if (expected.size() != found.size()) {
    return fmt::format("the ring has {} stations, the configuration {}", found.size(), expected.size());
  }
  for (std::size_t n = 0; n < expected.size(); ++n) {
    if (!is_same_id(found[n].id_code, expected[n].id_code)) {
      return fmt::format("station {} has the ID code {:04X}h, the configuration {:04X}h", n, found[n].id_code,
                         expected[n].id_code);
    }
    if (found[n].before != expected[n].before || found[n].on_branch != expected[n].on_branch) {
      return fmt::format("station {} hangs on another interface than in the configuration", n);
    }
  }
  return {};
}

void Master::set_images() {
  std::size_t words = 0;
  for (const FoundStation& station : stations_) words += station.words;
  inputs_.assign(words, 0);
  outputs_.assign(words, 0);
  sent_words_.assign(words, 0);
  returned_words_.assign(std::max(words, stations_.size() + 2), 0);
  acknowledged_.assign(stations_.size(), 0);
  input_order_ = shift_order();
  output_order_ = output_order();
}

// Station by station from the last to the first, the words of each in their order.
std::vector<unsigned> Master::shift_order() const {
  std::vector<unsigned> order;
  order.reserve(inputs_.size());
  auto end = static_cast<unsigned>(inputs_.size());
  for (auto station = stations_.rbegin(); station != stations_.rend(); ++station) {
    const unsigned first = end - station->words;
    for (unsigned word = first; word < end; ++word) order.push_back(word);
    end = first;
  }
  return order;
}

// ---- application ----

void Master::write_output(unsigned word, std::uint16_t value, kernel::Time) {
  if (word < outputs_.size() && state_ == MasterState::run) outputs_[word] = value;
}

MasterStatus Master::status() const {
  MasterStatus status;
  status.state = state_;
  status.stations = stations_;
  status.configuration_error = configuration_error_;
  status.data_cycles = supervision_.data_cycles();
  status.id_cycles = supervision_.id_cycles();
  status.rejected_cycles = supervision_.rejected_cycles();
  status.rejected_data_cycles = supervision_.rejected_data_cycles();
  status.consecutive_bad = supervision_.consecutive_bad();
  status.quality_bit = supervision_.quality_bit();
  status.has_fault_location = fault_location_.has_value();
  if (fault_location_) status.fault_location = *fault_location_;
  status.peripheral_faults = peripheral_faults_;
  status.reconfigurations = reconfigurations_;
  status.cycle_time = cycle_time_;
  return status;
}

}  // namespace fieldproof::interbus
