#include "conformance/valve_bus/node_cases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/kernel/sanitized.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/rules.hpp"

namespace fieldproof::conformance {
namespace {

struct DeclaredNode {
  std::string name;
  judge::Pics pics;
};

judge::Pics declaring(std::initializer_list<std::pair<std::string, judge::Pics::Answer>> answers) {
  judge::Pics pics;
  for (const auto& [item, answer] : answers) pics.declare(item, answer);
  return pics;
}

std::vector<DeclaredNode> declared_nodes() {
  std::vector<DeclaredNode> all{
      {"address_99", declaring({{"address_tens", std::int64_t{9}}, {"address_units", std::int64_t{9}}})},
      {"address_1", declaring({{"address_tens", std::int64_t{0}}, {"address_units", std::int64_t{1}}})},
      {"one_board", declaring({{"boards", std::int64_t{1}}})},
      {"P1", declaring({{"characters", std::string("P1")}})},
      {"P2", declaring({{"characters", std::string("P2")}})},
      {"acknowledges", declaring({{"answers_writes", true}})},
      {"acknowledges_P2", declaring({{"answers_writes", true}, {"characters", std::string("P2")}})},
      {"lets_go", declaring({{"loss_limit", 500 * kernel::kMillisecond}})},
      {"lets_go_soon", declaring({{"loss_limit", 100 * kernel::kMillisecond}})},
  };
  constexpr std::int64_t kSlowest = 1'200;
  constexpr std::int64_t kFastest = 1'000'000;
  std::vector<std::int64_t> rates{kSlowest, kFastest};
  rates.insert(rates.end(), valve_bus::dip_bit_rates().begin(), valve_bus::dip_bit_rates().end());
  for (const std::int64_t rate : rates) {
    all.push_back({"at_" + std::to_string(rate), declaring({{"bit_rate", rate}})});
  }
  return all;
}

// A node that answers as early as it may, and one that answers as late.
class EarlyNode : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  kernel::Duration turnaround_time() const override { return valve_bus::delimiter(rules()); }
};
class LateNode : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  kernel::Duration turnaround_time() const override {
    return valve_bus::delimiter(rules()) + valve_bus::turnaround_time_span(rules());
  }
};

template <typename Node>
std::unique_ptr<valve_bus::NodeDevice> make(const valve_bus::NodeConfiguration& configuration) {
  return std::make_unique<Node>(configuration);
}

class DeclaredNodes : public testing::TestWithParam<DeclaredNode> {
 protected:
  template <typename Node>
  static void expect_passes(std::uint64_t seeds) {
    for (const NodeCase& one : node_cases()) {
      if (is_canary(one.test_case)) continue;
      const bool is_excluded =
          one.test_case.not_applicable && one.test_case.not_applicable(GetParam().pics).has_value();
      if (is_excluded || has_tag(one.test_case, kStressTag)) continue;
      NodeSetting setting;
      setting.volume = Volume::quick;
      setting.pics = GetParam().pics;
      setting.make_device = &make<Node>;
      for (setting.seed = 1; setting.seed <= (kernel::kIsSanitized ? 1 : seeds); ++setting.seed) {
        const judge::CaseResult result = run_on_bench(one, setting);
        EXPECT_TRUE(result.verdict == judge::Verdict::pass || result.verdict == judge::Verdict::warn)
            << result.id << " seed " << setting.seed << ": " << result.reason
            << (result.findings.empty() ? "" : ", " + result.findings.front().actual);
      }
    }
  }
};

// Whatever a node declares, the reference that is so passes: anything else is a false alarm.
TEST_P(DeclaredNodes, PassAsTheyDeclare) {
  expect_passes<valve_bus::Node>(3);
}
TEST_P(DeclaredNodes, PassWhenTheyAnswerAsEarlyAsTheyMay) {
  expect_passes<EarlyNode>(1);
}
TEST_P(DeclaredNodes, PassWhenTheyAnswerAsLateAsTheyMay) {
  expect_passes<LateNode>(1);
}

// Takes a frame with a wrong check for a sign of life of its host.
class KeptAliveByAnyFrame : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  bool fits(std::span<const std::uint8_t> octets) const override {
    is_wrong_ = !Node::fits(octets);
    return true;
  }
  void on_command(const valve_bus::Command& command, kernel::Time now) override {
    if (!is_wrong_) Node::on_command(command, now);
  }
  mutable bool is_wrong_ = false;
};

TEST(NodePower, AWrongFrameIsNoSignOfLife) {
  const auto cases = node_cases();
  const auto one = std::ranges::find_if(cases, [](const NodeCase& each) {
    return each.test_case.id == "valve_bus/node/power/valves_hold_without_a_host";
  });
  NodeSetting setting;
  setting.pics = declaring({{"loss_limit", 100 * kernel::kMillisecond}});
  setting.make_device = &make<KeptAliveByAnyFrame>;
  EXPECT_EQ(run_on_bench(*one, setting).reason, "valves_hold_without_host");
}

NodeCase case_of(std::string_view id) {
  return *std::ranges::find_if(node_cases(), [&](const NodeCase& each) { return each.test_case.id == id; });
}

// Hears nothing for a while after power-up.
class StartsSlowly : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  void on_power_up(kernel::Time now) override { hears_from_ = now + 10 * kernel::kMillisecond; }
  void on_character(const line::UartCharacter& character) override {
    if (character.start >= hears_from_) Node::on_character(character);
  }
  kernel::Time hears_from_{};
};

TEST(NodePower, ANodeHasTheTimeToStartThatItDeclares) {
  const NodeCase one = case_of("valve_bus/node/power/power_lost_in_a_frame");
  NodeSetting setting;
  setting.make_device = &make<StartsSlowly>;
  EXPECT_EQ(run_on_bench(one, setting).reason, "remembers_over_power_loss");
  setting.pics = declaring({{"start_up_time", 10 * kernel::kMillisecond}});
  EXPECT_EQ(run_on_bench(one, setting).verdict, judge::Verdict::pass);
}

// A node of which something cannot be seen or done; without its process side nobody sees its valves, and its
// switches stand as they stand.
template <bool iut::Capabilities::* kWhat>
class NodeWithout : public valve_bus::Node, private valve_bus::NodeBoards {
 public:
  using Node::Node;
  void wire(segment::Port& line, valve_bus::NodeBoards& boards) override {
    Node::wire(line, kWhat == &iut::Capabilities::process_side ? *this : boards);
  }
  iut::Capabilities capabilities() const override {
    iut::Capabilities all;
    all.*kWhat = false;
    return all;
  }

 private:
  std::uint16_t limit_switches(kernel::Time) override { return 0x1234; }
  void drive_valves(std::uint16_t, kernel::Time) override {}
};

template <bool iut::Capabilities::* kWhat>
void expect_no_accusation_without() {
  for (const NodeCase& one : node_cases()) {
    if (is_canary(one.test_case) || has_tag(one.test_case, kStressTag)) continue;
    NodeSetting setting;
    setting.volume = Volume::quick;
    setting.make_device = &make<NodeWithout<kWhat>>;
    const judge::CaseResult result = run_on_bench(one, setting);
    EXPECT_LE(result.verdict, judge::Verdict::warn) << result.id << ": " << result.reason;
  }
}

// What a case needs and cannot have makes it not applicable; it accuses nobody.
TEST(NodeCapabilities, WithheldOnesAccuseNobody) {
  expect_no_accusation_without<&iut::Capabilities::process_side>();
  expect_no_accusation_without<&iut::Capabilities::moving_inputs>();
  expect_no_accusation_without<&iut::Capabilities::driver_control>();
  expect_no_accusation_without<&iut::Capabilities::distance>();
}

// Drives its valves as two ports, one after the other.
class TwoPorts : public valve_bus::Node {
 public:
  using Node::Node;

 private:
  void actuate(std::uint16_t valves, kernel::Time now) override {
    constexpr kernel::Duration kBetween{83'000};
    Node::actuate(static_cast<std::uint16_t>((this->valves() & 0xFF00U) | (valves & 0xFFU)), now);
    Node::actuate(valves, now + kBetween);
  }
};

TEST(NodeValves, TwoPortsWithinTheSkewAreOneMove) {
  for (const NodeCase& one : node_cases()) {
    if (is_canary(one.test_case) || has_tag(one.test_case, kStressTag)) continue;
    NodeSetting setting;
    setting.volume = Volume::quick;
    setting.make_device = &make<TwoPorts>;
    const judge::CaseResult result = run_on_bench(one, setting);
    EXPECT_LE(result.verdict, judge::Verdict::warn) << result.id << ": " << result.reason;
  }
}

// Whenever it moves them.
class MovesLate : public valve_bus::Node {
 public:
  MovesLate(const valve_bus::NodeConfiguration& configuration, kernel::Duration later)
      : Node(configuration), later_(later) {}

 protected:
  void actuate(std::uint16_t valves, kernel::Time now) override { move_ = {valves, now + later_}; }

 private:
  kernel::Time next_time() const override {
    return move_ ? std::min(Node::next_time(), move_->second) : Node::next_time();
  }
  void on_time(kernel::Time now) override {
    if (move_ && move_->second <= now) Node::actuate(std::exchange(move_, std::nullopt)->first, now);
    Node::on_time(now);
  }
  kernel::Duration later_;
  std::optional<std::pair<std::uint16_t, kernel::Time>> move_;
};

TEST(NodeValves, AreTooLateHoweverLate) {
  for (const std::int64_t microseconds : {2'300, 2'690, 2'750, 9'000}) {
    NodeSetting setting;
    setting.make_device = [&](const valve_bus::NodeConfiguration& configuration) {
      return std::make_unique<MovesLate>(configuration, microseconds * kernel::kMicrosecond);
    };
    const judge::CaseResult result = run_on_bench(case_of("valve_bus/node/write/drives_the_valves"), setting);
    EXPECT_EQ(result.reason, "valves_too_late") << microseconds;
    ASSERT_FALSE(result.findings.empty());
    EXPECT_THAT(result.findings.front().actual, testing::HasSubstr("after the last stop bit, to"));
    EXPECT_THAT(result.findings.front().decode,
                testing::Contains(testing::ContainsRegex("valves [0-9A-F ]+ from [0-9.]+ ms on")));
  }
}

// Each move so much later than it is told to, in its turn; announced at once, or made when it is due.
class MovesLateInTurn : public valve_bus::Node {
 public:
  MovesLateInTurn(const valve_bus::NodeConfiguration& configuration, kernel::Duration later, bool announces)
      : Node(configuration), later_(later), announces_(announces) {}

 protected:
  void actuate(std::uint16_t valves, kernel::Time now) override {
    if (announces_) return Node::actuate(valves, now + later_);
    moves_.emplace_back(valves, now + later_);
  }

 private:
  kernel::Time next_time() const override {
    return moves_.empty() ? Node::next_time() : std::min(Node::next_time(), moves_.front().second);
  }
  void on_time(kernel::Time now) override {
    for (; !moves_.empty() && moves_.front().second <= now; moves_.pop_front())
      Node::actuate(moves_.front().first, now);
    Node::on_time(now);
  }
  void on_power_up(kernel::Time now) override {
    moves_.clear();
    Node::on_power_up(now);
  }
  kernel::Duration later_;
  bool announces_;
  std::deque<std::pair<std::uint16_t, kernel::Time>> moves_;
};

// A wrong instant is no wrong value, whatever a case is about.
TEST(NodeValves, AreTooLateInWhateverCaseSeesThem) {
  for (const bool announces : {false, true}) {
    for (const std::int64_t milliseconds : {3, 20, 200}) {
      unsigned late = 0;
      std::vector<std::string> others;
      for (const NodeCase& one : node_cases()) {
        if (is_canary(one.test_case) || has_tag(one.test_case, kStressTag)) continue;
        NodeSetting setting;
        setting.volume = Volume::quick;
        setting.make_device = [&](const valve_bus::NodeConfiguration& configuration) {
          return std::make_unique<MovesLateInTurn>(configuration, milliseconds * kernel::kMillisecond,
                                                   announces);
        };
        const judge::CaseResult result = run_on_bench(one, setting);
        if (result.verdict != judge::Verdict::fail) continue;
        if (result.reason == "valves_too_late")
          ++late;
        else
          others.push_back(result.id + " " + result.reason);
      }
      EXPECT_GT(late, 40U) << milliseconds;
      EXPECT_LE(others.size(), 3U) << milliseconds << announces << testing::PrintToString(others);
    }
  }
}

// What the block check does not see is said of the bus, and of nobody who is judged.
TEST(NodeImmunity, WhatTheCheckDoesNotSeeIsAWarn) {
  for (const auto& [name, counts] :
       {std::pair("check/double_errors_show_the_exclusive_or", "27 of 80 commands"),
        std::pair("immunity/pulses_in_step_with_eleven_bits_pass_the_check",
                  " hit writes in step were taken"),
        std::pair("immunity/pulses_in_step_with_ten_bits_pass_the_check",
                  " hit writes in step were taken")}) {
    NodeSetting setting;
    setting.volume = Volume::quick;
    const judge::CaseResult result = run_on_bench(case_of(std::string("valve_bus/node/") + name), setting);
    EXPECT_EQ(result.verdict, judge::Verdict::warn) << name;
    EXPECT_EQ(result.reason, "check_does_not_see_it") << name;
    ASSERT_EQ(result.findings.size(), 1U) << name;
    EXPECT_THAT(result.findings.front().actual, testing::HasSubstr(counts)) << name;
  }
}

// The upper eight 0.9 us after the lower ones.
class MovesByHalves : public MovesLate {
 public:
  explicit MovesByHalves(const valve_bus::NodeConfiguration& configuration)
      : MovesLate(configuration, 900 * kernel::kNanosecond) {}

 private:
  void actuate(std::uint16_t valves, kernel::Time now) override {
    Node::actuate(static_cast<std::uint16_t>((std::exchange(before_, valves) & 0xFF00) | (valves & 0x00FF)),
                  now);
    MovesLate::actuate(valves, now);
  }
  std::uint16_t before_ = 0;
};

// Each third transmission is lost.
class LosesThirds final : public fault::Channel {
  bool pass(const line::Waveform&, line::Waveforms&) override { return ++count_ % 3 == 0; }
  unsigned count_ = 0;
};

// All that change within 1 us move at once.
TEST(NodeValves, MayMoveOneAfterTheOtherUnderBursts) {
  NodeSetting setting;
  const std::vector<fault::Stress> stresses{
      {"losses", 20 * kernel::kMillisecond,
       [](const fault::StressPlace&) { return std::make_unique<LosesThirds>(); }}};
  setting.stresses = stresses;
  setting.make_device = [](const valve_bus::NodeConfiguration& configuration) {
    return std::make_unique<MovesByHalves>(configuration);
  };
  for (const char* one : {"immunity/bursts_move_nothing_by_themselves", "write/drives_the_valves"}) {
    const judge::CaseResult result = run_on_bench(case_of(std::string("valve_bus/node/") + one), setting);
    EXPECT_EQ(result.verdict, judge::Verdict::pass) << one << result.reason;
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheReference, DeclaredNodes, testing::ValuesIn(declared_nodes()),
                         [](const auto& node) { return node.param.name; });

}  // namespace
}  // namespace fieldproof::conformance
