#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/document.hpp"
#include "protocols/token_bus/cable_rules.hpp"
#include "protocols/token_bus/channel_selection.hpp"
#include "protocols/token_bus/frame.hpp"

// A ring of the token bus as a file describes it: stations, and data that go between them by the services of
// a plant instrumentation and control network (PICNET).
//
//   { "name": "boiler", "stations": [2, 4, 6, 8],
//     "data": [ { "from": 2, "to": 4 },
//               { "from": 4, "to": 2, "service": "periodic", "every": "10 ms", "octets": 32 },
//               { "from": 6, "to": 8, "service": "bulk", "load": "100 kbit/s", "octets": 1000 } ],
//     "cable": "700 m", "repeaters": ["350 m"], "slot_time_octets": 34 }
namespace fieldproof::token_bus {

// The paper names them: urgent data in real time, periodic data, advanced services. Which access class
// carries which, and that advanced services are these two, is this project's choice.
enum class RingService : std::uint8_t {
  urgent,     // class 6
  periodic,   // class 4
  confirmed,  // class 2: a request with response
  bulk        // class 0
};
inline constexpr std::array kRingServices{RingService::urgent, RingService::periodic, RingService::confirmed,
                                          RingService::bulk};
std::string_view text_of(RingService service);
inline unsigned priority_of(RingService service) {
  return 6 - 2 * static_cast<unsigned>(service);
}
inline Action action_of(RingService service) {
  return service == RingService::confirmed ? Action::request_with_response : Action::request_with_no_response;
}

// Number of the flow, number of the datum, a word.
inline constexpr std::size_t kLeastDatum = 5;

// One flow of data. Neither `every` nor `load`: a datum under each token of its station.
struct RingData {
  Address from = 0;
  Address to = 0;
  RingService service = RingService::urgent;
  kernel::Duration every{};
  std::int64_t load = 0;  // bit/s of data, at random instants
  std::size_t octets = kLeastDatum;

  bool is_under_each_token() const { return every == kernel::Duration{} && load == 0; }
  // From a datum to the next, on average; zero under each token.
  kernel::Duration mean_gap() const;
};

// The cable of a channel is cut, and repaired.
struct RingCut {
  Channel channel = Channel::a;
  kernel::Duration at{};  // since all data have come once
  kernel::Duration lasts{};
  Address after = 0;  // between this station and the next one on the cable
};

struct RingDescription {
  std::string name;
  std::vector<Address> stations;  // even: addresses of individuals
  std::vector<RingData> data;
  double cable_m = 0;                 // along which the stations stand evenly, in their order
  std::vector<double> repeaters_m{};  // from its begin, ascending
  unsigned channels = 1;              // 2: each station has a dual channel manager
  std::vector<RingCut> cuts{};        // with two channels; of one of them at a time, in the order of time
  Rules rules{};
  CableRules cable{};

  // So many stations, each with a word for the next one.
  static RingDescription built_in(unsigned stations = 4);
  // Throw kernel::Error(configuration) with file, line, pointer and what would be right.
  static RingDescription load(const std::filesystem::path& path);
  static RingDescription read(const config::Value& root);
};

// The first thing in a description that no ring has, as a sentence with what would be right.
std::optional<config::Violation> violation_of(const RingDescription& ring);

// ---- the line ----
double position_m(const RingDescription& ring, std::size_t station);
kernel::Duration cable_delay(const RingDescription& ring, double length_m);
// How many stations stand before the place of a cut.
std::size_t stations_before(const RingDescription& ring, const RingCut& cut);
// That a channel manager takes to select.
kernel::Duration selection_delay(const RingDescription& ring);
// From one end to the other, repeaters and channel managers included.
kernel::Duration path_delay(const RingDescription& ring);
// The least slot time: there and back, two stations, and a symbol.
unsigned needed_slot_octets(const RingDescription& ring);

}  // namespace fieldproof::token_bus
