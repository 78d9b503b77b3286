#include "protocols/bandwidth/window_server.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fieldproof::bandwidth {
namespace {

constexpr Waiting kAll{.real_time = true, .periodic = true, .non_real_time = true};
constexpr PeriodicByte kFree{};

std::vector<Packet> packets_of(WindowVisit& visit, const Waiting& waiting) {
  std::vector<Packet> packets;
  for (Packet packet = visit.next(waiting); packet != Packet::none; packet = visit.next(waiting))
    packets.push_back(packet);
  return packets;
}

using Packets = std::vector<Packet>;

TEST(WindowServer, TheByteHasABitAndANode) {
  EXPECT_EQ(PeriodicByte::begun_by(0).octet(), 0x80);
  EXPECT_EQ(PeriodicByte::begun_by(127).octet(), 0xFF);
  EXPECT_FALSE(kFree.is_periodic());
  EXPECT_TRUE(PeriodicByte(0x85).is_of(5));
  EXPECT_FALSE(PeriodicByte(0x85).is_of(4));
  EXPECT_FALSE(PeriodicByte(0x05).is_of(5)) << "without the bit the address says nothing";
}

TEST(WindowServer, RealTimeGoesBeforePeriodicAndNothingAfterIt) {
  WindowVisit visit(5, kFree);
  EXPECT_EQ(packets_of(visit, kAll), (Packets{Packet::real_time, Packet::periodic}));
  EXPECT_EQ(visit.byte().octet(), 0x85);
}

TEST(WindowServer, WithoutDataOneNonRealTimePacketGoes) {
  WindowVisit visit(5, kFree);
  EXPECT_EQ(packets_of(visit, {.real_time = true, .non_real_time = true}),
            (Packets{Packet::real_time, Packet::non_real_time}));
  EXPECT_EQ(visit.byte(), kFree);
}

TEST(WindowServer, InAPeriodicIntervalNoNonRealTimePacketGoes) {
  WindowVisit visit(5, PeriodicByte::begun_by(3));
  EXPECT_EQ(packets_of(visit, {.real_time = true, .non_real_time = true}), Packets{Packet::real_time});
  EXPECT_EQ(visit.byte().octet(), 0x83);
  WindowVisit with_data(5, PeriodicByte::begun_by(3));
  EXPECT_EQ(packets_of(with_data, kAll), (Packets{Packet::real_time, Packet::periodic}));
  EXPECT_EQ(with_data.byte().octet(), 0x83) << "who has begun it ends it";
}

TEST(WindowServer, WhoHasBegunTheIntervalEndsIt) {
  WindowVisit visit(5, PeriodicByte::begun_by(5));
  EXPECT_EQ(packets_of(visit, {.non_real_time = true}), Packets{Packet::non_real_time});
  EXPECT_EQ(visit.byte(), kFree);
}

TEST(WindowServer, AndBeginsItAnewAtOnceForANewDatum) {
  WindowVisit visit(5, PeriodicByte::begun_by(5));
  EXPECT_EQ(packets_of(visit, kAll), (Packets{Packet::real_time, Packet::periodic}));
  EXPECT_EQ(visit.byte().octet(), 0x85);
}

// The periodic queue is looked at after the real-time packet.
TEST(WindowServer, ADatumThatComesDuringTheRealTimePacketGoes) {
  WindowVisit visit(5, kFree);
  EXPECT_EQ(visit.next({.real_time = true, .non_real_time = true}), Packet::real_time);
  EXPECT_EQ(visit.next(kAll), Packet::periodic);
  EXPECT_EQ(visit.next(kAll), Packet::none);
}

TEST(WindowServer, NothingWaitsNothingGoes) {
  WindowVisit visit(5, kFree);
  EXPECT_EQ(visit.next({}), Packet::none);
  EXPECT_EQ(visit.next(kAll), Packet::none) << "the visit is over";
}

}  // namespace
}  // namespace fieldproof::bandwidth
