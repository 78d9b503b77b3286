#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/iut/served_station.hpp"
#include "harness/kernel/error.hpp"

// A device whose ports are circuits between two chips, between the bench and an implementation outside, in
// both directions: it receives and sends levels, as service_signals.hpp writes them. It is given a reception
// whole, when it begins: what it drives follows from levels that have come by then.
namespace fieldproof::token_bus {

// A device of the bench that an implementation plays. A role says what may be written; `who` is "a
// translator".
template <typename Device>
class AttachedSides : public Device, private iut::Bench {
 public:
  void set_power(bool is_on, kernel::Time now) override { attached_.set_power(is_on, now); }
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    attached_.call(reception.start, [&](iut::Device& device) { device.receive(port, reception); });
  }
  void on_time(kernel::Time now) override { attached_.on_time(now); }
  kernel::Time next_time() const override { return attached_.next_time(); }
  void end() override { attached_.end(); }

 protected:
  // Throws iut::Misbehaviour when the implementation refuses the case, kernel::Error where it announces
  // anything but levels.
  AttachedSides(std::string who, iut::Attachment attachment, const iut::CaseBegin& begin)
      : who_(std::move(who)), attached_(std::move(attachment)) {
    if (attached_.unit_kind() != iut::UnitKind::levels) {
      throw kernel::Error(
          kernel::ErrorKind::implementation,
          fmt::format("{} of the token bus receives and sends levels; this implementation announces "
                      "another unit",
                      who_));
    }
    attached_.begin(begin, *this);
  }
  void wire_ports(std::vector<segment::Port*> ports) { ports_ = std::move(ports); }
  iut::AttachedCase& attached() { return attached_; }

  void write(iut::Item item, std::uint64_t, kernel::Time) override {
    iut::refuse_impossible(fmt::format("writes item {}; {} has none to write", item, who_));
  }

 private:
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {
    iut::refuse_impossible("sends characters, having announced levels");
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    attached_.expect_supplied();
    if (port >= ports_.size()) {
      iut::refuse_impossible(
          fmt::format("drives port {}; {} has ports 0 to {}", port, who_, ports_.size() - 1));
    }
    attached_.expect_drive(wave);
    ports_[port]->drive(wave);
  }
  std::uint64_t read(iut::Item item, kernel::Time) override {
    iut::refuse_impossible(fmt::format("reads item {}; {} has none to read", item, who_));
  }

  std::string who_;
  iut::AttachedCase attached_;
  std::vector<segment::Port*> ports_;
};

// An implementation that a device of ours plays; a role wires it in `begin`.
template <typename Device, typename Configuration>
class ServedSides : public iut::ServedStation<Device> {
 public:
  using Make = std::function<std::unique_ptr<Device>(const Configuration&)>;
  explicit ServedSides(Make make) : make_(std::move(make)) {}

  void set_power(bool is_on, kernel::Time now) override {
    this->act(now, [&] { this->station().set_power(is_on, now); });
  }
  using iut::ServedStation<Device>::receive;
  void receive(unsigned port, const line::Waveform& reception) override {
    this->act(reception.start, [&] { this->station().receive(port, reception); });
  }

 protected:
  void make(const Configuration& configuration, iut::Bench& bench) {
    this->play(make_(configuration), bench);
  }

 private:
  Make make_;
};

}  // namespace fieldproof::token_bus
