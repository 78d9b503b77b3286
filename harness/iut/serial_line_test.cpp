#include "harness/iut/serial_line.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "harness/iut/misbehaviour.hpp"
#include "harness/iut/scripted_peer.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::iut {
namespace {

using Octets = std::vector<std::uint8_t>;

TEST(SerialUri, SaysWhatTheLineIs) {
  const SerialSettings all = serial_settings(
      "serial:/dev/ttyUSB0?baud=62500&format=8e1&latency=200us&upper=exec:./node --at 'a?b&c=d'");
  EXPECT_EQ(all.path, "/dev/ttyUSB0");
  EXPECT_EQ(all.bit_rate, 62'500);
  EXPECT_EQ(all.format->text(), "8e1");
  EXPECT_EQ(all.latency, 200 * kernel::kMicrosecond);
  EXPECT_EQ(all.upper, "exec:./node --at 'a?b&c=d'");
  const SerialSettings none = serial_settings("serial:/dev/ttyS1");
  EXPECT_EQ(none.path, "/dev/ttyS1");
  EXPECT_FALSE(none.bit_rate || none.format || none.latency);
  EXPECT_TRUE(none.upper.empty());
}

TEST(SerialUri, RefusesWhatIsNone) {
  for (const char* wrong :
       {"serial:", "serial:?baud=9600", "serial:x?baud=", "serial:x?baud=9600x", "serial:x?baud=-1",
        "serial:x?baud=99999999999999999999", "serial:x?format=9n1", "serial:x?format=8x1",
        "serial:x?format=8n", "serial:x?format=8n3", "serial:x?latency=3", "serial:x?latency=-3us",
        "serial:x?speed=1", "serial:x?baud", "serial:x?&baud=9600"}) {
    try {
      serial_settings(wrong);
      ADD_FAILURE() << wrong;
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::usage) << wrong;
    }
  }
}

TEST(SerialUri, EachFormatOfAUartIsKnown) {
  for (const char* text : {"8n1", "7e2", "5o1", "8m1", "6s2"})
    EXPECT_EQ(character_format_of(text)->text(), text);
}

class SerialLines : public testing::Test {
 protected:
  // Until `count` octets have come.
  Octets all_of(SerialLine& line, std::size_t count) {
    Octets all;
    const kernel::Time until = clock_.now() + 5 * kernel::kSecond;
    while (all.size() < count && clock_.now() < until) {
      if (const auto arrival = line.read(until))
        all.insert(all.end(), arrival->octets.begin(), arrival->octets.end());
    }
    return all;
  }

  ScriptFolder folder_;
  WallClock clock_;
};

TEST_F(SerialLines, EachOctetGoesThroughATerminalAsItIs) {
  SerialLine far = SerialLine::at_new_terminal(folder_.file("line"), clock_);
  SerialLine near(folder_.file("line"), clock_);
  EXPECT_TRUE(far.is_terminal());
  EXPECT_TRUE(near.is_terminal());
  near.set(9'600, *character_format_of("8e1"));
  Octets octets(256);
  for (std::size_t n = 0; n < octets.size(); ++n) octets[n] = static_cast<std::uint8_t>(n);
  far.write(octets);
  EXPECT_EQ(all_of(near, octets.size()), octets);
  near.write(octets);
  EXPECT_EQ(all_of(far, octets.size()), octets);
}

TEST_F(SerialLines, StampsHoldWhatHappened) {
  SerialLine far = SerialLine::at_new_terminal(folder_.file("line"), clock_);
  SerialLine near(folder_.file("line"), clock_);
  near.look_every(50 * kernel::kMicrosecond);
  const kernel::Time silent_until = clock_.now() + 2 * kernel::kMillisecond;
  EXPECT_FALSE(near.read(silent_until));
  EXPECT_GE(clock_.now(), silent_until);
  const kernel::Time before = clock_.now();
  const Stamp written = far.write(Octets{1, 2, 3});
  const kernel::Time behind = clock_.now();
  EXPECT_LE(before, written.earliest);
  EXPECT_LE(written.earliest, written.latest);
  EXPECT_LE(written.latest, behind);
  const auto arrival = near.read(behind + kernel::kSecond);
  ASSERT_TRUE(arrival);
  EXPECT_LE(arrival->stamp.earliest, arrival->stamp.latest);
  EXPECT_GE(arrival->stamp.latest, written.earliest);
  EXPECT_LE(arrival->stamp.latest, clock_.now());
}

TEST_F(SerialLines, WaitingEndsWhenTheOtherDescriptorCanBeRead) {
  SerialLine far = SerialLine::at_new_terminal(folder_.file("line"), clock_);
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  EXPECT_FALSE(can_be_read(from.number()));
  to.close();
  EXPECT_TRUE(can_be_read(from.number()));
  EXPECT_FALSE(far.read(kernel::kNever, from.number()));
}

TEST_F(SerialLines, HangUpIsMisbehaviour) {
  auto far = std::make_unique<SerialLine>(SerialLine::at_new_terminal(folder_.file("line"), clock_));
  SerialLine near(folder_.file("line"), clock_);
  far.reset();
  EXPECT_FALSE(std::filesystem::is_symlink(folder_.file("line")));
  for (const bool writes : {false, true}) {
    try {
      writes ? void(near.write(Octets{1})) : void(near.read(clock_.now() + kernel::kSecond));
      ADD_FAILURE() << writes;
    } catch (const Misbehaviour& gone) {
      EXPECT_EQ(gone.reason(), reasons::kGone);
    }
  }
}

TEST_F(SerialLines, WhoTakesNothingHangs) {
  const SerialLine far = SerialLine::at_new_terminal(folder_.file("line"), clock_);
  SerialLine near(folder_.file("line"), clock_);
  try {
    near.write(Octets(1U << 20U));
    ADD_FAILURE();
  } catch (const Misbehaviour& hangs) {
    EXPECT_EQ(hangs.reason(), reasons::kHangs);
  }
}

TEST_F(SerialLines, WhatIsNoLineIsRefused) {
  for (const std::string& path : {folder_.file("nothing"), std::string("/dev/null"), folder_.file("")}) {
    try {
      const SerialLine line(path, clock_);
      ADD_FAILURE() << path;
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation) << path;
    }
  }
}

TEST_F(SerialLines, NameOfOneThatWasKilledIsTakenAgain) {
  std::filesystem::create_symlink("/dev/pts/there_is_none", folder_.file("line"));
  const SerialLine far = SerialLine::at_new_terminal(folder_.file("line"), clock_);
  EXPECT_TRUE(std::filesystem::exists(folder_.file("line")));
  std::ofstream(folder_.file("file")) << "of somebody else";
  EXPECT_THROW(SerialLine::at_new_terminal(folder_.file("file"), clock_), kernel::Error);
}

TEST(SerialLatency, IsMeasured) {
  EXPECT_GT(measured_latency(10), kernel::Duration{});
  EXPECT_LT(measured_latency(10), kernel::kSecond);
}

}  // namespace
}  // namespace fieldproof::iut
