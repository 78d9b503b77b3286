#include "harness/traffic/csma_cd.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::kMicrosecond;

constexpr std::uint64_t kFrames = kernel::kIsSanitized ? 20'000 : 200'000;

CsmaCd ether(unsigned stations, double load) {
  CsmaCd line{.stations = stations, .frame = 200 * kMicrosecond};
  line.per_ms = load / stations / 0.2;
  return line;
}

double us_of(double picoseconds) {
  return picoseconds * 1e-6;
}

// One station is a queue with service of a fixed time (Pollaczek and Khinchine), in which a frame occupies
// the line until the gap after it is over; a frame that finds the line free ends after its own time.
TEST(CsmaCd, OneStationIsAQueueWithAFixedServiceTime) {
  for (const double load : {0.2, 0.5, 0.7}) {
    const CsmaCd line = ether(1, load);
    const CsmaFigures it = run_csma_cd(line, {.frames = kFrames});
    const double service = us_of(static_cast<double>((line.frame + line.propagation + line.gap).count()));
    const double rho = line.per_ms * service * 1e-3;
    const double wait = rho * service / (2 * (1 - rho));
    EXPECT_NEAR(us_of(it.delays.mean()), wait + 200, 0.05 * wait + 1) << load;
    EXPECT_EQ(it.collisions, 0U);
    EXPECT_EQ(it.given_up, 0U);
    EXPECT_NEAR(it.carried, load, 0.02 * load + 0.003);
  }
}

// Slot by slot, without events: stations that all have something to send, of whom each waits its slots.
// Independent of the model but for the rules: after a collision the line is idle for all at the same instant.
double saturated_share_slot_by_slot(unsigned stations, std::uint64_t frames, const CsmaCd& line) {
  kernel::Random random(77);
  struct Waits {
    std::int64_t ready = 0;  // ps
    unsigned attempts = 0;
  };
  std::vector<Waits> all(stations);
  std::int64_t idle_from = 0;
  std::int64_t useful = 0;
  for (std::uint64_t sent = 0; sent < frames;) {
    std::int64_t first = INT64_MAX;
    for (const Waits& one : all) first = std::min(first, std::max(one.ready, idle_from));
    std::vector<std::size_t> who;
    std::int64_t last = first;
    for (std::size_t n = 0; n < all.size(); ++n) {
      const std::int64_t begin = std::max(all[n].ready, idle_from);
      if (begin == first || begin < first + line.propagation.count()) {
        who.push_back(n);
        last = std::max(last, begin);
      }
    }
    if (who.size() == 1) {
      idle_from = first + (line.frame + line.propagation + line.gap).count();
      all[who[0]] = {first + line.frame.count(), 0};
      useful += line.frame.count();
      ++sent;
      continue;
    }
    const std::int64_t end = last + line.propagation.count() + line.jam.count();
    idle_from = end + line.gap.count();
    for (const std::size_t n : who) {
      all[n].attempts = all[n].attempts + 1 == kMostAttempts ? 0 : all[n].attempts + 1;
      const unsigned exponent = std::min(all[n].attempts, 10U);
      const std::uint64_t slots = all[n].attempts == 0 ? 0 : random.below(1ULL << exponent);
      all[n].ready = end + static_cast<std::int64_t>(slots) * line.slot.count();
    }
  }
  return static_cast<double>(useful) / static_cast<double>(idle_from);
}

TEST(CsmaCd, WhatASaturatedLineCarriesIsThatOfAnotherSimulation) {
  for (const unsigned stations : {2U, 5U, 20U}) {
    const CsmaCd line = ether(stations, 1.6);  // queues grow
    const double share = run_csma_cd(line, {.frames = kFrames}).carried;
    EXPECT_NEAR(share, saturated_share_slot_by_slot(stations, kFrames, line), 0.015) << stations;
    EXPECT_GT(share, 0.4);
    EXPECT_LT(share, 0.9);
  }
}

// Of two frames that meet, another collision follows where both draw the same of 2 slots, a third one where
// both draw the same of 4 as well: 1 + 1/2 + 1/2 1/4 + 1/2 1/4 1/8 + ... = 1.642 collisions for each meeting.
// So rare that hardly a third frame comes meanwhile.
TEST(CsmaCd, TwoThatMeetCollideAsOftenAsTheirDrawsAreEqual) {
  CsmaCd line = ether(2, 0.4);
  line.per_ms = 0.05;
  line.frame = line.slot;
  const CsmaFigures it = run_csma_cd(line, {.frames = 5 * kFrames});
  ASSERT_GT(it.first_collisions, kFrames / 200);
  const double of_a_meeting = static_cast<double>(it.collisions) / static_cast<double>(it.first_collisions);
  EXPECT_NEAR(of_a_meeting, 1.642, 3 / std::sqrt(static_cast<double>(it.first_collisions)) + 0.02);
  EXPECT_EQ(it.given_up, 0U);
}

// The reason for a token: few frames are late by far, and beyond a load some are given up.
TEST(CsmaCd, DelaysHaveATailAndNoBound) {
  const CsmaFigures light = run_csma_cd(ether(32, 0.2), {.frames = kFrames, .bound = 5'000 * kMicrosecond});
  const CsmaFigures heavy = run_csma_cd(ether(32, 0.45), {.frames = kFrames, .bound = 5'000 * kMicrosecond});
  EXPECT_LT(light.delays.quantile(0.5), 400 * kMicrosecond.count());
  EXPECT_GT(heavy.delays.max(), 20 * heavy.delays.quantile(0.5));
  EXPECT_GT(heavy.beyond, light.beyond);
  const CsmaFigures beyond = run_csma_cd(ether(200, 1.5), {.frames = kFrames});
  EXPECT_GT(beyond.given_up, 0U);
}

TEST(CsmaCd, SameSeedSameDelays) {
  const CsmaCd line = ether(8, 0.4);
  EXPECT_EQ(run_csma_cd(line, {.frames = 2'000}).delays.mean(),
            run_csma_cd(line, {.frames = 2'000}).delays.mean());
  EXPECT_NE(run_csma_cd(line, {.frames = 2'000}).delays.mean(),
            run_csma_cd(line, {.seed = 2, .frames = 2'000}).delays.mean());
}

TEST(CsmaCd, RefusesWhatIsNoEthernet) {
  for (const auto& change : std::vector<std::function<void(CsmaCd&)>>{
           [](CsmaCd& line) { line.stations = 0; }, [](CsmaCd& line) { line.stations = 1'025; },
           [](CsmaCd& line) { line.frame = 50 * kMicrosecond; }, [](CsmaCd& line) { line.per_ms = 0; },
           [](CsmaCd& line) { line.per_ms = std::nan(""); },
           [](CsmaCd& line) { line.propagation = 26 * kMicrosecond; }}) {
    CsmaCd line = ether(2, 0.1);
    change(line);
    EXPECT_THROW(run_csma_cd(line, {}), kernel::Error);
  }
}

}  // namespace
}  // namespace fieldproof::traffic
