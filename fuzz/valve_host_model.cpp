#include "fuzz/valve_host_model.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::fuzz {
namespace {

using kernel::Duration;
using kernel::Time;
using valve_bus::Command;
using valve_bus::HostErrorKind;
using valve_bus::HostResponse;

constexpr std::uint8_t kWriteCommand = 0;
constexpr std::uint8_t kReadCommand = 1;
constexpr unsigned kAttempts = 3;
// Positions on the line are rounded to picoseconds, each for itself.
constexpr Duration kRoundedPosition = kernel::kNanosecond;

}  // namespace

ValveHostModel::ValveHostModel(const valve_bus::Rules& rules)
    : rules_(rules), receiver_(character_format(rules), rules.bit_rate), request_receiver_(receiver_) {}

void ValveHostModel::set_power(bool is_on) {
  is_on_ = is_on;
  frame_ = {};
  heard_until_ = Time{Duration::min()};
  orders_.clear();
  parts_ = 0;
  read_.reset();
  known_.fill(std::nullopt);
  written_.fill(std::nullopt);
  owed_old_.reset();
  in_window_.clear();
}

// ---- what arrives ----

void ValveHostModel::run_until(Time now) {
  if (frame_.octets.empty()) return;
  if (frame_.busy_until + delimiter(rules_) + character_notice(rules_) <= now) end_frame();
}

void ValveHostModel::on_wave(const line::Waveform& wave) {
  // What is known at the very end of it is known behind it.
  run_until(wave.end() - Duration{1});
  if (!is_on_) return;
  std::vector<line::CharacterReceiver::Received> received;
  receiver_.receive(wave, received);
  for (const auto& one : received) {
    // While it drives it does not listen.
    if (one.start >= driving_until_) on_heard(one);
  }
}

void ValveHostModel::on_heard(const line::CharacterReceiver::Received& one) {
  if (!frame_.octets.empty()) {
    const Duration silence = one.start - frame_.busy_until;
    if (silence >= delimiter(rules_)) {
      end_frame();
    } else if (silence > longest_gap(rules_)) {
      frame_.is_good = false;
    }
  }
  if (frame_.octets.empty()) frame_.start = one.start;
  frame_.octets.push_back(static_cast<std::uint8_t>(one.character.data));
  if (!one.character.is_good()) frame_.is_good = false;
  frame_.busy_until = one.busy_until;
  heard_until_ = one.busy_until;
  // The host knows that it is over a delimiter and a character later.
  const Duration talk = frame_.busy_until - frame_.start + delimiter(rules_) + character_notice(rules_);
  if (talk >= response_time_out(rules_)) was_busy_ = true;
}

void ValveHostModel::end_frame() {
  if (read_ && frame_.start <= read_->sent + response_time_out(rules_)) in_window_.push_back(frame_);
  frame_ = {};
}

// ---- what it sends ----

void ValveHostModel::on_driven(const line::Waveform& wave) {
  FIELDPROOF_CHECK(is_on_, "a host without supply does not drive");
  if (request_.empty()) run_until(wave.start);
  std::vector<line::CharacterReceiver::Received> received;
  request_receiver_.receive(wave, received);
  FIELDPROOF_CHECK(received.size() == 1, "a host drives a character at a time");
  FIELDPROOF_CHECK(received.front().character.is_good(), "a host sends good characters");
  request_.push_back(received.front());
  driving_until_ = wave.end();
  if (request_.size() < 5) return;
  std::array<std::uint8_t, 5> octets{};
  for (std::size_t n = 0; n < octets.size(); ++n) {
    octets.at(n) = static_cast<std::uint8_t>(request_[n].character.data);
  }
  FIELDPROOF_CHECK((octets[0] ^ octets[1] ^ octets[2] ^ octets[3]) == octets[4],
                   "the check of a request fits");
  const Time start = request_.front().start;
  const Time end = request_.back().busy_until;
  request_.clear();
  on_request({octets[0], octets[1], octets[2], octets[3]}, start, end);
}

void ValveHostModel::on_request(const Command& command, Time start, Time end) {
  ++requests_;
  FIELDPROOF_CHECK(!owed_old_, "what was known is told with the error");
  FIELDPROOF_CHECK(
      heard_until_ == Time{Duration::min()} || start - heard_until_ >= delimiter(rules_) - kRoundedPosition,
      "a host leaves the line silent for a delimiter");
  if (read_) {
    FIELDPROOF_CHECK(command == read_->command, "a read ends before anything else is sent");
    FIELDPROOF_CHECK(++read_->attempts <= kAttempts, "a read is sent three times at most");
    read_->sent = end;
    in_window_.clear();
    return;
  }
  if (!orders_.empty() && orders_.front() == command) {
    orders_.pop_front();
    FIELDPROOF_CHECK(!is_refused(command), "what is no order is refused");
    if (command.command == kWriteCommand) {
      written_.at(command.id) = command;
    } else {
      read_ = Read{command, 1, end};
      in_window_.clear();
    }
    return;
  }
  FIELDPROOF_CHECK(command.command == kWriteCommand && written_.at(command.id) == command,
                   "a host sends what is next, or the last write of a node");
}

// ---- what it tells ----

bool ValveHostModel::is_refused(const Command& command) const {
  return command.id < rules_.first_address || command.id > rules_.last_address ||
         (command.command != kWriteCommand && command.command != kReadCommand);
}

void ValveHostModel::on_response(const HostResponse& response, Time when) {
  run_until(when);
  if (response.is_old) {
    FIELDPROOF_CHECK(owed_old_ && *owed_old_ == response, "what is told as old was known");
    owed_old_.reset();
    return;
  }
  FIELDPROOF_CHECK(read_ && read_->command.id == response.id, "a response is that of the read");
  FIELDPROOF_CHECK(in_window_.size() == 1, "the first frame in the window is the response, or none is");
  const Frame& frame = in_window_.front();
  FIELDPROOF_CHECK(frame.is_good && frame.octets.size() == 3, "a response has three good characters");
  FIELDPROOF_CHECK((frame.octets[0] ^ frame.octets[1]) == frame.octets[2], "the check of a response fits");
  FIELDPROOF_CHECK(frame.octets[0] == response.data0 && frame.octets[1] == response.data1,
                   "what is told is what arrived");
  FIELDPROOF_CHECK(frame.start - read_->sent >= longest_gap(rules_) - kRoundedPosition,
                   "a response does not come too early");
  known_.at(response.id) = response;
  read_.reset();
  was_busy_ = false;
  ++responses_;
}

void ValveHostModel::expect_no_answer_of(std::uint8_t id, HostErrorKind kind) {
  if (read_) {
    FIELDPROOF_CHECK(read_->command.id == id, "an error is that of the read");
    FIELDPROOF_CHECK(kind == HostErrorKind::line_busy || read_->attempts == kAttempts || was_busy_,
                     "a read fails behind three attempts");
    read_.reset();
    was_busy_ = false;
  } else {
    // The line was never silent: it was not sent even once.
    FIELDPROOF_CHECK(kind == HostErrorKind::line_busy && !orders_.empty() && orders_.front().id == id,
                     "an order that was not sent fails for a busy line");
    const Command order = orders_.front();
    orders_.pop_front();
    if (order.command == kWriteCommand) {
      written_.at(id) = order;
      return;
    }
  }
  owed_old_ = known_.at(id);
  if (owed_old_) owed_old_->is_old = true;
}

void ValveHostModel::on_error(const valve_bus::HostError& error, Time when) {
  run_until(when);
  FIELDPROOF_CHECK(!owed_old_, "what was known is told with the error");
  switch (error.kind) {
    case HostErrorKind::refused_id:
    case HostErrorKind::refused_command:
      FIELDPROOF_CHECK(!orders_.empty() && orders_.front().id == error.id && is_refused(orders_.front()),
                       "what is refused is no order, and is next");
      return orders_.pop_front();
    case HostErrorKind::part_of_command:
      FIELDPROOF_CHECK(parts_ > 0, "a part that is told was given");
      --parts_;
      return;
    case HostErrorKind::no_response:
    case HostErrorKind::bad_response:
    case HostErrorKind::line_busy:
      return expect_no_answer_of(error.id, error.kind);
    case HostErrorKind::not_acknowledged:
    case HostErrorKind::readback_mismatch:
    case HostErrorKind::fifo_overflow:
      FIELDPROOF_CHECK(false, "no option is on, and no order was lost");
  }
}

}  // namespace fieldproof::fuzz
