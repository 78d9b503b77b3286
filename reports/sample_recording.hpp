// For tests: a small recording of a case that fails, with transmissions that a fault changed, and a dissector
// of its own.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <string>

#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

namespace fieldproof::reports {

// Of a protocol in which a transmission whose first levels are 00 carries a wrong check.
class SampleDissector final : public trace::Dissector {
 public:
  std::int64_t bit_rate() const override { return 1'000'000; }
  std::uint8_t capture_number() const override { return 200; }
  std::uint8_t capture_variant() const override { return 7; }
  std::string brief(const line::Waveform& wave) const override { return wave.levels.text(); }
  std::unique_ptr<trace::Teller> teller() const override { return std::make_unique<SampleTeller>(); }

 private:
  class SampleTeller final : public trace::Teller {
   public:
    trace::Decoded tell(const line::Waveform& wave) override {
      return {fmt::format("frame {}: {}", ++count_, wave.levels.text()), !wave.levels[0] && !wave.levels[1]};
    }

   private:
    int count_ = 0;
  };
};

inline line::Waveform sample_wave(int us, std::uint64_t levels, unsigned count) {
  line::Waveform wave{kernel::kStart + us * kernel::kMicrosecond, 1'000'000, {}};
  wave.levels.append(levels, count);
  return wave;
}

inline trace::Recording sample_recording() {
  trace::Recording recording;
  recording.channels = {"master/in", "slave@1/in", "slave@1"};
  recording.records = {
      trace::Transmission{0, sample_wave(0, 0b10110110, 8), std::nullopt},
      trace::Transmission{0, sample_wave(20, 0b10110110, 8), 0},
      trace::Fault{0, kernel::kStart + 24 * kernel::kMicrosecond, "flip levels 4..4"},
      trace::Fault{0, kernel::kStart + 23 * kernel::kMicrosecond, "flip levels 3..3"},
      trace::Observation{2, kernel::kStart + 30 * kernel::kMicrosecond, "output", 0x1A5FF},
      trace::Transmission{1, sample_wave(40, 0b10110100, 8), 1},
      trace::Transmission{1, sample_wave(60, 0b10110100, 8), std::nullopt},
  };
  recording.changes = {
      {0, sample_wave(20, 0b10110110, 8), {sample_wave(20, 0b10101110, 8)}},
      {1, sample_wave(42, 0b10110100, 8), {}},
  };
  recording.steps = {{kernel::kStart, "1 of 2: the master sends a frame"},
                     {kernel::kStart + 20 * kernel::kMicrosecond, "2 of 2: expected: it is answered"}};
  return recording;
}

}  // namespace fieldproof::reports
