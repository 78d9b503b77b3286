#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "protocols/fieldbus_dll/attached_link.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"

// A station of the profile FF-P between the bench and an implementation outside, in both directions:
// AttachedFfDevice is a station of the bench that an iut::Device plays; ServedFfDevice is an iut::Device that
// a station of ours plays. Ports and items are those of attached_link.hpp. Of the user's octets:
//
//   to the station    01 priority destination(4) DLSDU        submit
//                     02 address(4) DLSDU                     write a buffer
//                     03 node                                 hand the link over
//   from the station  01 DLPDU                                a DT1 is delivered
//                     02 DLPDU                                a DT3 of a publisher is delivered
//
// Priorities are 1 to 3, urgent being 3; a DLPDU stands as on the line without its check.
namespace fieldproof::fieldbus_dll {

enum class FfAsk : std::uint8_t { submit = 1, write = 2, order_transfer = 3 };
enum class FfIndication : std::uint8_t { data = 1, published = 2 };

class AttachedFfDevice final : public FfDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedFfDevice(iut::Attachment attachment, const FfConfiguration& configuration,
                   const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& line, FfUser& user) override;
  bool start(kernel::Time now) override { return link_.start(now); }
  void stop(kernel::Time now) override { link_.stop(now); }
  bool submit(const FfRequest& request, kernel::Time now) override;
  bool write(FfAddress address, const Octets& data, kernel::Time now) override;
  bool order_transfer(std::uint8_t node, kernel::Time now) override;
  bool ask(const Octets& request, kernel::Time now) override { return link_.ask(request, now); }

  void receive(segment::PortIndex, const line::Waveform& reception) override { link_.receive(reception); }
  void on_activity(segment::PortIndex, bool begins, kernel::Time now) override {
    link_.on_activity(begins, now);
  }
  void on_time(kernel::Time now) override { link_.on_time(now); }
  kernel::Time next_time() const override { return link_.next_time(); }
  void end() override { attached_.end(); }

 private:
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override { link_.transmit(port, wave); }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  FfRules rules_;
  iut::AttachedCase attached_;
  AttachedLink link_;
  FfUser* user_ = nullptr;
};

class ServedFfDevice final : public iut::ServedUserLine<FfDevice>, private FfUser {
 public:
  using Make = std::function<std::unique_ptr<FfDevice>(const FfConfiguration&)>;
  explicit ServedFfDevice(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;

 private:
  bool asked(const Octets& request, kernel::Time now) override;
  void on_data(const FfDlpdu& dlpdu, kernel::Time when) override { tell(FfIndication::data, dlpdu, when); }
  void on_published(const FfDlpdu& dlpdu, kernel::Time when) override {
    tell(FfIndication::published, dlpdu, when);
  }
  void on_event(const FfEvent& event, kernel::Time when) override {
    report_event(static_cast<std::uint64_t>(event.kind), event.node, when);
  }
  void tell(FfIndication what, const FfDlpdu& dlpdu, kernel::Time when);

  Make make_;
  FfRules rules_;
};

// The role as benches and attachments know it.
struct FfDeviceRole {
  using Device = FfDevice;
  using Configuration = FfConfiguration;
  using Attached = AttachedFfDevice;
  using Served = ServedFfDevice;
  static constexpr const char* protocol = "fieldbus_dll";
  static constexpr const char* role = "ff_device";
};

// The role as benches and attachments know it.
struct FfLasRole {
  using Device = FfDevice;
  using Configuration = FfConfiguration;
  using Attached = AttachedFfDevice;
  using Served = ServedFfDevice;
  static constexpr const char* protocol = "fieldbus_dll";
  static constexpr const char* role = "ff_las";
};

}  // namespace fieldproof::fieldbus_dll
