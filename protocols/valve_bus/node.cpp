#include "protocols/valve_bus/node.hpp"

#include <algorithm>
#include <array>

#include "harness/kernel/check.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr unsigned kDriverBehindBits = 1;
constexpr unsigned kOneBoard = 1;
constexpr std::uint16_t kFirstBoard = 0x00FF;

}  // namespace

Node::Node(const NodeConfiguration& configuration)
    : configuration_(configuration),
      address_(Node::address_of(configuration.address_tens, configuration.address_units)),
      codec_(configuration.rules),
      collector_(configuration.rules) {}

void Node::wire(segment::Port& line, NodeBoards& boards) {
  line_ = &line;
  boards_ = &boards;
}

void Node::set_power(bool is_on, kernel::Time now) {
  collector_.clear();
  answer_.reset();
  valves_ = 0;
  state_ = is_on ? NodeState::waiting : NodeState::off;
  if (!is_on) return;
  address_ = address_of(configuration_.address_tens, configuration_.address_units);
  last_command_ = now;
  on_power_up(now);
}

// ---- the line ----

void Node::receive(segment::PortIndex, const line::Waveform& reception) {
  if (state_ == NodeState::off) return;
  const kernel::Time now = reception.end();
  codec_.decode(reception, [&](const line::UartCharacter& character) {
    if (collector_.ends_at() <= character.start) end_frame(now);
    line::UartCharacter heard = judged(character);
    // The receiver is off: what comes now is not heard, so what it belongs to is not whole.
    if (heard.start < driving_until_) heard.is_stop_missing = true;
    on_character(heard);
  });
}

void Node::on_character(const line::UartCharacter& character) {
  answer_.reset();
  collector_.add(character);
  state_ = NodeState::collecting;
}

void Node::on_time(kernel::Time now) {
  if (state_ == NodeState::off) return;
  if (collector_.known_at() <= now) end_frame(now);
  if (answer_ && driver_on_at(*answer_) <= now) {
    const Answer answer = *answer_;
    answer_.reset();
    std::array<std::uint8_t, kResponseOctets> octets = octets_of(answer.response);
    octets.back() = response_check(answer.response);
    transmit(octets, std::max(answer.start, now + bits(rules(), rules().driver_on_bits)));
    state_ = NodeState::waiting;
  }
  if (loss_at() <= now) {
    last_command_ = now;
    if (valves_ != 0) actuate(0, now);
  }
}

kernel::Time Node::next_time() const {
  if (state_ == NodeState::off) return kernel::kNever;
  kernel::Time next = std::min(collector_.known_at(), loss_at());
  if (answer_) next = std::min(next, driver_on_at(*answer_));
  return next;
}

void Node::end_frame(kernel::Time now) {
  const CollectedFrame frame = collector_.frame();
  collector_.clear();
  state_ = NodeState::waiting;
  on_frame(frame, now);
}

kernel::Time Node::driver_on_at(const Answer& answer) const {
  return answer.start - bits(rules(), rules().driver_on_bits);
}

kernel::Time Node::loss_at() const {
  const bool can_be_lost = rules().loss_limit > kernel::Duration{};
  return can_be_lost ? last_command_ + rules().loss_limit : kernel::kNever;
}

// ---- decisions ----

unsigned Node::address_of(unsigned tens, unsigned units) const {
  constexpr unsigned kDigits = 10;
  return tens < kDigits && units < kDigits ? kDigits * tens + units : 0;
}

void Node::on_frame(const CollectedFrame& frame, kernel::Time now) {
  const auto octets = frame.whole(kCommandOctets);
  if (!octets || !fits(*octets)) return;
  const Command command = command_of(*octets);
  if (!is_meant(command.id)) return;
  last_command_ = now;
  on_command(command, now);
  if (answer_) answer_->start = std::max(answer_->start, frame.busy_until + turnaround_time());
}

bool Node::is_meant(std::uint8_t id) const {
  return id == address_ && id >= rules().first_address && id <= rules().last_address;
}

bool Node::fits(std::span<const std::uint8_t> octets) const {
  return block_check(octets) == 0;
}

void Node::on_command(const Command& command, kernel::Time now) {
  if (command.command == rules().write_command) {
    actuate(valves_of(command), now);
    if (rules().answers_writes) answer_at({command.data0, command.data1}, now);
  } else if (command.command == rules().read_command) {
    answer_at(response(now), now);
  }
}

std::uint16_t Node::valves_of(const Command& command) const {
  const auto both = static_cast<std::uint16_t>(command.data0 | command.data1 << 8);
  return configuration_.boards == kOneBoard ? both & kFirstBoard : both;
}

Response Node::response(kernel::Time now) {
  std::uint16_t switches = limit_switches(now);
  if (configuration_.boards == kOneBoard) switches &= kFirstBoard;
  return {static_cast<std::uint8_t>(switches & 0xFF), static_cast<std::uint8_t>(switches >> 8)};
}

kernel::Duration Node::turnaround_time() const {
  return delimiter(rules()) + kNodeProcessing;
}

std::uint8_t Node::response_check(const Response& response) const {
  return static_cast<std::uint8_t>(response.data0 ^ response.data1);
}

// ---- actions ----

void Node::actuate(std::uint16_t valves, kernel::Time now) {
  valves_ = valves;
  boards_->drive_valves(valves, now);
}

void Node::answer_at(const Response& response, kernel::Time start) {
  answer_ = Answer{response, start};
  state_ = NodeState::answering;
}

void Node::transmit(std::span<const std::uint8_t> octets, kernel::Time start) {
  FIELDPROOF_CHECK(line_ != nullptr, "a node that drives has been wired");
  const auto characters = static_cast<unsigned>(octets.size());
  driving_until_ = start + half_characters(rules(), 2 * characters) + bits(rules(), kDriverBehindBits);
  codec_.drive(*line_, octets, start, {rules().driver_on_bits, kDriverBehindBits});
}

}  // namespace fieldproof::valve_bus
