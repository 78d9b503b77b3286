#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "conformance/interbus/slave_seeded_faults.hpp"

// Slaves that differ in their supervision, their interfaces and their messages.
namespace fieldproof::conformance::slave_seeded_faults {

class SafeStateLate : public Slave {
  using Slave::Slave;
  void on_reset(kernel::Time now) override { clear_outputs(now + 500 * kernel::kMillisecond); }
};

class SilenceCountsDataOnly : public Slave {
  using Slave::Slave;
  kernel::Time sign_of_life(kernel::Time, kernel::Time last_data_telegram) const override {
    return last_data_telegram;
  }
};

// A telegram without its stop level is none to its supervision.
class WithoutStopNoSignOfLife : public Slave {
  using Slave::Slave;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  kernel::Time sign_of_life(kernel::Time last_telegram, kernel::Time) const override {
    return is_stop_missing_ ? life_ : life_ = last_telegram;
  }
  bool is_stop_missing_ = false;
  mutable kernel::Time life_ = kNoTelegram;
};

// Its clock stands still to its supervision once it has counted 32 bits of microseconds.
class CountsMicrosecondsIn32Bits : public Slave {
  using Slave::Slave;
  kernel::Time sign_of_life(kernel::Time last_telegram, kernel::Time) const override {
    constexpr kernel::Duration kMost = (std::int64_t{1} << 32) * kernel::kMicrosecond;
    constexpr kernel::Duration kForEver = 100 * kMost;
    return last_telegram.time_since_epoch() < kMost ? last_telegram : last_telegram + kForEver;
  }
};

// Takes what comes back from after its outgoing interfaces for a sign of life of the master.
class KeptAliveByReturns : public Slave {
  using Slave::Slave;
  bool is_sign_of_life(segment::PortIndex) const override { return true; }
};

// Its memory is buffered, or it does not see that the supply has been away.
class KeepsAllWithoutSupply final : public interbus::Slave {
 public:
  using Slave::Slave;
  void set_power(bool, kernel::Time) override {}
};

class ResetLeavesInterfacesOn : public Slave {
  using Slave::Slave;
  bool reset_switches_off() const override { return false; }
};

// Takes no order of a control word that has a bit without a meaning.
// Begins anew as if the supply came back, but for its messages.
class ResetEndsOutgoingReset : public Slave {
  using Slave::Slave;
  void on_reset(kernel::Time now) override {
    Slave::on_reset(now);
    if (std::exchange(is_beginning_, true)) return;
    const std::uint16_t kept = messages();
    set_power(true, now);
    set_messages(kept);
    is_beginning_ = false;
  }
  bool is_beginning_ = false;
};

class IgnoresWordsWithReservedBits : public Slave {
  using Slave::Slave;
  std::uint16_t control_word(std::uint16_t received) override {
    if ((received & ~unsigned{heeded_control_bits()}) == 0) last_ = received;
    return last_;
  }
  std::uint16_t last_ = 0;
};

// Deaf to one order of the control word.
class IgnoresControlBit : public Slave {
 public:
  IgnoresControlBit(const SlaveConfiguration& configuration, std::uint16_t bit)
      : Slave(configuration), bit_(bit) {}

 private:
  std::uint16_t heeded_control_bits() const override {
    return static_cast<std::uint16_t>(Slave::heeded_control_bits() & ~unsigned{bit_});
  }
  std::uint16_t bit_;
};

class InterfaceSwitchesInsideCycle : public Slave {
  using Slave::Slave;
  void on_control_octet(kernel::Time when) override;
  bool goes_new_way(const line::Telegram&) const override { return true; }
};

class OutgoingResetClearsOutputs : public Slave {
  using Slave::Slave;
  void on_control_octet(kernel::Time when) override { last_octet_ = when; }
  void on_id_read(std::uint16_t messages_read) override;
  kernel::Time last_octet_{};
};

class SwitchesWithTheBridge : public Slave {
 public:
  using Slave::Slave;
  void set_next_present(bool on_branch, bool present) override;
};

class IgnoresTheBridge : public Slave {
 public:
  using Slave::Slave;
  void set_next_present(bool, bool) override {}
};

class PeripheralFaultNotTold : public Slave {
  using Slave::Slave;
  std::uint16_t id_register(kernel::Time when) override {
    return static_cast<std::uint16_t>(Slave::id_register(when) & ~unsigned{rules().message_peripheral_fault});
  }
};

class PeripheralFaultMarksDataCycles : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    Slave::sample_inputs(when, octets);
    has_fault_ = terminals().has_peripheral_fault(when);
  }
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const override {
    return Slave::status_octet_to_send(received, mark, own_error || has_fault_);
  }
  bool has_fault_ = false;
};

class MessageNeverCleared : public Slave {
  using Slave::Slave;
  void on_id_read(std::uint16_t) override {}
};

// Clears them by an ID cycle that another station has marked, which the master does not take.
class MessageClearedByMarkedIdCycle : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    Slave::on_cycle_rejected(when, own_error);
    if (!own_error && phase() == Phase::id_check) on_id_read(messages());
  }
};

// Takes a good data cycle for the end of the error.
class MessageClearedByDataCycle : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    return is_good_ = Slave::accepts_cycle(own_check_good, upstream_clean);
  }
  void on_cycle_end(kernel::Time) override {
    if (is_good_ && phase() == Phase::data_check) on_id_read(messages());
  }
  mutable bool is_good_ = false;
};

// Takes the orders of an ID cycle that another station has marked.
class ObeysAMarkedIdCycle : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    return own_check_good && (upstream_clean || phase() == Phase::id_check);
  }
};

// 0 errors are no message to it, and so are 256.
class CountsErrorsIn8Bits : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    Slave::on_cycle_rejected(when, own_error);
    if (own_error && ++errors_ == 0) on_id_read(rules().message_check_error);
  }
  void on_id_read(std::uint16_t messages_read) override {
    errors_ = 0;
    Slave::on_id_read(messages_read);
  }
  std::uint8_t errors_ = 0;
};

class CountsIdCyclesIn8Bits : public Slave {
  using Slave::Slave;
  void on_id_read(std::uint16_t messages_read) override {
    ++id_cycles_;
    Slave::on_id_read(messages_read);
  }
  bool may_drive_outputs(Mode mode) const override {
    return id_cycles_ != 0 && Slave::may_drive_outputs(mode);
  }
  std::uint8_t id_cycles_ = 0;
};

class TellsErrorsOfOthers : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool) override { Slave::on_cycle_rejected(when, true); }
};

class MessageWithoutError : public Slave {
  using Slave::Slave;
  void on_transfer_end(kernel::Time) override { set_messages(rules().message_check_error); }
};

class TellsNoCheckError : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time, bool) override {}
};

}  // namespace fieldproof::conformance::slave_seeded_faults
