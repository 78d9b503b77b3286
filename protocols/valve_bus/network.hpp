#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/valve_bus/rules.hpp"

// A valve bus as a file describes it: the host's switches, the cable, the nodes along it, and what the PC
// does in a cycle.
//
//   { "name": "press 3", "bit_rate_switches": 0, "cable": "400 m",
//     "nodes": [ { "address": 1, "at": "20 m" }, { "address": 7, "at": "390 m" } ],
//     "copy": [ { "from": 1, "to": 7 } ] }
//
// Reading is strict (network.schema.json has the shape); an unknown key, an address that two nodes have, a
// node beyond the cable, more nodes than there are addresses is a kernel::Error that names line and pointer
// and says what would be right.
namespace fieldproof::valve_bus {

struct NodeDescription {
  unsigned address = 1;
  double at_m = 0;  // from the host
};

// The PC writes the limit switches of one node to the valves of another, as soon as it has read them.
struct CopyRule {
  unsigned from = 0;  // addresses
  unsigned to = 0;
};

struct NetworkDescription {
  std::string name;
  Rules rules;                         // their bit rate is that of the switches
  unsigned dip = 0;                    // position of the host's switches
  double length_m = 1000;              // of the cable
  std::vector<NodeDescription> nodes;  // in the order of the cable
  // In each cycle the PC writes the valves of every node before it reads its limit switches; else it writes
  // only what it copies.
  bool writes = true;
  std::vector<CopyRule> copy;

  // So many nodes, spread evenly, addresses from 1 on. Throws kernel::Error(configuration) as `load`.
  static NetworkDescription even(unsigned dip, unsigned nodes, double length_m);
  static NetworkDescription load(const std::filesystem::path& path);
  static NetworkDescription read(const config::Value& root);
};

// The first thing in a description that no bus has, as a sentence with what would be right.
std::optional<config::Violation> violation_of(const NetworkDescription& network);

// Repeaters between the host and the node with this index: after each 30 nodes (31 on the host's segment).
unsigned repeaters_before(const Rules& rules, std::size_t node);
// From the host to that node, as time.
kernel::Duration distance_to(const NetworkDescription& network, std::size_t node);

}  // namespace fieldproof::valve_bus
