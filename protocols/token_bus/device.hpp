#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "harness/segment/station.hpp"
#include "protocols/token_bus/frame.hpp"

// What a bench wires to and asks of a station of the token bus, whoever implements it. The line side is
// segment::Station: port 0, with activity sensed, and without what the station drives itself.
namespace fieldproof::token_bus {

struct DataRequest {
  Action action = Action::request_with_no_response;  // or request_with_response
  unsigned priority = 6;                             // 7 to 0
  Address destination = 0;
  Octets data{};
};

enum class EventKind : std::uint8_t {
  joined,             // the station has its first token
  left,               // the ring, as it was asked to
  sole_station,       // it has claimed the token, and nobody else is in its ring
  successor_changed,  // `address` is the next one
  pass_failed,        // nobody took the token, and nobody answered
  unexpected_frame,   // of `address`, while this station held the token: it is dropped
  response_missing,   // of `address`, to a request and all its repetitions
  duplicate_address,  // another has it; the station is offline
  faulty_transmitter  // no token was taken for too long; the station is offline
};
inline constexpr std::size_t kEventKinds = 9;
std::string_view text_of(EventKind kind);

struct Event {
  EventKind kind;
  Address address = 0;
};

// Faulty receptions since the start, in the order of ReceptionKind after `frame`.
using Counters = std::array<std::uint32_t, 5>;

// Who uses the MAC. It may submit from here; instants never decrease.
class StationUser {
 public:
  virtual ~StationUser() = default;
  // A data frame to this station or to a group: an indication, or the response to a request of its own.
  virtual void on_data(const Frame& frame, kernel::Time when) = 0;
  virtual void on_event(const Event& event, kernel::Time when) = 0;
};

struct StationConfiguration {
  Rules rules{};
  Address address = 0x000A;     // individual
  bool in_ring_desired = true;  // when it begins
};

class StationDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& line, StationUser& user) = 0;
  // Nothing is sent before. False: the rules are impossible, and nothing will be.
  virtual bool start(kernel::Time now) = 0;
  // The supply fails: what it knew is gone, and it neither receives nor sends before the next start.
  virtual void stop(kernel::Time now) = 0;
  // After what has been submitted in the same class. False: it is not taken.
  virtual bool submit(const DataRequest& request, kernel::Time now) = 0;
  virtual void set_in_ring_desired(bool is_desired, kernel::Time now) = 0;
  // What the next requests with response are answered with; none are answered without it.
  virtual void set_response(const Octets& data, kernel::Time now) = 0;
  virtual Counters counters() const = 0;
};

}  // namespace fieldproof::token_bus
