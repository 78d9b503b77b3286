#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/ring.hpp"

// Random process data through a network, end to end: what was given to the terminals and to the master's
// image, and whether it is what came out. Words are never 0: an output of 0 is the safe value, which nobody
// sent.
//
// Contract: the master's hook for cycle ends belongs to the caller, who tells each end here; the oracle then
// judges both images and gives both sides new words. Deterministic in the stream and in what the network
// does.
//
// Limit: an output that a station would take over in the same cycle in which the master stops the bus is not
// told from one of the cycle before.
namespace fieldproof::interbus {

// Cycles are data cycles.
struct ErrorLedger {
  std::uint64_t sent = 0;
  std::uint64_t corrupted = 0;  // some receiver got something else than was driven
  std::uint64_t detected = 0;   // rejected by the master
  std::uint64_t repeated = 0;   // ID cycles that followed a rejection
  // Words that an application got and nobody had sent: in the master's input image, at a station's outputs.
  std::uint64_t accepted_wrong_inputs = 0;
  std::uint64_t accepted_wrong_outputs = 0;
  std::uint64_t wrong_cycles = 0;  // with such words, however many
  // Words of good cycles that a station did not put out: it held the ones before.
  std::uint64_t missed_outputs = 0;
  // Words at a station's outputs that became 0, which nobody sends: a reset, after a stop of the bus or a
  // silence.
  std::uint64_t cleared_outputs = 0;
  // Rejected by the master, but a station had taken over its outputs: the words were right.
  std::uint64_t partly_latched = 0;

  std::uint64_t accepted_wrong() const { return accepted_wrong_inputs + accepted_wrong_outputs; }
};

class ExchangeOracle {
 public:
  // A word that an application got: an output of the process image at its station, or an input in the image.
  struct WrongWord {
    bool is_output = false;
    unsigned word = 0;  // of the process image
    std::uint16_t sent = 0;
    std::uint16_t got = 0;
    kernel::Time when;
  };

  // The ring's terminals tell it their changes: the ring is not run any more once it is gone.
  ExchangeOracle(MasterDevice& master, Ring& ring, kernel::Random random);
  ExchangeOracle(const ExchangeOracle&) = delete;
  ExchangeOracle& operator=(const ExchangeOracle&) = delete;

  // The ledger counts from here on.
  void begin();
  const ErrorLedger& ledger() const { return ledger_; }
  // Of the ledger.
  const std::optional<WrongWord>& first_wrong() const { return first_wrong_; }
  // Whether the last good cycle was not put out somewhere; how many were put out everywhere.
  bool has_missed() const { return has_missed_; }
  std::uint64_t good_cycles() const { return good_cycles_; }

  void on_cycle_end(kernel::Time now, bool is_data, bool accepted, bool is_corrupted);

 private:
  void watch(int position);
  void judge_inputs(kernel::Time now, bool is_good_data);
  void accept_wrong(const WrongWord& wrong);
  void judge_outputs();
  void exchange(kernel::Time now);

  MasterDevice& master_;
  Ring& ring_;
  kernel::Random random_;
  std::vector<std::uint16_t> sent_;          // the output image of the cycle in work
  std::vector<std::uint16_t> at_terminals_;  // the inputs that it will bring
  std::vector<std::uint16_t> held_;          // the input image as it was seen last
  std::vector<std::uint16_t> put_out_;       // at the output terminals
  bool has_latched_ = false;
  bool has_missed_ = false;
  bool was_rejected_ = false;
  std::uint64_t good_cycles_ = 0;
  std::uint64_t wrong_before_ = 0;
  ErrorLedger ledger_;
  std::optional<WrongWord> first_wrong_;
};

}  // namespace fieldproof::interbus
