#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conformance/interbus/slave_seeded_faults.hpp"

// Slaves that differ in their shift register and in what it does to their terminals.
namespace fieldproof::conformance::slave_seeded_faults {

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

// When the first telegram has come whole.
class SamplesATelegramLate : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    Slave::sample_inputs(when + kernel::levels_duration(line::kDataTelegramLevels, rules().bit_rate), octets);
  }
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

// Terminals that do as those after them, where nothing else is said.
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

// Has room for 16 input words.
class LosesInputWordsAbove16 : public Slave {
  using Slave::Slave;
  void sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) override {
    constexpr std::size_t kRoom = 32;
    Slave::sample_inputs(when, octets);
    if (octets.size() > kRoom) std::ranges::fill(octets.subspan(kRoom), std::uint8_t{0});
  }
};

}  // namespace fieldproof::conformance::slave_seeded_faults
