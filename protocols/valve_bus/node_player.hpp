#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "harness/iut/device.hpp"
#include "harness/iut/serial_line.hpp"
#include "protocols/valve_bus/codec.hpp"
#include "protocols/valve_bus/device.hpp"

// Plays a node on a serial line in wall-clock time, as a box would: what SerialNode is attached to when there
// is no box. The node lives in instants of its own: characters have ended when they were read, what it wants
// to do at an instant is done as soon as the clock of the machine is there. How late the system made it is
// told through the upper channel, of which this is the Device.
namespace fieldproof::valve_bus {

class NodePlayer final : public iut::Device, private segment::Port, private NodeBoards {
 public:
  using MakeNode =
      std::function<std::unique_ptr<NodeDevice>(const NodeConfiguration&, const iut::CaseBegin& begin)>;

  // The line must outlive the player.
  NodePlayer(iut::SerialLine& line, MakeNode make_node) : line_(line), make_node_(std::move(make_node)) {}

  // Without an upper channel: this node, powered from now on.
  void begin_alone(const NodeConfiguration& configuration);
  // Goes on until the descriptor can be read; for ever with -1.
  void play(int descriptor);

  // ---- the upper channel ----
  iut::UnitKind unit_kind() const override { return iut::UnitKind::characters; }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override;
  // Has gone on until then, and tells what has happened.
  void on_time(kernel::Time until) override;
  kernel::Time next_time() const override;
  void end() override;

 private:
  // Characters without a gap, with the driver around them.
  struct Block {
    iut::Transmission transmission;
    kernel::Time end{};  // of the last stop bit
  };
  struct Write {
    iut::Item item;
    std::uint64_t value;
    kernel::Time when;
  };
  using Report = std::variant<Write, iut::Transmission>;

  void start(const NodeConfiguration& configuration, const iut::CaseBegin& begin);
  // Waits until then at most, or for what comes first, and does what is due.
  void turn(kernel::Time until, int descriptor);
  void hear(const iut::Arrival& arrival);
  // The node acts up to this instant; characters that are over are put on the line.
  void advance(kernel::Time until);
  void say(const Block& block);
  void report();

  void drive(line::Waveform& wave) override;
  std::uint16_t limit_switches(kernel::Time) override { return switches_; }
  void drive_valves(std::uint16_t valves, kernel::Time when) override;

  iut::SerialLine& line_;
  MakeNode make_node_;
  iut::WallClock clock_;
  std::unique_ptr<NodeDevice> node_;
  std::unique_ptr<CharacterCodec> codec_;
  Rules rules_;
  iut::Bench* bench_ = nullptr;
  bool is_supplied_ = false;
  kernel::Time now_{};  // of the node
  kernel::Time driven_until_{};
  kernel::Time driver_on_{};
  std::uint16_t switches_ = 0;
  std::deque<Block> blocks_;
  std::deque<Report> reports_;
  std::uint64_t heard_ = 0;  // octets
  std::uint64_t said_ = 0;
};

}  // namespace fieldproof::valve_bus
