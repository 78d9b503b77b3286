#include "protocols/fieldbus_dll/token_network.hpp"

#include <fmt/format.h>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using config::ObjectReader;
using config::Value;

constexpr std::int64_t kOctetBits = 8;

traffic::PacketStream stream_from(const Value& value, std::int64_t bit_rate) {
  return config::read_object(value, [&](ObjectReader& o) {
    traffic::PacketStream stream;
    const Value octets = o.required("octets");
    stream.length = kernel::levels_duration(octets.as_integer<std::int64_t>(1, 1'000) * kOctetBits, bit_rate);
    if (stream.length > traffic::kLongestTokenTime)
      config::fail(octets, "this takes more than 1 s on the line");
    const Value rate = o.required("per_s");
    stream.per_ms = rate.as_number(0, traffic::kMostPerMs * 1e3) / 1e3;
    if (stream.per_ms > 0 && stream.per_ms < traffic::kLeastPerMs) {
      config::fail(rate, "so rare packets are not simulated; write 0, or 0.001 or more");
    }
    return stream;
  });
}

void add_nodes(const Value& value, std::int64_t bit_rate, traffic::TokenTraffic& traffic) {
  config::read_object(value, [&](ObjectReader& o) {
    traffic::TokenNode node;
    node.overhead = o.required("overhead").as_duration(kernel::kNanosecond, traffic::kLongestTokenTime);
    if (const auto urgent = o.optional("urgent"))
      node.streams[traffic::kUrgent] = stream_from(*urgent, bit_rate);
    if (const auto normal = o.optional("normal"))
      node.streams[traffic::kNormal] = stream_from(*normal, bit_rate);
    if (const auto rest = o.optional("time_available")) {
      node.streams[traffic::kTimeAvailable] = stream_from(*rest, bit_rate);
    }
    const auto count = o.optional("count");
    const std::size_t nodes = count ? count->as_integer<std::size_t>(1, traffic::kMostTokenNodes) : 1;
    if (traffic.nodes.size() + nodes > traffic::kMostTokenNodes) {
      config::fail(value, fmt::format("these are more than {} nodes together", traffic::kMostTokenNodes));
    }
    traffic.nodes.insert(traffic.nodes.end(), nodes, node);
  });
}

void read_schedule(const Value& value, traffic::TokenTraffic& traffic) {
  config::read_object(value, [&](ObjectReader& o) {
    traffic.macrocycle =
        o.required("macrocycle").as_duration(kernel::kMicrosecond, traffic::kLongestMacrocycle);
    for (const Value& item : o.required("items").as_array(1, traffic::kMostScheduledItems)) {
      traffic.schedule.push_back(config::read_object(item, [&](ObjectReader& i) {
        return traffic::ScheduledItem{
            .offset = i.required("offset").as_duration({}, traffic.macrocycle),
            .length = i.required("length").as_duration(kernel::kNanosecond, traffic.macrocycle)};
      }));
    }
  });
}

DelayBound bound_from(const Value& value) {
  return config::read_object(value, [](ObjectReader& o) {
    DelayBound bound;
    bound.at_most = o.required("at_most").as_duration(kernel::kMicrosecond, 1'000 * kernel::kSecond);
    if (const auto share = o.optional("share")) bound.share = share->as_number(0.01, 0.99999);
    return bound;
  });
}

}  // namespace

TokenNetwork TokenNetwork::read(const config::Document& document) {
  return config::read_object(document.root(), [](ObjectReader& o) {
    TokenNetwork network;
    network.name = o.required("name").as_string();
    const std::int64_t bit_rate = o.required("bit_rate").as_bit_rate(1'000, 100'000'000);
    const Value nodes = o.required("nodes");
    for (const Value& node : nodes.as_array(1, traffic::kMostTokenNodes))
      add_nodes(node, bit_rate, network.traffic);
    bool has_urgent = false;
    for (const traffic::TokenNode& node : network.traffic.nodes)
      has_urgent |= node.streams[traffic::kUrgent].per_ms > 0;
    if (!has_urgent)
      config::fail(nodes, "no node has urgent packets; one needs \"urgent\" with a rate over 0");
    if (const auto rule = o.optional("rule")) {
      network.traffic.rule = rule->as_choice<traffic::TokenRule>(
          {{"one_step", traffic::TokenRule::one_step}, {"all_or_urgent", traffic::TokenRule::all_or_urgent}});
    }
    if (const auto schedule = o.optional("schedule")) {
      read_schedule(*schedule, network.traffic);
      try {
        check(network.traffic);
      } catch (const kernel::Error& error) {
        config::fail(*schedule, error.what());
      }
    }
    network.bound = bound_from(o.required("urgent_delay"));
    return network;
  });
}

}  // namespace fieldproof::fieldbus_dll
