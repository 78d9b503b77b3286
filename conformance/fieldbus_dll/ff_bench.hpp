#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/link_bench.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// The bench of one case for a station of the profile FF-P: a link with the implementation under test (IUT)
// and the lower tester in the place of every other station, and the upper tester as the IUT's user.
namespace fieldproof::conformance {

// What a case needs around the IUT.
struct FfNeeds {
  // Of the configuration of the IUT; null: as it is.
  std::function<void(fieldbus_dll::FfConfiguration&)> change{};
  bool is_live = true;         // a device that has been probed and activated when the case begins
  bool is_in_standby = false;  // a link master that is what a device is
};

// Who plays, and how.
struct FfSetting : PlannedSetting<fieldbus_dll::FfDevice, fieldbus_dll::FfConfiguration> {
  bool is_link_master = false;
  const LinkStresses* link_stresses = nullptr;  // must outlive the bench
};

// The high octet first, four octets or two.
void append_address(Octets& octets, fieldbus_dll::FfAddress address, bool is_long);
inline void append_address(Octets& octets, fieldbus_dll::FfAddress address) {
  append_address(octets, address, fieldbus_dll::is_long(address));
}

// What the IUT gives its user.
struct FfReport {
  enum class Kind : std::uint8_t { data, published, event };
  Kind kind;
  fieldbus_dll::FfDlpdu dlpdu{};
  fieldbus_dll::FfEvent event{fieldbus_dll::FfEventKind::activated};

  std::string text() const;
  friend bool operator==(const FfReport&, const FfReport&) = default;
};

// The IUT's user.
class FfUpperTester final : public fieldbus_dll::FfUser {
 public:
  void on_data(const fieldbus_dll::FfDlpdu& dlpdu, kernel::Time) override {
    data.push_back(dlpdu);
    reports.push_back({FfReport::Kind::data, dlpdu});
  }
  void on_published(const fieldbus_dll::FfDlpdu& dlpdu, kernel::Time) override {
    published.push_back(dlpdu);
    reports.push_back({FfReport::Kind::published, dlpdu});
  }
  void on_event(const fieldbus_dll::FfEvent& event, kernel::Time) override {
    events.push_back(event);
    reports.push_back({FfReport::Kind::event, {}, event});
  }

  bool was_delivered(const Octets& octets) const;

  std::vector<fieldbus_dll::FfDlpdu> data;
  std::vector<fieldbus_dll::FfDlpdu> published;
  std::vector<fieldbus_dll::FfEvent> events;
  std::vector<FfReport> reports;  // all of these, in order
};

class FfBench final : public LinkBench {
 public:
  using Priority = fieldbus_dll::Priority;

  // Stations of the tester.
  static constexpr std::uint8_t kScheduler = 0x10;
  static constexpr std::uint8_t kPeer = 0x22;
  static constexpr fieldbus_dll::FfAddress kPeersAddress = 0x2230;
  // What the IUT of a device publishes, and to what it has subscribed.
  static constexpr fieldbus_dll::FfAddress kPublished = 0x2120;
  static constexpr fieldbus_dll::FfAddress kSubscribed = 0x2220;

  FfBench(const FfNeeds& needs, const FfSetting& setting);

  const fieldbus_dll::FfRules& rules() const { return configuration_.rules; }
  const fieldbus_dll::FfConfiguration& configuration() const { return configuration_; }
  std::uint8_t node() const { return configuration_.node; }
  bool is_link_master() const { return is_link_master_; }
  bool has_started() const { return has_started_; }
  void set_supply(bool is_on);
  std::string words(const DrivenDlpdu& dlpdu) const override;

  // ---- upper tester ----
  FfUpperTester& user() { return user_; }
  // False when the IUT refuses it.
  bool submit(Priority priority, const Octets& data, fieldbus_dll::FfAddress to = kPeersAddress);
  bool write(fieldbus_dll::FfAddress address, const Octets& data);
  bool order_transfer(std::uint8_t node);
  // Octets as they are, which need not be a request.
  bool ask_user_request(const Octets& request);
  // To which it has submitted.
  const std::set<fieldbus_dll::FfAddress>& destinations() const { return destinations_; }

  // ---- DLPDUs of the tester ----
  std::uint8_t control(std::uint8_t code, Priority priority) const {
    return static_cast<std::uint8_t>(code | static_cast<unsigned>(priority));
  }
  // To the IUT; every other one begins a circulation.
  Octets pt(Priority least, unsigned duration);
  Octets cd(fieldbus_dll::FfAddress address) const;
  Octets dt1(Priority priority, fieldbus_dll::FfAddress to, fieldbus_dll::FfAddress from, const Octets& data,
             bool is_final = false) const;
  Octets dt3(fieldbus_dll::FfAddress from, const Octets& data) const;  // final
  Octets activation(std::uint8_t node) const;
  // A probe for the IUT; a scheduler drives without it.
  void ask();

  // What the tester says V(MID) after a DLPDU of the IUT, or later; nothing: silence.
  struct Reply {
    Octets octets;
    kernel::Duration later{};
  };
  using Answers = std::function<std::optional<Reply>(const DrivenDlpdu&)>;
  // Answers all that the IUT says until then, with `returned` where nothing else is given. Gives it.
  std::vector<DrivenDlpdu> serve(kernel::Time until, const Answers& answers = {});
  // Says what `returned` gives, if it gives something, and runs until it is over.
  void answer_one(const DrivenDlpdu& dlpdu);
  // Returns each token at once and answers each CD with a DT3; no probe is answered.
  std::optional<Reply> returned(const DrivenDlpdu& dlpdu) const;

  void finish() { station_->end(); }

 private:
  fieldbus_dll::FfConfiguration configuration_;
  bool is_link_master_;
  FfUpperTester user_;
  bool begins_circulation_ = false;
  std::set<fieldbus_dll::FfAddress> destinations_;
  std::unique_ptr<fieldbus_dll::FfDevice> station_;
  bool has_started_ = false;
};

}  // namespace fieldproof::conformance
