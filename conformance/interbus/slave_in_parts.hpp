#pragma once

#include <array>
#include <deque>
#include <memory>

#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/device.hpp"

// A slave that is given a transmission in parts, each when it begins. A segment hands a transmission over
// whole; a slave that works through it at once would know what comes at port 0 before what comes back at
// ports 1 and 2 earlier. Within one transmission that matters only where an ID cycle may have switched the
// ways: the telegram after its end begins a part, and the next transfer phase, if that comes later.
//
// A part begins with the start level of a telegram, as the receiver of a reference finds it. What is left of
// a transmission when another one begins at the same port means nothing, so it is dropped.
namespace fieldproof::conformance {

// What comes back is given whole, or telegram by telegram.
enum class ReturnParts : std::uint8_t { whole, telegrams };

class SlaveInParts final : public interbus::SlaveDevice {
 public:
  SlaveInParts(std::unique_ptr<interbus::SlaveDevice> slave, const interbus::Rules& rules,
               ReturnParts returns);

  void wire(const interbus::SlavePorts& ports, interbus::Terminals& terminals) override {
    slave_->wire(ports, terminals);
  }
  void set_next_present(bool on_branch, bool present) override {
    slave_->set_next_present(on_branch, present);
  }
  void set_power(bool is_on, kernel::Time now) override;
  bool has_line_interface() const override { return slave_->has_line_interface(); }
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  void end() override { slave_->end(); }

 private:
  // Of an ID cycle, at port 0.
  enum class Phase : std::uint8_t { none, check, pause };

  struct Part {
    segment::PortIndex port;
    line::Waveform wave;
  };

  bool begins_part(segment::PortIndex port, const line::Telegram& telegram);
  void cut(segment::PortIndex port, const line::Waveform& reception);
  void forget(segment::PortIndex port);

  std::unique_ptr<interbus::SlaveDevice> slave_;
  std::array<line::TelegramReceiver, 3> receivers_;
  ReturnParts returns_;
  Phase phase_ = Phase::none;
  std::deque<Part> later_;           // in order of time
  std::vector<std::size_t> starts_;  // of parts in a reception, in levels; a member for its buffer
};

}  // namespace fieldproof::conformance
