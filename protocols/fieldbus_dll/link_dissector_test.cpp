#include "protocols/fieldbus_dll/link_dissector.hpp"

#include <gtest/gtest.h>

#include "harness/line/delimited_frame.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

line::Waveform frame_of(const Octets& on_line) {
  line::Waveform wave{kernel::kStart, 2 * LinkRules{}.bit_rate, {}};
  line::DelimitedFrameCode().append(wave.levels, on_line);
  return wave;
}

TEST(LinkDissector, TellsDlpdusOfItsProfile) {
  EXPECT_EQ(LinkDissector(IsaRules{}).brief(frame_of(with_check(Octets{0x42, 0x21, 0x10}))),
            "ET normal 10 -> 21");
  EXPECT_EQ(LinkDissector(FfRules{}).brief(frame_of(with_check(Octets{0x36, 0x20, 0x01, 0x18}))),
            "PT normal 20 for 280 octets, first");
  EXPECT_EQ(LinkDissector(FfRules{}).brief(frame_of(with_check(Octets{0x42, 0x21, 0x10}))),
            "42 21 10 E1 DC (no DLPDU)");
}

TEST(LinkDissector, TellsWhatIsWrongWithAFrame) {
  const LinkDissector dissector(IsaRules{});
  const auto teller = dissector.teller();
  const trace::Decoded wrong = teller->tell(frame_of({0x42, 0x21, 0x10, 0xE1, 0xDD}));
  EXPECT_EQ(wrong.text, "42 21 10 E1 DD (check wrong)");
  EXPECT_TRUE(wrong.is_check_wrong);
  line::Waveform cut = frame_of(with_check(Octets{0x42, 0x21, 0x10}));
  cut.levels.resize(32 + 40);
  EXPECT_EQ(dissector.brief(cut), "42 21 (signal lost)");
  EXPECT_EQ(dissector.brief({kernel::kStart, 62'500, line::Levels::of_text("0101")}), "no frame");
  EXPECT_EQ(dissector.brief(frame_of({})), " (check wrong)");
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
