#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "harness/fault/channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"

// The channels of the textbooks, for comparison: bits flip by chance, whatever the wave and the receiver are.
// A level of a transmission is a bit.
//
// They walk from flip to flip by geometric skips: a clean transmission costs the binary symmetric channel a
// comparison and a subtraction, however long it is, and that of Gilbert and Elliott a look at the idle time
// in front of it.
namespace fieldproof::emc {

// The binary symmetric channel: each bit flips with probability p, independently.
class BernoulliChannel final : public fault::Channel {
 public:
  // p out of 0..1 is a usage error.
  BernoulliChannel(double flip_probability, kernel::Random random);

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

  std::uint64_t flipped_bits() const { return flipped_; }

 private:
  kernel::GeometricSkip skip_;
  kernel::Random random_;
  std::uint64_t clean_;  // bits until the next flip
  std::uint64_t flipped_ = 0;
};

// Gilbert and Elliott: a good and a bad state, each with its own flip probability; per bit the state changes
// with a probability of its own. Gilbert's is the one with good_flip = 0.
struct GilbertElliott {
  double to_bad = 0;   // per bit, in the good state
  double to_good = 0;  // per bit, in the bad state
  double good_flip = 0;
  double bad_flip = 0.5;

  double bad_share() const { return to_bad / (to_bad + to_good); }
  double bit_error_rate() const { return bad_share() * bad_flip + (1 - bad_share()) * good_flip; }
};

// The process by itself: positions of flips along a line of bits.
class GilbertElliottProcess {
 public:
  // Probabilities out of 0..1, or two states that are never left, are a usage error. Begins in the state that
  // a long run is in, drawn.
  GilbertElliottProcess(const GilbertElliott& parameters, kernel::Random random);

  // The next flip among the next `bits` bits, counted from the first of them; these bits (up to and with the
  // flip, or all) have then passed.
  std::optional<std::uint64_t> next_flip(std::uint64_t bits);
  // So many bits pass of which nobody asks whether they flip; costs little, however many they are.
  void skip(std::uint64_t bits);

  bool is_bad() const { return is_bad_; }

 private:
  void enter(bool bad);

  kernel::GeometricSkip to_bad_;
  kernel::GeometricSkip to_good_;
  kernel::GeometricSkip good_flip_;
  kernel::GeometricSkip bad_flip_;
  double bad_share_;
  double memory_;  // how much of the state a bit leaves to the next: 1 - to_bad - to_good
  kernel::Random random_;
  bool is_bad_ = false;
  std::uint64_t stays_ = 0;  // bits that are left in this state
  std::uint64_t clean_ = 0;  // bits until a flip in this state
};

// Idle time passes for the state too, at the rate of the transmission after it.
class GilbertElliottChannel final : public fault::Channel {
 public:
  GilbertElliottChannel(const GilbertElliott& parameters, kernel::Random random);

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

  std::uint64_t flipped_bits() const { return flipped_; }

 private:
  void pass_idle_time(const line::Waveform& sent);

  GilbertElliottProcess process_;
  kernel::Time passed_until_ = kernel::kStart;
  std::uint64_t flipped_ = 0;
};

// Exactly these bits, as (transmission, bit), both from 0, whatever happens in between. Positions after the
// end of a transmission do nothing and are counted.
class BitListChannel final : public fault::Channel {
 public:
  struct Position {
    std::uint64_t transmission;
    std::uint64_t bit;

    friend auto operator<=>(const Position&, const Position&) = default;
  };

  using Positions = std::shared_ptr<const std::vector<Position>>;

  // In order, shared by the receivers of a list; a position that is named twice flips twice.
  explicit BitListChannel(Positions positions);

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

  std::uint64_t flipped_bits() const { return flipped_; }
  std::uint64_t missed_bits() const { return missed_; }

 private:
  Positions positions_;
  std::size_t next_ = 0;
  std::uint64_t passed_ = 0;
  std::uint64_t flipped_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace fieldproof::emc
