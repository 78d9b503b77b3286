#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/iut/attached_uart.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/host_settings.hpp"

// A host module between the bench and an implementation outside, in both directions: AttachedHost is a host
// of the bench that an iut::Device plays; ServedHost is an iut::Device that a host of ours plays.
//
// Port 0 is the line, in characters or levels. Port 1 is the PC: its octets are told as characters whatever
// the unit, each over at the instant of the call. The implementation writes what it tells the PC, and keeps
// the words that the PC may look at (its FIFO, its counters) up to date. It is told the settings of
// host_settings.
namespace fieldproof::valve_bus {

inline constexpr unsigned kPcPort = 1;

inline constexpr iut::Item kDip = 0;           // read: position of the switches
inline constexpr iut::Item kResponse = 1;      // told: ID | DATA0 << 8 | DATA1 << 16 | is old << 24
inline constexpr iut::Item kError = 2;         // told: ID | kind << 8, in the order of HostErrorKind
inline constexpr iut::Item kFifoRoom = 3;      // kept: octets
inline constexpr iut::Item kOverflow = 4;      // kept: 0, 1
inline constexpr iut::Item kTimeouts = 0x100;  // kept, + ID each
inline constexpr iut::Item kRejected = 0x200;
inline constexpr iut::Item kLate = 0x300;
inline constexpr iut::Item kRetries = 0x400;

class AttachedHost final : public HostDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedHost(iut::Attachment attachment, const HostConfiguration& configuration, const std::string& case_id,
               std::uint64_t seed);

  void wire(segment::Port& line, HostApplication& application) override;
  void set_power(bool is_on, kernel::Time now) override;
  void set_dip(unsigned position) override { dip_ = position; }
  void write(std::span<const std::uint8_t> octets, kernel::Time now) override;
  std::size_t fifo_room() const override { return fifo_room_; }
  bool has_overflowed() const override { return has_overflowed_; }
  HostCounters counters(std::uint8_t id) const override;
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    line_.receive(port, reception);
  }
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override {
    line_.on_activity(port, begins, now);
  }
  void on_time(kernel::Time now) override { line_.on_time(now); }
  kernel::Time next_time() const override { return line_.next_time(); }
  void end() override { line_.end(); }
  iut::Capabilities capabilities() const override { return attached_.capabilities(); }
  iut::TimingUncertainty uncertainty_of_request(kernel::Time driver_on) const override {
    return line_.uncertainty_of(driver_on);
  }

 private:
  void set_driver(unsigned port, bool is_on, kernel::Time at) override { line_.set_driver(port, is_on, at); }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    line_.send(port, start, characters);
  }
  void transmit(unsigned port, line::Waveform& wave) override { line_.transmit(port, wave); }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;
  void set_uncertainty(iut::TimingUncertainty uncertainty) override { line_.set_uncertainty(uncertainty); }
  void tell_response(std::uint64_t value, kernel::Time when);
  void tell_error(std::uint64_t value, kernel::Time when);

  Rules rules_;
  unsigned dip_;
  iut::AttachedCase attached_;
  iut::AttachedUart line_;
  HostApplication* application_ = nullptr;
  std::size_t fifo_room_ = 0;
  bool has_overflowed_ = false;
  std::array<std::array<std::uint64_t, 256>, 4> counters_{};  // by kind, by ID
};

class ServedHost final : public iut::ServedStation<HostDevice>, private HostApplication {
 public:
  using Make = std::function<std::unique_ptr<HostDevice>(const HostConfiguration&)>;
  explicit ServedHost(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override {
    act(reception.end(), [&] { station().receive(port, reception); });
  }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override;

 private:
  void before_call() override;
  void after_call() override;
  void keep(iut::Item item, std::uint64_t value, std::uint64_t& told);
  void on_response(const HostResponse& response, kernel::Time when) override;
  void on_error(const HostError& error, kernel::Time when) override;

  Make make_;
  bool is_on_ = false;
  std::uint64_t dip_ = 0;
  // As the bench was told them.
  std::uint64_t fifo_room_ = 0;
  std::uint64_t has_overflowed_ = 0;
  std::array<std::array<std::uint64_t, 256>, 4> counters_{};
};

// The role as benches and attachments know it.
struct HostRole {
  using Device = HostDevice;
  using Configuration = HostConfiguration;
  using Attached = AttachedHost;
  using Served = ServedHost;
  static constexpr const char* protocol = "valve_bus";
  static constexpr const char* role = "host";
};

}  // namespace fieldproof::valve_bus
