#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// The bench of one case for a station of the profile ISA-D: a link with the implementation under test (IUT)
// and the lower tester in the place of every other station, and the upper tester as the IUT's user.
//
// The lower tester drives what the case says and hears what the IUT drives as it leaves it. Verdicts rest on
// that, and on what was delivered to the user.
namespace fieldproof::conformance {

inline constexpr std::uint8_t kIsaStationAddress = 0x21;  // a basic station

// What a case needs around the IUT.
struct IsaNeeds {
  fieldbus_dll::IsaSchedule schedule{};  // of an IUT that is the scheduler
  bool is_scheduler = true;              // when the case begins
  std::int64_t bit_rate = 31'250;
  // Of the configuration of the IUT besides; empty: as it is.
  std::function<void(fieldbus_dll::IsaConfiguration&)> change{};
  bool is_in_standby = false;  // a link master that is what a basic station is
};

// Who plays, and how.
struct IsaSetting : PlannedSetting<fieldbus_dll::IsaDevice, fieldbus_dll::IsaConfiguration> {
  std::uint8_t address = kIsaStationAddress;    // of the IUT
  const LinkStresses* link_stresses = nullptr;  // must outlive the bench
};

// Throws kernel::Error(configuration) where no reply can come in time.
void expect_judgeable_isa(const fieldbus_dll::IsaConfiguration& station);

// What the IUT gives its user: data, or an event.
struct IsaReport {
  std::optional<fieldbus_dll::IsaDlpdu> data{};
  fieldbus_dll::IsaEvent event{fieldbus_dll::IsaEventKind::reply_missing};

  std::string text() const;
  friend bool operator==(const IsaReport&, const IsaReport&) = default;
};

// The IUT's user.
class IsaUpperTester final : public fieldbus_dll::IsaUser {
 public:
  struct Delivery {
    fieldbus_dll::IsaDlpdu dlpdu;
    kernel::Time when;
  };

  void on_data(const fieldbus_dll::IsaDlpdu& dlpdu, kernel::Time when) override {
    deliveries.push_back({dlpdu, when});
    reports.push_back({dlpdu});
  }
  void on_event(const fieldbus_dll::IsaEvent& event, kernel::Time) override {
    events.push_back(event);
    reports.push_back({{}, event});
  }
  bool is_reply_coming(fieldbus_dll::Priority least, kernel::Time) override {
    return works_on_reply && works_on.value_or(least) == least;
  }

  bool was_delivered(const Octets& data) const;

  std::vector<Delivery> deliveries;
  std::vector<fieldbus_dll::IsaEvent> events;
  std::vector<IsaReport> reports;  // all of these, in order
  bool works_on_reply = false;
  std::optional<fieldbus_dll::Priority> works_on{};  // on data of this priority only
};

class IsaBench final : public LinkBench {
 public:
  using Priority = fieldbus_dll::Priority;

  // Stations of the tester.
  static constexpr std::uint8_t kScheduler = 0x10;
  static constexpr std::uint8_t kPeer = 0x22;

  IsaBench(const IsaNeeds& needs, const IsaSetting& setting);

  const fieldbus_dll::IsaRules& rules() const { return configuration_.rules; }
  std::uint8_t address() const { return configuration_.address; }
  kernel::Duration reply_wait() const { return octets(rules().reply_wait_octets); }
  kernel::Duration reply_forming() const { return octets(rules().reply_forming_octets); }

  // ---- upper tester ----
  IsaUpperTester& user() { return user_; }
  // False when the IUT refuses it.
  bool submit(fieldbus_dll::IsaService service, Priority priority, const Octets& data,
              std::uint8_t destination = kPeer);
  bool submit_unit_data(Priority priority, const Octets& data) {
    return submit(fieldbus_dll::IsaService::unit_data, priority, data);
  }
  // False when the IUT refuses it.
  bool order_transfer(std::uint8_t node);
  bool ask_user_request(const Octets& request);
  // It has taken its settings.
  bool is_in_standby() const { return is_in_standby_; }
  bool has_started() const { return has_started_; }
  void set_supply(bool is_on);
  std::string words(const DrivenDlpdu& dlpdu) const override;

  // ---- DLPDUs of the tester ----
  std::uint8_t control(std::uint8_t code, Priority priority) const {
    return static_cast<std::uint8_t>(code | static_cast<unsigned>(priority));
  }
  Octets et(Priority least) const;
  // A token for the IUT, which it returns.
  void ask();
  Octets es(Priority least, unsigned duration) const;
  Octets cd(Priority least) const;
  // A final DT to the IUT.
  Octets dt(Priority priority, const Octets& data, std::uint8_t source = kPeer) const;
  Octets ee(std::uint8_t source) const;

  void finish() { station_->end(); }

 private:
  fieldbus_dll::IsaConfiguration configuration_;
  bool is_in_standby_;
  IsaUpperTester user_;
  std::unique_ptr<fieldbus_dll::IsaDevice> station_;
  bool has_started_ = false;
};

}  // namespace fieldproof::conformance
