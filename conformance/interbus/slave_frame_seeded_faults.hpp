#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "conformance/interbus/slave_seeded_faults.hpp"

// Slaves that differ in what they take for a good cycle, and in the telegrams that they hear.
namespace fieldproof::conformance::slave_seeded_faults {

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

// Takes a cycle for whole that has a telegram too few for its register and the loopback word.
class TakesACycleOneTelegramShort : public Slave {
  using Slave::Slave;
  std::size_t least_octets(std::size_t register_octets) const override {
    return Slave::least_octets(register_octets) - 1;
  }
};

class DoesNotLookAtTheLength : public Slave {
  using Slave::Slave;
  std::size_t least_octets(std::size_t) const override { return 0; }
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

// Keeps its error in a bit that each missing stop level turns over.
class SecondMissingStopTakesTheErrorBack : public Slave {
  using Slave::Slave;
  bool is_telegram_valid(const line::Telegram& telegram) const override {
    if (telegram.is_stop_missing()) ++missing_;
    return Slave::is_telegram_valid(telegram);
  }
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const override {
    return Slave::status_octet_to_send(received, mark, own_error && !is_taken_back());
  }
  bool accepts_cycle(bool own_check_good, bool upstream_clean) const override {
    return Slave::accepts_cycle(own_check_good || is_taken_back(), upstream_clean);
  }
  void on_cycle_end(kernel::Time) override { missing_ = 0; }
  bool is_taken_back() const { return missing_ > 0 && missing_ % 2 == 0; }
  mutable unsigned missing_ = 0;
};

// What begins after a cycle that was broken off has no errors yet.
class ForgetsTheMissingStopOfABegin : public Slave {
  using Slave::Slave;
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    is_broken_off_ = true;
    Slave::on_cycle_rejected(when, own_error);
  }
  void on_cycle_end(kernel::Time) override { is_broken_off_ = false; }
  bool is_telegram_valid(const line::Telegram& telegram) const override {
    return std::exchange(is_broken_off_, false) || Slave::is_telegram_valid(telegram);
  }
  mutable bool is_broken_off_ = false;
};

// Looks at the high octet of the status word for the marks of others.
class TakesHalfAStatusWord : public Slave {
  using Slave::Slave;
  std::uint8_t status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const override {
    high_ = low_;
    low_ = received;
    return Slave::status_octet_to_send(received, mark, own_error);
  }
  bool accepts_cycle(bool own_check_good, bool) const override {
    return own_check_good && high_ == rules().status_clean >> 8;
  }
  mutable unsigned high_ = 0;
  mutable std::uint8_t low_ = 0;
};

// Marks a cycle with a missing stop level, and reports nothing.
class TellsNoMissingStop : public Slave {
  using Slave::Slave;
  bool is_telegram_valid(const line::Telegram& telegram) const override {
    if (telegram.is_stop_missing()) is_missing_ = true;
    return Slave::is_telegram_valid(telegram);
  }
  void on_cycle_rejected(kernel::Time when, bool own_error) override {
    if (!is_missing_) Slave::on_cycle_rejected(when, own_error);
    is_missing_ = false;
  }
  mutable bool is_missing_ = false;
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

// Misses a start bit right after a stop bit.
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

}  // namespace fieldproof::conformance::slave_seeded_faults
