#include "protocols/token_bus/service_datum.hpp"

#include "harness/kernel/check.hpp"
#include "protocols/token_bus/ring_description.hpp"

namespace fieldproof::token_bus {

Octets octets_of(const ServiceDatum& datum, std::size_t length) {
  FIELDPROOF_CHECK(length >= kLeastDatum, "a datum holds its numbers and its word");
  Octets octets{datum.flow, static_cast<std::uint8_t>(datum.number >> 8),
                static_cast<std::uint8_t>(datum.number), static_cast<std::uint8_t>(datum.word >> 8),
                static_cast<std::uint8_t>(datum.word)};
  octets.reserve(length);
  // Neighbours differ, and so do places that lie any power of two apart.
  for (std::size_t n = octets.size(); n < length; ++n)
    octets.push_back(static_cast<std::uint8_t>(octets[n % kLeastDatum] + 29 * n + (n >> 8)));
  return octets;
}

std::optional<ServiceDatum> datum_of(const Octets& octets) {
  if (octets.size() < kLeastDatum) return std::nullopt;
  const ServiceDatum datum{octets[0], static_cast<std::uint16_t>(octets[1] << 8 | octets[2]),
                           static_cast<std::uint16_t>(octets[3] << 8 | octets[4])};
  return octets_of(datum, octets.size()) == octets ? std::optional(datum) : std::nullopt;
}

Octets response_of(Address address) {
  return {0xFF, static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address)};
}

void Deliveries::give(const ServiceDatum& datum) {
  flows_.at(datum.flow).given[datum.number % kKnown] = datum;
}

Delivery Deliveries::get(const ServiceDatum& datum) {
  if (datum.flow >= flows_.size()) return Delivery::wrong;
  Flow& flow = flows_[datum.flow];
  if (flow.given[datum.number % kKnown] != datum) return Delivery::wrong;
  const auto ahead = static_cast<std::int16_t>(datum.number - flow.last_got.value_or(datum.number - 1));
  if (ahead == 0) return Delivery::twice;
  if (ahead < 0) return Delivery::out_of_order;
  flow.last_got = datum.number;
  return Delivery::first;
}

}  // namespace fieldproof::token_bus
