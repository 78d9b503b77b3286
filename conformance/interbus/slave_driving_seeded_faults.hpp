#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "conformance/interbus/slave_seeded_faults.hpp"

// Slaves that differ in what they drive.
namespace fieldproof::conformance::slave_seeded_faults {

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

// Changes the last bit of a transfer octet that leaves at a given place after the slave's own register.
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

// Its clock starts a quarter of a bit after the edge; what it passes on leaves as early as if it did not.
class SamplesLate : public ChangesWhatItDrives {
 public:
  explicit SamplesLate(const SlaveConfiguration& configuration, bool on_the_way_back = false)
      : ChangesWhatItDrives(configuration),
        finder_(line::shared_telegram_code(configuration.rules.telegram), configuration.rules.bit_rate),
        on_the_way_back_(on_the_way_back) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override {
    told_ = now;
    Slave::on_time(now);
  }

 private:
  void change(line::Waveform& wave) override;
  line::TelegramReceiver finder_;
  bool on_the_way_back_;
  kernel::Time told_{};
};

// Takes a low pulse of any length for a start level where telegrams come back.
class TakesGlitchesOnTheWayBack : public Slave {
  using Slave::Slave;
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
};

// A telegram that its transmission cuts is idle to it.
class DropsACutTelegram : public Slave {
 public:
  explicit DropsACutTelegram(const SlaveConfiguration& configuration)
      : Slave(configuration),
        finder_(line::shared_telegram_code(configuration.rules.telegram), configuration.rules.bit_rate) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  line::TelegramReceiver finder_;
};

// What goes on with a telegram that the transmission before has cut is idle to it.
class LosesTheRestOfACutTelegram : public Slave {
 public:
  explicit LosesTheRestOfACutTelegram(const SlaveConfiguration& configuration)
      : Slave(configuration),
        finder_(line::shared_telegram_code(configuration.rules.telegram), configuration.rules.bit_rate) {}
  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 private:
  line::TelegramReceiver finder_;
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

}  // namespace fieldproof::conformance::slave_seeded_faults
