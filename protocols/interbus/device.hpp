#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/segment/station.hpp"
#include "protocols/interbus/rules.hpp"

// What the bench wires to and asks of an INTERBUS slave and of a master, whoever implements them: the
// built-in reference, a mutant of it, or an implementation outside. The line side is segment::Station;
// here is the other side of the device: its terminals and, for a master, its application interface (the upper
// tester).
namespace fieldproof::interbus {

// ---- slave ----

// Receivers of a slave, in its numbering.
inline constexpr segment::PortIndex kFromUpstream = 0;  // forward data, from the master's side
inline constexpr segment::PortIndex kFromBranch = 1;    // return data of what lies behind OUT2
inline constexpr segment::PortIndex kFromRemote = 2;    // return data of what lies behind OUT1

// The terminals of a slave. Instants may lie ahead of the segment's now, because a station works through a
// whole reception when it begins; they never decrease from call to call of one kind.
class Terminals {
 public:
  virtual ~Terminals() = default;
  virtual std::uint16_t input(unsigned word, kernel::Time when) = 0;
  virtual void output(unsigned word, std::uint16_t value, kernel::Time when) = 0;
  virtual bool has_peripheral_fault(kernel::Time when) = 0;
  virtual bool wants_reconfiguration(kernel::Time when) = 0;
};

struct SlaveConfiguration {
  Rules rules;
  std::string name;
  std::uint16_t id_code = 0;  // bits 0..12
  unsigned words = 0;         // register length
  bool is_local = false;      // sits on logic-level lines: local delay
  bool has_branch = false;    // has a second outgoing interface
};

// Where a slave drives; null where nothing is plugged in (the next-device bridge is open).
struct SlavePorts {
  segment::Port* upstream = nullptr;
  segment::Port* branch = nullptr;
  segment::Port* remote = nullptr;
};

class SlaveDevice : public segment::Station {
 public:
  virtual void wire(const SlavePorts& ports, Terminals& terminals) = 0;
  // The plug with the bridge at an outgoing interface is put in or pulled.
  virtual void set_next_present(bool on_branch, bool present) = 0;
  // The supply goes or comes back; it is there from `wire` on. Nothing outlasts it, and what stands at the
  // outputs without it is the bench's.
  virtual void set_power(bool is_on, kernel::Time now) = 0;
  // Whether it finds telegrams in levels itself, and makes levels of its own.
  virtual bool has_line_interface() const { return true; }
};

// ---- master ----

enum class MasterState { off, ready, identification, run, locating, bus_stop };

struct FoundStation {
  std::uint16_t id_code = 0;  // without message bits
  unsigned words = 0;
  int before = -1;         // index in this list; -1: the master
  bool on_branch = false;  // behind the second outgoing interface of `before`

  friend bool operator==(const FoundStation&, const FoundStation&) = default;
};

// Where an error lies: between station `from` and `to` in the order of the ring; -1 is the master's output on
// the way out (`from`) or its input on the way back (`to`).
struct FaultLocation {
  int from = -1;
  int to = -1;
  friend bool operator==(const FaultLocation&, const FaultLocation&) = default;
};

struct MasterConfiguration {
  Rules rules;
  // What must be found; empty: what is found is taken.
  std::vector<FoundStation> expected;
  kernel::Duration cycle_time{};  // requested; zero: the shortest possible
  // Ring positions of stations, words and directions for the copy task: input word -> output word, both
  // indices into the process images.
  struct Copy {
    unsigned input_word;
    unsigned output_word;
  };
  std::vector<Copy> copy;
};

// The upper tester's view of a master. All counters since the last start.
struct MasterStatus {
  MasterState state = MasterState::off;
  std::vector<FoundStation> stations;
  std::string configuration_error;  // empty, or what does not fit
  std::uint64_t data_cycles = 0;    // finished, good or bad
  std::uint64_t id_cycles = 0;
  std::uint64_t rejected_cycles = 0;  // data and ID cycles
  std::uint64_t rejected_data_cycles = 0;
  unsigned consecutive_bad = 0;
  bool quality_bit = false;
  bool has_fault_location = false;
  FaultLocation fault_location;
  std::vector<int> peripheral_faults;  // ring positions, as read in the last good ID cycle
  std::vector<int> reconfigurations;
  kernel::Duration cycle_time{};  // in force

  friend bool operator==(const MasterStatus&, const MasterStatus&) = default;
};

// The image of the process data in words: station by station in the order of the ring, as many words for each
// as its register has, in both directions.
class MasterDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& out) = 0;  // the return line is heard as port 0

  // Orders of the application, also from within the hook below. Outputs go with the next cycle that begins.
  virtual void start(kernel::Time now) = 0;             // power-up: recognises the topology, checks it, runs
  virtual void stop(kernel::Time now) = 0;              // outputs 0, then silence
  virtual void request_id_cycle(kernel::Time now) = 0;  // instead of the next data cycle
  virtual void write_output(unsigned word, std::uint16_t value, kernel::Time now) = 0;

  virtual std::uint16_t output(unsigned word) const = 0;
  virtual std::uint16_t input(unsigned word) const = 0;
  virtual MasterStatus status() const = 0;

  // Called after each finished cycle, when the images are consistent: the application.
  using CycleHook = std::function<void(kernel::Time now, bool data_cycle, bool accepted)>;
  virtual void on_cycle_end(CycleHook hook) = 0;
};

}  // namespace fieldproof::interbus
