#include "harness/trace/octet_dissector.hpp"

#include <gtest/gtest.h>

#include <array>

#include "harness/line/octet_line.hpp"

namespace fieldproof::trace {
namespace {

TEST(OctetDissector, TellsTheOctetsOfATransmission) {
  const OctetDissector dissector(19'200);
  line::Waveform wave =
      line::OctetLine(19'200).wave_of(std::array<std::uint8_t, 2>{0x07, 0x5D}, kernel::kStart);
  EXPECT_EQ(dissector.brief(wave), "07 5D");
  EXPECT_EQ(dissector.teller()->tell(wave).text, "07 5D");
  wave.levels.flip(9);
  EXPECT_EQ(dissector.brief(wave), "a wrong character");
}

}  // namespace
}  // namespace fieldproof::trace
