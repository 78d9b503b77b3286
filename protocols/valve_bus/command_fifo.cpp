#include "protocols/valve_bus/command_fifo.hpp"

#include <utility>

namespace fieldproof::valve_bus {

CommandFifo::CommandFifo(const Rules& rules)
    : ring_(rules.fifo_octets), part_limit_(rules.partial_command_limit) {}

bool CommandFifo::put(std::uint8_t octet, kernel::Time now) {
  last_octet_ = now;
  if (phase_ == 0) {
    is_losing_ = room() < kWritten && !on_overflow();
    if (is_losing_ && !loses_whole_commands()) return false;
  }
  phase_ = (phase_ + 1) % kWritten;
  if (is_losing_) return phase_ != 1;
  keep(octet);
  part_ = phase_;
  return true;
}

std::optional<Command> CommandFifo::take() {
  if (!has_command()) return std::nullopt;
  const std::uint8_t id = read();
  const std::uint8_t command = read();
  const std::uint8_t data0 = read();
  return Command{id, command, data0, read()};
}

kernel::Time CommandFifo::part_ends_at() const {
  return phase_ == 0 ? kernel::kNever : last_octet_ + part_limit_;
}

std::vector<std::uint8_t> CommandFifo::take_part() {
  phase_ = 0;
  std::vector<std::uint8_t> part(std::exchange(part_, 0));
  count_ -= part.size();
  write_ = (write_ + capacity() - part.size()) % capacity();
  for (std::size_t n = 0; n < part.size(); ++n) part[n] = ring_[(write_ + n) % capacity()];
  return part;
}

void CommandFifo::clear() {
  write_ = read_ = count_ = part_ = phase_ = 0;
  has_overflowed_ = false;
}

bool CommandFifo::on_overflow() {
  set_overflowed();
  return false;
}

void CommandFifo::drop_oldest() {
  for (std::size_t n = 0; n < kWritten; ++n) read();
}

void CommandFifo::keep(std::uint8_t octet) {
  ring_[write_] = octet;
  write_ = behind_written(write_);
  ++count_;
}

std::uint8_t CommandFifo::read() {
  const std::uint8_t octet = ring_[read_];
  read_ = behind_read(read_);
  --count_;
  return octet;
}

}  // namespace fieldproof::valve_bus
