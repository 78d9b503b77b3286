#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "harness/iut/device.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"
#include "protocols/valve_bus/transmitter.hpp"

// A local node between the bench and an implementation outside, in both directions: AttachedNode is a node of
// the bench that an iut::Device plays; ServedNode is an iut::Device that a node of ours plays.
//
// The implementation writes item kValves (16 solenoids) and reads item kLimitSwitches; it hears and says
// characters, or levels. It is told the settings of node_settings.
namespace fieldproof::valve_bus {

inline constexpr iut::Item kValves = 0;
inline constexpr iut::Item kLimitSwitches = 1;

// "bit_rate", "characters" (0: P0, 1: P1, 2: P2), "address_tens", "address_units", "boards",
// "answers_writes", "loss_limit_ms".
std::vector<std::pair<std::string, std::int64_t>> node_settings(const NodeConfiguration& configuration);
// The other way round; what is not there is as the configuration has it anyway.
NodeConfiguration node_configuration_of(const iut::CaseBegin& begin);

// A device for one case and what is to be done behind it.
struct NodeAttachment {
  iut::Device* device = nullptr;
  std::shared_ptr<void> lease;            // keeps the device
  std::function<void()> on_well_ended{};  // the case has ended as it should
};

class AttachedNode final : public NodeDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedNode(NodeAttachment attachment, const NodeConfiguration& configuration, const std::string& case_id,
               std::uint64_t seed);
  ~AttachedNode() override;

  void wire(segment::Port& line, NodeBoards& boards) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  void end() override;

 private:
  template <typename Call>
  void call(kernel::Time now, Call&& call);
  void expect_supplied() const;
  void transmit(const iut::Transmission& transmission) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  NodeAttachment attachment_;
  NodeConfiguration configuration_;
  CharacterCodec codec_;
  Transmitter transmitter_;
  segment::Port* line_ = nullptr;
  NodeBoards* boards_ = nullptr;
  std::vector<iut::Character> characters_;
  kernel::Time now_{};  // as the implementation was told it
  kernel::Time last_write_{};
  bool is_supplied_ = false;
  bool is_well_ = true;
  bool has_ended_ = false;
};

class ServedNode final : public iut::Device, private segment::Port, private NodeBoards {
 public:
  using MakeNode = std::function<std::unique_ptr<NodeDevice>(const NodeConfiguration&)>;
  explicit ServedNode(MakeNode make_node) : make_node_(std::move(make_node)) {}

  iut::UnitKind unit_kind() const override { return iut::UnitKind::levels; }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override { node_->set_power(is_on, now_ = now); }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override {
    now_ = reception.end();
    node_->receive(port, reception);
  }
  void on_time(kernel::Time now) override { node_->on_time(now_ = now); }
  kernel::Time next_time() const override { return node_ ? node_->next_time() : kernel::kNever; }
  void end() override { node_.reset(); }

 private:
  void drive(line::Waveform& wave) override { bench_->transmit(0, wave); }
  std::uint16_t limit_switches(kernel::Time when) override {
    return static_cast<std::uint16_t>(bench_->read(kLimitSwitches, std::max(when, now_)));
  }
  void drive_valves(std::uint16_t valves, kernel::Time when) override {
    bench_->write(kValves, valves, std::max(when, now_));
  }

  MakeNode make_node_;
  std::unique_ptr<NodeDevice> node_;
  iut::Bench* bench_ = nullptr;
  // A node may act at the end of a character by its own clock, before a slower sender has ended it.
  kernel::Time now_{};
};

}  // namespace fieldproof::valve_bus
