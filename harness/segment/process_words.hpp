#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "harness/kernel/time.hpp"

// The process side of a simulated device, in words of 16 bits: inputs that are constant or a signal in time,
// outputs with the instants at which they changed.
//
// Contract: instants may lie ahead, because a station works through a whole reception when it begins; those
// of one output never decrease.
namespace fieldproof::segment {

class ProcessWords {
 public:
  using Signal = std::function<std::uint16_t(kernel::Time)>;

  struct Change {
    kernel::Time when;
    unsigned word;
    std::uint16_t before;
    std::uint16_t after;
  };

  explicit ProcessWords(unsigned words) : inputs_(words), signals_(words), outputs_(words), writes_(words) {}

  void set_input(unsigned word, std::uint16_t value) { inputs_.at(word) = value; }
  void set_signal(unsigned word, Signal signal) { signals_.at(word) = std::move(signal); }
  std::uint16_t input(unsigned word, kernel::Time when) const {
    return signals_[word] ? signals_[word](when) : inputs_[word];
  }

  // What was written last; its instant may lie ahead.
  std::uint16_t output(unsigned word) const { return outputs_.at(word); }
  // What stands at the terminals at `now`, which is not before the write that came before the last one.
  std::uint16_t output_at(unsigned word, kernel::Time now) const {
    return writes_.at(word).when <= now ? outputs_[word] : writes_[word].before;
  }
  const std::vector<std::uint16_t>& outputs() const { return outputs_; }
  void write(unsigned word, std::uint16_t value, kernel::Time when) {
    ++write_count_;
    last_write_ = when;
    std::uint16_t& held = outputs_.at(word);
    writes_[word] = {when, held};
    if (held == value) return;
    const Change change{when, word, held, value};
    if (changes_.size() < kMostChanges) {
      changes_.insert(std::ranges::upper_bound(changes_, when, {}, &Change::when), change);
    }
    for (const auto& hook : on_change_) hook(change);
    held = value;
  }

  // Changes of outputs in order of time since `forget_changes`, at most kMostChanges of them; and how often
  // any output was written, changed or not.
  static constexpr std::size_t kMostChanges = 65'536;
  const std::vector<Change>& changes() const { return changes_; }
  void forget_changes() { changes_.clear(); }
  // Called at each change as it is written, after those that were added before.
  void on_change(std::function<void(const Change&)> hook) { on_change_.push_back(std::move(hook)); }
  std::uint64_t write_count() const { return write_count_; }
  kernel::Time last_write() const { return last_write_; }

 private:
  struct Write {
    kernel::Time when{};
    std::uint16_t before = 0;
  };

  std::vector<std::uint16_t> inputs_;
  std::vector<Signal> signals_;
  std::vector<std::uint16_t> outputs_;
  std::vector<Write> writes_;  // the last one of each word
  std::vector<Change> changes_;
  std::vector<std::function<void(const Change&)>> on_change_;
  std::uint64_t write_count_ = 0;
  kernel::Time last_write_{};
};

}  // namespace fieldproof::segment
