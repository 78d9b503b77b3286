#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/token_bus/frame.hpp"

// What the applications of a ring send each other, and whether it comes as it went: octets that follow from
// the number of the flow, the number of the datum in it, and a word, so that any other octet shows.
namespace fieldproof::token_bus {

struct ServiceDatum {
  std::uint8_t flow = 0;
  std::uint16_t number = 0;
  std::uint16_t word = 0;

  friend bool operator==(const ServiceDatum&, const ServiceDatum&) = default;
};

// `length` is kLeastDatum at least.
Octets octets_of(const ServiceDatum& datum, std::size_t length);
// Nothing where these octets were made of no datum.
std::optional<ServiceDatum> datum_of(const Octets& octets);

// What the application of a station answers confirmed data with.
Octets response_of(Address address);

enum class Delivery : std::uint8_t {
  first,  // as it is due; others may have been lost before
  twice,
  out_of_order,
  wrong  // nobody has sent it so
};
inline constexpr std::size_t kDeliveries = 4;

// All flows of a network: what was given to their sources, and what their sinks get of it.
//
// Limit: the last 256 data of a flow are known; what is older is wrong.
class Deliveries {
 public:
  void add_flow() { flows_.emplace_back(); }
  void give(const ServiceDatum& datum);
  Delivery get(const ServiceDatum& datum);

 private:
  static constexpr std::size_t kKnown = 256;
  struct Flow {
    std::array<std::optional<ServiceDatum>, kKnown> given{};
    std::optional<std::uint16_t> last_got{};
  };

  std::vector<Flow> flows_;
};

}  // namespace fieldproof::token_bus
