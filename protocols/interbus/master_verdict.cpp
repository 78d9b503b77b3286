// What the master makes of a cycle that has come back, or has not.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/interbus/master.hpp"

namespace fieldproof::interbus {

// ---- decisions ----

bool Master::accepts_loopback(const ReturnedCycle& returned, std::size_t octet) const {
  return returned.word(octet) == rules().loopback_word;
}

bool Master::accepts_check(const ReturnedCycle& returned) const {
  return Master::check_of(returned.transfer(), {}) == returned.check();
}

FaultLocation Master::locate(int first_marked) const {
  if (first_marked >= 0) return {first_marked - 1, first_marked};
  // No station saw it: it lies after the last one.
  return {static_cast<int>(stations_.size()) - 1, -1};
}

void Master::run_copy_task() {
  for (const auto& [from, to] : configuration_.copy) {
    if (from < inputs_.size() && to < outputs_.size()) outputs_[to] = inputs_[from];
  }
}

// ---- verdicts ----

void Master::finish_cycle(kernel::Time now) {
  verdict_at_ = kernel::kNever;
  is_collecting_ = false;
  returned_.finish();
  if (is_id_cycle_) {
    finish_id_cycle(now);
  } else {
    finish_data_cycle(now);
  }
}

// Everything but the loopback word.
bool Master::accepts_trailer() const {
  return accepts_count(returned_) && accepts_framing(returned_) && accepts_phases(returned_) &&
         accepts_status(returned_.status()) && accepts_check(returned_);
}

void Master::read_inputs() {
  std::size_t octet = 0;
  for (const unsigned word : input_order_) {
    returned_words_[word] = returned_.word(octet);
    octet += 2;
  }
}

void Master::finish_data_cycle(kernel::Time now) {
  const std::size_t words = inputs_.size();
  read_inputs();
  const std::span<const std::uint16_t> brought(returned_words_.data(), words);
  const bool is_silent = returned_.count() == 0;
  const bool accepted =
      is_silent ? accepts_silence()
                : accepts_loopback(returned_, 2 * words) && accepts_trailer() && accepts_inputs(brought);
  supervision_.count_data_cycle(accepted);
  if (is_stopping_ && ends_stop(accepted)) {
    enter_off();
  } else if (accepted) {
    if (!is_silent) std::ranges::copy(brought, inputs_.begin());
    if (clears_consecutive()) supervision_.clear_consecutive();
    run_copy_task();
  } else {
    on_rejected_inputs(brought);
    on_rejected(true, now);
  }
  if (hook_) hook_(now, true, accepted);
}

void Master::on_rejected(bool data_cycle, kernel::Time now) {
  is_fault_open_ = true;
  if (needs_id_cycle_after_error()) is_id_cycle_needed_ = true;
  if (counts_as_consecutive(data_cycle)) supervision_.count_consecutive();
  if (reaches_stop(supervision_.consecutive_bad())) abort_bus(now);
}

void Master::finish_id_cycle(kernel::Time now) {
  const bool accepted = judge_id_cycle(now);
  if (hook_) hook_(now, false, accepted);
}

bool Master::judge_id_cycle(kernel::Time now) {
  const auto position = accepts_trailer() ? loopback_position() : std::nullopt;
  const bool in_run = state_ == MasterState::run;
  supervision_.count_id_cycle(position.has_value());
  if (!position) {
    if (in_run) {
      on_rejected(false, now);
    } else {
      on_recognition_rejected();
    }
    return false;
  }
  const auto ids = read_ids(*position);
  if (in_run) {
    on_run_ids(ids, now);
  } else {
    ring_delay_ = first_returned_ - cycle_start_;
    on_recognition_ids(ids);
  }
  return true;
}

// How many ID words came back in front of the loopback word. As many as stations are known, or one more, is
// what is expected; any other number shows another ring.
std::optional<std::size_t> Master::loopback_position() const {
  const std::size_t known = state_ == MasterState::run ? stations_.size() : topology_.stations().size();
  const std::size_t words = returned_.transfer().size() / 2;
  for (const std::size_t likely : {known, known + 1}) {
    if (returned_.word(2 * likely) == rules().loopback_word) return likely;
  }
  for (std::size_t n = 0; n < words; ++n) {
    if (returned_.word(2 * n) == rules().loopback_word) return n;
  }
  return std::nullopt;
}

// In the order of the ring: the last station's word came first.
std::span<const std::uint16_t> Master::read_ids(std::size_t count) {
  if (returned_words_.size() < count) returned_words_.resize(count);
  for (std::size_t n = 0; n < count; ++n) returned_words_[count - 1 - n] = returned_.word(2 * n);
  return {returned_words_.data(), count};
}

void Master::on_run_ids(std::span<const std::uint16_t> ids, kernel::Time now) {
  is_id_cycle_needed_ = false;
  std::size_t same = 0;
  while (same < std::min(ids.size(), stations_.size()) &&
         is_same_id(ids[same] & Topology::kCodeMask, stations_[same].id_code)) {
    ++same;
  }
  if (same == ids.size() && same == stations_.size()) return read_messages(ids);
  if (!refuses_changed_ring()) return;
  if (ids.size() != stations_.size()) {
    refuse(fmt::format("the ring has {} stations, the configuration {}", ids.size(), stations_.size()));
  } else {
    refuse(fmt::format("station {} has the ID code {:04X}h, the configuration {:04X}h", same,
                       ids[same] & Topology::kCodeMask, stations_[same].id_code));
  }
  const int before = same < stations_.size() ? stations_[same].before : static_cast<int>(same) - 1;
  fault_location_ = FaultLocation{before, static_cast<int>(same)};
  abort_bus(now);
}

void Master::report_messages(std::span<const std::uint16_t> ids) {
  peripheral_faults_.clear();
  reconfigurations_.clear();
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const auto index = static_cast<int>(n);
    if ((ids[n] & rules().message_peripheral_fault) != 0 && reports_peripheral_fault()) {
      peripheral_faults_.push_back(index);
    }
    if ((ids[n] & rules().message_reconfiguration) != 0 && reports_reconfiguration()) {
      reconfigurations_.push_back(index);
    }
  }
}

void Master::read_messages(std::span<const std::uint16_t> ids) {
  report_messages(ids);
  int first_marked = -1;
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const std::uint16_t messages = ids[n] & static_cast<std::uint16_t>(~Topology::kCodeMask);
    acknowledged_[n] = messages != 0 ? rules().control_acknowledge : std::uint16_t{0};
    if ((messages & rules().message_check_error) != 0 && first_marked < 0) first_marked = static_cast<int>(n);
  }
  if (is_fault_open_) fault_location_ = locate(first_marked);
  is_fault_open_ = false;
}

// ---- recognition ----

void Master::on_recognition_ids(std::span<const std::uint16_t> ids) {
  if (clears_consecutive()) supervision_.clear_consecutive();
  if (ids.empty() && topology_.stations().empty()) {
    // The line is closed, but there is no station on it.
    if (state_ == MasterState::locating) return on_fault_found(-1);
    return enter_ready(action_at_);
  }
  if (state_ == MasterState::ready) state_ = MasterState::identification;
  topology_.on_ids(ids);
  if (!topology_.is_finished()) return;
  if (state_ == MasterState::locating) {
    finish_locating();
  } else {
    report_messages(ids);
    finish_recognition();
  }
}

void Master::on_recognition_rejected() {
  const bool is_alone = topology_.stations().empty();
  const bool is_locating = state_ == MasterState::locating;
  if (is_alone && !is_locating) return enter_ready(action_at_);
  if (is_alone && returned_.count() == 0) return on_fault_found(-1);
  supervision_.count_consecutive();
  if (!reaches_stop(supervision_.consecutive_bad())) return;
  on_fault_found(topology_.probed_station());
}

// Nothing good comes back since an interface of this station was switched on (-1: since the beginning).
void Master::on_fault_found(int station) {
  fault_location_ = FaultLocation{station, static_cast<int>(topology_.stations().size())};
  enter_bus_stop();
}

}  // namespace fieldproof::interbus
