// Bursts and random flips on a line: what a clean transmission costs, what a hit bit costs, and a binary
// symmetric channel beside the two ways to write one with the standard library.
//
// The frames are those of an INTERBUS line, 182 bits at 500 kbit/s. A hit bit is one during which the output
// of the receiver was wrong for some time; 5 M hit bits/s are 200 ns for each.
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "bench/rows.hpp"
#include "emc/burst_channel.hpp"
#include "emc/profile.hpp"
#include "emc/random_flips.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::bench {
namespace {

constexpr std::int64_t kBitRate = 500'000;
constexpr kernel::Duration kCycle = 814'800 * kernel::kNanosecond;

line::Waveform frame() {
  const line::TelegramCode code{line::TelegramLayout{}};
  kernel::Random random(1);
  line::Waveform wave;
  wave.rate = kBitRate;
  for (unsigned n = 0; n < 14; ++n) {
    code.append(wave.levels, line::kDataTelegram, static_cast<std::uint8_t>(random.below(256)));
  }
  return wave;
}

class BurstLine {
 public:
  explicit BurstLine(bool has_framing, emc::Repetition repetition = emc::Repetition::khz_5)
      : bursts_{.repetition = repetition},
        channel_(
            emc::BurstSchedule(bursts_, kernel::Random(1)),
            emc::LineResponse(emc::Profile::named("A").coupling).wrong_output(1000, emc::Polarity::positive),
            {kBitRate,
             has_framing ? std::make_shared<emc::TelegramFraming>(line::TelegramLayout{}) : nullptr,
             {},
             true,
             true},
            trace_, trace_.add_channel("rx")),
        sent_(frame()) {
    place_frames();
  }

  // Frames far from any burst.
  std::uint64_t pass_clean(std::uint64_t count) {
    const auto& timing = channel_.schedule().timing();
    for (std::uint64_t n = 0; n < count; ++n) {
      sent_.start += kCycle;
      if (channel_.schedule().has_pulse_in(sent_.start - kCycle, sent_.start + kCycle)) {
        sent_.start += timing.pulses * timing.pitch;
        continue;
      }
      channel_.pass(sent_, arrivals_);
    }
    return count;
  }

  // Frames that a pulse hits, one after the other.
  std::uint64_t pass_hit(std::uint64_t count) {
    const std::uint64_t before = channel_.statistics().wrong_levels;
    while (channel_.statistics().wrong_levels - before < count) {
      arrivals_.clear();
      sent_.start = starts_[placed_];
      if (++placed_ == starts_.size()) placed_ = 0;
      channel_.pass(sent_, arrivals_);
    }
    return channel_.statistics().wrong_levels - before;
  }

 private:
  // Frames over pulses, at any phase.
  void place_frames() {
    emc::BurstSchedule schedule(bursts_, kernel::Random(1));
    kernel::Random random(2);
    kernel::Time pulse = kernel::kStart;
    starts_.resize(50'000);
    for (kernel::Time& start : starts_) {
      pulse = schedule.first_from(pulse + kernel::kMillisecond);
      start = pulse - kernel::Duration{static_cast<std::int64_t>(random.below(360'000'000))};
    }
  }

  emc::BurstSettings bursts_;
  trace::Trace trace_;
  emc::BurstChannel channel_;
  line::Waveform sent_;
  line::Waveforms arrivals_;
  std::vector<kernel::Time> starts_;
  std::size_t placed_ = 0;
};

Batch clean() {
  return [line = std::make_shared<BurstLine>(true)] { return line->pass_clean(100'000); };
}

Batch hit(bool has_framing, emc::Repetition repetition = emc::Repetition::khz_5) {
  return [line = std::make_shared<BurstLine>(has_framing, repetition)] { return line->pass_hit(1'000); };
}

// Bits of a frame that is hit, on average: those of `place_frames`.
constexpr double kHitsAt5Khz = 1.1;
constexpr double kHitsAt100Khz = 11.2;

// Asks a coin for each bit of the frames that the bursts hit, as many bits of a frame being hit.
Batch naive_injector(double hits_per_frame) {
  return
      [sent = frame(), engine = std::mt19937_64(1), coin = std::bernoulli_distribution(hits_per_frame / 182),
       arrivals = line::Waveforms()]() mutable -> std::uint64_t {
        std::uint64_t hits = 0;
        while (hits < 1'000) {
          arrivals.clear();
          line::Waveform& arrival = arrivals.add(sent);
          for (std::size_t n = 0; n < sent.levels.size(); ++n) {
            if (!coin(engine)) continue;
            arrival.levels.flip(n);
            ++hits;
          }
        }
        return hits;
      };
}

Batch copies() {
  return [wave = frame(), copy = line::Waveform()]() mutable -> std::uint64_t {
    for (int n = 0; n < 10'000; ++n) copy = wave;
    return 10'000 + (copy.levels.empty() ? 1U : 0U);
  };
}

// ---- a binary symmetric channel with one error in a hundred bits ----

constexpr double kErrorRate = 0.01;
constexpr std::uint64_t kFrames = 2'000;

Batch bit_by_bit() {
  return [sent = frame(), engine = std::mt19937_64(1), coin = std::bernoulli_distribution(kErrorRate),
          arrivals = line::Waveforms()]() mutable -> std::uint64_t {
    for (std::uint64_t frames = 0; frames < kFrames; ++frames) {
      arrivals.clear();
      bool is_changed = false;
      for (std::size_t n = 0; n < sent.levels.size(); ++n) {
        if (!coin(engine)) continue;
        if (!is_changed) arrivals.add(sent);
        is_changed = true;
        arrivals.back().levels.flip(n);
      }
    }
    return kFrames * sent.levels.size();
  };
}

Batch standard_skips() {
  return [sent = frame(), engine = std::mt19937_64(1),
          skip = std::geometric_distribution<std::int64_t>(kErrorRate), arrivals = line::Waveforms(),
          left = std::int64_t{0}]() mutable -> std::uint64_t {
    const auto size = static_cast<std::int64_t>(sent.levels.size());
    for (std::uint64_t frames = 0; frames < kFrames; ++frames) {
      arrivals.clear();
      if (left < size) arrivals.add(sent);
      for (; left < size; left += skip(engine) + 1)
        arrivals.back().levels.flip(static_cast<std::size_t>(left));
      left -= size;
    }
    return kFrames * sent.levels.size();
  };
}

Batch own_skips() {
  return [sent = frame(), channel = std::make_shared<emc::BernoulliChannel>(kErrorRate, kernel::Random(1)),
          arrivals = line::Waveforms()]() mutable -> std::uint64_t {
    for (std::uint64_t frames = 0; frames < kFrames; ++frames) {
      arrivals.clear();
      channel->pass(sent, arrivals);
    }
    return kFrames * sent.levels.size();
  };
}

const Rows kRows({{"burst channel, clean", "copy of the waveform", "transmissions", "", 0, copies},
                  {"burst channel, clean", "no pulse", "transmissions", "copy", 0.5, clean},
                  {"burst channel, hit at 5 kHz", "a coin for each bit", "hit bits", "", 0,
                   [] { return naive_injector(kHitsAt5Khz); }},
                  {"burst channel, hit at 5 kHz", "fieldproof", "hit bits", "a coin", 1,
                   [] { return hit(true); }},
                  {"burst channel, hit at 5 kHz", "fieldproof, each rewritten", "hit bits", "a coin", 0,
                   [] { return hit(false); }},
                  {"burst channel, hit at 100 kHz", "a coin for each bit", "hit bits", "", 0,
                   [] { return naive_injector(kHitsAt100Khz); }},
                  {"burst channel, hit at 100 kHz", "fieldproof", "hit bits", "a coin", 0,
                   [] { return hit(true, emc::Repetition::khz_100); }},
                  {"flips at 1 in 100", "a coin for each bit", "bits", "", 0, bit_by_bit},
                  {"flips at 1 in 100", "std::geometric_distribution", "bits", "", 0, standard_skips},
                  {"flips at 1 in 100", "fieldproof", "bits", "std::geometric", 1.4, own_skips}});

}  // namespace
}  // namespace fieldproof::bench
