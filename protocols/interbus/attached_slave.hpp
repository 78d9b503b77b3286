#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/slave_settings.hpp"
#include "protocols/interbus/telegram_front.hpp"

// A slave between the bench and an implementation outside, in both directions: AttachedSlave is a slave of
// the bench that an iut::Device plays; ServedSlave is an iut::Device that a slave of ours plays.
//
// The implementation hears and says levels or telegrams (telegram_front.hpp), on the ports of SlaveDevice. It
// is told a reception whole, when it begins: what it drives passes on levels that have come by then. It
// writes and reads the items below, and is told the settings of slave_settings.
namespace fieldproof::interbus {

inline constexpr iut::Item kOutputWord = 0x000;  // write, + word
inline constexpr iut::Item kInputWord = 0x100;   // read, + word
inline constexpr iut::Item kPeripheralFault = 0x200;
inline constexpr iut::Item kReconfiguration = 0x201;  // the button is pressed
inline constexpr iut::Item kRemotePlugged = 0x202;    // the bridge in the plug of OUT1 is closed
inline constexpr iut::Item kBranchPlugged = 0x203;    // of OUT2

class AttachedSlave final : public SlaveDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedSlave(iut::Attachment attachment, const SlaveConfiguration& configuration,
                const std::string& case_id, std::uint64_t seed);

  void wire(const SlavePorts& ports, Terminals& terminals) override;
  void set_next_present(bool on_branch, bool present) override {
    (on_branch ? branch_present_ : remote_present_) = present;
  }
  void set_power(bool is_on, kernel::Time now) override;
  bool has_line_interface() const override { return front_ == nullptr; }
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  void end() override;

 private:
  void tell(unsigned port, std::span<const iut::Character> telegrams, kernel::Time now);
  void drive(unsigned port, line::Waveform& wave);
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;

  unsigned words_;
  iut::AttachedCase attached_;
  std::unique_ptr<TelegramFront> front_;  // of one that hears telegrams
  std::array<segment::Port*, 3> ports_{};
  Terminals* terminals_ = nullptr;
  bool is_supplied_ = false;
  bool remote_present_ = true;
  bool branch_present_ = true;
};

class ServedSlave final : public iut::ServedStation<SlaveDevice>, private Terminals {
 public:
  using Make = std::function<std::unique_ptr<SlaveDevice>(const SlaveConfiguration&)>;
  explicit ServedSlave(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  using iut::ServedStation<SlaveDevice>::receive;
  void receive(unsigned port, const line::Waveform& reception) override {
    act(reception.start, [&] { station().receive(port, reception); });
  }

 private:
  void before_call() override;
  std::uint16_t input(unsigned word, kernel::Time when) override;
  void output(unsigned word, std::uint16_t value, kernel::Time when) override;
  bool has_peripheral_fault(kernel::Time when) override;
  bool wants_reconfiguration(kernel::Time when) override;

  Make make_;
  bool is_wired_ = false;
  bool is_branch_plugged_ = false;
  bool is_remote_plugged_ = false;
};

// The role as benches and attachments know it.
struct SlaveRole {
  using Device = SlaveDevice;
  using Configuration = SlaveConfiguration;
  using Attached = AttachedSlave;
  using Served = ServedSlave;
  static constexpr const char* protocol = "interbus";
  static constexpr const char* role = "slave";
};

}  // namespace fieldproof::interbus
