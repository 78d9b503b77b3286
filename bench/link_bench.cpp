// Sixteen stations of Foundation Fieldbus at full fidelity: how much faster than a real link are they?
//
// Each frame is encoded to half bits, driven, heard by all and decoded again. The peer is real time, so the
// ratio says how many seconds of the link are simulated in one.
#include <cstdint>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bench/rows.hpp"
#include "protocols/fieldbus_dll/ff_link.hpp"

namespace fieldproof::bench {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr std::uint8_t kScheduler = 0x10;
constexpr std::uint8_t kStations = 16;
constexpr std::uint8_t kPublishers = 4;
constexpr std::uint8_t kSelector = 0x20;
constexpr std::uint32_t kMacrocycle = 16'000;  // ticks: 500 ms

// A scheduler and 15 nodes. Four publish once in a macrocycle, the others send a message of 64 octets each.
class FullLink {
 public:
  FullLink() : link_({}, kernel::Random(1)) {
    link_.on_driven([this](const fieldbus_dll::FfDriven& one) {
      if (one.dlpdu.type == fieldbus_dll::FfType::dt3) ++published_;
      if (one.dlpdu.type == fieldbus_dll::FfType::dt1) ++messages_;
    });
    link_.add_master(configuration_of(kScheduler), user_);
    for (std::uint8_t n = 1; n < kStations; ++n) {
      const auto node = static_cast<std::uint8_t>(kScheduler + n);
      link_.add_device(configuration_of(node), user_);
      if (is_publisher(node)) link_.write(node, fieldbus_dll::address_of(node, kSelector), {1, 2, 3, 4, 5});
    }
    run_macrocycles(20);  // all become live
    if (published_ < kPublishers * 10 || messages_ < kStations * 10)
      throw std::logic_error("the link of the benchmark is not busy");
  }

  void run_macrocycles(unsigned count) {
    for (unsigned n = 0; n < count; ++n) {
      for (std::uint8_t node = kScheduler + 1; node < kScheduler + kStations; ++node) {
        if (!is_publisher(node))
          link_.submit(node, {Priority::normal, fieldbus_dll::address_of(kScheduler, kSelector),
                              fieldbus_dll::Octets(64, node)});
      }
      link_.run_to(link_.now() + kMacrocycle * fieldbus_dll::kTick);
    }
  }

 private:
  static bool is_publisher(std::uint8_t node) {
    return node > kScheduler && node <= kScheduler + kPublishers;
  }

  static FfConfiguration configuration_of(std::uint8_t node) {
    FfConfiguration configuration;
    configuration.node = node;
    if (is_publisher(node)) configuration.published = {fieldbus_dll::address_of(node, kSelector)};
    if (node != kScheduler) return configuration;
    configuration.begins_as_scheduler = true;
    configuration.schedule = {.version = 1, .macrocycle = kMacrocycle, .items = {}};
    for (std::uint8_t n = 0; n < kPublishers; ++n) {
      configuration.schedule.items.push_back(
          {n * kMacrocycle / kPublishers + 100,
           fieldbus_dll::address_of(static_cast<std::uint8_t>(kScheduler + 1 + n), kSelector),
           Priority::normal});
    }
    return configuration;
  }

  fieldbus_dll::FfSilentUser user_;
  fieldbus_dll::FfLink link_;
  std::uint64_t published_ = 0;
  std::uint64_t messages_ = 0;
};

// The link itself takes a millisecond for a millisecond.
std::uint64_t real_time() {
  const std::clock_t end = std::clock() + CLOCKS_PER_SEC / 1'000;
  while (std::clock() < end) {
  }
  return 1;
}

Batch simulated_link() {
  return [link = std::make_shared<FullLink>()] {
    constexpr unsigned kMacrocycles = 2;
    link->run_macrocycles(kMacrocycles);
    return std::uint64_t{kMacrocycles * kMacrocycle / 32};
  };
}

// At least 200 times real time is asked for.
const Rows kLink({{"sixteen stations at 31.25 kbit/s", "real time", "ms of the link", "", 0,
                   [] { return Batch(&real_time); }},
                  {"sixteen stations at 31.25 kbit/s", "stations, frames and half bits", "ms of the link",
                   "real time", 200, &simulated_link}});

}  // namespace
}  // namespace fieldproof::bench
