#include "harness/line/frame_check_16.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::line {
namespace {

constexpr FrameCheckParameters kCcitt = {
    "CRC-16/IBM-3740", 16, 0x1021, 0xFFFF, false, false, 0, 0x29B1, 0x0000, true, ""};
// Tables and all at compile time.
constexpr FrameCheck16 kAtCompileTime(kCcitt);
static_assert(kAtCompileTime.finish(kAtCompileTime.start()) == 0xFFFF);

std::vector<const FrameCheckParameters*> sixteen_bit_sets() {
  std::vector<const FrameCheckParameters*> sets;
  for (const FrameCheckParameters& p : frame_check_catalogue()) {
    if (p.width == 16) sets.push_back(&p);
  }
  return sets;
}

std::vector<std::uint8_t> random_octets(kernel::Random& random, std::size_t size) {
  std::vector<std::uint8_t> octets(size);
  for (std::uint8_t& octet : octets) octet = static_cast<std::uint8_t>(random.next());
  return octets;
}

// All five ways through the engine against the general one, at every length where one of them changes its
// step, and at lengths beyond.
TEST(FrameCheck16, EveryWayGivesWhatTheGeneralEngineGives) {
  kernel::Random random(1);
  ASSERT_EQ(sixteen_bit_sets().size(), 31U);
  for (const FrameCheckParameters* p : sixteen_bit_sets()) {
    const FrameCheck general(*p);
    const FrameCheck16 fast(*p);
    for (std::size_t size = 0; size < 330; ++size) {
      const std::vector<std::uint8_t> octets = random_octets(random, size);
      const FrameCheckValue expected = general.compute(octets);
      ASSERT_TRUE(fast.compute(octets) == expected) << p->name << " " << size;
      ASSERT_TRUE(fast.finish(fast.update_by_table(fast.start(), octets)) == expected) << p->name;
      ASSERT_TRUE(fast.finish(fast.update_by_slices(fast.start(), octets)) == expected) << p->name;
      if (size >= 64 && FrameCheck16::can_fold()) {
        ASSERT_TRUE(fast.finish(fast.update_by_folding(fast.start(), octets)) == expected) << p->name << size;
      }
    }
  }
}

TEST(FrameCheck16, BitsInLineOrderGiveTheSame) {
  for (const FrameCheckParameters* p : sixteen_bit_sets()) {
    const FrameCheck16 fast(*p);
    FrameCheck16::State state = fast.start();
    for (const char digit : std::string_view("123456789")) {
      for (unsigned bit = 0; bit < 8; ++bit) {
        state = fast.update_bit(state, ((digit >> (p->refin ? bit : 7 - bit)) & 1) != 0);
      }
    }
    EXPECT_TRUE(fast.finish(state) == p->check) << p->name;
  }
}

RC_GTEST_PROP(FrameCheck16, PiecesOfAnyLengthGiveTheWhole, ()) {
  const auto p = *rc::gen::elementOf(sixteen_bit_sets());
  const auto size = *rc::gen::inRange<std::size_t>(0, 2000);
  const auto cut = *rc::gen::inRange<std::size_t>(0, size + 1);
  kernel::Random random(*rc::gen::arbitrary<std::uint64_t>());
  const std::vector<std::uint8_t> message = random_octets(random, size);
  const std::span<const std::uint8_t> octets = message;
  const FrameCheck16& fast = shared_frame_check_16(p->name);
  const FrameCheck16::State in_pieces =
      fast.update(fast.update(fast.start(), octets.first(cut)), octets.subspan(cut));
  RC_ASSERT(in_pieces == fast.update_by_table(fast.start(), octets));
  RC_ASSERT(in_pieces == fast.update(fast.start(), octets));
}

RC_GTEST_PROP(FrameCheck16, CheckOctetsLeadToTheResidueAndAFlippedBitDoesNot,
              (std::vector<std::uint8_t> message)) {
  for (const FrameCheckParameters* p : sixteen_bit_sets()) {
    const FrameCheck16& fast = shared_frame_check_16(p->name);
    std::vector<std::uint8_t> word = message;
    for (const std::uint8_t octet : fast.check_octets(fast.update(fast.start(), message)))
      word.push_back(octet);
    RC_ASSERT(fast.is_residue(fast.update(fast.start(), word)));
    RC_ASSERT(FrameCheck(*p).is_code_word(word));
    const auto bit = *rc::gen::inRange<std::size_t>(0, word.size() * 8);
    word[bit / 8] = static_cast<std::uint8_t>(word[bit / 8] ^ (1U << (bit % 8)));
    RC_ASSERT(!fast.is_residue(fast.update(fast.start(), word)));
  }
}

// Known answers from outside: INTERBUS with all four presets, PROFIBUS PA, Modbus.
TEST(FrameCheck16, GivesTheKnownAnswers) {
  const std::vector<std::uint8_t> digits = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(kAtCompileTime.compute(digits), 0x29B1);
  EXPECT_EQ(shared_frame_check_16("CRC-16/GENIBUS").compute(digits), 0xD64E);
  EXPECT_EQ(shared_frame_check_16("XMODEM").compute(digits), 0x31C3);
  EXPECT_EQ(shared_frame_check_16("X-25").compute(digits), 0x906E);
  EXPECT_EQ(shared_frame_check_16("CRC-16/PROFIBUS").compute(digits), 0xA819);
  EXPECT_EQ(shared_frame_check_16("MODBUS").compute(digits), 0x4B37);
}

TEST(FrameCheck16, IsSharedAndRefusesWhatIsNotSixteenBits) {
  EXPECT_EQ(&shared_frame_check_16("X-25"), &shared_frame_check_16("crc-16/ibm-sdlc"));
  EXPECT_THROW(shared_frame_check_16("CRC-15/CAN"), kernel::Error);
  EXPECT_THROW(shared_frame_check_16("nothing"), kernel::Error);
  EXPECT_THROW(FrameCheck16(frame_check_named("CRC-15/CAN")), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::line
