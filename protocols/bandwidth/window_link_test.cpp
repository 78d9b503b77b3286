#include "protocols/bandwidth/window_link.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/sanitized.hpp"
#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::bandwidth {
namespace {

constexpr std::uint64_t kSlotsOfLine = kernel::kIsSanitized ? 10 : 80;

struct Line {
  const char* name;
  std::int64_t bit_rate;
  bool is_polled;
};

// A plan of sixteen nodes, its packets as long as their frames.
WindowTraffic planned_on(const WindowLineRules& rules, std::int64_t scale) {
  Demand demand = fractional_density();
  for (kernel::Duration& bound : demand.bounds) bound *= scale;
  demand.nodes = 12;
  demand.real_time_queues = 3;
  WindowTraffic traffic = traffic_of(demand, 1);
  for (QueueTraffic& queue : traffic.real_time) queue.mean_gap = 3 * traffic.slot;
  for (QueueTraffic& queue : traffic.non_real_time) queue.mean_gap = traffic.slot;
  return on_line(traffic, rules);
}

void expect_alike(const WindowTraffic& traffic, const WindowLineRules& rules, Load load) {
  WindowRun run{.seed = 5, .slots = kSlotsOfLine, .real_time = load, .non_real_time = load, .first_node = 3};
  const LinkRun link = run_window_link(traffic, rules, run);
  std::vector<Sent> sent;
  run.on_sent = [&](const Sent& one) { sent.push_back(one); };
  const WindowFigures figures = run_windows(traffic, run);
  // The last visit may begin before the end of the run and send after it.
  ASSERT_GE(sent.size() + 2, link.sent.size());
  ASSERT_LE(sent.size(), link.sent.size() + 2);
  const kernel::Duration before = link.origin - kernel::kStart;
  for (std::size_t n = 0; n < std::min(sent.size(), link.sent.size()); ++n) {
    const Sent& on_the_line = link.sent[n];
    ASSERT_EQ(sent[n].packet, on_the_line.packet) << n;
    ASSERT_EQ(sent[n].node, on_the_line.node) << n;
    ASSERT_EQ(sent[n].byte, on_the_line.byte) << n;
    ASSERT_EQ(sent[n].begin + before, on_the_line.begin) << n;
    ASSERT_EQ(sent[n].end + before, on_the_line.end) << n;
    if (sent[n].packet == Packet::periodic) {
      ASSERT_EQ(sent[n].generated + before, on_the_line.generated) << n;
    }
  }
  EXPECT_GT(link.sent.size(), kSlotsOfLine);
  for (std::size_t n = 0; n < figures.loops.size(); ++n) {
    const WindowSampler::Books& controller = link.books[2 * n + 1];
    EXPECT_NEAR(static_cast<double>(controller.samplings), static_cast<double>(figures.loops[n].samplings),
                1);
    EXPECT_NEAR(static_cast<double>(controller.vacant), static_cast<double>(figures.loops[n].vacant), 1);
    EXPECT_NEAR(static_cast<double>(controller.lost), static_cast<double>(figures.loops[n].lost), 1);
  }
}

TEST(WindowLink, StationsSendWhatTheSimulationSends) {
  for (const Line& line :
       {Line{"token, 1 Mbit/s", 1'000'000, false}, Line{"polling, 1 Mbit/s", 1'000'000, true},
        Line{"token, 31.25 kbit/s", 31'250, false}}) {
    WindowLineRules rules{.bit_rate = line.bit_rate, .is_polled = line.is_polled};
    const WindowTraffic traffic = planned_on(rules, 1'000'000 / line.bit_rate);
    for (const Load load : {Load::arriving, Load::saturated, Load::random, Load::just_late}) {
      SCOPED_TRACE(std::string(line.name) + ", " + name_of(load));
      expect_alike(traffic, rules, load);
    }
  }
}

TEST(WindowLink, SoTheyDoWhereControllersAreOffTheGrid) {
  for (const bool is_polled : {false, true}) {
    const WindowLineRules rules{.is_polled = is_polled, .non_real_time_octets = 240};
    WindowTraffic traffic = planned_on(rules, 1);
    for (LoopTraffic& loop : traffic.loops) loop.skew = traffic.slot / 40 * 5;
    expect_alike(traffic, rules, Load::random);
  }
}

TEST(WindowLink, ServerAndDataTakeTheirFrames) {
  const WindowLineRules rules{.bit_rate = 1'000'000, .preamble_octets = 1, .gap_octets = 4};
  // Gap, preamble, two delimiters, three octets and two of check: 12 octets of 8 us.
  EXPECT_EQ(rules.time_of(kServerOctets), 96 * kernel::kMicrosecond);
  EXPECT_EQ(rules.time_of_packet(Packet::periodic), (4 + 3 + 4 + 32 + 2) * 8 * kernel::kMicrosecond);
}

TEST(WindowFrames, AreReadAsTheyAreWritten) {
  const std::vector<WindowFrame> frames{
      {.type = FrameType::token, .destination = 5, .byte = PeriodicByte(0x85)},
      {.type = FrameType::poll, .destination = 127},
      {.type = FrameType::answer, .source = 3, .byte = PeriodicByte(0x80)},
      {.type = FrameType::data, .packet = Packet::real_time, .destination = 1, .source = 2},
      {.type = FrameType::data,
       .packet = Packet::periodic,
       .destination = 1,
       .source = 2,
       .byte = PeriodicByte(0x82),
       .generated = kernel::kStart + 5 * kernel::kSecond,
       .sample = kernel::kStart + 4 * kernel::kSecond},
      {.type = FrameType::data, .packet = Packet::non_real_time, .destination = 1, .source = 2}};
  for (const WindowFrame& frame : frames) EXPECT_EQ(window_frame_of(octets_of(frame, 20)), frame);
}

TEST(WindowFrames, WhatIsNoneIsNotRead) {
  for (const Octets& octets : {Octets{}, Octets{0x01, 5}, Octets{0x01, 128, 0}, Octets{0x04, 5, 0},
                               Octets{0x10, 1, 2, 0}, Octets{0x14, 1, 2, 0}, Octets{0x11, 1, 2},
                               Octets{0x11, 1, 200, 0}, Octets{0x12, 1, 2, 0, 9}, Octets{0x01, 5, 0, 0}})
    EXPECT_FALSE(window_frame_of(octets)) << octets.size();
}

}  // namespace
}  // namespace fieldproof::bandwidth
