#include "harness/kernel/error.hpp"

#include <gtest/gtest.h>

namespace fieldproof::kernel {
namespace {

TEST(Error, KindsHaveTheirExitCodes) {
  EXPECT_EQ(Error(ErrorKind::usage, "x").exit_code(), 64);
  EXPECT_EQ(Error(ErrorKind::configuration, "x").exit_code(), 65);
  EXPECT_EQ(Error(ErrorKind::implementation, "x").exit_code(), 5);
}

TEST(Error, CarriesItsSentenceThroughTheStandardInterface) {
  try {
    throw Error(ErrorKind::configuration, "network.json:3: \"bitrate\" is unknown; \"bit_rate\" is meant.");
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "network.json:3: \"bitrate\" is unknown; \"bit_rate\" is meant.");
  }
}

}  // namespace
}  // namespace fieldproof::kernel
