#include "emc/burst_fit.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>

namespace fieldproof::emc {
namespace {

constexpr double kLeastVolts = 0.02;
constexpr double kStepsPerOctave = 40;
constexpr std::size_t kVoltSteps = 1'040;  // to 1.3 MV
constexpr double kLeastStrength = 1e-9;
constexpr std::size_t kStrengthSteps = 1'600;
constexpr double kCertain = 30;        // a strength of which nothing is left
constexpr double kLeastShare = 1e-12;  // below: a count above 0 is as good as impossible
constexpr int kBits = 20;              // of a minimum
constexpr double kNinetyFive = 3.841;  // chi-squared of one degree of freedom

// Between two entries of a table over equal steps of a logarithm.
double interpolated(const std::vector<double>& table, double step) {
  const double at = std::clamp(step, 0.0, static_cast<double>(table.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(at), table.size() - 2);
  const double part = at - static_cast<double>(below);
  return table[below] * (1 - part) + table[below + 1] * part;
}

double minus_log_likelihood(std::uint64_t bad, std::uint64_t frames, double share) {
  const double p = std::clamp(share, kLeastShare, 1 - kLeastShare);
  return -static_cast<double>(bad) * std::log(p) - static_cast<double>(frames - bad) * std::log1p(-p);
}

class Fitting {
 public:
  Fitting(const BurstModel& model, std::span<const CountedFrames> rows) : model_(model), rows_(rows) {}

  BurstFit fit() const {
    const auto [log_gain, least] =
        minimum_over_gain([this](double gain) { return best_strength(gain).second; });
    const double log_strength = best_strength(log_gain).first;
    BurstFit found;
    found.gain = factor(log_gain, kGains, least, [this](double gain) { return best_strength(gain).second; });
    found.strength = factor(log_strength, kStrengths, least,
                            [this](double strength) { return best_gain(strength).second; });
    for (const CountedFrames& row : rows_)
      found.expected.push_back(static_cast<double>(row.frames) *
                               model_.corrupted(row, found.gain.value, found.strength.value));
    judge(found);
    return found;
  }

 private:
  using Function = std::function<double(double)>;
  using Minimum = std::pair<double, double>;  // where, and what
  // Of a logarithm.
  struct Range {
    double least;
    double most;
  };

  double cost(double log_gain, double log_strength) const {
    const double gain = std::exp(log_gain);
    const double strength = std::exp(log_strength);
    double sum = 0;
    for (const CountedFrames& row : rows_)
      sum += minus_log_likelihood(row.bad, row.frames, model_.corrupted(row, gain, strength));
    return sum;
  }

  // The likelihood has one maximum over the strength: the share grows with it.
  Minimum best_strength(double log_gain) const {
    return boost::math::tools::brent_find_minima(
        [&](double log_strength) { return cost(log_gain, log_strength); }, kStrengths.least, kStrengths.most,
        kBits);
  }

  Minimum best_gain(double log_strength) const {
    return minimum_over_gain([&](double log_gain) { return cost(log_gain, log_strength); });
  }

  // Over the gain there may be several: looked at in steps first.
  static Minimum minimum_over_gain(const Function& cost) {
    constexpr int kLooks = 80;
    const double step = (kGains.most - kGains.least) / kLooks;
    Minimum best{kGains.least, cost(kGains.least)};
    for (int n = 1; n <= kLooks; ++n) {
      const double at = kGains.least + n * step;
      if (const double value = cost(at); value < best.second) best = {at, value};
    }
    return boost::math::tools::brent_find_minima(cost, std::max(kGains.least, best.first - step),
                                                 std::min(kGains.most, best.first + step), kBits);
  }

  static FittedFactor factor(double log_value, const Range& range, double least, const Function& cost) {
    const auto is_within = [&](double at) { return 2 * (cost(at) - least) <= kNinetyFive; };
    const auto end = [&](double bound) {
      if (is_within(bound)) return bound;
      double inside = log_value;
      double outside = bound;
      while (std::abs(outside - inside) > 1e-4) {
        const double middle = (inside + outside) / 2;
        (is_within(middle) ? inside : outside) = middle;
      }
      return outside;
    };
    return {std::exp(log_value), std::exp(end(range.least)), std::exp(end(range.most)),
            is_within(range.least), is_within(range.most)};
  }

  // Cells of few errors, or few frames without one, are one cell together.
  void judge(BurstFit& found) const {
    constexpr double kFew = 5;
    constexpr int kParameters = 2;
    double few_bad = 0;
    double few_expected = 0;
    double few_variance = 0;
    int cells = 0;
    for (std::size_t n = 0; n < rows_.size(); ++n) {
      const double expected = found.expected[n];
      const auto frames = static_cast<double>(rows_[n].frames);
      const auto bad = static_cast<double>(rows_[n].bad);
      const double variance = expected * (1 - expected / frames);
      if (variance < kFew) {
        few_bad += bad;
        few_expected += expected;
        few_variance += variance;
        continue;
      }
      found.chi_squared += (bad - expected) * (bad - expected) / variance;
      ++cells;
    }
    if (few_variance >= 1 || few_bad > 0) {
      found.chi_squared += (few_bad - few_expected) * (few_bad - few_expected) / std::max(few_variance, 1e-9);
      ++cells;
    }
    found.degrees = cells - kParameters;
    if (found.degrees <= 0) return;
    found.probability =
        boost::math::cdf(boost::math::complement(boost::math::chi_squared(found.degrees), found.chi_squared));
    found.verdict = found.probability < kRefuted ? FitVerdict::contradicts : FitVerdict::consistent;
  }

  static inline const Range kGains{std::log(1e-3), std::log(100)};
  static inline const Range kStrengths{std::log(1.0 / 32), std::log(32)};

  const BurstModel& model_;
  std::span<const CountedFrames> rows_;
};

}  // namespace

std::string_view name(FitVerdict verdict) {
  switch (verdict) {
    case FitVerdict::consistent:
      return "consistent";
    case FitVerdict::contradicts:
      return "contradicts";
    case FitVerdict::open:
      return "open";
  }
  return "";
}

BurstModel::BurstModel(const Coupling& coupling, unsigned levels, std::int64_t bit_rate) {
  const LineResponse response(coupling);
  for (const Polarity polarity : {Polarity::positive, Polarity::negative})
    strengths_[polarity] = strength_of(response, polarity, bit_rate);
  for (const Repetition repetition :
       {Repetition::khz_5, Repetition::khz_100, Repetition::khz_2_5_edition_1}) {
    const FrameHits hits(levels, bit_rate, repetition);
    std::vector<double>& shares = shares_[repetition];
    for (std::size_t n = 0; n < kStrengthSteps; ++n)
      shares.push_back(hits.corrupted(kLeastStrength * std::exp2(static_cast<double>(n) / kStepsPerOctave)));
  }
}

std::vector<double> BurstModel::strength_of(const LineResponse& response, Polarity polarity,
                                            std::int64_t bit_rate) const {
  std::vector<double> strengths;
  for (std::size_t n = 0; n < kVoltSteps; ++n) {
    const double volts = kLeastVolts * std::exp2(static_cast<double>(n) / kStepsPerOctave);
    const double chance =
        volts < response.threshold_volts()
            ? 0
            : chance_of_hit(response.wrong_output(volts, polarity), line::Sampling{}, bit_rate);
    strengths.push_back(std::min(kCertain, -std::log1p(-std::min(chance, 1 - 1e-15))));
  }
  return strengths;
}

double BurstModel::corrupted(const CountedFrames& condition, double gain, double strength) const {
  const double step = kStepsPerOctave * std::log2(condition.volts * gain / kLeastVolts);
  const double of_pulse = strength * interpolated(strengths_.at(condition.polarity), step);
  if (of_pulse < kLeastStrength) return 0;
  return interpolated(shares_.at(condition.repetition),
                      kStepsPerOctave * std::log2(of_pulse / kLeastStrength));
}

BurstFit BurstModel::fit(std::span<const CountedFrames> rows) const {
  return Fitting(*this, rows).fit();
}

}  // namespace fieldproof::emc
