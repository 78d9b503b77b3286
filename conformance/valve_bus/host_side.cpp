#include "conformance/valve_bus/host_side.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/valve_bus/host_expect.hpp"

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

}  // namespace

void HostSide::order(const valve_bus::Command& command) {
  ++orders_;
  ids_.insert(command.id);
  bench_.order(command);
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
  bench_.answer_levels(levels, turnaround_time);
  const auto bits = static_cast<std::int64_t>(levels.size());
  bench_.wait(turnaround_time + bench_.bits(bits));
  take_indications();
}

void HostSide::drain() {
  kernel::Time limit = bench_.now() + bench_.observation_timeout();
  while (!is_flooded()) {
    const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()));
    if (!frame) break;
    if (note(*frame)) limit = bench_.now() + bench_.observation_timeout();
  }
  take_indications();
}

void HostSide::say(std::span<const std::uint8_t> octets) {
  if (octets.empty()) return;
  // A refresh may begin before the host has noticed the first character.
  unnoticed_from_ = bench_.now();
  unnoticed_until_ = bench_.now() + 2 * valve_bus::character_notice(bench_.rules());
  bench_.say(octets);
  wait(bench_.observation_timeout());
}

void HostSide::wait(kernel::Duration duration) {
  const kernel::Time limit = bench_.now() + duration;
  while (const auto frame = bench_.next_frame(std::max(kernel::Duration{}, limit - bench_.now()))) {
    note(*frame);
    if (is_flooded() || bench_.now() >= limit) break;
  }
  take_indications();
}

void HostSide::restart() {
  take_indications();
  bench_.restart(static_cast<unsigned>(bench_.pics().number("dip", 0)));
  ids_.clear();
}

bool HostSide::is_doubtful() const {
  return std::ranges::any_of(bench_.arrived(), &ArrivedFrame::is_doubtful);
}

void HostSide::take_indications() {
  while (bench_.was_told()) indications_.push_back(observed(*bench_.next_told({})));
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
  if (octets.size() == valve_bus::kCommandOctets) {
    command = frame.command();
    if (bench_.is_refresh(*command)) return std::nullopt;
    bench_.note_write(*command);
  }
  requests_.push_back({{octets.begin(), octets.end()}, frame.start});
  return command;
}

}  // namespace fieldproof::conformance
