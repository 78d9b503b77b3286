#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocols/interbus/device.hpp"

// Recognition of a ring step by step, as pure logic: which control words the next ID cycle carries, and what
// its result means. The first cycle shows the station that closes the ring; then for each station its second
// interface (OUT2) and after everything after it its remote one (OUT1) is switched on by one ID cycle, and
// the next ID cycle shows whether the ring has grown by one. What is found is always the new end of the
// ring, so the list of stations is in the order of the ring at any time.
//
// Limits: those of the rules (stations, I/O points, levels); beyond them `error()` is not empty and the
// recognition has ended.
namespace fieldproof::interbus {

class TopologyDecisions {
 public:
  TopologyDecisions() = default;
  TopologyDecisions(const TopologyDecisions&) = delete;
  TopologyDecisions& operator=(const TopologyDecisions&) = delete;
  virtual ~TopologyDecisions() = default;

  // Register length of an ID code; nothing when its length code is undefined.
  virtual std::optional<unsigned> words_of(std::uint16_t id_code) const = 0;
  virtual bool searches_branches() const = 0;
};

class Topology {
 public:
  Topology(const Rules& rules, const TopologyDecisions& decisions);

  void restart();

  // In the order of the ring; grows by one station at a time.
  const std::vector<FoundStation>& stations() const { return stations_; }
  std::span<const std::uint16_t> control_words() const { return control_; }
  unsigned words() const { return words_; }

  // The control word for a station that may have appeared after the last known one.
  std::uint16_t pad_word() const { return both_off_; }

  // A good ID cycle with the words of so many stations, in the order of the ring.
  void on_ids(std::span<const std::uint16_t> ids);

  bool is_finished() const { return is_finished_; }
  const std::string& error() const { return error_; }

  // The station whose interface is being looked after; -1: the master.
  int probed_station() const;

  static constexpr std::uint16_t kCodeMask = 0x1FFF;  // of an ID register, without the messages

 private:
  struct Probe {
    int station;
    bool on_branch;
  };
  enum class Step { first, switching, observing };

  void observe(std::span<const std::uint16_t> ids);
  void add_station(std::uint16_t id);
  void next_probe();
  std::uint16_t off_bit(bool on_branch) const;
  void fail(std::string sentence);

  const Rules& rules_;
  const TopologyDecisions& decisions_;
  std::uint16_t both_off_;
  std::vector<FoundStation> stations_;
  std::vector<std::uint16_t> control_;
  std::vector<unsigned> levels_;
  std::vector<Probe> open_;  // still to be looked behind, the last first
  Probe probe_{-1, false};
  Step step_ = Step::first;
  unsigned words_ = 0;
  bool is_finished_ = false;
  std::string error_;
};

}  // namespace fieldproof::interbus
