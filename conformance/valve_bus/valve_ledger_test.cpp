#include "conformance/valve_bus/valve_ledger.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace fieldproof::conformance {
namespace {

constexpr kernel::Time at_ms(std::int64_t milliseconds) {
  return kernel::kStart + milliseconds * kernel::kMillisecond;
}

TEST(ValveLedger, KnowsWhatTheValvesWereAndWhatTheyWereTold) {
  ValveLedger ledger;
  EXPECT_EQ(ledger.at(at_ms(5)), 0U);
  ledger.add_write({at_ms(1), 0xA5});
  ledger.add_write({at_ms(1), 0xA5});  // the same again
  ledger.add_write({at_ms(4), 0x5A});
  ledger.add_move({at_ms(7), 0xA5, 0x5A});  // announced
  ledger.add_move({at_ms(3), 0, 0xA5});
  EXPECT_EQ(ledger.at(at_ms(2)), 0U);
  EXPECT_EQ(ledger.at(at_ms(3)), 0xA5U);
  EXPECT_EQ(ledger.at(at_ms(8)), 0x5AU);
  EXPECT_EQ(ledger.writes().size(), 2U);
  ASSERT_TRUE(ledger.write_of(0x5A, at_ms(0), at_ms(9)));
  EXPECT_EQ(ledger.write_of(0x5A, at_ms(0), at_ms(9))->end, at_ms(4));
  EXPECT_FALSE(ledger.write_of(0x5A, at_ms(0), at_ms(3)));
  EXPECT_FALSE(ledger.write_of(0xA5, at_ms(2), at_ms(9)));
  ASSERT_TRUE(ledger.first_move_to(0x5A, at_ms(4)));
  EXPECT_EQ(ledger.first_move_to(0x5A, at_ms(4))->when, at_ms(7));
  EXPECT_FALSE(ledger.first_move_to(0xA5, at_ms(4)));
  ledger.forget_writes();
  EXPECT_TRUE(ledger.writes().empty());
}

TEST(ValveLedger, AWriteThatIsRepeatedIsDueSinceItsFirst) {
  ValveLedger ledger;
  for (const auto& [milliseconds, valves] :
       {std::pair(1, 0xA5), std::pair(2, 0x5A), std::pair(3, 0xA5), std::pair(4, 0xA5)})
    ledger.add_write({at_ms(milliseconds), static_cast<std::uint16_t>(valves)});
  EXPECT_EQ(ledger.write_of(0xA5, at_ms(0), at_ms(9))->end, at_ms(3));
  EXPECT_EQ(ledger.write_of(0xA5, at_ms(0), at_ms(2))->end, at_ms(1));
}

TEST(ValveLedger, KeepsTheLastMovesOnly) {
  ValveLedger ledger;
  for (std::int64_t n = 0; n < 1'000; ++n)
    ledger.add_move({at_ms(n), static_cast<std::uint16_t>(n), static_cast<std::uint16_t>(n + 1)});
  EXPECT_LT(ledger.moves().size(), 500U);
  EXPECT_EQ(ledger.at(at_ms(999)), 1'000U);
}

}  // namespace
}  // namespace fieldproof::conformance
