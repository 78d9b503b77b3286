#pragma once

#include <deque>
#include <optional>

#include "harness/traffic/poisson_arrivals.hpp"
#include "protocols/token_bus/ring_description.hpp"
#include "protocols/token_bus/service_datum.hpp"

// The application at the source of a flow: when it requests, what waits, what its MAC has.
//
// One datum at a time is with the MAC; requests that come meanwhile wait here, at most 16 of them: then the
// next ones are not taken.
namespace fieldproof::token_bus {

class RingFlow {
 public:
  // A datum that was given to the MAC.
  struct Given {
    ServiceDatum datum;
    kernel::Time requested;
    bool is_sent = false;  // seen on the line
  };

  RingFlow(const RingData& data, std::uint8_t number, kernel::Random random);

  const RingData& data() const { return data_; }

  // Requests come from now on, until the stop.
  void begin(kernel::Time now);
  void stop();
  kernel::Time next_request() const { return next_; }
  // Takes the requests that are due.
  void take_due(kernel::Time now);
  void request(kernel::Time when);

  // The oldest request that waits becomes the datum that the MAC has; nothing where none waits, or it has
  // one.
  std::optional<ServiceDatum> next_datum(std::uint16_t word);
  bool may_give() const { return !given_ && !waiting_.empty(); }
  bool has_waiting() const { return !waiting_.empty(); }
  const std::optional<Given>& given() const { return given_; }
  // It is on the line, for the first time or again. When it was requested, the first time.
  std::optional<kernel::Time> on_sent(const ServiceDatum& datum);
  void on_done() { given_.reset(); }
  // Of all requests, those that were not taken: they come faster than the ring carries data.
  std::uint64_t requests() const { return requests_; }
  std::uint64_t refused() const { return refused_; }

 private:
  static constexpr std::size_t kMostWaiting = 16;

  RingData data_;
  std::uint8_t flow_;
  kernel::Random random_;
  std::optional<traffic::PoissonArrivals> arrivals_{};
  kernel::Time next_ = kernel::kNever;
  std::deque<kernel::Time> waiting_{};
  std::optional<Given> given_{};
  std::uint16_t number_ = 0;
  std::uint64_t requests_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace fieldproof::token_bus
