#include "protocols/token_bus/service_datum.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "protocols/token_bus/ring_description.hpp"

namespace fieldproof::token_bus {
namespace {

ServiceDatum any_datum() {
  return {*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint16_t>(),
          *rc::gen::arbitrary<std::uint16_t>()};
}

RC_GTEST_PROP(ServiceDatum, IsReadAsItWasWritten, ()) {
  const ServiceDatum datum = any_datum();
  const auto length = *rc::gen::inRange<std::size_t>(kLeastDatum, 1'500);
  const Octets octets = octets_of(datum, length);
  RC_ASSERT(octets.size() == length);
  RC_ASSERT(datum_of(octets) == std::optional(datum));
}

RC_GTEST_PROP(ServiceDatum, AnyOtherOctetBehindItsHeadShows, ()) {
  Octets octets = octets_of(any_datum(), *rc::gen::inRange<std::size_t>(kLeastDatum + 1, 300));
  const auto at = *rc::gen::inRange<std::size_t>(kLeastDatum, octets.size());
  octets[at] ^= static_cast<std::uint8_t>(*rc::gen::inRange(1, 256));
  RC_ASSERT(!datum_of(octets));
}

TEST(ServiceDatum, IsNoneWhereItIsTooShort) {
  EXPECT_FALSE(datum_of({1, 0, 0, 0}));
  EXPECT_FALSE(datum_of({}));
}

class OneFlow : public testing::Test {
 protected:
  OneFlow() { deliveries_.add_flow(); }
  Delivery get(std::uint16_t number, std::uint16_t word = 7) { return deliveries_.get({0, number, word}); }
  void give(std::uint16_t number) { deliveries_.give({0, number, 7}); }

  Deliveries deliveries_;
};

TEST_F(OneFlow, IsJudgedByWhatWasGiven) {
  for (std::uint16_t n = 0; n < 6; ++n) give(n);
  EXPECT_EQ(get(0), Delivery::first);
  EXPECT_EQ(get(0), Delivery::twice);
  EXPECT_EQ(get(2), Delivery::first) << "one was lost";
  EXPECT_EQ(get(1), Delivery::out_of_order);
  EXPECT_EQ(get(0), Delivery::out_of_order);
  EXPECT_EQ(get(3, 8), Delivery::wrong);
  EXPECT_EQ(get(6), Delivery::wrong) << "not given yet";
  EXPECT_EQ(deliveries_.get({1, 0, 7}), Delivery::wrong) << "no such flow";
  EXPECT_EQ(get(3), Delivery::first) << "what is wrong changes nothing";
}

TEST_F(OneFlow, GoesOnWhenItsNumbersBeginAnew) {
  for (unsigned n = 0; n < 70'000; ++n) {
    give(static_cast<std::uint16_t>(n));
    ASSERT_EQ(get(static_cast<std::uint16_t>(n)), Delivery::first) << n;
  }
}

}  // namespace
}  // namespace fieldproof::token_bus
