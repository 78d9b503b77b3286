#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/field/field.hpp"
#include "protocols/bandwidth/allocation.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

// A network whose bandwidth is to be allocated, as a file has it (bandwidth_network.schema.json).
namespace fieldproof::bandwidth {

enum class Access : std::uint8_t { token, polling };
std::string_view text_of(Access access);

struct LoopDescription {
  kernel::Duration bound{};  // of the loop delay; there is no default
  std::uint8_t sensor = 0;   // nodes
  std::uint8_t controller = 1;
  kernel::Duration skew{};  // of the controller's sampling, after the common grid

  friend bool operator==(const LoopDescription&, const LoopDescription&) = default;
};

// One queue at each node from `first` to `last`.
struct QueueDescription {
  std::uint8_t first = 0;
  std::uint8_t last = 0;
  kernel::Duration mean_gap{};  // of its packets; 0: not known, only adversaries send

  friend bool operator==(const QueueDescription&, const QueueDescription&) = default;
};

struct Network {
  std::string name;
  Access access = Access::token;
  Rule rule = Rule::hong;
  LengthRule length_rule = LengthRule::safe;
  unsigned nodes = 2;
  kernel::Duration server_overhead = 100 * kernel::kMicrosecond;
  kernel::Duration empty_answer{};  // of a node that is polled and has nothing
  kernel::Duration periodic_packet = 400 * kernel::kMicrosecond;
  kernel::Duration real_time_packet = 200 * kernel::kMicrosecond;
  kernel::Duration non_real_time_packet{};  // 0: the longest that the rule allows
  std::vector<LoopDescription> loops;
  std::vector<QueueDescription> real_time;
  std::vector<QueueDescription> non_real_time;

  Demand demand() const;
  // Of the file, or the longest that the rule allows; 0 where there is no room for any.
  kernel::Duration packet_of(const Allocation& allocation) const;
  // Throws kernel::Error(configuration) for a skew of a slot or more.
  WindowTraffic traffic(const Allocation& allocation) const;

  // Throws kernel::Error(configuration), which says where and what would be right.
  static Network read(const config::Document& document);
};

extern const field::Table<Network>& kNetworkTable;

}  // namespace fieldproof::bandwidth
