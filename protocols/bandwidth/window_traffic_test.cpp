#include "protocols/bandwidth/window_traffic.hpp"

#include <gtest/gtest.h>

#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::bandwidth {
namespace {

TEST(WindowTraffic, TraceOfTheSecondPlanToTheMicrosecond) {
  struct Expected {
    unsigned stream;
    std::int64_t generated, delivered;
  };
  // Computed by another program.
  constexpr unsigned S1 = 0, C1 = 1, S2 = 2, C2 = 3, S3 = 4, C3 = 5, S4 = 6, C4 = 7;
  const std::vector<Expected> expected{
      {S1, 0, 400},         {S2, 0, 1000},        {S3, 0, 1600},        {S1, 20000, 25850},
      {C1, 20000, 26350},   {C2, 20000, 26950},   {C3, 20000, 27550},   {S4, 40000, 42400},
      {S1, 40000, 43200},   {C1, 40000, 43700},   {S2, 40000, 44200},   {C2, 60000, 61275},
      {C4, 60000, 62075},   {S1, 60000, 62775},   {C1, 60000, 63275},   {C1, 80000, 82475},
      {S2, 80000, 82975},   {S3, 80000, 83575},   {S1, 80000, 84575},   {S1, 100000, 106000},
      {C1, 100000, 106500}, {C2, 100000, 107100}, {C3, 100000, 107700}, {S1, 120000, 131850}};
  std::vector<Sent> sent;
  WindowRun run{.slots = 10, .real_time = Load::none, .non_real_time = Load::saturated};
  run.on_sent = [&](const Sent& one) {
    if (one.packet == Packet::periodic) sent.push_back(one);
  };
  WindowTraffic traffic = traffic_of(fractional_density(), 2'225);
  run_windows(traffic, run);
  ASSERT_GE(sent.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(sent[n].node, expected[n].stream) << n;
    EXPECT_EQ((sent[n].generated - kernel::kStart) / kernel::kMicrosecond, expected[n].generated) << n;
    EXPECT_EQ(sent[n].end - kernel::kStart, expected[n].delivered * kernel::kMicrosecond) << n;
  }
}

}  // namespace
}  // namespace fieldproof::bandwidth
