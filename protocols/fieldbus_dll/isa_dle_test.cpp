#include "protocols/fieldbus_dll/isa_dle.hpp"

#include <gtest/gtest.h>

#include <string>

#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::uint8_t kPeer = 0x22;

class IsaDleTest : public testing::Test {
 protected:
  IsaDleTest() : user_(link_.add(dle_)) { link_.wait(20); }

  void submit(IsaService service, Octets octets = {}, Priority priority = Priority::normal) {
    ASSERT_TRUE(dle_.submit({service, priority, kPeer, std::move(octets)}, link_.now()));
    link_.refresh();
  }
  // The station has an ES and has compelled the peer.
  void compel() {
    submit(IsaService::compel);
    link_.say(token(IsaType::es, Priority::normal, kNode, 2'000));
    link_.wait(16);
    ASSERT_EQ(dle_.state(), DleState::awaiting_reply);
    link_.heard();
  }

  IsaTestLink link_;
  IsaDle dle_{{.rules = {}, .address = kNode}};
  IsaTestLink::User& user_;
};

TEST_F(IsaDleTest, SendsUnderATokenAndReturnsIt) {
  submit(IsaService::unit_data, {0xAB});
  link_.say(token(IsaType::et, Priority::normal, kNode));
  EXPECT_EQ(dle_.state(), DleState::holding);
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "@36 DU normal 21 -> 22: AB\n@53 EE 21 -> 10, single frame done\n");
  EXPECT_EQ(dle_.state(), DleState::idle);
}

// ---- idle ----

TEST_F(IsaDleTest, IdleDeliversDataAndLeavesTheRest) {
  link_.say(data(IsaType::du, kNode, kPeer, {1}));
  link_.wait(20);
  link_.say(data(IsaType::dt, kNode, kPeer, {2}));
  link_.wait(20);
  link_.say(data(IsaType::du, kPeer, 0x23, {3}));
  link_.wait(20);
  link_.say({.type = IsaType::ee, .destination = kNode, .source = kPeer});
  link_.wait(20);
  link_.say({.type = IsaType::tl, .destination = kNode, .source = 0x10});
  link_.wait(40);
  EXPECT_EQ(user_.take(), "DU normal 22 -> 21: 01\nDT normal 22 -> 21 final: 02\n");
  EXPECT_EQ(link_.heard(), "");
  EXPECT_EQ(dle_.state(), DleState::idle);
}

// ---- holding ----

TEST_F(IsaDleTest, HoldingATokenThatIsOverIsSilent) {
  link_.say(token(IsaType::es, Priority::normal, kNode, 5));
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "");
  EXPECT_EQ(dle_.state(), DleState::idle);
}

// The CD ends, two octets after the ES, at the very instant at which that is over, or an octet beside it.
TEST_F(IsaDleTest, ATokenIsOverAtTheInstantAtWhichItsDurationIs) {
  constexpr std::int64_t kOctetsOfACd = 8;  // with preamble, delimiters and check
  for (const std::int64_t beside : {-1, 0, 1}) {
    IsaTestLink link;
    IsaDle dle{{.rules = {}, .address = kNode}};
    link.add(dle);
    link.wait(20);
    link.say(
        token(IsaType::es, Priority::normal, kNode, static_cast<std::uint16_t>(2 + kOctetsOfACd + beside)));
    link.wait(2);
    link.say({.type = IsaType::cd, .destination = kNode, .source = 0x10});
    EXPECT_EQ(dle.state(), beside > 0 ? DleState::holding : DleState::replying) << beside;
  }
}

TEST_F(IsaDleTest, HoldingADataDlpduOfAnotherIsWaitedFor) {
  submit(IsaService::unit_data, {0xAB});
  link_.say(token(IsaType::es, Priority::normal, kNode, 2'000));
  link_.wait(2);
  link_.say(data(IsaType::du, kNode, kPeer, {7}));
  link_.wait(60);
  EXPECT_EQ(user_.take(), "DU normal 22 -> 21: 07\n");
  EXPECT_EQ(link_.heard(), "@49 DU normal 21 -> 22: AB\n@66 EE 21 -> 10, nothing to send\n");
}

TEST_F(IsaDleTest, HoldingLosesItsTokenWhenASchedulerSpeaks) {
  submit(IsaService::unit_data, {0xAB});
  link_.say(token(IsaType::es, Priority::normal, kNode, 2'000));
  link_.wait(2);
  link_.say(token(IsaType::et, Priority::normal, kPeer));
  EXPECT_EQ(dle_.state(), DleState::idle);
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "");
}

TEST_F(IsaDleTest, HoldingTakesTheNewTokenInPlaceOfTheOld) {
  submit(IsaService::unit_data, {0xAB}, Priority::time_available);
  link_.say(token(IsaType::es, Priority::normal, kNode, 2'000));
  link_.wait(2);
  link_.say(token(IsaType::et, Priority::time_available, kNode, 0, 0x0F));
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "@48 DU time-available 21 -> 22: AB\n@65 EE 21 -> 0F, single frame done\n");
}

// ---- awaiting a reply ----

TEST_F(IsaDleTest, AReplyIsDeliveredAndTheTokenUsedOn) {
  compel();
  link_.say(data(IsaType::dt, kNode, kPeer, {5}));
  EXPECT_EQ(user_.take(), "DT normal 22 -> 21 final: 05\n");
  EXPECT_EQ(dle_.state(), DleState::holding);
  link_.wait(40);
  EXPECT_EQ(dle_.state(), DleState::idle);
}

TEST_F(IsaDleTest, ARepliesAbsenceIsToldAndTheTokenUsedOn) {
  compel();
  link_.wait(60);
  EXPECT_EQ(user_.take(), "reply missing 34\n");
  EXPECT_EQ(link_.heard(), "@78 EE 21 -> 10, nothing to send\n");
}

TEST_F(IsaDleTest, AnotherDlpduInPlaceOfAReplyCostsTheToken) {
  for (const IsaDlpdu& other : {data(IsaType::dt, kNode, 0x23, {5}), data(IsaType::du, kNode, kPeer, {5}),
                                cd(kNode, 0x23), token(IsaType::et, Priority::normal, kNode)}) {
    compel();
    link_.say(other);
    EXPECT_EQ(dle_.state(), DleState::idle) << describe(other);
    EXPECT_EQ(user_.take(), "token dropped " + std::to_string(other.source) + "\n") << describe(other);
    link_.wait(100);
    EXPECT_EQ(link_.heard(), "") << describe(other);
  }
}

// ---- replying ----

TEST_F(IsaDleTest, ACdIsAnsweredWithWhatThereIs) {
  submit(IsaService::reply_data, {9});
  link_.say(cd(kNode, kPeer));
  EXPECT_EQ(dle_.state(), DleState::replying);
  link_.wait(40);
  link_.say(cd(kNode, kPeer));
  link_.wait(40);
  EXPECT_EQ(link_.heard(), "@36 DT normal 21 -> 22 final: 09\n@84 DT normal 21 -> 22 final\n");
}

TEST_F(IsaDleTest, AReplyIsGivenUpWhenAnybodySpeaksBeforeIt) {
  user_.works_on_reply = true;
  link_.say(cd(kNode, kPeer));
  link_.wait(10);
  link_.say(data(IsaType::du, 0x23, kPeer, {}));
  EXPECT_EQ(dle_.state(), DleState::idle);
  submit(IsaService::reply_data, {9});
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "");
}

TEST_F(IsaDleTest, AReplyThatAUserPromisedAndDoesNotGiveIsNone) {
  user_.works_on_reply = true;
  link_.say(cd(kNode, kPeer));
  link_.wait(23);
  EXPECT_EQ(dle_.state(), DleState::replying);
  link_.wait(60);
  EXPECT_EQ(link_.heard(), "");
  EXPECT_EQ(dle_.state(), DleState::idle);
}

// ---- whatever the state ----

TEST_F(IsaDleTest, ACdThatShouldCarryDataIsRefused) {
  EXPECT_FALSE(dle_.submit({IsaService::compel, Priority::normal, kPeer, {0xAB}}, link_.now()));
  link_.say(token(IsaType::es, Priority::normal, kNode, 2'000));
  link_.wait(100);
  EXPECT_NE(link_.heard().find("EE"), std::string::npos);
}

TEST_F(IsaDleTest, AServiceOrPriorityThatThereIsNotIsRefused) {
  for (const unsigned priority : {0U, 4U})
    EXPECT_FALSE(
        dle_.submit({IsaService::unit_data, static_cast<Priority>(priority), kPeer, {1}}, link_.now()));
  EXPECT_FALSE(dle_.submit({static_cast<IsaService>(3), Priority::normal, kPeer, {1}}, link_.now()));
  EXPECT_FALSE(dle_.order_transfer(kPeer, link_.now()));
  EXPECT_FALSE(dle_.ask({7, 1}, link_.now()));
}

TEST_F(IsaDleTest, WithImpossibleRulesItDoesNotStart) {
  IsaRules rules;
  rules.link.inter_pdu_delay_octets = 24;
  EXPECT_EQ(impossible(rules), std::nullopt);
  EXPECT_TRUE(IsaDle({.rules = rules, .address = kNode}).start(kernel::kStart));
  rules.link.inter_pdu_delay_octets = 25;
  EXPECT_EQ(impossible(rules), "inter_pdu_delay_octets is 25, and may be 0 to 24");
  EXPECT_FALSE(IsaDle({.rules = rules, .address = kNode}).start(kernel::kStart));
}

TEST_F(IsaDleTest, WhatIsNoDlpduIsAsIfNothingWere) {
  link_.say(
      {.type = IsaType::ee, .destination = 0xFF, .source = kPeer});  // an address that an EE cannot have
  link_.wait(40);
  EXPECT_EQ(user_.take(), "");
  submit(IsaService::unit_data, {1});
  EXPECT_FALSE(dle_.submit({IsaService::unit_data, Priority::urgent, kPeer, Octets(65)}, link_.now()));
  EXPECT_FALSE(dle_.submit({IsaService::unit_data, Priority::urgent, 0xF8, {}}, link_.now()));
  EXPECT_FALSE(dle_.submit({IsaService::compel, Priority::urgent, 0xFF, {}}, link_.now()));
  EXPECT_TRUE(dle_.submit({IsaService::unit_data, Priority::urgent, 0xFF, {}}, link_.now()));
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
