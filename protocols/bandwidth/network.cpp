#include "protocols/bandwidth/network.hpp"

#include <fmt/format.h>

#include "harness/field/json_reader.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::bandwidth {
namespace {

using config::ObjectReader;
using config::Value;
using kernel::Duration;

std::vector<QueueTraffic> queues_of(const std::vector<QueueDescription>& described) {
  std::vector<QueueTraffic> queues;
  for (const QueueDescription& one : described) {
    for (unsigned node = one.first; node <= one.last; ++node)
      queues.push_back({.node = static_cast<std::uint8_t>(node), .mean_gap = one.mean_gap});
  }
  return queues;
}

void check_order(const std::vector<QueueDescription>& queues, const Value& value) {
  for (const QueueDescription& one : queues) {
    if (one.first > one.last) {
      config::fail(value, fmt::format("from node {} to node {} there is none; \"first\" is the lower one",
                                      one.first, one.last));
    }
  }
}

void check_network(const Network& network, ObjectReader& object) {
  const std::vector<Value> loops = object.required("loops").as_array();
  for (std::size_t n = 0; n < network.loops.size(); ++n) {
    if (network.loops[n].bound == Duration::zero())
      config::fail(loops.at(n), "a loop has a \"bound\" of its delay, such as \"60 ms\"");
  }
  if (const auto value = object.optional("real_time")) check_order(network.real_time, *value);
  if (const auto value = object.optional("non_real_time")) check_order(network.non_real_time, *value);
  if (network.access == Access::token && network.empty_answer > Duration::zero()) {
    config::fail(object.required("empty_answer"),
                 "a node that passes a token answers nothing; polling has empty answers");
  }
  try {
    const Allocation allocation = allocate(network.demand());
    check(network.traffic(allocation));
  } catch (const kernel::Error& error) {
    config::fail(object.value(), error.what());
  }
}

}  // namespace

std::string_view text_of(Access access) {
  return access == Access::token ? "token" : "polling";
}

Demand Network::demand() const {
  Demand demand;
  demand.rule = rule;
  for (const LoopDescription& loop : loops) demand.bounds.push_back(loop.bound);
  demand.nodes = nodes;
  demand.real_time_queues = static_cast<unsigned>(queues_of(real_time).size());
  demand.overhead = server_overhead + empty_answer;
  demand.periodic_packet = periodic_packet;
  demand.real_time_packet = real_time_packet;
  return demand;
}

Duration Network::packet_of(const Allocation& allocation) const {
  if (non_real_time_packet > Duration::zero()) return non_real_time_packet;
  return std::max(allocation.longest(length_rule), Duration::zero());
}

WindowTraffic Network::traffic(const Allocation& allocation) const {
  WindowTraffic traffic;
  traffic.nodes = nodes;
  traffic.slot = allocation.slot;
  traffic.overhead = server_overhead;
  traffic.empty_answer = empty_answer;
  traffic.periodic_packet = periodic_packet;
  traffic.real_time_packet = real_time_packet;
  traffic.non_real_time_packet = packet_of(allocation);
  for (std::size_t n = 0; n < loops.size(); ++n) {
    const LoopShare& share = allocation.loops[n];
    traffic.loops.push_back({.sensor = loops[n].sensor,
                             .controller = loops[n].controller,
                             .every = share.every,
                             .sensor_offset = share.sensor_offset,
                             .controller_offset = share.controller_offset,
                             .skew = loops[n].skew});
  }
  traffic.real_time = queues_of(real_time);
  traffic.non_real_time = queues_of(non_real_time);
  return traffic;
}

Network Network::read(const config::Document& document) {
  return config::read_object(document.root(), [](ObjectReader& object) {
    Network network;
    network.name = object.required("name").as_string();
    object.required("nodes");
    object.required("loops").as_array(1, kMostLoops);
    field::read_members(object, kNetworkTable, network);
    check_network(network, object);
    return network;
  });
}

}  // namespace fieldproof::bandwidth
