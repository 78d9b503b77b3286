#include "conformance/fieldbus_dll/submission_order.hpp"

#include <gtest/gtest.h>

#include "harness/traffic/request_queues.hpp"

namespace fieldproof::conformance {
namespace {

enum class Urgency : std::uint8_t { low, high };
struct Wish {
  Urgency priority;
};
using Queues = traffic::RequestQueues<Wish, Urgency::high, Urgency::low>;

TEST(SubmissionOrderTest, IsThatOfWhatWaitsWhateverItsPriority) {
  Queues queues;
  SubmissionOrder<Queues> order;
  for (const Urgency one : {Urgency::low, Urgency::high, Urgency::low}) {
    queues.push({one});
    order.add(one);
  }
  for (const Urgency one : {Urgency::low, Urgency::high, Urgency::low}) {
    ASSERT_EQ(order.first_of(queues), one);
    queues.pop(one);
  }
  EXPECT_EQ(order.first_of(queues), std::nullopt);
}

// With the supply the queues are lost, and nobody tells the order of it.
TEST(SubmissionOrderTest, LeavesWhatWasLost) {
  SubmissionOrder<Queues> order;
  order.add(Urgency::low);
  order.add(Urgency::high);
  Queues queues;
  EXPECT_EQ(order.first_of(queues), std::nullopt);
  queues.push({Urgency::high});
  order.add(Urgency::high);
  EXPECT_EQ(order.first_of(queues), Urgency::high);
}

}  // namespace
}  // namespace fieldproof::conformance
