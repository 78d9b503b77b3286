#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/fault/known_names.hpp"
#include "harness/fault/plan.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/cycle_fields.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/terminal_block.hpp"

// The stations of a network, wired to a ring: for each station a forward link to it and a return link from
// it, both as long as its cable. What sits at the master's place (a master, or a lower tester that plays one)
// is attached to the segment by the caller and wired with `out()`.
//
// What the trace is told: each change of an output, as "output" at "slave@3" with word * 65536 + value, at
// the instant of the change.
//
// Receivers, and so the links to them, are named "slave@3/in", "slave@3/return" (from after OUT1),
// "slave@3/branch_return" (from after OUT2) and "master/in"; positions count from 1 in ring order.
namespace fieldproof::interbus {

class Ring {
 public:
  // Makes the slave at a position (from 1); null means the reference.
  using MakeSlave = std::function<std::unique_ptr<SlaveDevice>(int position, const SlaveConfiguration&)>;

  Ring(segment::Segment& segment, const NetworkDescription& network, std::size_t master_seat,
       const MakeSlave& make_slave = nullptr);

  segment::Port& out() { return *links_.front().forward; }

  std::size_t size() const { return slaves_.size(); }
  SlaveDevice& slave(int position) { return *slaves_.at(index(position)).device; }
  TerminalBlock& terminals(int position) { return slaves_.at(index(position)).terminals; }
  const SlaveConfiguration& configuration(int position) const {
    return slaves_.at(index(position)).configuration;
  }
  std::size_t seat(int position) const { return slaves_.at(index(position)).seat; }

  segment::Link& link_to(int position) { return *links_.at(index(position)).forward; }
  segment::Link& link_from(int position) { return *links_.at(index(position)).back; }
  // A receiver's link by its name, null when there is none.
  segment::Link* find_link(std::string_view receiver);
  // All receivers in ring order, each with the octets that reach it in front of the loopback word.
  struct Receiver {
    segment::Link* link;
    CycleFields::InFront in_front;
  };
  std::vector<Receiver> receivers();
  std::vector<segment::Link*> links();
  // Both directions of the cables of the remote bus, in ring order: what lies in the clamp of a burst test.
  std::vector<segment::Link*> remote_links();

  // Puts the channels of a fault plan on the receivers that its rules can mean. The plan must outlive the
  // ring. Throws kernel::Error(configuration) for a rule that names what a ring does not have.
  void install(fault::InstalledPlan& plan);

  // Positions of the image words: first word of a station in the master's images.
  unsigned first_word(int position) const { return slaves_.at(index(position)).first_word; }
  unsigned word_count() const { return word_count_; }

  // The bench is done with all of them.
  void end();

  // The cable to the station is cut, both directions, or mended.
  void set_cable(int position, bool connected);

 private:
  struct Place {
    std::unique_ptr<SlaveDevice> device;
    SlaveConfiguration configuration;
    TerminalBlock terminals;
    SlavePorts ports;
    std::size_t seat;
    unsigned first_word;
  };
  struct Cable {
    segment::Link* forward = nullptr;
    segment::Link* back = nullptr;
  };

  fault::KnownNames known_names();
  static std::size_t index(int position) { return static_cast<std::size_t>(position - 1); }
  void add_station(const NetworkDescription& network, const RingPlace& place, const MakeSlave& make_slave);
  void find_last_behind(const std::vector<RingPlace>& places);
  CycleFields::InFront in_front_of(std::size_t station) const;
  void lay_cable(const NetworkDescription& network, const RingPlace& place, std::size_t n);

  segment::Segment& segment_;
  std::size_t master_seat_;
  std::deque<Place> slaves_;
  std::vector<Cable> links_;
  std::vector<std::size_t> last_behind_;  // index of the last station that hangs behind this one, or its own
  unsigned word_count_ = 0;
};

// The master's configuration for a network: expected stations, requested cycle time, copy task.
MasterConfiguration master_configuration(const NetworkDescription& network);

}  // namespace fieldproof::interbus
