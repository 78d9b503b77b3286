#include "conformance/valve_bus/host_side.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/valve_bus/host_expect.hpp"
#include "protocols/valve_bus/command_fifo.hpp"

namespace fieldproof::conformance {
namespace {

// Three attempts of a read, and three of the read that verifies a write: more than that for each order is a
// flood.
constexpr std::size_t kMostRequestsOfAnOrder = 8;

Observation observed(const HostEvent& event) {
  if (const auto* error = std::get_if<valve_bus::HostError>(&event.what))
    return {{0, error->id, static_cast<std::int64_t>(error->kind)}, event.when};
  const auto& response = std::get<valve_bus::HostResponse>(event.what);
  return {{1, response.id, response.data0, response.data1, response.is_old ? 1 : 0}, event.when};
}

bool is_of_the_fifo(const HostEvent& event) {
  const auto* error = std::get_if<valve_bus::HostError>(&event.what);
  return error != nullptr && (error->kind == valve_bus::HostErrorKind::fifo_overflow ||
                              error->kind == valve_bus::HostErrorKind::part_of_command);
}

}  // namespace

void HostSide::order(const valve_bus::Command& command) {
  ++orders_;
  ids_.insert(command.id);
  // With less room it depends on when the host takes the one before.
  is_overflow_doubtful_ |= bench_.fifo_room() < 2 * valve_bus::CommandFifo::kWritten;
  bench_.order(command);
}

void HostSide::order_octets(std::span<const std::uint8_t> octets, std::size_t commands) {
  orders_ += commands;
  bench_.write(octets);
}

void HostSide::order_part(std::span<const std::uint8_t> octets) {
  ++orders_;
  bench_.write(octets);
  wait(bench_.rules().partial_command_limit + 10 * kernel::kMillisecond);
}

bool HostSide::awaits_response(const valve_bus::Command& command) const {
  return command.command == bench_.rules().read_command;
}

bool HostSide::is_flooded() const {
  return requests_.size() > kMostRequestsOfAnOrder * (orders_ + 1);
}

bool HostSide::await_command() {
  const kernel::Time limit = bench_.now() + bench_.observation_timeout();
  while (const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()))) {
    if (note(*frame) || is_flooded()) return true;
  }
  return false;
}

bool HostSide::await_request() {
  kernel::Time limit = bench_.now() + bench_.observation_timeout();
  while (!is_flooded()) {
    const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()));
    take_indications();
    if (!frame) return false;
    const auto command = note(*frame);
    if (!command) continue;
    if (awaits_response(*command)) return true;
    limit = bench_.now() + bench_.observation_timeout();
  }
  return false;
}

void HostSide::answer(const line::Levels& levels, kernel::Duration turnaround_time, bool is_whole) {
  is_end_sure_ = is_whole;
  pace_.on_answer();
  bench_.answer_levels(levels, turnaround_time);
  const auto bits = static_cast<std::int64_t>(levels.size());
  bench_.wait(turnaround_time + bench_.bits(bits));
  take_indications();
}

void HostSide::answer_octets(std::span<const std::uint8_t> octets, kernel::Duration turnaround_time) {
  pace_.on_answer();
  const kernel::Time end = bench_.answer(octets, turnaround_time);
  wait(end - bench_.now());
}

void HostSide::drain() {
  kernel::Time limit = bench_.now() + bench_.observation_timeout();
  while (!is_flooded()) {
    const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()));
    if (!frame) break;
    if (note(*frame)) limit = bench_.now() + bench_.observation_timeout();
  }
  take_indications();
  pace_.expect_refreshed();
}

void HostSide::say(std::span<const std::uint8_t> octets) {
  if (octets.empty()) return;
  // A refresh may begin before the host has noticed the first character.
  unnoticed_from_ = bench_.now();
  unnoticed_until_ = bench_.now() + 2 * valve_bus::character_notice(bench_.rules());
  bench_.say(octets);
  pace_.on_noise();
  wait(bench_.observation_timeout());
}

// With gaps in which no host is sure of silence.
void HostSide::talk(kernel::Duration duration, const valve_bus::Command& command) {
  pace_.on_noise();
  const kernel::Time end = bench_.now() + duration;
  for (unsigned n = 0; n < 3 || bench_.now() < end; ++n) {
    if (n == 2) order(command);
    bench_.say(std::array<std::uint8_t, 1>{0x55});
    bench_.wait(bench_.characters(2));
  }
  wait(bench_.observation_timeout());
  pace_.on_noise();
}

void HostSide::wait(kernel::Duration duration) {
  const kernel::Time limit = bench_.now() + duration;
  while (const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()))) {
    note(*frame);
    if (is_flooded() || bench_.now() >= limit) break;
  }
  take_indications();
  pace_.expect_refreshed();
}

// A refresh that is due is given up, and due again.
void HostSide::keep_line_busy(kernel::Duration duration) {
  unnoticed_from_ = bench_.now();
  unnoticed_until_ = bench_.now() + 2 * valve_bus::character_notice(bench_.rules());
  const kernel::Time end = bench_.now() + duration;
  while (bench_.now() < end) {
    bench_.say(std::array<std::uint8_t, 1>{0x55});
    bench_.wait(bench_.characters(2));
  }
  pace_.on_noise();
  wait(pace_.longest_refresh() + kernel::kMillisecond);
}

void HostSide::acknowledge_wrongly(const valve_bus::Command& command, unsigned attempts, Acknowledge how) {
  wrongly_acknowledged_ = command;
  wrong_acknowledges_ = attempts;
  wrong_acknowledge_ = how;
}

void HostSide::acknowledge(const valve_bus::Command& command) {
  constexpr std::int64_t kAcknowledgeBits = 60;
  constexpr std::uint8_t kInverted = 0x10;
  const bool is_wrong = wrong_acknowledges_ > 0 && command == wrongly_acknowledged_;
  if (is_wrong) --wrong_acknowledges_;
  const Acknowledge how = is_wrong ? wrong_acknowledge_ : Acknowledge::right;
  if (how == Acknowledge::none) return;
  const bool is_other = how == Acknowledge::other_data;
  const auto data0 = static_cast<std::uint8_t>(command.data0 ^ (is_other ? kInverted : 0));
  auto octets = octets_of(valve_bus::Response{data0, command.data1});
  if (how == Acknowledge::wrong_check) octets.back() ^= kInverted;
  const std::size_t count = how == Acknowledge::one_octet ? 1 : octets.size();
  pace_.on_answer();
  bench_.answer(std::span(octets).first(count), bench_.bits(kAcknowledgeBits));
}

bool HostSide::await_write(const valve_bus::Command& command, kernel::Duration within) {
  const kernel::Time limit = bench_.now() + within;
  while (const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()))) {
    note(*frame);
    const bool is_it =
        frame->sent.characters.size() == valve_bus::kCommandOctets && frame->command() == command;
    if (is_it) return true;
    if (is_flooded()) break;
  }
  take_indications();
  return false;
}

void HostSide::restart() {
  take_indications();
  bench_.restart(dip_);
  pace_.on_power();
  ids_.clear();
}

void HostSide::note_fifo() {
  fifo_states_.push_back(
      {{bench_.has_overflowed() ? 1 : 0, static_cast<std::int64_t>(bench_.fifo_room())}, bench_.now()});
}

bool HostSide::is_doubtful() const {
  return std::ranges::any_of(bench_.arrived(), &ArrivedFrame::is_doubtful);
}

void HostSide::take_indications() {
  while (bench_.was_told()) {
    const HostEvent event = *bench_.next_told({});
    if (const auto* error = std::get_if<valve_bus::HostError>(&event.what))
      pace_.on_error(*error, event.when);
    (is_of_the_fifo(event) ? fifo_errors_ : indications_).push_back(observed(event));
  }
}

std::optional<valve_bus::Command> HostSide::note(const HostFrame& frame) {
  // While its driver is on a host hears nothing of what begins then.
  const bool was_deaf = before_on_ < unnoticed_until_ && before_off_ > unnoticed_from_;
  before_on_ = frame.sent.driver_on;
  before_off_ = frame.sent.driver_off;
  const bool is_sure = std::exchange(is_end_sure_, true) && !was_deaf &&
                       (frame.start < unnoticed_from_ || frame.start >= unnoticed_until_);
  if (judge_ != nullptr && is_sure) expect_form(bench_, *judge_, frame);
  const std::vector<std::uint8_t> octets = frame.sent.octets();
  std::optional<valve_bus::Command> command;
  take_indications();
  if (octets.size() == valve_bus::kCommandOctets) {
    command = frame.command();
    const bool is_refresh = bench_.is_refresh(*command);
    pace_.on_frame(frame, is_refresh);
    if (bench_.rules().answers_writes && command->command == bench_.rules().write_command)
      acknowledge(*command);
    if (is_refresh) return std::nullopt;
    bench_.note_write(*command);
  }
  requests_.push_back({{octets.begin(), octets.end()}, frame.start});
  return command;
}

}  // namespace fieldproof::conformance
