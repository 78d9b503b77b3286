#include "harness/traffic/urgent_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "harness/kernel/error.hpp"
#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::traffic {
namespace {

constexpr double kNegligible = 1e-18;  // of a probability
constexpr std::size_t kMostStates = 100'000;
constexpr double kTruncated = 1e-9;  // of all probability, by them
constexpr unsigned kMostQueues = 1024;
constexpr double kLowestRate = 1e-6;
constexpr double kHighestRate = 1e6;
constexpr kernel::Duration kLongest = 3600 * kernel::kSecond;

void expect(bool holds, const char* what, const char* right) {
  if (holds) return;
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("urgent-data traffic: {}; {} would be right", what, right));
}

// Of 0, 1 .. n successes.
std::vector<double> binomial(unsigned n, double probability) {
  std::vector<double> all(n + 1, 0.0);
  const double p = std::clamp(probability, 0.0, 1.0);
  all[0] = 1;
  for (unsigned trial = 1; trial <= n; ++trial) {
    for (unsigned k = trial; k > 0; --k) all[k] = all[k] * (1 - p) + all[k - 1] * p;
    all[0] *= 1 - p;
  }
  return all;
}

using Atoms = std::map<kernel::Duration, double>;

// (2), and (3) with its factor.
Atoms rotation_with(const UrgentTraffic& traffic, double urgent, double available) {
  Atoms atoms;
  const std::vector<double> of_urgent = binomial(traffic.urgent_queues, urgent);
  const std::vector<double> of_available = binomial(traffic.available_queues, available);
  for (unsigned i = 0; i < of_urgent.size(); ++i) {
    for (unsigned j = 0; j < of_available.size(); ++j) {
      const kernel::Duration time =
          traffic.empty_rotation + i * traffic.urgent_length + j * traffic.available_length;
      atoms[time] += of_urgent[i] * of_available[j];
    }
  }
  return atoms;
}

// Summed on the side that was asked for: 1 minus the other would cancel.
struct Split {
  double below = 0;
  double at_or_above = 0;
};

Split split_at(const Atoms& atoms, kernel::Duration time) {
  Split split;
  for (const auto& [at, probability] : atoms) (at < time ? split.below : split.at_or_above) += probability;
  return split;
}

struct Modes {
  Atoms urgent_only, both;
  double priority_0 = 0, priority_1 = 0;
};

// (12) to (15).
Modes modes_of(const UrgentTraffic& traffic, UrgentDelay& it) {
  Modes modes{rotation_with(traffic, it.rho_00, 0), rotation_with(traffic, it.rho_10, it.rho_11)};
  const Split after_0 = split_at(modes.urgent_only, traffic.target_rotation);
  const Split after_1 = split_at(modes.both, traffic.target_rotation);
  it.mu_0 = after_0.below;
  it.mu_1 = after_1.below;
  // A token that never leaves its priority has that of its first rotation, 1.
  const double sum = after_0.below + after_1.at_or_above;
  it.priority_0 = sum > 0 ? after_1.at_or_above / sum : 0;
  it.priority_1 = sum > 0 ? after_0.below / sum : 1;
  return modes;
}

void publish_rhos(const UrgentTraffic& traffic, UrgentDelay& it) {
  it.rho_00 = traffic.urgent_per_ms * it.mean_0;
  it.rho_10 = traffic.urgent_per_ms * it.mean_1;
  it.rho_11 = traffic.available_per_ms * it.mean_1;
}

double mean_of(const Atoms& atoms) {
  double mean = 0;
  for (const auto& [time, probability] : atoms) mean += ms(time) * probability;
  return mean;
}

// The fixed point of rho00 = rho10 = lambda0 T and rho11 = min(1, lambda1 T / P1), approached from (18).
Modes conserve_flow(const UrgentTraffic& traffic, UrgentDelay& it) {
  constexpr int kMostSteps = 100'000;
  constexpr double kDamping = 0.05;
  double rotation = it.mean_1;
  double wanted = it.rho_11;
  Modes modes;
  for (int step = 0; step < kMostSteps; ++step) {
    it.rho_00 = it.rho_10 = std::min(1.0, traffic.urgent_per_ms * rotation);
    it.rho_11 = std::min(1.0, wanted);
    modes = modes_of(traffic, it);
    it.mean_0 = mean_of(modes.urgent_only);
    it.mean_1 = mean_of(modes.both);
    const double next = it.priority_0 * it.mean_0 + it.priority_1 * it.mean_1;
    const double next_wanted =
        it.priority_1 > 0 ? std::min(2.0, traffic.available_per_ms * next / it.priority_1) : 2.0;
    const double moved = std::abs(next - rotation) / next + std::abs(next_wanted - wanted);
    rotation += kDamping * (next - rotation);
    wanted += kDamping * (next_wanted - wanted);
    if (moved < 1e-14) break;
  }
  it.is_available_saturated = wanted > 1 + 1e-9;
  return modes;
}

void mix(const Modes& modes, UrgentDelay& it) {
  Atoms all;
  for (const auto& [time, probability] : modes.urgent_only) all[time] += it.priority_0 * probability;
  for (const auto& [time, probability] : modes.both) all[time] += it.priority_1 * probability;
  for (const auto& [time, probability] : all) {
    it.rotation.push_back({time, probability});
    it.mean_square_rotation += ms(time) * ms(time) * probability;
  }
  it.mean_rotation = it.priority_0 * it.mean_0 + it.priority_1 * it.mean_1;
}

// How many urgent packets arrive in a rotation: probabilities of 0, 1, ... until the rest is negligible.
std::vector<double> arrivals_in(const std::vector<RotationAtom>& rotation, double per_ms) {
  std::vector<double> arrivals;
  std::vector<double> terms;
  for (const RotationAtom& atom : rotation)
    terms.push_back(atom.probability * std::exp(-per_ms * ms(atom.time)));
  const double most = per_ms * ms(rotation.back().time);
  while (arrivals.size() < kMostStates) {
    double sum = 0;
    for (const double term : terms) sum += term;
    arrivals.push_back(sum);
    const auto m = static_cast<double>(arrivals.size());
    if (m > most && sum < kNegligible) break;
    for (std::size_t n = 0; n < terms.size(); ++n) terms[n] *= per_ms * ms(rotation[n].time) / m;
  }
  return arrivals;
}

// (24) by counting what crosses each level, where all terms are positive; solved forwards it goes negative.
std::vector<double> states_at_visit(const std::vector<double>& arrivals, double rho) {
  std::vector<double> tail(arrivals.size() + 1, 0.0);  // of m arrivals or more
  for (std::size_t m = arrivals.size(); m > 0; --m) tail[m - 1] = tail[m] + arrivals[m - 1];
  const auto at_least = [&](std::size_t m) { return m < tail.size() ? tail[m] : 0.0; };
  std::vector<double> pi{1 - rho};
  double left = rho;
  while (left > 1e-17 && pi.size() < kMostStates) {
    const std::size_t i = pi.size() - 1;
    double up = pi[0] * at_least(i + 1);
    const std::size_t from = i + 2 > tail.size() ? i + 2 - tail.size() : 1;
    for (std::size_t j = std::max<std::size_t>(from, 1); j <= i; ++j) up += pi[j] * at_least(i - j + 2);
    pi.push_back(up / arrivals[0]);
    left -= pi.back();
    if (pi.back() < kNegligible && pi.size() > arrivals.size()) break;
  }
  return pi;
}

// (23)
std::vector<double> states_at_departure(const std::vector<double>& pi, double rho, double per_packet) {
  std::vector<double> meanwhile{std::exp(-per_packet)};
  while (meanwhile.back() > kNegligible || static_cast<double>(meanwhile.size()) < per_packet) {
    meanwhile.push_back(meanwhile.back() * per_packet / static_cast<double>(meanwhile.size()));
  }
  std::vector<double> p(pi.size() + meanwhile.size() - 2, 0.0);
  for (std::size_t i = 1; i < pi.size(); ++i) {
    for (std::size_t m = 0; m < meanwhile.size(); ++m) p[i - 1 + m] += pi[i] / rho * meanwhile[m];
  }
  return p;
}

void wait(const UrgentTraffic& traffic, UrgentDelay& it) {
  it.mean_residual = it.mean_square_rotation / (2 * it.mean_rotation);
  it.rho = traffic.urgent_per_ms * it.mean_rotation;
  it.is_urgent_unstable = it.rho >= 1;
  if (it.is_urgent_unstable) return;
  const double length = ms(traffic.urgent_length);
  if (it.rho == 0) {  // nobody is ever met: the limit of what stands below
    it.at_visit = it.at_departure = {1};
  } else {
    it.at_visit = states_at_visit(arrivals_in(it.rotation, traffic.urgent_per_ms), it.rho);
    it.at_departure = states_at_departure(it.at_visit, it.rho, traffic.urgent_per_ms * length);
  }
  expect(std::abs(1 - std::accumulate(it.at_departure.begin(), it.at_departure.end(), 0.0)) < kTruncated,
         "more than 100 000 packets that may wait", "urgent data that leave more room");
  for (std::size_t n = 0; n < it.at_departure.size(); ++n) {
    const double p = it.at_departure[n];
    it.mean_at_departure += static_cast<double>(n) * p;
    it.delay += p * it.mean_of_nth(static_cast<unsigned>(n + 1));
    if (n > 0) it.delay_as_printed += p * it.mean_of_nth(static_cast<unsigned>(n));
  }
  it.delay += length;
  it.delay_as_printed += length;
  it.delay_without_own_rotation = it.delay - it.rho * length;
}

}  // namespace

void check(const UrgentTraffic& traffic) {
  const auto is_length = [](kernel::Duration time) { return time > kernel::Duration{} && time <= kLongest; };
  const auto is_rate = [](double rate) { return rate == 0 || (rate >= kLowestRate && rate <= kHighestRate); };
  expect(traffic.urgent_queues >= 1 && traffic.urgent_queues <= kMostQueues, "no or too many urgent queues",
         "1 to 1024");
  expect(traffic.available_queues <= kMostQueues, "too many time-available queues", "0 to 1024");
  expect(is_length(traffic.urgent_length) && is_length(traffic.available_length), "a packet without a length",
         "a time above 0, up to an hour");
  expect(is_length(traffic.empty_rotation), "a rotation that takes no time", "a time above 0, up to an hour");
  expect(is_length(traffic.target_rotation), "a target rotation time that is none",
         "a time above 0, up to an hour");
  expect(is_rate(traffic.urgent_per_ms) && is_rate(traffic.available_per_ms), "a rate that is none",
         "packets per millisecond, 0 or 1e-6 to 1e6");
}

double UrgentTraffic::load() const {
  return urgent_queues * urgent_per_ms * ms(urgent_length) +
         available_queues * available_per_ms * ms(available_length);
}

void set_load(UrgentTraffic& traffic, double load, double urgent_share, double available_share) {
  const double per_share = traffic.urgent_queues * urgent_share * ms(traffic.urgent_length) +
                           traffic.available_queues * available_share * ms(traffic.available_length);
  traffic.urgent_per_ms = load * urgent_share / per_share;
  traffic.available_per_ms = load * available_share / per_share;
}

UrgentTraffic paper_traffic(double load, double urgent_share, double available_share,
                            kernel::Duration target_rotation) {
  UrgentTraffic traffic;
  traffic.urgent_length = 600 * kernel::kMicrosecond;
  traffic.available_length = 2136 * kernel::kMicrosecond;
  traffic.empty_rotation = 16 * kernel::kMillisecond;
  traffic.target_rotation = target_rotation;
  set_load(traffic, load, urgent_share, available_share);
  return traffic;
}

double UrgentDelay::cumulative(kernel::Duration time) const {
  double sum = 0;
  for (const RotationAtom& atom : rotation) {
    if (atom.time <= time) sum += atom.probability;
  }
  return sum;
}

double UrgentDelay::residual_density(kernel::Duration time) const {
  double longer = 0;
  for (const RotationAtom& atom : rotation) {
    if (atom.time > time) longer += atom.probability;
  }
  return longer / mean_rotation;
}

double UrgentDelay::mean_of_nth(unsigned n) const {
  return mean_residual + (static_cast<double>(n) - 1) * mean_rotation;
}

UrgentDelay urgent_delay(const UrgentTraffic& traffic, Balance balance) {
  check(traffic);
  UrgentDelay it;
  const double urgent = traffic.urgent_queues * traffic.urgent_per_ms * ms(traffic.urgent_length);
  const double rotation = ms(traffic.empty_rotation);
  it.is_urgent_unstable = traffic.load() >= 1;
  if (it.is_urgent_unstable) return it;
  it.mean_0 = rotation / (1 - urgent);
  it.mean_1 = rotation / (1 - traffic.load());
  publish_rhos(traffic, it);
  it.printed_mass = std::pow(2 - it.rho_11, traffic.available_queues);
  if (balance == Balance::as_published && (it.rho_10 > 1 || it.rho_11 > 1)) {
    it.is_urgent_unstable = it.rho_10 > 1;
    it.is_available_saturated = it.rho_11 > 1;
    return it;
  }
  const Modes modes = balance == Balance::as_published ? modes_of(traffic, it) : conserve_flow(traffic, it);
  mix(modes, it);
  wait(traffic, it);
  return it;
}

}  // namespace fieldproof::traffic
