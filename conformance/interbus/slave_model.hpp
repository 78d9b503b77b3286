#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "conformance/interbus/slave_line.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/interbus/rules.hpp"

// What a right slave sends for a cycle that it got, computed from scratch by the lower tester: its register
// leaves first, then everything that came in; the check of what it sent; the status word, marked when the
// check that it got does not fit what it got. Shares no line with the reference slave: the frame check is
// the shift register of the textbook, bit by bit, put into one table.
//
// Contract: speaks about whole cycles only (transfer telegrams of one kind, then four check telegrams);
// whether a sequence of telegrams is one, `find_first_cycle` says.
namespace fieldproof::conformance {

class BitwiseCheck {
 public:
  explicit BitwiseCheck(const line::FrameCheckParameters& parameters);

  std::uint16_t start() const { return start_; }
  std::uint16_t next(std::uint16_t state, std::uint8_t octet) const {
    return is_reflected_ ? static_cast<std::uint16_t>((state >> 8) ^ table_[(state ^ octet) & 0xFF])
                         : static_cast<std::uint16_t>((state << 8) ^ table_[(state >> 8) ^ octet]);
  }
  // The check as two octets in line order, the first in the high half.
  std::uint16_t word(std::uint16_t state) const;
  std::uint16_t of(std::span<const std::uint8_t> octets) const;

 private:
  bool is_reflected_;
  std::uint16_t start_;
  std::uint16_t xorout_;
  std::array<std::uint16_t, 256> table_{};
};

// A cycle as it passed on a line.
struct CycleOnLine {
  std::span<const SeenTelegram> telegrams;  // data telegrams: transfer, then four of the check phase
  std::size_t octets = 0;                   // transfer telegrams
  bool is_id_cycle = false;

  std::uint16_t word(std::size_t n) const {
    return static_cast<std::uint16_t>(telegrams[n].data << 8 | telegrams[n + 1].data);
  }
  std::uint16_t check() const { return word(octets); }
  std::uint16_t status() const { return word(octets + 2); }
};

// A whole cycle in a sequence of telegrams: a run of transfer telegrams of one kind that four check telegrams
// of that kind follow, nothing but status telegrams between them, no stop level missing.
struct FoundCycle {
  bool is_found = false;
  bool is_id_cycle = false;
  std::vector<std::uint8_t> octets;
  std::uint16_t check = 0;
  std::uint16_t status = 0;
  std::size_t end = 0;  // telegrams up to its end
};
// The first one and the last one; `is_found` says whether there is any.
void find_first_cycle(std::span<const SeenTelegram> telegrams, FoundCycle& found);
void find_last_cycle(std::span<const SeenTelegram> telegrams, FoundCycle& found);

struct RightAnswer {
  std::vector<std::uint8_t> octets;
  std::uint16_t check = 0;
  std::uint16_t status = 0;
  bool is_own_error = false;  // the check that came in does not fit
};

// The field in which an answer differs first, as a reason code of its own.
struct AnswerDifference {
  std::string reason;  // empty: no difference
  std::string place;   // "transfer telegram 3 (register octet)"
  std::string expected;
  std::string actual;
};

class SlaveModel {
 public:
  explicit SlaveModel(const interbus::Rules& rules);

  const BitwiseCheck& check() const { return check_; }

  // `load` is the register as the cycle begins.
  const RightAnswer& answer(const CycleOnLine& in, std::span<const std::uint8_t> load);

  // Compares what the slave sent with the last answer().
  bool is_right(const CycleOnLine& out) const;
  AnswerDifference difference(const CycleOnLine& out, std::size_t register_octets) const;

 private:
  std::uint8_t header_of(const CycleOnLine& cycle, std::size_t n) const;

  BitwiseCheck check_;
  std::uint16_t status_marked_;
  RightAnswer right_;
};

}  // namespace fieldproof::conformance
