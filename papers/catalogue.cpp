#include "papers/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "harness/kernel/error.hpp"

namespace fieldproof::papers {
namespace {

constexpr std::array<Reproduce, 4> kInterbus = {&interbus_cycle_times, &interbus_highest_frequency,
                                                &interbus_square_waves, &interbus_bursts};
constexpr std::array<Reproduce, 4> kValveBus = {&valve_bus_cycle_times, &valve_bus_sentences,
                                                &valve_bus_block_check, &valve_bus_resonance};
constexpr std::array<Reproduce, 6> kFoundation = {&foundation_rotations, &foundation_sentences,
                                                  &foundation_targets,   &foundation_shares,
                                                  &foundation_lengths,   &foundation_stations};
constexpr std::array<Reproduce, 3> kControlLoop = {&control_loop_quiet, &control_loop_under_bursts,
                                                   &control_loop_with_operator};
constexpr std::array<Reproduce, 5> kBandwidth = {&bandwidth_periodic, &bandwidth_non_real_time,
                                                 &bandwidth_real_time, &bandwidth_loop, &bandwidth_stations};
constexpr std::array<Reproduce, 4> kControlNetwork = {&control_network_coding, &control_network_rotation,
                                                      &control_network_access, &control_network_recovery};

constexpr std::array kPapers = {
    Paper{"interbus", "J.-H. Park, The Study on the Cycling Time for Interbus, 2004",
          "of the cycle-time paper", kernel::kMillisecond, kInterbus},
    Paper{"valve_bus",
          "D.-S. Kim, H.-S. Seo and W.-H. Lee, pneumatic control systems by fieldbus communication",
          "of the valve bus", kernel::kMillisecond, kValveBus},
    Paper{"foundation",
          "S. H. Hong and B. K. Son, Delay Analysis of Urgent Data in the Foundation Fieldbus, 2003",
          "of 16 nodes at 1 Mbit/s", kernel::kSecond, kFoundation},
    Paper{"fieldbus",
          "S.-H. Hong, K.-A. Kim, J.-Y. Kim and S.-J. Ko, distributed control and automation systems and "
          "fieldbus",
          "of a control loop and eight other nodes", kernel::kMillisecond, kControlLoop},
    Paper{"bandwidth",
          "S.-H. Hong, K.-A. Kim, J.-Y. Kim and S.-J. Ko, distributed control and automation systems and "
          "fieldbus: bandwidth allocation",
          "of four control loops and ten nodes", kernel::kMillisecond, kBandwidth},
    Paper{"control_network",
          "J.-Y. Lee, H.-j. Moon, S. Y. Moon, W.-H. Kwon, S. W. Lee and Park, token-passing bus access "
          "method on "
          "IEEE 802.3 physical layer for control networks of a distributed control system",
          "of 16 stations at 10 Mbit/s", kernel::kMillisecond, kControlNetwork},
};

}  // namespace

std::span<const Paper> catalogue() {
  return kPapers;
}

const Paper& paper_named(std::string_view name) {
  const auto found = std::ranges::find(kPapers, name, &Paper::name);
  if (found != kPapers.end()) return *found;
  std::vector<std::string_view> names;
  for (const Paper& paper : kPapers) names.push_back(paper.name);
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no paper '{}'; there are '{}'", name, fmt::join(names, "', '")));
}

}  // namespace fieldproof::papers
