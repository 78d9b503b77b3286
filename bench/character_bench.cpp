// Start-stop characters beside a receiver that goes bit by bit, and transmissions through the channel of a
// fault plan beside taking a copy of them.
#include <memory>
#include <vector>

#include "bench/rows.hpp"
#include "harness/fault/plan.hpp"
#include "harness/fault/telegram_fields.hpp"
#include "harness/kernel/random.hpp"
#include "harness/line/character.hpp"

namespace fieldproof::bench {
namespace {

constexpr line::CharacterFormat kFormat{8, line::Parity::even, line::StopBits::one};
constexpr std::int64_t kBitRate = 500'000;
constexpr std::size_t kCharacters = 256;
constexpr std::size_t kRounds = 20;

line::Waveform characters() {
  kernel::Random random(1);
  const line::CharacterCode code(kFormat);
  line::Waveform wave;
  wave.rate = kBitRate;
  for (std::size_t n = 0; n < kCharacters; ++n) {
    code.append(wave.levels, static_cast<unsigned>(random.below(256)));
    wave.levels.append_idle(random.below(3));
  }
  return wave;
}

// One state, one counter, one shift register, asked for each bit.
Batch bit_by_bit() {
  return [wave = characters()]() -> std::uint64_t {
    std::uint64_t good = 0;
    for (std::size_t round = 0; round < kRounds; ++round) {
      unsigned at = 0;
      unsigned data = 0;
      unsigned ones = 0;
      for (std::size_t n = 0; n < wave.levels.size(); ++n) {
        const bool level = wave.levels[n];
        if (at == 0) {
          if (!level) at = 1, data = 0, ones = 0;
        } else if (at <= 8) {
          data |= unsigned{level} << (at - 1);
          ones += level;
          ++at;
        } else if (at == 9) {
          ones += level;
          ++at;
        } else {
          if (level && ones % 2 == 0 && data < 256) ++good;
          at = 0;
        }
      }
    }
    return good;
  };
}

Batch fast() {
  return [wave = characters(), code = line::CharacterCode(kFormat)]() -> std::uint64_t {
    std::uint64_t good = 0;
    for (std::size_t round = 0; round < kRounds; ++round) {
      code.decode(wave.levels, 0, [&](const line::Character& character) { good += character.is_good(); });
    }
    return good;
  };
}

Batch sampled() {
  return [wave = characters(), receiver = line::CharacterReceiver(kFormat, kBitRate),
          received = std::vector<line::CharacterReceiver::Received>()]() mutable -> std::uint64_t {
    std::uint64_t good = 0;
    for (std::size_t round = 0; round < kRounds; ++round) {
      received.clear();
      receiver.receive(wave, received);
      for (const auto& one : received) good += one.character.is_good();
    }
    return good;
  };
}

line::Waveform train() {
  const line::TelegramCode code{line::TelegramLayout{}};
  line::Waveform wave;
  wave.rate = kBitRate;
  for (std::uint8_t n = 0; n < 14; ++n) code.append(wave.levels, line::kDataTelegram, n);
  return wave;
}

// A receiver after a plan, and a train of telegrams that passes again and again.
class Passing {
 public:
  explicit Passing(fault::Rule rule)
      : installed_(fault::Plan({std::move(rule)}), trace_, kernel::Random(1)),
        channel_(installed_.channel_for({"rx", trace_.add_channel("rx")},
                                        std::make_unique<fault::TelegramFields>(line::TelegramLayout{}))) {
    sent_ = train();
  }

  std::uint64_t pass(std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
      arrivals_.clear();
      channel_->pass(sent_, arrivals_);
    }
    return count;
  }

 private:
  trace::Trace trace_;
  fault::InstalledPlan installed_;
  fault::Channel* channel_;
  line::Waveform sent_;
  line::Waveforms arrivals_;
};

Batch passing(fault::Rule rule, std::size_t count) {
  return [world = std::make_shared<Passing>(std::move(rule)), count] { return world->pass(count); };
}

Batch closed_window() {
  fault::Rule rule;
  rule.when.from = kernel::kStart + kernel::kSecond;
  return passing(rule, 100'000);
}

Batch another_frame() {
  fault::Rule rule = fault::flip_level("rx", "data", 0);
  rule.when.frame = fault::Numbers::only(fault::Numbers{}.last);
  return passing(rule, 1'000);
}

Batch flips() {
  return passing(fault::flip_level("rx", "data", 0), 100);
}

// Of the transmission that `Passing` passes.
Batch copies() {
  return [wave = train(), copy = line::Waveform()]() mutable -> std::uint64_t {
    for (int n = 0; n < 10'000; ++n) copy = wave;
    return 10'000 + (copy.levels.empty() ? 1U : 0U);
  };
}

const Rows kRows({{"character decode", "bit by bit", "characters", "", 0, bit_by_bit},
                  {"character decode", "fieldproof", "characters", "bit by bit", 3, fast},
                  {"character decode", "fieldproof, sampled", "characters", "bit by bit", 0, sampled},
                  {"fault plan", "copy of the waveform", "transmissions", "", 0, copies},
                  {"fault plan", "window not open", "transmissions", "copy", 0, closed_window},
                  {"fault plan", "another frame is meant", "transmissions", "copy", 0, another_frame},
                  {"fault plan", "14 flips", "transmissions", "copy", 0, flips}});

}  // namespace
}  // namespace fieldproof::bench
