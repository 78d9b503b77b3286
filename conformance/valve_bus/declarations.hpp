#pragma once

#include <vector>

#include "harness/judge/pics.hpp"
#include "protocols/valve_bus/device.hpp"

// What is declared of a node and of a host in a PICS: how it is configured, in the words of its settings, and
// what the bench can do to it.
namespace fieldproof::conformance {

struct NodeDeclaration {
  valve_bus::NodeConfiguration configuration{.rules = {}, .address_tens = 0, .address_units = 5, .boards = 2};
  bool address_switches_can_be_set = true;
  kernel::Duration start_up_time{};  // from power-up to where it hears the line
  bool power_can_be_switched = true;
};

struct HostDeclaration {
  valve_bus::HostConfiguration configuration{};
  bool dip_can_be_set = true;
  bool takes_early_responses = false;
  bool power_can_be_switched = true;
};

std::vector<judge::PicsItem> node_pics_items();
// Of the reference, at address 5.
judge::Pics declared_node();
NodeDeclaration node_declared_in(const judge::Pics& pics);

std::vector<judge::PicsItem> host_pics_items();
judge::Pics declared_host();
HostDeclaration host_declared_in(const judge::Pics& pics);

}  // namespace fieldproof::conformance
