#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "protocols/interbus/slave.hpp"

// The deviating slaves, one class each; the table of their names is in slave_deviations.cpp.
namespace fieldproof::conformance::slave_deviants {

using interbus::Slave;
using interbus::SlaveConfiguration;
using interbus::SlavePorts;
using interbus::Terminals;

// ---- frame check and status word ----

class SendsCheckOfReceivedBits : public Slave {
  using Slave::Slave;
  line::FrameCheck16::State check_to_send(line::FrameCheck16::State received,
                                          line::FrameCheck16::State) const override {
    return received;
  }
};

class CheckNotResetBetweenCycles : public Slave {
  using Slave::Slave;
  line::FrameCheck16::State check_preset() const override {
    return has_left_ ? left_ : Slave::check_preset();
  }
  line::FrameCheck16::State check_to_send(line::FrameCheck16::State,
                                          line::FrameCheck16::State sent) const override {
    has_left_ = true;
    return left_ = sent;
  }
  mutable bool has_left_ = false;
  mutable line::FrameCheck16::State left_ = 0;
};

class ComparesFirstCheckOctetOnly : public Slave {
  using Slave::Slave;
  bool check_octet_fits(unsigned n, std::uint8_t received, std::uint8_t expected) const override {
    return n > 0 || received == expected;
  }
};

class AcceptsCheckOfZero : public Slave {
  using Slave::Slave;
  bool check_octet_fits(unsigned, std::uint8_t received, std::uint8_t expected) const override {
    return received == 0 || received == expected;
  }
};

class LatchesInSpiteOfOwnError : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool, bool upstream_clean) const override { return upstream_clean; }
};

class IgnoresUpstreamStatus : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool) const override { return own_check_good; }
};

class DoesNotMarkStatus : public Slave {
  using Slave::Slave;
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t, bool) const override {
    return received;
  }
};

class ClearsMarkOfOthers : public Slave {
  using Slave::Slave;
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const override {
    return static_cast<std::uint8_t>(own_error ? received | mark : received & ~unsigned{mark});
  }
};

// Looks for the loopback word that masters usually send, and takes a cycle without it for a wrong one.
class ExpectsTheUsualLoopbackWord : public Slave {
 public:
  using Slave::Slave;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override;
  mutable std::deque<bool> has_word_;  // of the cycles of the reception
};

class LosesEvery200thCycle : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    return Slave::accepts_cycle(own_check_good, upstream_clean) && ++cycles_ % 200 != 0;
  }
  mutable unsigned cycles_ = 0;
};

class LocksUpAfterRejectedCycle : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    return !is_locked_ && Slave::accepts_cycle(own_check_good, upstream_clean);
  }
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    is_locked_ = true;
    Slave::on_cycle_rejected(when, own_error);
  }
  bool is_locked_ = false;
};

class WaitsForIdCycleAfterRejectedCycle : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    const bool is_deaf = is_waiting_ && phase() == Phase::data_check;
    return !is_deaf && Slave::accepts_cycle(own_check_good, upstream_clean);
  }
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    is_waiting_ = true;
    Slave::on_cycle_rejected(when, own_error);
  }
  void on_id_read(std::uint16_t messages_read) override {
    is_waiting_ = false;
    Slave::on_id_read(messages_read);
  }
  bool is_waiting_ = false;
};

class LosesTheCycleBehindARejectedOne : public Slave {
  using Slave::Slave;
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    const bool loses = has_rejected_;
    has_rejected_ = false;
    return !loses && Slave::accepts_cycle(own_check_good, upstream_clean);
  }
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    has_rejected_ = own_error;
    Slave::on_cycle_rejected(when, own_error);
  }
  mutable bool has_rejected_ = false;
};

// ---- telegrams ----

class StopBitNotChecked : public Slave {
  using Slave::Slave;
  bool is_telegram_valid(const line::Telegram&) const override { return true; }
};

class DoesNotResynchronise : public Slave {
  using Slave::Slave;
  bool resynchronises() const override { return false; }
};

class StatusTelegramShifts : public Slave {
  using Slave::Slave;
  bool status_telegram_shifts() const override { return true; }
};

class StartBitNotValidated : public Slave {
 public:
  explicit StartBitNotValidated(const SlaveConfiguration& configuration)
      : Slave(configuration, {.sampling = {}, .validates_start = false}) {}
};

class StrayTelegramSpoilsNextCycle : public Slave {
  using Slave::Slave;
  void on_stray_check() override { is_spoilt_ = true; }
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    const bool was_spoilt = is_spoilt_;
    is_spoilt_ = false;
    return !was_spoilt && Slave::accepts_cycle(own_check_good, upstream_clean);
  }
  mutable bool is_spoilt_ = false;
};

// Takes a whole cycle for what its first telegram was.
class IgnoresSelectInsideACycle : public Slave {
 public:
  explicit IgnoresSelectInsideACycle(const SlaveConfiguration& configuration)
      : Slave(configuration), code_(configuration.rules.telegram), layout_(configuration.rules.telegram) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  line::TelegramCode code_;
  line::TelegramLayout layout_;
};

// Misses a start bit right behind a stop bit.
class NeedsIdleBetweenTelegrams : public Slave {
 public:
  explicit NeedsIdleBetweenTelegrams(const SlaveConfiguration& configuration)
      : Slave(configuration), code_(configuration.rules.telegram) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  line::TelegramCode code_;
};

// Adapts its clock to whatever comes.
class FollowsAnyRate : public Slave {
 public:
  using Slave::Slave;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
};

// ---- registers and terminals ----

class IdOctetsSwapped : public Slave {
  using Slave::Slave;
  std::uint16_t id_register(kernel::Time when) override {
    const unsigned id = Slave::id_register(when);
    return static_cast<std::uint16_t>(id << 8 | id >> 8);
  }
};

class OutputOctetsSwapped : public Slave {
  using Slave::Slave;
  std::uint16_t word_of(std::uint8_t first, std::uint8_t second) const override {
    return Slave::word_of(second, first);
  }
};

class InputBitStuck : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    Slave::sample_inputs(when, octets);
    if (!octets.empty()) octets[0] |= 1;
  }
};

class TearsInputs : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override;
};

// The words one telegram apart, each of them whole.
class TearsBetweenInputWords : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override;
};

class SamplesWithPreviousCycle : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    if (sampled_.empty()) return Slave::sample_inputs(when, octets);
    std::ranges::copy(sampled_, octets.begin());
  }
  void on_transfer_end(kernel::Time when) override {
    sampled_.resize(2 * std::size_t{configuration().words});
    Slave::sample_inputs(when, sampled_);
  }
  std::vector<std::uint8_t> sampled_;
};

class LatchesAtEndOfDataPhase : public Slave {
  using Slave::Slave;
  void on_transfer_end(kernel::Time when) override { latch_outputs(when); }
};

class OutputsWithoutIdentification : public Slave {
  using Slave::Slave;
  bool may_drive_outputs(Mode) const override { return true; }
};

class ClearsOutputsOnRejectedCycle : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    Slave::on_cycle_rejected(when, own_error);
    clear_outputs(when);
  }
};

// Terminals that do as those behind them, where nothing else is said.
class PassingTerminals : public Terminals {
 public:
  void attach(Terminals& behind, unsigned words) {
    behind_ = &behind;
    words_ = words;
  }
  std::uint16_t input(unsigned word, kernel::Time when) override {
    return word < words_ ? behind_->input(word, when) : 0;
  }
  void output(unsigned word, std::uint16_t value, kernel::Time when) override {
    if (word < words_) behind_->output(word, value, when);
  }
  bool has_peripheral_fault(kernel::Time when) override { return behind_->has_peripheral_fault(when); }
  bool wants_reconfiguration(kernel::Time when) override { return behind_->wants_reconfiguration(when); }

 protected:
  Terminals& behind() { return *behind_; }

 private:
  Terminals* behind_ = nullptr;
  unsigned words_ = 0;
};

// A register of another length than the terminals have words.
class WrongRegisterLength : public Slave {
 public:
  WrongRegisterLength(const SlaveConfiguration& configuration, unsigned words)
      : Slave(with_words(configuration, words)), real_words_(configuration.words) {}
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    narrow_.attach(terminals, real_words_);
    Slave::wire(ports, narrow_);
  }

 private:
  static SlaveConfiguration with_words(SlaveConfiguration configuration, unsigned words) {
    configuration.words = words;
    return configuration;
  }
  PassingTerminals narrow_;
  unsigned real_words_;
};

class LengthCodeBinary : public WrongRegisterLength {
 public:
  explicit LengthCodeBinary(const SlaveConfiguration& configuration)
      : WrongRegisterLength(configuration, configuration.id_code >> 8 & 0x1FU) {}
};

// The ID register stays in the ring in data cycles, in front of the data.
class IdRegisterInDataCycle : public WrongRegisterLength {
 public:
  explicit IdRegisterInDataCycle(const SlaveConfiguration& configuration)
      : WrongRegisterLength(configuration, configuration.words + 1) {}

 private:
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override;
};

class LatchesLate : public Slave {
 public:
  LatchesLate(const SlaveConfiguration& configuration, kernel::Duration lateness)
      : Slave(configuration), late_(lateness) {}
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    late_.attach(terminals, configuration().words);
    Slave::wire(ports, late_);
  }

 private:
  class LateTerminals final : public PassingTerminals {
   public:
    explicit LateTerminals(kernel::Duration lateness) : lateness_(lateness) {}
    void output(unsigned word, std::uint16_t value, kernel::Time when) override {
      PassingTerminals::output(word, value, when + lateness_);
    }

   private:
    kernel::Duration lateness_;
  };
  LateTerminals late_;
};

class GlitchesOutputsOnRejectedCycle : public Slave {
 public:
  using Slave::Slave;
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    remembering_.attach(terminals, configuration().words);
    Slave::wire(ports, remembering_);
  }

 private:
  class RememberingTerminals final : public PassingTerminals {
   public:
    void output(unsigned word, std::uint16_t value, kernel::Time when) override {
      if (word == 0) first = value;
      PassingTerminals::output(word, value, when);
    }
    std::uint16_t first = 0;
  };
  void on_cycle_rejected(kernel::Time when, bool own_error) override;
  RememberingTerminals remembering_;
};

class OutputsSetAtPowerUp : public Slave {
 public:
  using Slave::Slave;
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    Slave::wire(ports, terminals);
    if (configuration().words > 0) terminals.output(0, 0x0001, kernel::kStart);
  }
};

// ---- what is driven ----

// Changes what the slave drives before it is on the line. `change` gets each waveform.
class ChangingPort final : public segment::Port {
 public:
  using Change = std::function<void(line::Waveform&)>;
  void attach(segment::Port* behind, Change change) {
    behind_ = behind;
    change_ = std::move(change);
  }
  segment::Port* port() { return behind_ == nullptr ? nullptr : this; }
  void drive(line::Waveform& wave) override {
    const std::int64_t rate = wave.rate;
    change_(wave);
    behind_->drive(wave);
    wave.rate = rate;  // the slave uses its waveform again
  }

 private:
  segment::Port* behind_ = nullptr;
  Change change_;
};

class ChangesWhatItDrives : public Slave {
 public:
  explicit ChangesWhatItDrives(const SlaveConfiguration& configuration)
      : Slave(configuration), code_(configuration.rules.telegram) {}
  void wire(const SlavePorts& ports, Terminals& terminals) override;

 protected:
  virtual void change(line::Waveform& wave) = 0;
  const line::TelegramCode& code() const { return code_; }

 private:
  line::TelegramCode code_;
  std::array<ChangingPort, 3> changing_;
};

class SwallowsStatusTelegrams : public ChangesWhatItDrives {
  using ChangesWhatItDrives::ChangesWhatItDrives;
  void change(line::Waveform& wave) override;
};

// Changes the last bit of a transfer octet that leaves at a given place behind the slave's own register.
class ChangesAnOctet : public ChangesWhatItDrives {
  using ChangesWhatItDrives::ChangesWhatItDrives;
  void change(line::Waveform& wave) override;
  virtual bool is_meant(bool is_id_cycle, std::size_t n, std::uint8_t before, std::uint8_t octet) const = 0;
  std::size_t transfer_ = 0;  // telegrams of the cycle so far
  std::uint8_t before_ = 0;
};

class LoopbackWordOfOnesChanged : public ChangesAnOctet {
  using ChangesAnOctet::ChangesAnOctet;
  bool is_meant(bool is_id_cycle, std::size_t n, std::uint8_t before, std::uint8_t octet) const override {
    return !is_id_cycle && n > 2 * configuration().words && before == 0xFF && octet == 0xFF;
  }
};

class LoopbackWordChangedInIdCycle : public ChangesAnOctet {
  using ChangesAnOctet::ChangesAnOctet;
  bool is_meant(bool is_id_cycle, std::size_t n, std::uint8_t, std::uint8_t) const override {
    return is_id_cycle && n == 3;
  }
};

class DelayVaries : public ChangesWhatItDrives {
  using ChangesWhatItDrives::ChangesWhatItDrives;
  void change(line::Waveform& wave) override {
    if (++count_ % 2 == 0) wave.start += kernel::levels_duration(1, rules().bit_rate);
  }
  unsigned count_ = 0;
};

class DoesNotRetime : public ChangesWhatItDrives {
  using ChangesWhatItDrives::ChangesWhatItDrives;
  void change(line::Waveform& wave) override;
};

class SendsDataAtPowerUp : public Slave {
 public:
  using Slave::Slave;
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    upstream_ = ports.upstream;
    Slave::wire(ports, terminals);
  }
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 private:
  segment::Port* upstream_ = nullptr;
  kernel::Time greeting_ = kernel::kStart + 10 * kernel::kMillisecond;
};

// Sends a status telegram of its own while the last telegram of a transmission still leaves.
class DrivesOverItself : public Slave {
 public:
  using Slave::Slave;
  void wire(const SlavePorts& ports, Terminals& terminals) override {
    upstream_ = ports.upstream;
    Slave::wire(ports, terminals);
  }
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  segment::Port* upstream_ = nullptr;
};

class SelectBitInStatusTelegrams : public ChangesWhatItDrives {
  using ChangesWhatItDrives::ChangesWhatItDrives;
  void change(line::Waveform& wave) override;
};

// Drives nothing any more once it has driven so many cycles.
class FallsSilent : public ChangesWhatItDrives {
 public:
  FallsSilent(const SlaveConfiguration& configuration, unsigned cycles)
      : ChangesWhatItDrives(configuration), check_telegrams_left_(4 * cycles) {}

 private:
  void change(line::Waveform& wave) override;
  unsigned check_telegrams_left_;
};

// ---- supervision, interfaces, messages ----

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

class MessageWithoutError : public Slave {
  using Slave::Slave;
  void on_transfer_end(kernel::Time) override { set_messages(rules().message_check_error); }
};

class TellsNoCheckError : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time, bool) override {}
};

}  // namespace fieldproof::conformance::slave_deviants
