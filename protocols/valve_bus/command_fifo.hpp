#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/valve_bus/frame.hpp"
#include "protocols/valve_bus/rules.hpp"

// The FIFO between the PC and the host module: a ring of octets in which commands of four stand one after
// the other.
//
// Contract: whole commands come out in the order in which they went in. What does not fit is lost command by
// command, the newest ones, never a part of one, so the stream stays in step. A command whose rest does not
// come in time is for `take_part`; what is written after it begins a new one.
namespace fieldproof::valve_bus {

class CommandFifo {
 public:
  // ID, COMMAND, DATA0, DATA1: the block check is the host's.
  static constexpr std::size_t kWritten = kCommandOctets - 1;

  explicit CommandFifo(const Rules& rules);
  CommandFifo(const CommandFifo&) = delete;
  CommandFifo& operator=(const CommandFifo&) = delete;
  virtual ~CommandFifo() = default;

  std::size_t room() const { return ring_.size() - count_; }
  bool has_command() const { return count_ - part_ >= kWritten; }
  bool has_overflowed() const { return has_overflowed_; }

  // False for the octet with which the loss of a command begins.
  bool put(std::uint8_t octet, kernel::Time now);
  // The oldest whole command.
  std::optional<Command> take();

  // When the command that is being written is given up; kNever without one.
  kernel::Time part_ends_at() const;
  // Takes the part out; nothing where the command was being lost.
  std::vector<std::uint8_t> take_part();
  void clear();

 protected:
  std::size_t capacity() const { return ring_.size(); }
  void set_overflowed() { has_overflowed_ = true; }
  // The oldest command is gone.
  void drop_oldest();

  // ---- decisions ----
  virtual std::size_t behind_written(std::size_t position) const { return (position + 1) % capacity(); }
  virtual std::size_t behind_read(std::size_t position) const { return (position + 1) % capacity(); }
  // A command begins for which there is no room. True: there is now.
  virtual bool on_overflow();
  // Whether with the first octet of a command its others are lost.
  virtual bool loses_whole_commands() const { return true; }

 private:
  void keep(std::uint8_t octet);
  std::uint8_t read();

  std::vector<std::uint8_t> ring_;
  kernel::Duration part_limit_;
  std::size_t write_ = 0;
  std::size_t read_ = 0;
  std::size_t count_ = 0;
  std::size_t part_ = 0;   // octets of the command that is being written, in the ring
  std::size_t phase_ = 0;  // octets of it that came
  bool is_losing_ = false;
  bool has_overflowed_ = false;
  kernel::Time last_octet_{};
};

}  // namespace fieldproof::valve_bus
