#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/segment/station.hpp"
#include "protocols/fieldbus_dll/ff_dlpdu.hpp"

// What a bench wires to and asks of a station of the profile FF-P, whoever implements it. The line side is
// segment::Station: port 0, with activity sensed, and without what the station drives itself.
namespace fieldproof::fieldbus_dll {

struct FfRequest {
  Priority priority = Priority::normal;
  FfAddress destination = 0;
  Octets data{};
};

enum class FfEventKind : std::uint8_t {
  activated,        // this station is in the live list
  reply_missing,    // of `node`, to a CD
  token_missed,     // by `node`
  token_reclaimed,  // from `node`
  node_found,       // `node` has answered a probe
  node_removed,     // `node` has missed its tokens
  claimed,          // this station is the scheduler
  taken,            // by a TL
  transferred,      // to `node`
  transfer_failed,  // to `node`
  left              // another is the scheduler
};

// "reply missing".
std::string_view text_of(FfEventKind kind);

struct FfEvent {
  FfEventKind kind;
  std::uint8_t node = 0;

  friend bool operator==(const FfEvent&, const FfEvent&) = default;
};

// The user of the data link. It may submit and write from here; instants never decrease.
class FfUser {
 public:
  virtual ~FfUser() = default;
  // A DT1 to this station or to everybody, but for what its data link entity keeps for itself.
  virtual void on_data(const FfDlpdu& dlpdu, kernel::Time when) = 0;
  // A DT3 of a publisher to which the station has subscribed.
  virtual void on_published(const FfDlpdu& dlpdu, kernel::Time when) = 0;
  virtual void on_event(const FfEvent& event, kernel::Time when) = 0;
};

// When a publisher is compelled, in link time.
struct FfScheduleItem {
  std::uint32_t at = 0;  // 1/32 ms behind the beginning of the macrocycle
  FfAddress address = 0;
  Priority priority = Priority::normal;
};

// A macrocycle begins whenever link time is a multiple of it.
struct FfSchedule {
  std::uint16_t version = 1;
  std::uint32_t macrocycle = 32'000;    // 1/32 ms
  std::vector<FfScheduleItem> items{};  // ordered by `at`, each inside of the macrocycle
};

struct FfConfiguration {
  FfRules rules{};
  std::uint8_t node = 0x20;
  bool supports_long_addresses = true;
  std::vector<FfAddress> published{};   // buffers of this station
  std::vector<FfAddress> subscribed{};  // buffers of others
  // Of a link master.
  FfSchedule schedule{};
  std::vector<std::uint8_t> live{};  // nodes that it knows when it begins
  bool begins_as_scheduler = false;
};

class FfDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& line, FfUser& user) = 0;
  // Nothing is sent before. False: the rules are impossible, and nothing will be.
  virtual bool start(kernel::Time now) = 0;
  // The supply fails: what it knew is gone, and it neither hears nor sends before the next start.
  virtual void stop(kernel::Time now) = 0;
  // After what has been submitted in the same priority. False: more data than the priority carries.
  virtual bool submit(const FfRequest& request, kernel::Time now) = 0;
  // The whole buffer at once. False: the station does not publish it, or it is too long.
  virtual bool write(FfAddress address, const Octets& data, kernel::Time now) = 0;

  // Of a link master: hands the link to another, as soon as no token is out. False: it is none.
  virtual bool order_transfer(std::uint8_t /*node*/, kernel::Time /*now*/) { return false; }
  // Octets that mean none of these. False: it is refused.
  virtual bool ask(const Octets& /*request*/, kernel::Time /*now*/) { return false; }
};

// ---- what data link entities tell each other by DT1, from selector 0 to selector 0 or to everybody ----

// The first octet of the DLSDU; this project's choice.
enum class SpduKind : std::uint8_t { activation = 1, live_list = 2 };

// The DLSDU of a live list: kind, revision, and 32 octets in which node n has bit 7 - n % 8 of octet n / 8.
Octets live_list_spdu(std::uint8_t revision, const std::vector<bool>& live);

}  // namespace fieldproof::fieldbus_dll
