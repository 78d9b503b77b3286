#include "protocols/valve_bus/network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/config/name.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::valve_bus {
namespace {

using config::ObjectReader;
using config::Value;

constexpr double kLongestCable = 100'000;  // m: more is a slip of the pen

CharacterProfile read_characters(const Value& value) {
  return value.as_choice<CharacterProfile>({{"P0", CharacterProfile::ninth_bit_one},
                                            {"P1", CharacterProfile::even_parity},
                                            {"P2", CharacterProfile::eight_bits}});
}

NodeDescription read_node(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    NodeDescription node;
    node.address = object.required("address").as_integer<unsigned>(0, 255);
    if (const auto at = object.optional("at")) node.at_m = at->as_length_m(0, kLongestCable);
    return node;
  });
}

CopyRule read_copy(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    return CopyRule{object.required("from").as_integer<unsigned>(0, 255),
                    object.required("to").as_integer<unsigned>(0, 255)};
  });
}

std::vector<NodeDescription> spread_evenly(unsigned count, double length_m) {
  std::vector<NodeDescription> nodes;
  for (unsigned n = 0; n < count; ++n) nodes.push_back({n + 1, length_m * (n + 1) / std::max(1U, count)});
  return nodes;
}

bool has(const NetworkDescription& network, unsigned address) {
  return std::ranges::find(network.nodes, address, &NodeDescription::address) != network.nodes.end();
}

std::optional<config::Violation> violation_of_nodes(const NetworkDescription& network) {
  const Rules& rules = network.rules;
  const unsigned most = rules.last_address - rules.first_address + 1;
  if (network.nodes.empty() || network.nodes.size() > most) {
    return {{"/nodes",
             fmt::format("{} nodes: a bus has 1 to {}, because two decimal switches set addresses {} to {}",
                         network.nodes.size(), most, rules.first_address, rules.last_address)}};
  }
  std::set<unsigned> seen;
  double before = 0;
  for (std::size_t n = 0; n < network.nodes.size(); ++n) {
    const NodeDescription& node = network.nodes[n];
    const std::string at = fmt::format("/nodes/{}", n);
    if (node.address < rules.first_address || node.address > rules.last_address) {
      return {{at + "/address", fmt::format("address {}: a node has one from {} to {}", node.address,
                                            rules.first_address, rules.last_address)}};
    }
    if (!seen.insert(node.address).second)
      return {
          {at + "/address", fmt::format("address {} is there already; each node has its own", node.address)}};
    if (node.at_m < before || node.at_m > network.length_m) {
      return {
          {at + "/at",
           fmt::format("the node with address {} lies at {} m; nodes are named in the order of the cable, "
                       "and it ends at {} m",
                       node.address, node.at_m, network.length_m)}};
    }
    before = node.at_m;
  }
  return std::nullopt;
}

}  // namespace

NetworkDescription NetworkDescription::even(unsigned dip, unsigned nodes, double length_m) {
  NetworkDescription network;
  network.name = fmt::format("{} nodes on {:g} m", nodes, length_m);
  network.dip = dip;
  network.length_m = length_m;
  network.nodes = spread_evenly(nodes, length_m);
  if (const auto violation = violation_of(network)) {
    throw kernel::Error(kernel::ErrorKind::configuration, violation->sentence);
  }
  network.rules.bit_rate = dip_bit_rates()[dip];
  return network;
}

namespace {

unsigned number_of_nodes(const Value& nodes) {
  const auto number = nodes.as_integer<std::int64_t>();
  const Rules rules;
  if (number >= 1 && number <= rules.last_address) return static_cast<unsigned>(number);
  config::fail(
      nodes, fmt::format("{} nodes: write 1 to {}, because two decimal switches give a node its address, or "
                         "an array of nodes",
                         number, rules.last_address));
}

}  // namespace

NetworkDescription NetworkDescription::read(const Value& root) {
  NetworkDescription network = config::read_object(root, [](ObjectReader& object) {
    NetworkDescription read;
    object.optional("$schema");
    read.name = config::read_name(object.required("name"));
    const auto most_dip = static_cast<unsigned>(dip_bit_rates().size() - 1);
    if (const auto dip = object.optional("bit_rate_switches"))
      read.dip = dip->as_integer<unsigned>(0, most_dip);
    if (const auto cable = object.optional("cable")) read.length_m = cable->as_length_m(0, kLongestCable);
    if (const auto characters = object.optional("characters"))
      read.rules.characters = read_characters(*characters);
    if (const auto answers = object.optional("answers_writes"))
      read.rules.answers_writes = answers->as_bool();
    if (const auto writes = object.optional("writes")) read.writes = writes->as_bool();
    const Value nodes = object.required("nodes");
    if (nodes.is_array()) {
      for (const Value& node : nodes.as_array(1)) read.nodes.push_back(read_node(node));
    } else {
      read.nodes = spread_evenly(number_of_nodes(nodes), read.length_m);
    }
    if (const auto copy = object.optional("copy")) {
      for (const Value& rule : copy->as_array()) read.copy.push_back(read_copy(rule));
    }
    return read;
  });
  network.rules.bit_rate = dip_bit_rates()[network.dip];
  if (const auto violation = violation_of(network)) config::fail(root, *violation);
  return network;
}

NetworkDescription NetworkDescription::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

std::optional<config::Violation> violation_of(const NetworkDescription& network) {
  if (network.dip >= dip_bit_rates().size()) {
    return {{"/bit_rate_switches",
             fmt::format("position {} of the bit-rate switches is none; positions 0 to {} are", network.dip,
                         dip_bit_rates().size() - 1)}};
  }
  if (auto violation = violation_of_nodes(network)) return violation;
  const Rules& rules = network.rules;
  const double segments = 1 + repeaters_before(rules, network.nodes.size() - 1);
  if (network.length_m > rules.max_length_m * segments) {
    return {{"/cable",
             fmt::format("a cable of {} m: {:g} segments of RS-485 reach {:g} m ({} m each, {} unit loads)",
                         network.length_m, segments, rules.max_length_m * segments, rules.max_length_m,
                         rules.unit_loads)}};
  }
  std::set<unsigned> written;
  for (std::size_t n = 0; n < network.copy.size(); ++n) {
    const CopyRule& rule = network.copy[n];
    for (const auto& [key, address] : {std::pair{"from", rule.from}, std::pair{"to", rule.to}}) {
      if (!has(network, address))
        return {{fmt::format("/copy/{}/{}", n, key),
                 fmt::format("a copy names address {}, which no node has", address)}};
    }
    if (!written.insert(rule.to).second)
      return {{fmt::format("/copy/{}/to", n),
               fmt::format("the valves of address {} are written by two copies; leave one", rule.to)}};
  }
  return std::nullopt;
}

unsigned repeaters_before(const Rules& rules, std::size_t node) {
  const unsigned first = rules.unit_loads - 1;   // with the host
  const unsigned others = rules.unit_loads - 2;  // between two repeaters
  return node < first ? 0 : 1 + (static_cast<unsigned>(node) - first) / others;
}

kernel::Duration distance_to(const NetworkDescription& network, std::size_t node) {
  const auto cable =
      std::llround(network.nodes.at(node).at_m * static_cast<double>(network.rules.cable_delay_ps_per_m));
  return kernel::Duration{cable} + repeaters_before(network.rules, node) * network.rules.repeater_delay;
}

}  // namespace fieldproof::valve_bus
