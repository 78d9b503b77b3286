#include "conformance/fieldbus_dll/driven_dlpdus.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/line/delimited_frame.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kBitRate = 31'250;

DrivenDlpdu heard(const line::Levels& half_bits) {
  DrivenDlpdus ear(kBitRate);
  ear.on_wave({kernel::kStart, 2 * kBitRate, half_bits});
  return ear.take_one();
}

// The tester and the stations write frames and checks by code of their own.
RC_GTEST_PROP(DrivenDlpdusProperty, TwoEncodersAgree, (const Octets& octets)) {
  const auto preamble = *rc::gen::inRange(1U, line::kMostPreambleOctets + 1);
  const Octets checked = with_frame_check(octets);
  RC_ASSERT(checked == fieldbus_dll::with_check(octets));
  line::Levels levels;
  line::DelimitedFrameCode().append(levels, checked, preamble);
  RC_ASSERT(half_bits_of_frame(checked, preamble) == levels);
  const DrivenDlpdu back = heard(levels);
  RC_ASSERT(back.is_well_formed);
  RC_ASSERT(back.has_right_check == !octets.empty());
  if (!octets.empty()) RC_ASSERT(back.octets == octets);
}

// Each half bit of a frame matters.
TEST(DrivenDlpdus, SeesEachHalfBitThatIsWrong) {
  const line::Levels right = half_bits_of_frame(with_frame_check(Octets{0x42, 0x21, 0x10}));
  ASSERT_TRUE(heard(right).is_well_formed && heard(right).has_right_check);
  for (std::size_t n = 0; n < right.size(); ++n) {
    line::Levels wrong = right;
    wrong.flip(n);
    const DrivenDlpdu one = heard(wrong);
    EXPECT_FALSE(one.is_well_formed && one.has_right_check) << n;
  }
}

TEST(DrivenDlpdus, SeesPreamblesThatAreNone) {
  const Octets octets = with_frame_check(Octets{0x42, 0x21, 0x10});
  EXPECT_FALSE(heard(half_bits_of_frame(octets, 0)).is_well_formed);
  EXPECT_TRUE(heard(half_bits_of_frame(octets, 8)).is_well_formed);
  EXPECT_FALSE(heard(half_bits_of_frame(octets, 9)).is_well_formed);
  EXPECT_FALSE(heard(half_bits_of_frame(octets).slice(4, 500)).is_well_formed);
}

TEST(DrivenDlpdu, IsToldWholeOrByBothEnds) {
  DrivenDlpdu dlpdu{kernel::kStart, kernel::kStart, true, true, Octets(32, 0x41)};
  EXPECT_EQ(dlpdu.text().size(), 32U * 3 - 1);
  dlpdu.octets = Octets(260, 0x41);
  dlpdu.octets.back() = 0x42;
  EXPECT_EQ(dlpdu.text(), "41 41 41 41 41 41 41 41 41 41 41 41 41 41 41 41 ... 41 41 41 42, 260 octets");
  dlpdu.has_right_check = false;
  EXPECT_TRUE(dlpdu.text().ends_with("260 octets with a wrong check"));
}

}  // namespace
}  // namespace fieldproof::conformance
