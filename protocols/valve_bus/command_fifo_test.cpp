#include "protocols/valve_bus/command_fifo.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fieldproof::valve_bus {
namespace {

using kernel::kMillisecond;
using Octets = std::vector<std::uint8_t>;

class CommandFifoTest : public testing::Test {
 protected:
  // Gives how many octets began the loss of a command.
  unsigned put(const Command& command) {
    unsigned losses = 0;
    for (const std::uint8_t octet : {command.id, command.command, command.data0, command.data1}) {
      if (!fifo_.put(octet, kernel::kStart)) ++losses;
    }
    return losses;
  }
  static Command numbered(unsigned number) {
    return {static_cast<std::uint8_t>(number % 99 + 1), 0, static_cast<std::uint8_t>(number),
            static_cast<std::uint8_t>(number >> 8)};
  }

  CommandFifo fifo_{Rules{}};
};

TEST_F(CommandFifoTest, GivesWholeCommandsInTheirOrder) {
  EXPECT_FALSE(fifo_.take());
  put({5, 0, 0xA5, 0x3C});
  put({6, 1, 0, 0});
  EXPECT_EQ(fifo_.room(), 504U);
  EXPECT_EQ(fifo_.take(), (Command{5, 0, 0xA5, 0x3C}));
  EXPECT_EQ(fifo_.take(), (Command{6, 1, 0, 0}));
  EXPECT_FALSE(fifo_.take());
}

TEST_F(CommandFifoTest, HoldsNoCommandUntilItsLastOctet) {
  for (const std::uint8_t octet : Octets{1, 0, 2}) EXPECT_TRUE(fifo_.put(octet, kernel::kStart));
  EXPECT_FALSE(fifo_.has_command());
  fifo_.put(3, kernel::kStart);
  EXPECT_TRUE(fifo_.has_command());
}

TEST_F(CommandFifoTest, LosesTheNewestCommandAsAWhole) {
  for (unsigned n = 0; n < 128; ++n) EXPECT_EQ(put(numbered(n)), 0U);
  EXPECT_EQ(fifo_.room(), 0U);
  EXPECT_FALSE(fifo_.has_overflowed());
  EXPECT_FALSE(fifo_.put(7, kernel::kStart));
  EXPECT_TRUE(fifo_.has_overflowed());
  // There is room again, but not for the rest of what has been lost.
  EXPECT_EQ(fifo_.take(), numbered(0));
  for (const std::uint8_t octet : Octets{0, 1, 2}) EXPECT_TRUE(fifo_.put(octet, kernel::kStart));
  EXPECT_EQ(fifo_.room(), 4U);
  EXPECT_EQ(put(numbered(128)), 0U);
  for (unsigned n = 1; n <= 128; ++n) EXPECT_EQ(fifo_.take(), numbered(n));
  EXPECT_FALSE(fifo_.take());
}

TEST_F(CommandFifoTest, GoesRoundManyTimes) {
  unsigned written = 0;
  unsigned read = 0;
  for (unsigned round = 0; round < 1000; ++round) {
    for (; written < read + 1 + round % 128; ++written) ASSERT_EQ(put(numbered(written)), 0U);
    for (; read < written; ++read) ASSERT_EQ(fifo_.take(), numbered(read));
  }
  EXPECT_EQ(fifo_.room(), 512U);
}

TEST_F(CommandFifoTest, GivesUpACommandOfWhichTheRestDoesNotCome) {
  EXPECT_EQ(fifo_.part_ends_at(), kernel::kNever);
  put(numbered(1));
  fifo_.put(9, kernel::kStart);
  fifo_.put(8, kernel::kStart + 3 * kMillisecond);
  EXPECT_EQ(fifo_.part_ends_at(), kernel::kStart + 103 * kMillisecond);
  EXPECT_EQ(fifo_.take_part(), (Octets{9, 8}));
  EXPECT_EQ(fifo_.part_ends_at(), kernel::kNever);
  put(numbered(2));
  EXPECT_EQ(fifo_.take(), numbered(1));
  EXPECT_EQ(fifo_.take(), numbered(2));
}

TEST_F(CommandFifoTest, ForgetsEverything) {
  for (unsigned n = 0; n < 129; ++n) put(numbered(n));
  fifo_.put(1, kernel::kStart);
  fifo_.clear();
  EXPECT_FALSE(fifo_.has_command());
  EXPECT_FALSE(fifo_.has_overflowed());
  EXPECT_EQ(fifo_.room(), 512U);
  EXPECT_EQ(fifo_.part_ends_at(), kernel::kNever);
}

}  // namespace
}  // namespace fieldproof::valve_bus
