#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "harness/iut/device.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/rules.hpp"

// What the bench wires to and asks of a local node or of a host module, whoever implements it: the built-in
// reference, a mutant of it, or an implementation outside. The line side is segment::Station (it hears the
// line as port 0, a node not what it drives itself); here is the other side of the device.
namespace fieldproof::valve_bus {

// The boards of a node. Bit i of the valves is solenoid i + 1: bits 0..7 those that DATA0 drives, bits 8..15
// those of DATA1. Bits of the limit switches in the same way: what a response carries. Instants never
// decrease from call to call.
class NodeBoards {
 public:
  virtual ~NodeBoards() = default;
  virtual std::uint16_t limit_switches(kernel::Time when) = 0;
  // All 16 from now on. A node that sets them one by one calls this for each.
  virtual void drive_valves(std::uint16_t valves, kernel::Time when) = 0;
};

struct NodeConfiguration {
  Rules rules;
  // The two address switches: decimal digits as they are set, 0..15 each (a switch can be of another kind).
  unsigned address_tens = 0;
  unsigned address_units = 1;
  unsigned boards = 2;  // drive boards, 1 or 2
};

class NodeDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& line, NodeBoards& boards) = 0;
  // The supply comes and goes; a node begins without it. It must not drive the line or a valve without it:
  // the valves are told off by who switches it.
  virtual void set_power(bool is_on, kernel::Time now) = 0;

  virtual iut::Capabilities capabilities() const { return {}; }
  // Of what it drove when its driver came on at this instant, and of the last moves of its valves.
  virtual iut::TimingUncertainty uncertainty_of_answer(kernel::Time) const { return {}; }
  virtual iut::TimingUncertainty uncertainty_of_valves() const { return {}; }
};

// ---- the host module and its PC ----

struct HostConfiguration {
  Rules rules;       // their bit rate is not looked at: the DIP switches say it
  unsigned dip = 0;  // position of the switches, an index of dip_bit_rates()
  // How it is wired: the receiver stays on while the driver is.
  bool receives_own_echo = false;
  // For nodes whose switches follow their valves: a read after each write of the PC must give what was
  // written.
  bool verifies_writes = false;
};

// What was last read of a node, told after each read of the PC.
struct HostResponse {
  std::uint8_t id = 0;
  std::uint8_t data0 = 0;
  std::uint8_t data1 = 0;
  bool is_old = false;  // the read has failed: this is what an earlier one gave

  friend bool operator==(const HostResponse&, const HostResponse&) = default;
};

enum class HostErrorKind : std::uint8_t {
  refused_id,         // no node has it
  refused_command,    // neither a write nor a read
  no_response,        // to none of the attempts
  bad_response,       // to the last attempt, wrong in length, form, check or time
  not_acknowledged,   // a write, where nodes acknowledge
  readback_mismatch,  // a write that its verification did not find
  line_busy,          // the line was not silent long enough to send
  fifo_overflow,      // the command that begins with this ID was lost
  part_of_command,    // the rest of the command that begins with this ID did not come
};

// "refused ID", "no response" ...
std::string_view describe(HostErrorKind kind);

struct HostError {
  std::uint8_t id = 0;
  HostErrorKind kind = HostErrorKind::no_response;

  friend bool operator==(const HostError&, const HostError&) = default;
};

// Of one node, since power-up.
struct HostCounters {
  std::uint64_t timeouts = 0;  // attempts that nothing answered
  std::uint64_t rejected = 0;  // attempts that were answered wrongly
  std::uint64_t late = 0;      // frames behind a time-out, before anything else was sent
  std::uint64_t retries = 0;

  friend bool operator==(const HostCounters&, const HostCounters&) = default;
};

// What the host tells its PC. It must not be written to from here. Instants never decrease.
class HostApplication {
 public:
  virtual ~HostApplication() = default;
  virtual void on_response(const HostResponse& response, kernel::Time when) = 0;
  virtual void on_error(const HostError& error, kernel::Time when) = 0;
};

class HostDevice : public segment::Station {
 public:
  virtual iut::Capabilities capabilities() const { return {}; }
  // Of what it drove when its driver came on at this instant.
  virtual iut::TimingUncertainty uncertainty_of_request(kernel::Time) const { return {}; }
  virtual void wire(segment::Port& line, HostApplication& application) = 0;
  // The supply comes and goes; a host begins without it. Power-up is the only reset.
  virtual void set_power(bool is_on, kernel::Time now) = 0;
  // The switches are turned; a host reads them at power-up.
  virtual void set_dip(unsigned position) = 0;

  // Octets from the PC into the FIFO: commands of four octets, ID COMMAND DATA0 DATA1, one after the other.
  virtual void write(std::span<const std::uint8_t> octets, kernel::Time now) = 0;
  virtual std::size_t fifo_room() const = 0;  // octets
  // Commands have been lost since power-up.
  virtual bool has_overflowed() const = 0;
  virtual HostCounters counters(std::uint8_t id) const = 0;
};

}  // namespace fieldproof::valve_bus
