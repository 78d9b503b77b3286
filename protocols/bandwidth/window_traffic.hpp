#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/bandwidth/window_figures.hpp"
#include "protocols/bandwidth/window_server.hpp"

// Control loops, real-time and non-real-time queues under a server that visits node after node, packet for
// packet, without frames and levels: how long do data wait, are any lost, does a controller sample in vain?
//
// The server is at its first node at 0. What a node sends is WindowVisit's decision; then the server takes
// its overhead to the next node. Polling: a node whose visit no periodic and no non-real-time packet has
// ended answers with an empty frame first.
//
// A sensor samples at the beginning of its slots, a controller at the beginning of its slots plus its skew. A
// node has one place for periodic data: what is sampled replaces what waits there, which is lost. A
// controller computes with the newest sensor datum that has arrived, also at the instant of its sampling; it
// does nothing before the first one. When several have arrived since its last sampling all but the newest are
// lost, when none has the sampling is vacant.
namespace fieldproof::bandwidth {

struct LoopTraffic {
  std::uint8_t sensor = 0;
  std::uint8_t controller = 1;  // nodes; each has one stream at most
  unsigned every = 1;           // slots
  unsigned sensor_offset = 0;
  unsigned controller_offset = 0;
  kernel::Duration skew{};  // of the controller; under a slot
};

struct QueueTraffic {
  std::uint8_t node = 0;
  kernel::Duration mean_gap{};  // of Poisson arrivals; 0: none come
};

struct WindowTraffic {
  unsigned nodes = 0;
  kernel::Duration slot{};
  kernel::Duration overhead{};      // from the end of a visit to the begin of the next one
  kernel::Duration empty_answer{};  // of a visit without a periodic or non-real-time packet
  kernel::Duration periodic_packet{};
  kernel::Duration real_time_packet{};
  kernel::Duration non_real_time_packet{};
  bool has_periodic_byte = true;  // else non-real-time packets go at all times, as in any cyclic service
  std::vector<LoopTraffic> loops;
  std::vector<QueueTraffic> real_time;
  std::vector<QueueTraffic> non_real_time;  // at most one of each kind at a node

  // Slots after which all loops repeat; every is a power of two.
  unsigned repeats_after() const;
  // Data that come in this slot, by node.
  std::vector<std::uint8_t> nodes_with_data(std::uint64_t number) const;
};

// When a queue has a packet to send.
enum class Load : std::uint8_t {
  none,
  arriving,   // as its packets arrive
  saturated,  // always
  random,     // in each slot with another probability
  // So that the server is on its way into a packet when the data of a slot come, at the node from where their
  // last one waits longest; always until they are sent.
  just_late,
};
const char* name_of(Load load);

struct Sent {
  Packet packet;
  std::uint8_t node;
  kernel::Time begin;
  kernel::Time end;
  kernel::Time generated;  // of periodic data
  PeriodicByte byte{};     // with which the server is at the node meanwhile
};

struct WindowRun {
  std::uint64_t seed = 1;
  std::uint64_t slots = 100'000;  // that are counted
  Load real_time = Load::arriving;
  Load non_real_time = Load::arriving;
  std::uint8_t first_node = 0;
  // The server begins with a non-real-time packet of the first node, whose periodic queue it has just seen.
  bool begins_in_packet = false;
  std::function<void(const Sent&)> on_sent{};
};

// Slots before the first that counts: by then each controller has got its first datum, if it comes in time.
std::uint64_t slots_of_start(const WindowTraffic& traffic);

// The longest delay of a datum of this slot, whatever non-real-time and real-time queues do, for this order
// of nodes: the server has just begun a packet at each node in turn.
kernel::Duration slowest_datum(const WindowTraffic& traffic, std::uint64_t slot);

// Throws kernel::Error(configuration) for nodes that are not there or have two streams, for times that are
// negative, a slot of 0, an overhead of 0 and a skew of a slot or more.
void check(const WindowTraffic& traffic);
WindowFigures run_windows(const WindowTraffic& traffic, const WindowRun& run);

}  // namespace fieldproof::bandwidth
