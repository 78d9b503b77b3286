#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "harness/iut/user_line.hpp"
#include "protocols/token_bus/device.hpp"
#include "protocols/token_bus/station_settings.hpp"

// A station of the token bus between the bench and an implementation outside, in both directions:
// AttachedStation is a station of the bench that an iut::Device plays; ServedStation is an iut::Device that a
// station of ours plays. Of the user's octets, numbers with the high octet first:
//
//   to the station    01 action priority destination(6) data   submit; actions in the order of Action
//                     02 desired                               in_ring_desired, 0 or 1
//                     03 data                                  what requests with response are answered with
//   from the station  01 frame                                 a data frame without its check, as on the line
//
// It writes item kFaultyReceptions + n whenever the n-th of its counters of faulty receptions changes.
namespace fieldproof::token_bus {

inline constexpr iut::Item kFaultyReceptions = 16;

enum class StationAsk : std::uint8_t { submit = 1, in_ring_desired = 2, response = 3 };
inline constexpr std::uint8_t kIndication = 1;

class AttachedStation final : public StationDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case, kernel::Error where it announces
  // anything but levels.
  AttachedStation(iut::Attachment attachment, const StationConfiguration& configuration,
                  const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& line, StationUser& user) override;
  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override { line_.stop(now); }
  bool submit(const DataRequest& request, kernel::Time now) override;
  void set_in_ring_desired(bool is_desired, kernel::Time now) override;
  void set_response(const Octets& data, kernel::Time now) override;
  Counters counters() const override { return counters_; }

  void receive(segment::PortIndex, const line::Waveform& reception) override {
    line_.receive_levels(reception);
  }
  void on_activity(segment::PortIndex, bool begins, kernel::Time now) override {
    line_.on_activity(begins, now);
  }
  void on_time(kernel::Time now) override { line_.on_time(now); }
  kernel::Time next_time() const override { return line_.next_time(); }
  void end() override { attached_.end(); }

 private:
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override { line_.transmit(port, wave); }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  Rules rules_;
  iut::AttachedCase attached_;
  iut::UserLine line_;
  StationUser* user_ = nullptr;
  Counters counters_{};
};

class ServedStation final : public iut::ServedUserLine<StationDevice>, private StationUser {
 public:
  using Make = std::function<std::unique_ptr<StationDevice>(const StationConfiguration&)>;
  explicit ServedStation(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;

 private:
  bool asked(const Octets& request, kernel::Time now) override;
  void after_call() override;
  void on_data(const Frame& frame, kernel::Time when) override;
  void on_event(const Event& event, kernel::Time when) override {
    report_event(static_cast<std::uint64_t>(event.kind), event.address, when);
  }

  Make make_;
  Rules rules_;
  Counters counters_{};
};

// The role as benches and attachments know it.
struct StationRole {
  using Device = StationDevice;
  using Configuration = StationConfiguration;
  using Attached = AttachedStation;
  using Served = ServedStation;
  static constexpr const char* protocol = "token_bus";
  static constexpr const char* role = "station";
};

}  // namespace fieldproof::token_bus
