#include "protocols/valve_bus/node.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/valve_bus/valve_block.hpp"

namespace fieldproof::valve_bus {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;
using Octets = std::vector<std::uint8_t>;

// A node alone on a line with a host that says what the test wants.
class NodeTest : public testing::Test, private segment::Station, private segment::Tap {
 protected:
  explicit NodeTest(NodeConfiguration configuration = {}) : configuration_(std::move(configuration)) {
    make();
  }

  void make() {
    node_ = std::make_unique<Node>(configuration_);
    host_seat_ = segment_.attach(*this, "host");
    node_seat_ = segment_.attach(*node_, "node");
    host_ = &line_.attach("host/in", host_seat_, 0, {});
    line_.tap_driven(*this);
    node_->wire(line_.attach("node/in", node_seat_, 0, {}), boards_);
    node_->set_power(true, now());
    segment_.refresh(node_seat_);
  }

  kernel::Time now() const { return segment_.now(); }
  void wait(kernel::Duration duration) { segment_.run_for(duration); }
  // Octets without a gap, and the time that they take.
  void send(const Octets& octets) {
    codec_.drive(*host_, octets, now(), {});
    sent_until_ = now() + half_characters(configuration_.rules, 2 * static_cast<unsigned>(octets.size()));
    segment_.run_until(sent_until_);
  }
  void send(const Command& command) {
    const auto octets = octets_of(command);
    send(Octets(octets.begin(), octets.end()));
  }

  NodeConfiguration configuration_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  CharacterCodec codec_{configuration_.rules};
  ValveBlock boards_;
  std::unique_ptr<Node> node_;
  segment::MediumPort* host_ = nullptr;
  std::size_t host_seat_ = 0;
  std::size_t node_seat_ = 0;
  kernel::Time sent_until_{};
  std::vector<line::Waveform> heard_;  // what the node drove
  Octets answer_;
  std::vector<kernel::Time> start_bits_;

 private:
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    heard_.push_back(wave);
    codec_.decode(wave, [&](const line::UartCharacter& character) {
      start_bits_.push_back(character.start);
      answer_.push_back(character.octet());
    });
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
  void on_wave(const line::Waveform&) override {}
};

TEST_F(NodeTest, DrivesItsValvesWhenTheSilenceIsSure) {
  send(Command{1, 0, 0xA5, 0x3C});
  wait(delimiter({}) + character_notice({}) - kernel::kNanosecond);  // positions are rounded, to picoseconds
  EXPECT_EQ(boards_.valves(), 0);
  wait(2 * kernel::kNanosecond);
  EXPECT_EQ(boards_.valves(), 0x3CA5);
  wait(10 * kMillisecond);
  EXPECT_TRUE(answer_.empty());
}

TEST_F(NodeTest, AnswersAReadWithItsLimitSwitches) {
  boards_.set_input(0, 0x0FF0);
  send(Command{1, 1, 0x12, 0x34});
  wait(3 * kMillisecond);
  EXPECT_EQ(answer_, (Octets{0xF0, 0x0F, 0xFF}));
  const kernel::Time due = sent_until_ + delimiter({}) + 100 * kMicrosecond;
  EXPECT_LE(std::chrono::abs(start_bits_.at(0) - due), kernel::kNanosecond);
  EXPECT_LE(std::chrono::abs(heard_.at(0).start - (due - bits({}, 1))), kernel::kNanosecond);
  EXPECT_EQ(boards_.valves(), 0);
}

TEST_F(NodeTest, LeavesTheAnswerWhenSomethingElseIsSaid) {
  send(Command{1, 1, 0, 0});
  wait(delimiter({}) + 40 * kMicrosecond);
  EXPECT_EQ(node_->state(), NodeState::answering);
  send(Command{2, 0, 0, 0});
  wait(3 * kMillisecond);
  EXPECT_TRUE(answer_.empty());
}

// The second command begins within the delimiter of the first, and is heard when that is over.
TEST_F(NodeTest, TakesNoFrameThatAnotherFollowsTooClosely) {
  send(Command{1, 0, 0xFF, 0xFF});
  wait(delimiter({}) - kMicrosecond);
  send(Command{1, 0, 0xFF, 0xFF});
  wait(5 * kMillisecond);
  EXPECT_EQ(boards_.valves(), 0);
}

TEST_F(NodeTest, DoesNotHearWhatComesWhileItDrives) {
  send(Command{1, 1, 0, 0});
  wait(delimiter({}) + 100 * kMicrosecond + character_time({}));
  send(Command{1, 0, 0xFF, 0xFF});
  wait(kMillisecond);
  EXPECT_EQ(boards_.valves(), 0);
  send(Command{1, 0, 0x11, 0x22});
  wait(kMillisecond);
  EXPECT_EQ(boards_.valves(), 0x2211);
}

TEST_F(NodeTest, IsSilentAndForgetfulWithoutPower) {
  send(Command{1, 0, 0xFF, 0xFF});
  wait(kMillisecond);
  node_->set_power(false, now());
  EXPECT_EQ(node_->next_time(), kernel::kNever);
  send(Command{1, 1, 0, 0});
  wait(5 * kMillisecond);
  EXPECT_TRUE(answer_.empty());
  EXPECT_EQ(node_->state(), NodeState::off);
}

class NodeWithoutHost : public NodeTest {
 protected:
  NodeWithoutHost() : NodeTest(limited()) {}
  static NodeConfiguration limited() {
    NodeConfiguration configuration;
    configuration.rules.loss_limit = 500 * kMillisecond;
    return configuration;
  }
};

TEST_F(NodeWithoutHost, SwitchesItsValvesOffWhenTheOptionSaysSo) {
  send(Command{1, 0, 0x01, 0x00});
  wait(kMillisecond);
  EXPECT_EQ(boards_.valves(), 1);
  wait(498 * kMillisecond);
  EXPECT_EQ(boards_.valves(), 1);
  wait(2 * kMillisecond);
  EXPECT_EQ(boards_.valves(), 0);
}

class NodeOfOneBoard : public NodeTest {
 protected:
  NodeOfOneBoard() : NodeTest({.rules = {}, .address_tens = 4, .address_units = 2, .boards = 1}) {}
};

TEST_F(NodeOfOneBoard, LeavesTheSecondOctetAlone) {
  EXPECT_EQ(node_->address(), 42U);
  boards_.set_input(0, 0xFFFF);
  send(Command{42, 0, 0x81, 0xFF});
  wait(kMillisecond);
  EXPECT_EQ(boards_.valves(), 0x0081);
  send(Command{42, 1, 0, 0});
  wait(3 * kMillisecond);
  EXPECT_EQ(answer_, (Octets{0xFF, 0x00, 0xFF}));
}

class NodeWithAcknowledge : public NodeTest {
 protected:
  NodeWithAcknowledge() : NodeTest(acknowledging()) {}
  static NodeConfiguration acknowledging() {
    NodeConfiguration configuration;
    configuration.rules.answers_writes = true;
    return configuration;
  }
};

TEST_F(NodeWithAcknowledge, TellsWhatItHasTaken) {
  send(Command{1, 0, 0x0F, 0xF0});
  wait(3 * kMillisecond);
  EXPECT_EQ(answer_, (Octets{0x0F, 0xF0, 0xFF}));
}

// Each state in which a character, silence, a loss of power can meet the node, and what becomes of it.
TEST_F(NodeTest, HasAStateForEachEvent) {
  std::string told;
  const auto tell = [&](std::string_view event) {
    constexpr std::array<std::string_view, 4> kNames{"off", "waiting", "collecting", "answering"};
    told +=
        std::string(event) + " -> " + std::string(kNames[static_cast<std::size_t>(node_->state())]) + "\n";
  };
  tell("power up");
  send(Octets{1});
  tell("character");
  wait(delimiter({}) + character_notice({}) + kernel::kNanosecond);
  tell("silence after part of a frame");
  send(Command{2, 1, 0, 0});
  wait(delimiter({}) + character_notice({}) + kernel::kNanosecond);
  tell("silence after a read of another node");
  send(Command{1, 0, 0, 0});
  wait(delimiter({}) + character_notice({}) + kernel::kNanosecond);
  tell("silence after a write of its own");
  send(Command{1, 1, 0, 0});
  wait(delimiter({}) + character_notice({}) + kernel::kNanosecond);
  tell("silence after a read of its own");
  wait(200 * kMicrosecond);
  tell("turnaround over");
  node_->set_power(false, now());
  tell("power off");
  EXPECT_EQ(told,
            "power up -> waiting\n"
            "character -> collecting\n"
            "silence after part of a frame -> waiting\n"
            "silence after a read of another node -> waiting\n"
            "silence after a write of its own -> waiting\n"
            "silence after a read of its own -> answering\n"
            "turnaround over -> waiting\n"
            "power off -> off\n");
}

}  // namespace
}  // namespace fieldproof::valve_bus
