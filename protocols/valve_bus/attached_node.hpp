#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/iut/attached_uart.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/node_settings.hpp"

// A local node between the bench and an implementation outside, in both directions: AttachedNode is a node of
// the bench that an iut::Device plays; ServedNode is an iut::Device that a node of ours plays.
//
// The implementation writes item kValves (16 solenoids) and reads item kLimitSwitches; it hears and says
// characters, or levels. It is told the settings of node_settings.
namespace fieldproof::valve_bus {

inline constexpr iut::Item kValves = 0;
inline constexpr iut::Item kLimitSwitches = 1;

class AttachedNode final : public NodeDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedNode(iut::Attachment attachment, const NodeConfiguration& configuration, const std::string& case_id,
               std::uint64_t seed);

  void wire(segment::Port& line, NodeBoards& boards) override;
  void set_power(bool is_on, kernel::Time now) override;
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
  iut::TimingUncertainty uncertainty_of_answer(kernel::Time driver_on) const override {
    return line_.uncertainty_of(driver_on);
  }
  iut::TimingUncertainty uncertainty_of_valves() const override { return line_.uncertainty(); }

 private:
  void set_driver(unsigned port, bool is_on, kernel::Time at) override { line_.set_driver(port, is_on, at); }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    line_.send(port, start, characters);
  }
  void transmit(unsigned port, line::Waveform& wave) override { line_.transmit(port, wave); }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;
  void set_uncertainty(iut::TimingUncertainty uncertainty) override { line_.set_uncertainty(uncertainty); }

  Rules rules_;
  iut::AttachedCase attached_;
  iut::AttachedUart line_;
  NodeBoards* boards_ = nullptr;
};

class ServedNode final : public iut::ServedStation<NodeDevice>, private NodeBoards {
 public:
  using Make = std::function<std::unique_ptr<NodeDevice>(const NodeConfiguration&)>;
  explicit ServedNode(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override {
    act(now, [&] { station().set_power(is_on, now); });
  }
  using iut::ServedStation<NodeDevice>::receive;
  void receive(unsigned port, const line::Waveform& reception) override {
    act(reception.end(), [&] { station().receive(port, reception); });
  }

 private:
  std::uint16_t limit_switches(kernel::Time when) override {
    return static_cast<std::uint16_t>(bench().read(kLimitSwitches, not_past(when)));
  }
  void drive_valves(std::uint16_t valves, kernel::Time when) override {
    bench().write(kValves, valves, not_past(when));
  }

  Make make_;
};

// The role as benches and attachments know it.
struct NodeRole {
  using Device = NodeDevice;
  using Configuration = NodeConfiguration;
  using Attached = AttachedNode;
  using Served = ServedNode;
  static constexpr const char* protocol = "valve_bus";
  static constexpr const char* role = "node";
};

}  // namespace fieldproof::valve_bus
