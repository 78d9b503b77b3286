#include "conformance/fieldbus_dll/ff_las_model.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;
using kernel::Time;

constexpr std::uint8_t kLas = 0x10;
constexpr unsigned kFirstMark = 0x04;
// 500 ms are 1953.125 octet durations.
constexpr std::uint32_t kDue = 16'000;
constexpr std::int64_t kBeforeDue = 1'953;

// A link at 31.25 kbit/s: an octet takes 256 us, V(MID) is 8, V(MRD) x V(ST) 32 octets. It tells what is said
// and answered, V(MID) after what was last on the line.
class FfLasModelTest : public testing::Test {
 protected:
  static fieldbus_dll::FfConfiguration configuration() {
    fieldbus_dll::FfConfiguration made;
    made.node = kLas;
    made.live = {0x11, 0x12};
    made.schedule = {.version = 1, .macrocycle = 32'000, .items = {{kDue, 0x1120, Priority::normal}}};
    made.rules.target_rotation = fieldbus_dll::octets({}, 200);
    made.rules.token_holding_octets = 100;
    made.rules.first_unpolled = 0x16;
    made.rules.unpolled = 0xE2;
    return made;
  }

  // Link time is due first.
  void SetUp() override { EXPECT_EQ(says({0x11, 0, 0, 0, 0, 0, 0}), ""); }

  static Time octet_at(std::int64_t count) { return kernel::kStart + fieldbus_dll::octets({}, count); }

  // The reason of the objection; empty: none.
  std::string says(Octets octets, std::int64_t later = 8) {
    const std::int64_t begin = now_ + later;
    now_ = begin + static_cast<std::int64_t>(octets.size()) + 5;
    const auto found = model_.say({octet_at(begin), octet_at(now_), true, true, std::move(octets)});
    return found ? found->reason : "";
  }
  std::string passes(std::uint8_t node, unsigned mark = 0, Priority priority = Priority::urgent,
                     std::uint8_t grant = 100) {
    return says({static_cast<std::uint8_t>(0x30U | mark | static_cast<unsigned>(priority)), node, 0, grant});
  }
  std::string probes(std::uint8_t node) { return says({0x26, node}); }

  Time heard_end(std::int64_t octets) { return octet_at(now_ += 8 + octets); }
  void returned() { model_.hear_answer(heard_end(6)); }
  // What comes next comes after V(MRD) x V(ST) of silence.
  void unanswered() { now_ += 24; }

  // IDLEs keep the line, until a DLPDU that comes V(MID) after would begin there.
  void idle_until(std::int64_t octet) {
    while (octet - now_ > 120) EXPECT_EQ(says({0x10}, 80), "");
    now_ = octet - 8;
  }

  void circulate(Priority priority) {
    EXPECT_EQ(passes(0x11, kFirstMark, priority), "");
    returned();
    EXPECT_EQ(passes(0x12, 0, priority), "");
    returned();
  }
  void probe_in_vain(std::uint8_t node) {
    EXPECT_EQ(probes(node), "");
    unanswered();
  }

  FfLasModel model_{configuration()};
  std::int64_t now_ = 0;
};

TEST_F(FfLasModelTest, CirculationsGoUpToAllPrioritiesWhileTheyAreFast) {
  circulate(Priority::urgent);
  probe_in_vain(0x13);
  circulate(Priority::normal);
  probe_in_vain(0x14);
  circulate(Priority::time_available);
  probe_in_vain(0x15);
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::normal), "priority_wrong");
}

TEST_F(FfLasModelTest, ASlowRotationGoesAStepBack) {
  circulate(Priority::urgent);
  probe_in_vain(0x13);
  circulate(Priority::normal);
  probe_in_vain(0x14);
  idle_until(now_ + 250);
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::urgent), "");
}

TEST_F(FfLasModelTest, EachLiveNodeHasItsTurnBetweenProbes) {
  EXPECT_EQ(passes(0x12, kFirstMark), "order_wrong");
}

TEST_F(FfLasModelTest, ANodeMayNotBePassedOver) {
  EXPECT_EQ(passes(0x11, kFirstMark), "");
  returned();
  probe_in_vain(0x13);
  EXPECT_EQ(passes(0x11, kFirstMark), "order_wrong");
}

TEST_F(FfLasModelTest, CirculationsAreMarkedAndHaveAProbeBetween) {
  circulate(Priority::urgent);
  EXPECT_EQ(passes(0x11), "begin_not_marked");
  returned();
  EXPECT_EQ(passes(0x12), "");
  returned();
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::normal), "no_probe");
}

TEST_F(FfLasModelTest, WaitsForAnAnswerOrForSilence) {
  EXPECT_EQ(passes(0x11, kFirstMark), "");
  EXPECT_EQ(passes(0x12), "does_not_wait");
}

TEST_F(FfLasModelTest, ATokenThatIsOverIsTakenBack) {
  EXPECT_EQ(passes(0x11, kFirstMark), "");
  model_.hear_data(heard_end(95));
  EXPECT_EQ(passes(0x12), "");
}

TEST_F(FfLasModelTest, WhoMissesThreeTokensIsRemovedAndThatIsTold) {
  for (const auto& [priority, node] : {std::pair{Priority::urgent, 0x13}, {Priority::normal, 0x14}}) {
    EXPECT_EQ(passes(0x11, kFirstMark, priority), "");
    unanswered();
    EXPECT_EQ(passes(0x12, 0, priority), "");
    returned();
    probe_in_vain(static_cast<std::uint8_t>(node));
  }
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::time_available), "");
  unanswered();
  EXPECT_EQ(passes(0x12, 0, Priority::time_available), "");
  returned();
  EXPECT_FALSE(model_.is_surely_live(0x11));
  probe_in_vain(0x15);
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::time_available), "token_for_removed");
}

TEST_F(FfLasModelTest, AFaultyAnswerLeavesOpenWhoIsLive) {
  for (const auto& [priority, node] :
       {std::pair{Priority::urgent, 0x13}, {Priority::normal, 0x14}, {Priority::time_available, 0x15}}) {
    EXPECT_EQ(passes(0x11, kFirstMark, priority), "");
    model_.hear_noise(heard_end(6));
    unanswered();
    EXPECT_EQ(passes(0x12, 0, priority), "");
    returned();
    probe_in_vain(static_cast<std::uint8_t>(node));
  }
  EXPECT_FALSE(model_.is_surely_live(0x11));
  // It has removed it; now that has to be told.
  EXPECT_EQ(passes(0x12, kFirstMark, Priority::time_available), "");
  returned();
  EXPECT_EQ(probes(0x11), "");
}

TEST_F(FfLasModelTest, OneProbeComesBetweenTwoCirculations) {
  circulate(Priority::urgent);
  EXPECT_EQ(probes(0x13), "");
  unanswered();
  EXPECT_EQ(probes(0x14), "second_probe");
}

TEST_F(FfLasModelTest, WhoAnswersAProbeIsActivatedAndPartOfTheNextCirculation) {
  circulate(Priority::urgent);
  EXPECT_EQ(probes(0x13), "");
  model_.hear_probe_response(heard_end(7));
  EXPECT_EQ(says({0xD2, 0x14, 0x00, kLas, 0x00, 0x01}), "unexpected_dlpdu");
  EXPECT_EQ(says({0xD2, 0x13, 0x00, kLas, 0x00, 0x01}), "");
  Octets list{0xD2, 0xFF, 0xFF, kLas, 0x00, 0x02, 0x01};
  list.resize(7 + 32);
  list[7 + 2] = 0xF0;
  EXPECT_EQ(says(list), "");
  list[7 + 2] = 0xE0;
  EXPECT_EQ(says(list), "live_list_wrong");
  // What was told made the rotation slow.
  circulate(Priority::urgent);
  EXPECT_EQ(passes(0x13), "");
}

TEST_F(FfLasModelTest, WhatIsDueGoesFirst) {
  idle_until(kBeforeDue + 1);
  EXPECT_EQ(passes(0x11, kFirstMark), "compelled_late");
}

TEST_F(FfLasModelTest, WhatIsDueGoesAtItsTime) {
  idle_until(kBeforeDue - 1);
  EXPECT_EQ(says({0xA2, 0x11, 0x20}), "compelled_early");
}

TEST_F(FfLasModelTest, WhatIsDueGoesSoon) {
  idle_until(kBeforeDue - 12);
  EXPECT_EQ(says({0x10}), "");  // until 6 octets before
  EXPECT_EQ(says({0xA2, 0x11, 0x20}, 8 + 17), "compelled_late");
}

TEST_F(FfLasModelTest, WhatIsDueIsCompelledAsItsItemSays) {
  idle_until(kBeforeDue + 1);
  EXPECT_EQ(says({0xA2, 0x11, 0x21}), "compelled_wrong");
  EXPECT_EQ(says({0xA2, 0x11, 0x20}), "");
}

TEST_F(FfLasModelTest, ATokenEndsBeforeWhatIsDue) {
  idle_until(kBeforeDue - 9 - 100 - 24);
  EXPECT_EQ(passes(0x11, kFirstMark), "");
  returned();
  EXPECT_EQ(passes(0x12), "token_over_due");
}

TEST_F(FfLasModelTest, ATokenThatIsCutUsesTheTime) {
  idle_until(1'000);
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::urgent, 90), "token_shorter_than_the_time");
}

TEST_F(FfLasModelTest, TheTimeGoesOnAndIsToldToWhoAsks) {
  EXPECT_EQ(passes(0x11, kFirstMark), "");
  model_.hear_time_request(heard_end(7));
  // 8 + 9 + 8 + 7 + 8 + 12 octet durations of 8.192 ticks after the first.
  EXPECT_EQ(says({0x11, 0, 0, 0, 0, 0x01, 0xAA}), "");
  model_.hear_time_request(heard_end(7));
  EXPECT_EQ(says({0x10}), "time_request_ignored");
}

TEST_F(FfLasModelTest, ItsUsersDataIsSentTheMostUrgentFirst) {
  ASSERT_TRUE(model_.submit(Priority::normal, {1}) && model_.submit(Priority::urgent, {2}));
  EXPECT_FALSE(model_.submit(Priority::urgent, Octets(65)));
  EXPECT_EQ(says({0xD3, 0x22, 0x30, kLas, 0x01, 2}), "");
  EXPECT_FALSE(model_.end().has_value());
  EXPECT_EQ(says({0xD2, 0x22, 0x30, kLas, 0x01, 3}), "sends_other_data");
}

TEST_F(FfLasModelTest, ItsOwnTurnReturnsNothingAndHasAnEnd) {
  for (int n = 0; n < 8; ++n)
    ASSERT_TRUE(model_.submit(Priority::urgent, Octets(30, static_cast<std::uint8_t>(n))));
  const auto own = [](std::uint8_t n, std::uint8_t code) {
    Octets dt1{code, 0x22, 0x30, kLas, 0x01};
    dt1.insert(dt1.end(), 30, n);
    return dt1;
  };
  EXPECT_EQ(says(own(0, 0xD7)), "sends_other_data");
  EXPECT_EQ(says(own(0, 0xD3)), "");
  EXPECT_EQ(says(own(1, 0xD3)), "own_turn_too_long");  // three times 40 and silences, within 100
}

TEST_F(FfLasModelTest, ItsOwnTurnIsUsed) {
  ASSERT_TRUE(model_.submit(Priority::urgent, {1}) && model_.submit(Priority::urgent, {2}));
  EXPECT_EQ(says({0xD3, 0x22, 0x30, kLas, 0x01, 1}), "");
  EXPECT_EQ(passes(0x11, kFirstMark), "data_not_sent");
}

TEST_F(FfLasModelTest, UrgentDataIsOwedOnceItsTurnHasPassed) {
  circulate(Priority::urgent);
  ASSERT_TRUE(model_.submit(Priority::urgent, {1}));
  probe_in_vain(0x13);
  EXPECT_FALSE(model_.end().has_value());
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::normal), "");
  EXPECT_TRUE(model_.end().has_value());
  returned();
  EXPECT_EQ(passes(0x12, 0, Priority::normal), "");
  returned();
  probe_in_vain(0x14);
  EXPECT_EQ(says({0xD3, 0x22, 0x30, kLas, 0x01, 1}), "");
  EXPECT_FALSE(model_.end().has_value());
}

TEST_F(FfLasModelTest, UrgentDataWithoutTimeInItsTurnIsNotOwed) {
  circulate(Priority::urgent);
  ASSERT_TRUE(model_.submit(Priority::urgent, Octets(64)));
  idle_until(kBeforeDue - 70);
  probe_in_vain(0x13);
  idle_until(kBeforeDue + 1);
  EXPECT_EQ(says({0xA2, 0x11, 0x20}), "");
  returned();
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::urgent), "");
  EXPECT_FALSE(model_.end().has_value());
}

TEST_F(FfLasModelTest, ItsOwnTurnHasThePriorityOfTheCirculation) {
  ASSERT_TRUE(model_.submit(Priority::normal, {1}));
  EXPECT_EQ(says({0xD2, 0x22, 0x30, kLas, 0x01, 1}), "");
  EXPECT_EQ(passes(0x11, kFirstMark), "sends_other_data");
}

TEST_F(FfLasModelTest, LiveListsAreNumberedAndHaveWhoSendsThem) {
  circulate(Priority::urgent);
  EXPECT_EQ(probes(0x13), "");
  model_.hear_probe_response(heard_end(7));
  Octets list{0xD2, 0xFF, 0xFF, kLas, 0x00, 0x02, 0x05};
  list.resize(7 + 32);
  list[7 + 2] = 0xF0;
  EXPECT_EQ(says(list), "");
  EXPECT_EQ(passes(0x11, kFirstMark, Priority::normal), "");
  returned();
  EXPECT_EQ(passes(0x12, 0, Priority::normal), "");
  returned();
  EXPECT_EQ(passes(0x13, 0, Priority::normal), "");
  returned();
  EXPECT_EQ(probes(0x14), "");
  model_.hear_probe_response(heard_end(7));
  list[7 + 2] = 0xF8;
  EXPECT_EQ(says(list), "live_list_wrong");
  list[6] = 0x05;
  list[7 + 2] = 0x78;
  EXPECT_EQ(says(list), "live_list_wrong");
}

TEST_F(FfLasModelTest, ATransferGoesBeforeTheCirculation) {
  model_.order_transfer(0x12, octet_at(now_));
  EXPECT_EQ(passes(0x11, kFirstMark), "not_transferred");
}

TEST_F(FfLasModelTest, WhatBelongsToAProbeAndATransferEndsBeforeWhatIsDue) {
  idle_until(kBeforeDue - 24 - 32 - 4);
  EXPECT_EQ(probes(0x13), "over_what_is_due");
  model_.order_transfer(0x12, octet_at(now_));
  EXPECT_EQ(says({0x06, 0x12, 0, 1}), "over_what_is_due");
}

TEST_F(FfLasModelTest, AnIdleIsNotSaidWhileNodesAreToBeProbed) {
  circulate(Priority::urgent);
  EXPECT_EQ(says({0x10}, 50), "idle_early");
  EXPECT_EQ(says({0x10}, 64), "");
}

TEST_F(FfLasModelTest, TheSupplyBeginsWithTheSameRevisionAndTime) {
  model_.lose_supply(octet_at(now_ += 50));
  EXPECT_EQ(says({0x11, 0, 0, 0, 0, 2, 0}), "time_wrong");
}

TEST_F(FfLasModelTest, WhoWasTheSchedulerAnswersAsADevice) {
  model_.hear_scheduler({0x01, 0x13}, heard_end(7));
  model_.hear_scheduler({0xA2, kLas, 0x20}, heard_end(8));
  EXPECT_TRUE(model_.owes_answer());
  EXPECT_EQ(says({0x17, 0x01}), "not_a_device");
  model_.hear_scheduler({0xA2, kLas, 0x20}, heard_end(8));
  EXPECT_EQ(says({0x17, 0x00}), "");
}

}  // namespace
}  // namespace fieldproof::conformance
