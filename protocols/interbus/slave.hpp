#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "harness/line/frame_check_16.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/shift_line.hpp"
#include "protocols/interbus/telegram_relay.hpp"

// The INTERBUS slave: a piece of the distributed shift register between its receive side and its send side,
// with a frame check at each of them.
//
// A cycle of data (or ID) telegrams is a transfer phase, in which each telegram shifts eight bits through the
// register, and a check phase: two telegrams with the check of what the *sender next to it* sent, two with
// the status word. In the check phase the slave sends the check of what it sent itself, compares what it
// received with the check of what it received, and marks the status word when they differ.
//
//   mode    reset ──good ID cycle──▶ active ──silence──▶ reset
//   phase   pause ─▶ data_transfer ─▶ data_check ─▶ pause       a telegram of another class than the phase
//           pause ─▶ id_transfer   ─▶ id_check   ─▶ pause       expects abandons the cycle
//
// Outputs change only in mode active, at the end of a check phase that `accepts_cycle`. The interfaces switch
// only at the end of a good ID cycle. Each decision that a standard leaves no choice about is a virtual
// function, so that a mutant is the override of exactly one.
//
// Limits: the analogue side is not modelled; a telegram is regenerated whole, also one whose stop bit is
// missing.
namespace fieldproof::interbus {

class Slave : public SlaveDevice {
 public:
  static constexpr kernel::Time kNoTelegram{kernel::Duration::min()};

  enum class Mode { reset, active };
  enum class Phase { pause, data_transfer, data_check, id_transfer, id_check };

  explicit Slave(const SlaveConfiguration& configuration);

  void wire(const SlavePorts& ports, Terminals& terminals) override;
  void set_next_present(bool on_branch, bool present) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  Mode mode() const { return mode_; }
  Phase phase() const { return phase_; }
  bool is_interface_on(bool on_branch) const { return on_branch ? branch_on_ : remote_on_; }

 protected:
  Slave(const SlaveConfiguration& configuration, line::TelegramReceiverOptions receiver);

  const Rules& rules() const { return configuration_.rules; }
  const SlaveConfiguration& configuration() const { return configuration_; }
  Terminals& terminals() { return *terminals_; }
  // Words of the register as they stand, output side.
  std::span<const std::uint8_t> register_octets() const { return shift_.held(); }
  std::uint16_t messages() const { return messages_; }

  // ---- decisions ----
  virtual bool is_telegram_valid(const line::Telegram& telegram) const { return !telegram.is_stop_missing(); }
  // Whether the receiver finds the next telegram after one without stop bit.
  virtual bool resynchronises() const { return true; }
  virtual bool status_telegram_shifts() const { return false; }
  virtual kernel::Time sign_of_life(kernel::Time last_telegram, kernel::Time last_data_telegram) const;
  // Of the telegrams that are heard there.
  virtual bool is_sign_of_life(segment::PortIndex port) const { return port == kFromUpstream; }
  virtual line::FrameCheck16::State check_preset() const { return check_.start(); }
  virtual line::FrameCheck16::State check_to_send(line::FrameCheck16::State received,
                                                  line::FrameCheck16::State sent) const;
  virtual std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const;
  // A ring is never shorter than this register and the loopback word, whatever the check of a fragment says.
  virtual std::size_t least_octets(std::size_t register_octets) const;
  virtual bool check_octet_fits(unsigned n, std::uint8_t received, std::uint8_t expected) const;
  virtual bool accepts_cycle(bool own_check_good, bool upstream_clean) const;
  virtual bool may_drive_outputs(Mode mode) const { return mode == Mode::active; }
  virtual void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets);
  virtual std::uint16_t word_of(std::uint8_t first, std::uint8_t second) const;
  virtual std::uint16_t id_register(kernel::Time when);
  virtual void on_transfer_end(kernel::Time) {}
  // The last octet of the status word has passed, whatever became of the cycle.
  virtual void on_cycle_end(kernel::Time) {}
  // A check telegram outside of a cycle, which is passed on.
  virtual void on_stray_check() {}
  virtual void on_cycle_rejected(kernel::Time, bool own_error);
  virtual void on_id_read(std::uint16_t messages_read) {
    messages_ &= static_cast<std::uint16_t>(~messages_read);
  }
  // Called for each octet of a transfer phase of an ID cycle: a slave that acts on its control word early.
  virtual void on_control_octet(kernel::Time) {}
  // Whether `next`, after a control word that took effect, goes the new way already.
  virtual bool goes_new_way(const line::Telegram& next) const {
    return !next.is_data() || (next.header & line::kControl) == 0;
  }
  virtual void on_reset(kernel::Time now);
  virtual bool reset_switches_off() const { return true; }
  // What takes effect of a control word that was received whole.
  virtual std::uint16_t control_word(std::uint16_t received) { return received; }
  virtual std::uint16_t heeded_control_bits() const;

  // ---- what the decisions act with ----
  void latch_outputs(kernel::Time when);
  void clear_outputs(kernel::Time when);
  void apply_control(std::uint16_t control, kernel::Time when);
  void set_messages(std::uint16_t bits) { messages_ |= bits; }

 private:
  void on_upstream(const line::Waveform& wave, const line::Telegram& telegram);
  std::uint8_t on_data(const line::Waveform& wave, const line::Telegram& telegram);
  std::uint8_t on_transfer(bool id_cycle, const line::Waveform& wave, const line::Telegram& telegram);
  std::uint8_t on_check(bool id_cycle, const line::Waveform& wave, const line::Telegram& telegram);
  void enter_transfer(bool id_cycle, kernel::Time when);
  void enter_check(kernel::Time when);
  void finish_cycle(kernel::Time end);
  void finish_data_cycle(bool good, kernel::Time end);
  void finish_id_cycle(bool good, kernel::Time end);
  void abandon_cycle(kernel::Time when);
  void relay_only(segment::PortIndex port, const line::Waveform& reception);
  void enter_reset(kernel::Time now);
  void switch_forward_ways(const line::Telegram& telegram);
  void switch_return_ways();
  void supervise();
  void flush_receivers(kernel::Time now);
  bool is_silence_ending() const;
  kernel::Time end_of(const line::Waveform& wave, const line::Telegram& telegram) const;
  void note_life(const line::Waveform& wave, const line::Telegram& telegram);
  kernel::Duration delay_to(segment::PortIndex to, segment::PortIndex from) const;
  segment::PortIndex next_after(segment::PortIndex from) const;
  void open_way(segment::PortIndex from, kernel::Time now);
  bool lacks_stop(const line::Telegram& telegram) const {
    return telegram.is_stop_missing() && !is_telegram_valid(telegram);
  }

  SlaveConfiguration configuration_;
  const line::TelegramCode& code_;
  const line::FrameCheck16& check_;
  std::array<line::TelegramReceiver, 3> receivers_;  // by PortIndex
  std::array<TelegramRelay, 3> relays_;
  std::array<TelegramRelay::Way, 3> ways_;  // out, by PortIndex, too: kFromRemote leads to OUT1
  std::array<kernel::Duration, 2> delays_;  // forward, return
  SlavePorts ports_;
  Terminals* terminals_ = nullptr;

  Mode mode_ = Mode::reset;
  Phase phase_ = Phase::pause;
  ShiftLine shift_;
  unsigned check_octets_seen_ = 0;
  std::array<std::uint8_t, 2> check_sent_{};
  std::array<std::uint8_t, 2> check_expected_{};
  bool own_error_ = false;
  bool upstream_clean_ = true;
  std::uint16_t messages_ = 0;
  std::uint16_t messages_read_ = 0;  // loaded into the ID register of the running ID cycle

  bool branch_present_ = true;
  bool remote_present_ = true;
  bool branch_on_ = false;
  bool remote_on_ = false;
  bool forward_branch_on_ = false;  // the same for the ways out, see switch_forward_ways
  bool forward_remote_on_ = false;
  bool return_branch_on_ = false;  // and for the ways back, see switch_return_ways
  bool return_remote_on_ = false;
  kernel::Time outgoing_reset_until_{kernel::Duration::min()};

  bool route_changed_ = false;  // a control word has taken effect, nothing has gone the new way yet
  bool shifts_status_ = false;
  bool is_supplied_ = true;
  bool is_deaf_ = false;  // a deviating receiver that does not resynchronise
  kernel::Time now_{};    // of the reception in work
  kernel::Time last_telegram_ = kNoTelegram;
  kernel::Time last_data_ = kNoTelegram;
  kernel::Time supervised_life_ = kNoTelegram;  // the sign of life that silence_end_ was reckoned from
  kernel::Time silence_end_ = kernel::kNever;
};

std::string_view name(Slave::Mode mode);
std::string_view name(Slave::Phase phase);

}  // namespace fieldproof::interbus
