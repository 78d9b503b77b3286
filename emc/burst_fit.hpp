// Counts of a laboratory against the burst model: which coupling would explain them, and whether any does.
//
// Two parameters are fitted by the likelihood of binomial counts. The *gain* is a factor on the open-circuit
// voltage: how much more couples in than the profile says; it places where errors begin and how they grow
// with the level. The *strength* is a factor on how often a pulse that couples in corrupts a frame: what the
// receiver filters, which levels are driven, the tolerances of the generator. Levels, repetition rates and
// polarities are not fitted: how the counts follow them is what is put to the test, by Pearson's chi-squared.
//
// Limits: frames are taken for independent given the condition. A generator whose rate differs by its
// tolerance from that of another row shows as a contradiction where the counts are large enough to see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/frame_hits.hpp"
#include "emc/generator.hpp"

namespace fieldproof::emc {

struct CountedFrames {
  double volts = 0;
  Repetition repetition = Repetition::khz_5;
  Polarity polarity = Polarity::positive;
  double time_s = 0;
  std::uint64_t frames = 0;
  std::uint64_t bad = 0;         // of them
  std::uint64_t undetected = 0;  // of the bad ones
};

// A fitted factor; at the ends of its interval the profile likelihood leaves 95 %. Open: there is no end
// within what is looked at, 1/1000 to 100 for the gain, 1/32 to 32 for the strength.
struct FittedFactor {
  double value = 1;
  double from = 1;
  double to = 1;
  bool is_open_below = false;
  bool is_open_above = false;

  bool holds(double truth) const { return from <= truth && truth <= to; }
};

enum class FitVerdict : std::uint8_t { consistent, contradicts, open };
std::string_view name(FitVerdict verdict);

struct BurstFit {
  FittedFactor gain;
  FittedFactor strength;
  double chi_squared = 0;
  int degrees = 0;         // of freedom; conditions in which few errors are expected are one together
  double probability = 1;  // of so large a chi-squared or a larger one, if the model is right
  // Contradicts below kRefuted; open without a degree of freedom.
  FitVerdict verdict = FitVerdict::open;
  std::vector<double> expected;  // bad frames, by row
};

inline constexpr double kRefuted = 0.01;

// What the model says of a line. Made once; a question costs some logarithms.
class BurstModel {
 public:
  BurstModel(const Coupling& coupling, unsigned levels, std::int64_t bit_rate);

  // The share of frames that are corrupted.
  double corrupted(const CountedFrames& condition, double gain, double strength) const;
  BurstFit fit(std::span<const CountedFrames> rows) const;

 private:
  // -log of the chance that a pulse corrupts nothing, over equal steps of the logarithm of the voltage.
  std::vector<double> strength_of(const LineResponse& response, Polarity polarity,
                                  std::int64_t bit_rate) const;

  std::map<Polarity, std::vector<double>> strengths_;
  // The share of corrupted frames, over equal steps of the logarithm of the strength.
  std::map<Repetition, std::vector<double>> shares_;
};

}  // namespace fieldproof::emc
