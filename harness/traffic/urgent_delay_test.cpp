#include "harness/traffic/urgent_delay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

// The worked values, computed independently of this code in another language; standing [calc].
struct Worked {
  const char* name;
  UrgentTraffic traffic;
  std::map<std::string, double> values;
};

const std::vector<Worked>& worked() {
  static const std::vector<Worked> all = {
      {"Middle",
       paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond),
       {{"lam0", 0.00799524853801169}, {"lam1", 0.00799524853801169},
        {"T0", 17.3301662707838},      {"T1", 24.6153846153846},
        {"rho00", 0.138558986539984},  {"rho10", 0.196806117858749},
        {"rho11", 0.196806117858749},  {"mu0", 1},
        {"mu1", 0.995042398866434},    {"P0", 0.00493314457045199},
        {"P1", 0.995066855429548},     {"Tbar", 24.5794455800634},
        {"T2", 616.801508169554},      {"Er", 12.5470996927174},
        {"rho", 0.19651877633914},     {"En", 0.129650322439557},
        {"pi0", 0.80348122366086},     {"pi1", 0.174088326450899},
        {"pi2", 0.0204838555744451},   {"p0", 0.881621603454848},
        {"p1", 0.107964023599857},     {"p2", 0.00961854367609375},
        {"d_V0", 2.36236323202012},    {"d_V1", 16.3338327375582},
        {"d_V2", 16.2159214717547}}},
      {"Low",
       paper_traffic(0.2, 1, 1, 20 * kMillisecond),
       {{"lam0", 0.0045687134502924},  {"lam1", 0.0045687134502924},
        {"T0", 16.7339449541284},      {"T1", 20},
        {"rho00", 0.0764525993883792}, {"rho10", 0.0913742690058479},
        {"rho11", 0.0913742690058479}, {"mu0", 0.999906059222062},
        {"mu1", 0.545060219269661},    {"P0", 0.312706520675224},
        {"P1", 0.687293479324776},     {"Tbar", 18.9786832902718},
        {"T2", 367.104428609612},      {"Er", 9.67149361720433},
        {"rho", 0.0867081656171042},   {"En", 0.0511225683053937},
        {"pi0", 0.913291834382896},    {"pi1", 0.0826528908787442},
        {"pi2", 0.00391933307479046},  {"p0", 0.950621318356787},
        {"p1", 0.0476835620439764},    {"p2", 0.00164757209153472},
        {"d_V0", 1.11066227699421},    {"d_V1", 11.241732650058},
        {"d_V2", 11.1897077506877}}},
      {"High",
       paper_traffic(0.5, 1, 2, 40 * kMillisecond),
       {{"lam0", 0.00641420361247947}, {"lam1", 0.0128284072249589},
        {"T0", 17.0498687664042},      {"T1", 32},
        {"rho00", 0.109361329833771},  {"rho10", 0.205254515599343},
        {"rho11", 0.410509031198686},  {"mu0", 1},
        {"mu1", 0.966085697374764},    {"P0", 0.0328018507328152},
        {"P1", 0.967198149267185},     {"Tbar", 31.5096080268396},
        {"T2", 1017.95941885637},      {"Er", 16.1531590299263},
        {"rho", 0.202109041633567},    {"En", 0.13370292133854},
        {"pi0", 0.797890958366433},    {"pi1", 0.178205688506024},
        {"pi2", 0.0217461111707307},   {"p0", 0.878343574094576},
        {"p1", 0.110562969492437},     {"p2", 0.010211912070267},
        {"d_V0", 2.94471594385772},    {"d_V1", 20.9660856733479},
        {"d_V2", 20.8448202483677}}},
  };
  return all;
}

std::map<std::string, double> values_of(const UrgentTraffic& traffic, const UrgentDelay& it) {
  return {{"lam0", traffic.urgent_per_ms},
          {"lam1", traffic.available_per_ms},
          {"T0", it.mean_0},
          {"T1", it.mean_1},
          {"rho00", it.rho_00},
          {"rho10", it.rho_10},
          {"rho11", it.rho_11},
          {"mu0", it.mu_0},
          {"mu1", it.mu_1},
          {"P0", it.priority_0},
          {"P1", it.priority_1},
          {"Tbar", it.mean_rotation},
          {"T2", it.mean_square_rotation},
          {"Er", it.mean_residual},
          {"rho", it.rho},
          {"En", it.mean_at_departure},
          {"pi0", it.at_visit.at(0)},
          {"pi1", it.at_visit.at(1)},
          {"pi2", it.at_visit.at(2)},
          {"p0", it.at_departure.at(0)},
          {"p1", it.at_departure.at(1)},
          {"p2", it.at_departure.at(2)},
          {"d_V0", it.delay_as_printed},
          {"d_V1", it.delay},
          {"d_V2", it.delay_without_own_rotation}};
}

class WorkedCase : public testing::TestWithParam<Worked> {};

TEST_P(WorkedCase, HasEachQuantity) {
  const auto values = values_of(GetParam().traffic, urgent_delay(GetParam().traffic));
  for (const auto& [name, expected] : GetParam().values) {
    EXPECT_NEAR(values.at(name), expected, 1e-11 * std::max(1.0, expected)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(OfThePaper, WorkedCase, testing::ValuesIn(worked()),
                         [](const auto& one) { return std::string(one.param.name); });

// Over the paper's loads, shares and target times, and those that break careless arithmetic.
template <typename Look>
void over_the_paper(Look look) {
  for (const double load : kernel::kIsSanitized ? std::vector{0.35} : std::vector{0.2, 0.35, 0.5}) {
    for (const auto& [urgent, available] : {std::pair{2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}}) {
      for (const int target : {16'000, 16'600, 20'000, 25'000, 34'816, 48'680, 60'000, 80'000}) {
        SCOPED_TRACE(std::to_string(load) + " " + std::to_string(urgent / available) + " " +
                     std::to_string(target));
        look(paper_traffic(load, urgent, available, target * kMicrosecond));
      }
    }
  }
}

double sum(const std::vector<double>& of) {
  return std::accumulate(of.begin(), of.end(), 0.0);
}

TEST(UrgentDelayIdentities, HoldEverywhere) {
  over_the_paper([](const UrgentTraffic& traffic) {
    const UrgentDelay it = urgent_delay(traffic);
    double mass = 0;
    double mean = 0;
    for (const RotationAtom& atom : it.rotation) {
      mass += atom.probability;
      mean += atom.probability * static_cast<double>(atom.time.count()) / 1e9;
    }
    EXPECT_NEAR(mass, 1, 1e-12);
    EXPECT_NEAR(mean, it.mean_rotation, 1e-12 * mean);
    EXPECT_NEAR(it.priority_0 + it.priority_1, 1, 1e-15);
    EXPECT_NEAR(sum(it.at_visit), 1, 1e-12);
    EXPECT_NEAR(sum(it.at_departure), 1, 1e-12);
    for (const double pi : it.at_visit) EXPECT_GE(pi, 0);
    // (26) in closed form, by the moments of the chain of departures.
    const double length = 0.6;
    EXPECT_NEAR(it.delay, it.mean_residual / (1 - it.rho) + (1 + it.rho) * length, 1e-10 * it.delay);
    EXPECT_NEAR(it.mean_at_departure,
                traffic.urgent_per_ms * it.mean_residual / (1 - it.rho) + traffic.urgent_per_ms * length,
                1e-10);
  });
}

// What the model of the paper breaks whenever a token has priority 0 now and then.
TEST(UrgentDelayBalance, OfFlowGivesTheMeanRotationOfTheLoad) {
  over_the_paper([](const UrgentTraffic& traffic) {
    const UrgentDelay it = urgent_delay(traffic, Balance::flow_conserving);
    if (it.is_available_saturated) {
      EXPECT_DOUBLE_EQ(it.rho_11, 1);
    } else {
      EXPECT_NEAR(it.mean_rotation, 16 / (1 - traffic.load()), 1e-8 * it.mean_rotation);
      EXPECT_NEAR(it.priority_1 * it.rho_11, traffic.available_per_ms * it.mean_rotation, 1e-8);
    }
  });
}

TEST(UrgentDelayBalance, SaysWhereTimeAvailableDataCannotKeepUp) {
  const auto is_saturated = [](double load, int target_us) {
    return urgent_delay(paper_traffic(load, 1, 1, target_us * kMicrosecond), Balance::flow_conserving)
        .is_available_saturated;
  };
  EXPECT_TRUE(is_saturated(0.35, 16'600));
  EXPECT_FALSE(is_saturated(0.35, 34'816));
}

// 16.6 ms is a rotation with one urgent packet: it took the target time, so the next one is urgent only.
TEST(UrgentDelayTies, RotationOfTheTargetTimeIsNotBelowIt) {
  const UrgentDelay tie = urgent_delay(paper_traffic(0.35, 1, 1, 16'600 * kMicrosecond));
  const UrgentDelay above = urgent_delay(paper_traffic(0.35, 1, 1, 16'601 * kMicrosecond));
  EXPECT_NEAR(tie.mu_0, std::pow(1 - tie.rho_00, 16), 1e-12);
  EXPECT_NEAR(above.mu_0 - tie.mu_0, 16 * tie.rho_00 * std::pow(1 - tie.rho_00, 15), 1e-12);
}

TEST(UrgentDelayPrinted, ThirdEquationIsNoDistribution) {
  const UrgentDelay it = urgent_delay(paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond));
  EXPECT_NEAR(it.printed_mass, 12'493, 1);
}

TEST(UrgentDelayResidual, IsTheDistributionOfWhatIsLeft) {
  const UrgentDelay it = urgent_delay(paper_traffic(0.5, 1, 2, 40 * kMillisecond));
  EXPECT_DOUBLE_EQ(it.cumulative(15 * kMillisecond), 0);
  EXPECT_NEAR(it.cumulative(70 * kMillisecond), 1, 1e-12);
  EXPECT_NEAR(it.residual_density(kernel::Duration{}), 1 / it.mean_rotation, 1e-14);
  // Its mean by summing the density in steps of 10 us.
  double mean = 0;
  for (int step = 0; step < 7'000; ++step) {
    mean += (step + 0.5) * 0.01 * it.residual_density((10 * step + 5) * kMicrosecond) * 0.01;
  }
  EXPECT_NEAR(mean, it.mean_residual, 1e-4);
  EXPECT_DOUBLE_EQ(it.mean_of_nth(1), it.mean_residual);
  EXPECT_DOUBLE_EQ(it.mean_of_nth(3), it.mean_residual + 2 * it.mean_rotation);
}

TEST(UrgentDelayLimits, WithoutUrgentDataIsAResidualRotation) {
  UrgentTraffic traffic = paper_traffic(0.2, 1, 1, 20 * kMillisecond);
  traffic.urgent_per_ms = 0;
  const UrgentDelay it = urgent_delay(traffic);
  EXPECT_DOUBLE_EQ(it.delay, it.mean_residual + 0.6);
}

TEST(UrgentDelayLimits, WhatCannotBeCarriedIsSaidSo) {
  EXPECT_TRUE(urgent_delay(paper_traffic(1.0, 1, 1, 20 * kMillisecond)).is_urgent_unstable);
  EXPECT_TRUE(urgent_delay(paper_traffic(0.9, 20, 1, 400 * kMillisecond)).is_urgent_unstable);
}

TEST(UrgentDelayLimits, WhatIsNoTrafficIsRefused) {
  const UrgentTraffic right = paper_traffic(0.2, 1, 1, 20 * kMillisecond);
  const auto expect_refused = [&](auto change) {
    UrgentTraffic wrong = right;
    change(wrong);
    EXPECT_THROW(urgent_delay(wrong), kernel::Error);
  };
  expect_refused([](auto& t) { t.urgent_queues = 0; });
  expect_refused([](auto& t) { t.available_queues = 2'000'000'000; });
  expect_refused([](auto& t) { t.urgent_length = kernel::Duration{}; });
  expect_refused([](auto& t) { t.available_length = -kMillisecond; });
  expect_refused([](auto& t) { t.empty_rotation = kernel::Duration::max(); });
  expect_refused([](auto& t) { t.target_rotation = kernel::Duration{}; });
  expect_refused([](auto& t) { t.urgent_per_ms = -1; });
  expect_refused([](auto& t) { t.urgent_per_ms = 1e-300; });
  expect_refused([](auto& t) { t.available_per_ms = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace fieldproof::traffic
