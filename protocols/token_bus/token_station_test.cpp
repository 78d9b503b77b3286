#include "protocols/token_bus/token_station.hpp"

#include <gtest/gtest.h>

#include "protocols/token_bus/test_bus.hpp"

namespace fieldproof::token_bus {
namespace {

using enum FrameKind;

constexpr Address kOwn = 0x000A;
constexpr Address kPrevious = 0x000E;
constexpr Address kNext = 0x0004;
constexpr std::int64_t kTokenOctets = 15;

// A station at 000A, with the tester in the place of all others.
class OneTokenStation : public testing::Test {
 protected:
  explicit OneTokenStation(const StationConfiguration& configuration = {})
      : station_(configuration), user_(bus_.add(station_)) {
    EXPECT_TRUE(station_.start(bus_.now()));
    bus_.refresh();
  }

  // It is in a ring of 000E, 000A and 0004, idle, 000E having had the token last.
  void join() {
    bus_.wait(10);
    bus_.drive(control(solicit_successor_1, kNext, kPrevious));
    bus_.wait(30);
    EXPECT_EQ(station_.state(), AccessState::demand_in);
    bus_.drive(control(token, kOwn, kPrevious));
    bus_.wait(25);
    EXPECT_EQ(station_.state(), AccessState::check_token_pass);
    bus_.drive(control(token, kPrevious, kNext));
    EXPECT_EQ(station_.state(), AccessState::idle);
    bus_.wait(10);
    bus_.take();
    user_.take();
  }
  // With an empty queue it passes the token at once.
  void give_token() { bus_.drive(control(token, kOwn, kPrevious)); }
  void submit(const DataRequest& request) {
    EXPECT_TRUE(station_.submit(request, bus_.now()));
    bus_.refresh();
  }
  // The tokens that come until a window opens, and it.
  void rotate_until_window() {
    for (unsigned n = 0; n < 40; ++n) {
      give_token();
      bus_.wait(10);
      if (station_.state() == AccessState::await_response) return;
      bus_.wait(15);
      bus_.drive(control(token, kPrevious, kNext));
      bus_.wait(10);
    }
    ADD_FAILURE() << "no window";
  }

  TestBus bus_;
  TokenStation station_;
  TestBus::User& user_;
};

TEST_F(OneTokenStation, ClaimsAfterSevenSlotsByTwoBitsOfItsAddressEach) {
  bus_.wait_slots(100);
  // 000A is 0000 0000 0000 1010: six passes 00, then 10, 10, and one by chance.
  const std::string text = bus_.take();
  EXPECT_TRUE(
      text.starts_with("@196 claim_token, 000A -> 0000, 0 octets\n"
                       "@239 claim_token, 000A -> 0000, 0 octets\n"))
      << text;
  std::size_t claims = 0;
  for (std::size_t at = text.find("claim"); at != std::string::npos; at = text.find("claim", at + 1))
    ++claims;
  EXPECT_EQ(claims, 9U);
  EXPECT_NE(text.find("@454 claim_token, 000A -> 0000, 112 octets\n"
                      "@609 claim_token, 000A -> 0000, 112 octets\n"
                      "@764 claim_token"),
            std::string::npos)
      << text;
  EXPECT_EQ(user_.take(), "sole station 000A\n");
  EXPECT_NE(text.find("solicit_successor_2, 000A -> 000A"), std::string::npos) << text;
  EXPECT_TRUE(station_.is_in_ring());
}

TEST_F(OneTokenStation, ActivityBeginsTheIdleTimeAnew) {
  bus_.wait(193);
  bus_.drive_noise(12);
  EXPECT_EQ(bus_.octets_now(), 205);
  bus_.wait(195);
  EXPECT_EQ(bus_.take(), "");
  EXPECT_EQ(station_.counters()[0], 1U);
  bus_.wait(20);
  EXPECT_TRUE(bus_.take().starts_with("@401 claim_token"));
}

TEST_F(OneTokenStation, ARivalThatClaimsLongerHasTheToken) {
  bus_.wait(196 + kTokenOctets + 20);
  EXPECT_EQ(station_.state(), AccessState::claim_token);
  bus_.drive_noise(30);
  EXPECT_EQ(station_.state(), AccessState::idle);
}

TEST_F(OneTokenStation, DoesNotClaimWithoutAReason) {
  station_.set_in_ring_desired(false, bus_.now());
  bus_.refresh();
  bus_.wait_slots(40);
  EXPECT_EQ(bus_.take(), "");
  submit({.destination = kNext, .data = {1}});
  bus_.wait(10);
  EXPECT_EQ(station_.state(), AccessState::claim_token);
}

TEST_F(OneTokenStation, AnswersAWindowThatHasItsAddress) {
  join();
  EXPECT_EQ(station_.predecessor(), kPrevious);
  EXPECT_EQ(station_.successor(), kNext);
}

TEST_F(OneTokenStation, WindowsWithItsAddressAndWithout) {
  struct Row {
    FrameKind kind;
    Address destination;
    Address source;
    int window;  // -1: none
  };
  for (const Row& row : {
           Row{solicit_successor_1, 0x0004, 0x000E, 0},
           Row{solicit_successor_1, 0x0008, 0x000C, 0},
           Row{solicit_successor_1, 0x000A, 0x000E, -1},
           Row{solicit_successor_1, 0x0004, 0x0008, -1},
           Row{solicit_successor_1, 0x000C, 0x0010, -1},
           Row{solicit_successor_1, 0x0004, 0x0100, 0},
           Row{solicit_successor_1, 0x0100, 0x0200, -1},
           Row{solicit_successor_2, 0x0010, 0x000C, 0},
           Row{solicit_successor_2, 0x0008, 0x0004, 1},
           Row{solicit_successor_2, 0x000E, 0x0004, -1},
           Row{solicit_successor_2, 0x000E, 0x000E, 0},
           Row{solicit_successor_2, 0x0004, 0x0004, 1},
       }) {
    TestBus bus;
    TokenStation station({});
    bus.add(station);
    station.start(bus.now());
    bus.refresh();
    bus.drive(control(row.kind, row.destination, row.source));
    bus.wait_slots(3);
    const std::int64_t begin = kTokenOctets + 6 + 28 * row.window;
    const std::string answer =
        "@" + std::to_string(begin) + " set_successor, 000A -> " + text_of(row.source, Rules{}) + ": 000A\n";
    EXPECT_EQ(bus.take(), row.window < 0 ? "" : answer) << row.source;
  }
}

TEST_F(OneTokenStation, AnswersInTheSecondWindowOnlyAfterASilentFirstOne) {
  bus_.drive(control(solicit_successor_2, 0x0008, 0x0004));
  bus_.wait(6);
  bus_.drive(with_address(set_successor, 0x0004, 0x0002, 0x0002));
  bus_.wait_slots(4);
  EXPECT_EQ(bus_.take(), "");
  EXPECT_EQ(station_.state(), AccessState::idle);
}

TEST_F(OneTokenStation, WaitsInAContestByTheComplementOfItsBits) {
  bus_.drive(control(solicit_successor_1, kNext, kPrevious));
  bus_.wait(6 + 17);
  bus_.take();
  // 00 00 00 00 00 00 10 10: six times three slots, then one.
  for (unsigned pass = 0; pass < 8; ++pass) {
    bus_.wait(6);
    bus_.drive(control(resolve_contention, kPrevious, kPrevious));
    EXPECT_EQ(station_.state(), AccessState::demand_delay);
    const std::int64_t begin = bus_.octets_now() + 28 * (pass < 6 ? 3 : 1) + 6;
    bus_.wait(begin + 17 - bus_.octets_now());
    EXPECT_EQ(bus_.take(), "@" + std::to_string(begin) + " set_successor, 000A -> 000E: 000A\n") << pass;
    EXPECT_EQ(station_.state(), AccessState::demand_in);
  }
}

TEST_F(OneTokenStation, YieldsToWhoAnswersSoonerInAContest) {
  bus_.drive(control(solicit_successor_1, kNext, kPrevious));
  bus_.wait(6 + 17 + 6);
  bus_.take();
  bus_.drive(control(resolve_contention, kPrevious, kPrevious));
  bus_.wait(6);
  bus_.drive_noise(17);
  EXPECT_EQ(station_.state(), AccessState::idle);
  bus_.wait_slots(4);
  EXPECT_EQ(bus_.take(), "");
}

TEST_F(OneTokenStation, PassesTheTokenAfterTheGap) {
  join();
  give_token();
  const std::int64_t end = bus_.octets_now();
  bus_.wait(25);
  EXPECT_EQ(bus_.take(), "@" + std::to_string(end + 6) + " token, 000A -> 0004\n");
}

TEST_F(OneTokenStation, ATokenThatNobodyTakesIsRepeatedThenItsSuccessorIsSought) {
  join();
  give_token();
  const std::int64_t first = bus_.octets_now() + 6;
  bus_.wait_slots(15);
  const auto at = [&](std::int64_t octets) { return "@" + std::to_string(first + octets) + " "; };
  const std::string who = "who_follows, 000A -> 0004: 0004\n";
  EXPECT_TRUE(bus_.take().starts_with(at(0) + "token, 000A -> 0004\n" + at(43) + "token, 000A -> 0004\n" +
                                      at(86) + who + at(86 + 17 + 84) + who + at(86 + 2 * (17 + 84)) +
                                      "solicit_successor_2, 000A -> 000A\n"));
  EXPECT_EQ(user_.take(), "pass failed 000A\n");
  EXPECT_EQ(station_.state(), AccessState::idle);
}

TEST_F(OneTokenStation, WhoFollowsTheLostOneIsTheNewSuccessor) {
  join();
  give_token();
  bus_.wait(6 + 43 + 43 + 17 + 6);
  bus_.take();
  bus_.drive(with_address(set_successor, kOwn, 0x0002, 0x0002));
  bus_.wait(25);
  EXPECT_TRUE(bus_.take().ends_with("token, 000A -> 0002\n"));
  EXPECT_EQ(user_.take(), "successor changed 0002\n");
}

TEST_F(OneTokenStation, AnswersForItsPredecessor) {
  join();
  bus_.drive(with_address(who_follows, kNext, 0x0020, kNext));
  bus_.wait(30);
  EXPECT_EQ(bus_.take(), "");
  bus_.drive(with_address(who_follows, kOwn, 0x0020, kOwn));
  bus_.wait(30);
  EXPECT_EQ(bus_.take(), "");
  bus_.drive(with_address(who_follows, kPrevious, 0x0020, kPrevious));
  bus_.wait(30);
  EXPECT_NE(bus_.take().find("set_successor, 000A -> 0020: 000A"), std::string::npos);
}

TEST_F(OneTokenStation, NoiseAfterATokenMakesItWaitLonger) {
  join();
  give_token();
  bus_.wait(6 + kTokenOctets + 8);
  bus_.take();
  bus_.drive_noise(4);
  const std::int64_t end = bus_.octets_now();
  bus_.wait(4 * 28 + 20);
  EXPECT_EQ(bus_.take(), "@" + std::to_string(end + 4 * 28) + " token, 000A -> 0004\n");
}

TEST_F(OneTokenStation, SecondNoiseAfterATokenIsItsSuccess) {
  join();
  give_token();
  bus_.wait(6 + kTokenOctets + 8);
  bus_.drive_noise(4);
  bus_.wait(40);
  bus_.drive_noise(4);
  EXPECT_EQ(station_.state(), AccessState::idle);
}

TEST_F(OneTokenStation, OpensAWindowOfOneSlotBetweenItAndItsSuccessor) {
  join();
  rotate_until_window();
  const std::int64_t begin = bus_.octets_now() - 4;
  bus_.take();
  bus_.wait_slots(3);
  EXPECT_EQ(bus_.take(), "@" + std::to_string(begin) + " solicit_successor_1, 000A -> 0004\n@" +
                             std::to_string(begin + kTokenOctets + 28) + " token, 000A -> 0004\n");
}

TEST_F(OneTokenStation, TakesWhoAnswersItsWindow) {
  join();
  rotate_until_window();
  bus_.wait(kTokenOctets);
  bus_.drive(with_address(set_successor, kOwn, 0x0006, 0x0006));
  bus_.wait(25);
  EXPECT_TRUE(bus_.take().ends_with("token, 000A -> 0006\n"));
  EXPECT_EQ(station_.successor(), 0x0006U);
}

TEST_F(OneTokenStation, ResolvesContentionAsOftenAsThereArePairs) {
  join();
  rotate_until_window();
  bus_.wait(kTokenOctets);
  bus_.take();
  for (unsigned pass = 0; pass < 9; ++pass) {
    bus_.drive_noise(17);
    bus_.wait(6 + kTokenOctets + 6);
    EXPECT_NE(bus_.take().find("resolve_contention, 000A -> 000A"), std::string::npos) << pass;
  }
  bus_.drive_noise(17);
  bus_.wait(25);
  EXPECT_TRUE(bus_.take().ends_with("token, 000A -> 0004\n"));
}

TEST_F(OneTokenStation, ServesItsClassesWhileTimeIsLeft) {
  join();
  for (const unsigned priority : {0U, 2U, 4U, 6U}) {
    submit(
        {.priority = priority, .destination = kNext, .data = Octets(1, static_cast<std::uint8_t>(priority))});
  }
  give_token();
  bus_.wait(200);
  const std::string text = bus_.take();
  // All but class 6 have had their timers begun in the visit before.
  std::size_t at = 0;
  for (const char* priority : {"priority 6", "priority 4", "priority 2", "priority 0", "token"}) {
    const std::size_t found = text.find(priority, at);
    ASSERT_NE(found, std::string::npos) << priority << "\n" << text;
    at = found;
  }
}

class ShortHold : public OneTokenStation {
 protected:
  ShortHold()
      : OneTokenStation([] {
          StationConfiguration configuration;
          configuration.rules.high_priority_hold_octets = 100;
          configuration.rules.target_rotation_octets = {400, 300, 200};
          return configuration;
        }()) {}
};

TEST_F(ShortHold, EndsWithTheFrameThatBeganInTime) {
  join();
  for (unsigned n = 0; n < 10; ++n) submit({.destination = kNext, .data = Octets(10)});
  give_token();
  bus_.wait(400);
  const std::string text = bus_.take();
  std::size_t frames = 0;
  for (std::size_t at = text.find("data"); at != std::string::npos; at = text.find("data", at + 1)) ++frames;
  // 25 octets each, 6 of silence before: begun at 6, 37, 68 and 99 of 100.
  EXPECT_EQ(frames, 4U) << text;
}

TEST_F(ShortHold, ASlowRingServesClassSixOnly) {
  join();
  for (unsigned n = 0; n < 5; ++n) {
    bus_.wait(100);
    bus_.drive(control(token, kPrevious, kNext));
  }
  bus_.wait(10);
  for (const unsigned priority : {0U, 2U, 4U, 6U}) submit({.priority = priority, .destination = kNext});
  give_token();
  bus_.wait(100);
  const std::string text = bus_.take();
  EXPECT_NE(text.find("priority 6"), std::string::npos);
  EXPECT_EQ(text.find("priority 4"), std::string::npos) << text;
  EXPECT_EQ(text.find("priority 0"), std::string::npos) << text;
}

TEST_F(OneTokenStation, RepeatsARequestThatNobodyAnswers) {
  join();
  submit({.action = Action::request_with_response, .destination = kNext, .data = {7}});
  give_token();
  const std::int64_t first = bus_.octets_now() + 6;
  bus_.wait(400);
  const std::string text = bus_.take();
  for (const std::int64_t n : {0, 1, 2}) {
    EXPECT_NE(text.find("@" + std::to_string(first + n * (16 + 84)) + " data, request with response"),
              std::string::npos)
        << text;
  }
  EXPECT_EQ(text.find("@" + std::to_string(first + 3 * (16 + 84)) + " data"), std::string::npos);
  EXPECT_TRUE(user_.take().starts_with("response missing 0004\n"));
  EXPECT_NE(text.find("token, 000A -> 0004"), std::string::npos);
}

TEST_F(OneTokenStation, GivesAResponseToItsUserAndGoesOn) {
  join();
  submit({.action = Action::request_with_response, .destination = kNext, .data = {7}});
  give_token();
  bus_.wait(6 + 16 + 6);
  EXPECT_EQ(station_.state(), AccessState::await_ifm_response);
  bus_.drive({.kind = data,
              .action = Action::response,
              .priority = 6,
              .destination = kOwn,
              .source = kNext,
              .data = {9}});
  EXPECT_EQ(user_.take(), "data, response, priority 6, 0004 -> 000A: 09\n");
  bus_.wait(25);
  EXPECT_TRUE(bus_.take().ends_with("token, 000A -> 0004\n"));
}

TEST_F(OneTokenStation, AnswersARequestWhenItHasAResponse) {
  const Frame request{.kind = data,
                      .action = Action::request_with_response,
                      .priority = 5,
                      .destination = kOwn,
                      .source = kNext,
                      .data = {1}};
  bus_.drive(request);
  bus_.wait(40);
  EXPECT_EQ(bus_.take(), "");
  station_.set_response({0xAB}, bus_.now());
  bus_.drive(request);
  const std::int64_t end = bus_.octets_now();
  bus_.wait(40);
  EXPECT_EQ(bus_.take(), "@" + std::to_string(end + 6) + " data, response, priority 5, 000A -> 0004: AB\n");
}

TEST_F(OneTokenStation, LeavesByNamingItsSuccessor) {
  join();
  station_.set_in_ring_desired(false, bus_.now());
  give_token();
  bus_.wait(50);
  const std::string text = bus_.take();
  EXPECT_NE(text.find("set_successor, 000A -> 000E: 0004"), std::string::npos) << text;
  EXPECT_NE(text.find("token, 000A -> 0004"), std::string::npos) << text;
  bus_.drive(control(token, kPrevious, kNext));
  EXPECT_EQ(user_.take(), "left 000A\n");
  bus_.wait_slots(20);
  EXPECT_EQ(bus_.take(), "");
}

TEST_F(OneTokenStation, AClaimForgetsTheSolicitationThatWasAnswered) {
  bus_.drive(control(solicit_successor_1, kNext, kPrevious));
  bus_.wait(6 + 17 + 6);
  bus_.drive(control(token, kNext, kPrevious));
  bus_.wait_slots(100);
  EXPECT_TRUE(station_.is_in_ring());
  station_.set_in_ring_desired(false, bus_.now());
  bus_.wait_slots(10);
  EXPECT_FALSE(station_.is_in_ring());
  station_.set_in_ring_desired(true, bus_.now());
  bus_.drive(control(token, kOwn, kPrevious));
  EXPECT_TRUE(station_.is_in_ring());
  EXPECT_EQ(station_.successor(), kPrevious);
}

TEST_F(OneTokenStation, CountsFaultyReceptions) {
  const Rules rules;
  const Octets good = with_check(octets_of(control(token, kOwn, kPrevious), rules));
  const auto drive = [&](const Octets& octets, const Delimiting& delimiting = {}) {
    MacSymbols symbols;
    append_framed(symbols, octets, delimiting);
    bus_.drive_levels(half_bits_of(symbols));
    bus_.wait(10);
  };
  Octets wrong = good;
  wrong[1] ^= 2;
  drive(wrong);
  drive(good, {.has_error = true});
  drive({});
  drive(Octets(8'192, 0x5A));
  bus_.drive_noise(10);
  bus_.wait(10);
  EXPECT_EQ(station_.counters(), (Counters{1, 1, 1, 1, 1}));
  EXPECT_EQ(station_.state(), AccessState::idle);
  EXPECT_EQ(bus_.take(), "");
}

TEST_F(OneTokenStation, SeesNothingRightAfterATransmission) {
  bus_.drive(control(token, kNext, kPrevious));
  bus_.wait(1);
  bus_.drive_noise(2);
  EXPECT_EQ(station_.counters()[0], 0U);
  bus_.wait(1);
  // Longer than the blanking: its end is seen.
  bus_.drive_noise(5);
  EXPECT_EQ(station_.counters()[0], 1U);
}

// ---- every state, every frame ----

struct Behaviour {
  AccessState state;
  // After claim, sol_1, sol_2, who_follows, resolve, token to it, token to another, set_successor to it, data
  // to it, a response to it, noise, own address.
  std::string_view after;
};

std::vector<Frame> frames_of_table() {
  return {control(claim_token, 0, kPrevious),
          control(solicit_successor_1, kNext, kPrevious),
          control(solicit_successor_2, kPrevious, kNext),
          with_address(who_follows, kNext, 0x0020, kNext),
          control(resolve_contention, kPrevious, kPrevious),
          control(token, kOwn, kPrevious),
          control(token, kNext, kPrevious),
          with_address(set_successor, kOwn, 0x0006, 0x0006),
          {.kind = data, .priority = 6, .destination = kOwn, .source = kPrevious, .data = {1}},
          {.kind = data, .action = Action::response, .priority = 6, .destination = kOwn, .source = kNext}};
}

// One letter each: O offline, I idle, d demand_in, D demand_delay, C claim_token, U use_token, R
// await_ifm_response, K check_token_pass, A await_response.
char letter_of(AccessState state) {
  return std::string_view("OIdDCURXPKA")[static_cast<std::size_t>(state)];
}

class TokenStationTable : public OneTokenStation {
 protected:
  void bring_to(AccessState state) {
    switch (state) {
      case AccessState::offline:
        station_.stop(bus_.now());
        break;
      case AccessState::demand_in:
        bus_.drive(control(solicit_successor_1, kNext, kPrevious));
        bus_.wait(6 + 17 + 6);
        break;
      case AccessState::demand_delay:
        bus_.drive(control(solicit_successor_1, kNext, kPrevious));
        bus_.wait(6 + 17 + 6);
        bus_.drive(control(resolve_contention, kPrevious, kPrevious));
        bus_.wait(6);
        break;
      case AccessState::claim_token:
        bus_.wait(196 + kTokenOctets + 5);
        break;
      case AccessState::use_token:
        join();
        submit({.destination = kNext});
        give_token();
        break;
      case AccessState::await_ifm_response:
        join();
        submit({.action = Action::request_with_response, .destination = kNext});
        give_token();
        bus_.wait(6 + 15 + 6);
        break;
      case AccessState::check_token_pass:
        join();
        give_token();
        bus_.wait(6 + kTokenOctets + 6);
        break;
      case AccessState::await_response:
        join();
        rotate_until_window();
        bus_.wait(kTokenOctets);
        break;
      default:
        break;
    }
    bus_.refresh();
    EXPECT_EQ(station_.state(), state);
  }
};

constexpr std::array kBehaviours{
    Behaviour{AccessState::offline, "OOOOOOOOOOOO"},
    // A token finds empty queues and is passed on.
    Behaviour{AccessState::idle, "IdIIIKIIIIIO"},
    Behaviour{AccessState::demand_in, "IdIIDKIIIIdO"},
    // Anything before its time makes it yield, and is then taken as in idle.
    Behaviour{AccessState::demand_delay, "IdIIIKIIIIIO"},
    Behaviour{AccessState::claim_token, "IdIIIKIIIICO"},
    Behaviour{AccessState::use_token, "IdIIIUIIIIUO"},
    // After the response there is nothing more to send.
    Behaviour{AccessState::await_ifm_response, "IdIIIRIIIKRO"},
    Behaviour{AccessState::check_token_pass, "IdIIIKIIIIKO"},
    Behaviour{AccessState::await_response, "IdIIIKIKIIAO"},
};

TEST(TokenStationStates, EveryFrameInEveryState) {
  for (const Behaviour& row : kBehaviours) {
    std::string after;
    for (std::size_t event = 0; event < 12; ++event) {
      class Fresh : public TokenStationTable {
       public:
        void TestBody() override {}
        char after(AccessState state, std::size_t number) {
          bring_to(state);
          if (number < 10) {
            bus_.drive(frames_of_table()[number]);
          } else if (number == 10) {
            bus_.drive_noise(8);
          } else {
            bus_.drive(control(token, kNext, kOwn));
          }
          return letter_of(station_.state());
        }
      } fresh;
      after += fresh.after(row.state, event);
    }
    EXPECT_EQ(after, row.after) << text_of(row.state);
  }
}

TEST(TokenStationStart, RefusesImpossibleNumbers) {
  StationConfiguration configuration;
  configuration.address = 0x000B;  // of a group
  EXPECT_FALSE(TokenStation(configuration).start(kernel::kStart));
  configuration.address = 0x1'0000;
  EXPECT_FALSE(TokenStation(configuration).start(kernel::kStart));
  configuration.address = 0x000C;
  EXPECT_TRUE(TokenStation(configuration).start(kernel::kStart));
  configuration.rules.slot_time_octets = 5;
  EXPECT_FALSE(TokenStation(configuration).start(kernel::kStart));
}

TEST_F(OneTokenStation, RefusesWhatItCannotSend) {
  EXPECT_TRUE(station_.submit({.destination = kNext, .data = Octets(8'182)}, bus_.now()));
  EXPECT_FALSE(station_.submit({.destination = kNext, .data = Octets(8'183)}, bus_.now()));
  EXPECT_FALSE(station_.submit({.priority = 8, .destination = kNext}, bus_.now()));
  EXPECT_FALSE(station_.submit({.action = Action::response, .destination = kNext}, bus_.now()));
  EXPECT_FALSE(station_.submit({.action = Action::request_with_response, .destination = 0xFFFF}, bus_.now()));
  EXPECT_TRUE(station_.submit({.destination = 0xFFFF}, bus_.now()));
  station_.stop(bus_.now());
  EXPECT_FALSE(station_.submit({.destination = kNext}, bus_.now()));
}

}  // namespace
}  // namespace fieldproof::token_bus
