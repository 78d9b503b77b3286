#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/segment/station.hpp"
#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

// What a bench wires to and asks of a station of the profile ISA-D, whoever implements it. The line side is
// segment::Station: port 0, with activity sensed, and without what the station drives itself.
namespace fieldproof::fieldbus_dll {

enum class IsaService : std::uint8_t {
  unit_data,  // a DU, when the station holds the token
  compel,     // a CD, when the station holds the token; what comes back is told to the user
  reply_data  // a DT, when somebody compels it
};

struct IsaRequest {
  IsaService service = IsaService::unit_data;
  Priority priority = Priority::normal;
  std::uint8_t destination = 0;  // of reply_data: not looked at, who compels gets it
  Octets data{};                 // of compel: none
};

enum class IsaEventKind : std::uint8_t {
  reply_missing,     // of `node`, whom this station compelled
  token_dropped,     // another's DLPDU in place of a reply; the token is not this station's any more
  token_reclaimed,   // of `node`, which let it lapse
  token_overrun,     // `node` sent more, or longer, than it was given
  second_scheduler,  // `node` acts as one, too
  scheduler_left,    // because of that
  transfer_failed,   // `node` did not take over
  transferred,       // to `node`
  scheduler_taken,   // by a TL from `node`
};

// "reply missing".
std::string_view text_of(IsaEventKind kind);

struct IsaEvent {
  IsaEventKind kind;
  std::uint8_t node = 0;

  friend bool operator==(const IsaEvent&, const IsaEvent&) = default;
};

// The user of the data link. It may submit from here; instants never decrease.
class IsaUser {
 public:
  virtual ~IsaUser() = default;
  // A DU to this station or to everybody, a DT to this station, and what it compelled.
  virtual void on_data(const IsaDlpdu& dlpdu, kernel::Time when) = 0;
  virtual void on_event(const IsaEvent& event, kernel::Time when) = 0;
  // The station is compelled to send data of this priority at least, and none has been submitted: is it being
  // worked out and will be submitted as soon as it is there?
  virtual bool is_reply_coming(Priority least, kernel::Time when) = 0;
};

// When a token is delegated, and to whom: an ET or an ES.
struct IsaScheduleItem {
  kernel::Duration at{};  // behind the beginning of the schedule
  IsaType type = IsaType::es;
  std::uint8_t node = 0;
  Priority least = Priority::time_available;
  std::uint16_t duration = 0;  // of ES, octet durations
};

struct IsaSchedule {
  std::uint16_t version = 1;
  kernel::Duration period{};             // it begins anew; zero: it is run once
  std::vector<IsaScheduleItem> items{};  // ordered by `at`, each inside of the period
};

struct IsaConfiguration {
  IsaRules rules{};
  std::uint8_t address = 0x21;
  // Of a link master.
  IsaSchedule schedule{};
  bool begins_as_scheduler = true;
};

// A data link entity: whom a scheduler delegates its token to, and who answers CD. A link master can be the
// scheduler besides.
class IsaDevice : public segment::Station {
 public:
  virtual void wire(segment::Port& line, IsaUser& user) = 0;
  // After what has been submitted in the same priority. False: a service or priority that is none, more data
  // than the priority carries, any with a CD, or an address that is none; nothing is kept of it.
  virtual bool submit(const IsaRequest& request, kernel::Time now) = 0;

  // The supply comes; a station that was never stopped has it. Of a link master: the schedule begins now,
  // where it begins as the scheduler. False: the rules are impossible, and nothing will be sent.
  virtual bool start(kernel::Time now) = 0;
  // The supply fails: what it knew is gone, and it neither hears nor sends before the next start.
  virtual void stop(kernel::Time now) = 0;
  // Of a link master: hands the link to this one, with a TL, as soon as no token is delegated. False: it is
  // none.
  virtual bool order_transfer(std::uint8_t /*node*/, kernel::Time /*now*/) { return false; }
  // Octets that mean none of these. False: it is refused.
  virtual bool ask(const std::vector<std::uint8_t>& /*request*/, kernel::Time /*now*/) { return false; }
};

}  // namespace fieldproof::fieldbus_dll
