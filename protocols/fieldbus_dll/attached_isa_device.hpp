#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "protocols/fieldbus_dll/attached_link.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

// A station of the profile ISA-D between the bench and an implementation outside, in both directions, as
// attached_ff_device.hpp has it for FF-P. Of the user's octets:
//
//   to the station    01 service priority destination DLSDU   submit; services in the order of IsaService
//                     03 node                                 hand the link over
//   from the station  01 DLPDU                                a DU or DT is delivered
//
// A station asks its user with `read` of item kReplyComing + priority whether data of that priority are being
// worked out; 1 is yes.
namespace fieldproof::fieldbus_dll {

inline constexpr iut::Item kReplyComing = 16;

enum class IsaAsk : std::uint8_t { submit = 1, order_transfer = 3 };
inline constexpr std::uint8_t kIsaData = 1;

class AttachedIsaDevice final : public IsaDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedIsaDevice(iut::Attachment attachment, const IsaConfiguration& configuration,
                    const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& line, IsaUser& user) override;
  bool start(kernel::Time now) override { return link_.start(now); }
  void stop(kernel::Time now) override { link_.stop(now); }
  bool submit(const IsaRequest& request, kernel::Time now) override;
  bool order_transfer(std::uint8_t node, kernel::Time now) override;
  bool ask(const std::vector<std::uint8_t>& request, kernel::Time now) override {
    return link_.ask(request, now);
  }

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

  IsaRules rules_;
  iut::AttachedCase attached_;
  AttachedLink link_;
  IsaUser* user_ = nullptr;
};

class ServedIsaDevice final : public iut::ServedUserLine<IsaDevice>, private IsaUser {
 public:
  using Make = std::function<std::unique_ptr<IsaDevice>(const IsaConfiguration&)>;
  explicit ServedIsaDevice(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;

 private:
  bool asked(const Octets& request, kernel::Time now) override;
  void on_data(const IsaDlpdu& dlpdu, kernel::Time when) override;
  void on_event(const IsaEvent& event, kernel::Time when) override {
    report_event(static_cast<std::uint64_t>(event.kind), event.node, when);
  }
  bool is_reply_coming(Priority least, kernel::Time when) override;

  Make make_;
  IsaRules rules_;
};

// The role as benches and attachments know it.
struct IsaDleRole {
  using Device = IsaDevice;
  using Configuration = IsaConfiguration;
  using Attached = AttachedIsaDevice;
  using Served = ServedIsaDevice;
  static constexpr const char* protocol = "fieldbus_dll";
  static constexpr const char* role = "isa_dle";
};

// The role as benches and attachments know it.
struct IsaLasRole {
  using Device = IsaDevice;
  using Configuration = IsaConfiguration;
  using Attached = AttachedIsaDevice;
  using Served = ServedIsaDevice;
  static constexpr const char* protocol = "fieldbus_dll";
  static constexpr const char* role = "isa_las";
};

}  // namespace fieldproof::fieldbus_dll
