#include "protocols/valve_bus/running_network.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "harness/network/quiet_run.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::valve_bus {
namespace {

struct NeverAnswers final : Node {
  using Node::Node;
  void transmit(std::span<const std::uint8_t>, kernel::Time) override {}
};
class AnswersOnce final : public Node {
 public:
  using Node::Node;
  void transmit(std::span<const std::uint8_t> octets, kernel::Time at) override {
    if (!std::exchange(has_answered_, true)) Node::transmit(octets, at);
  }

 private:
  bool has_answered_ = false;
};
struct SwapsBoards final : Node {
  using Node::Node;
  std::uint16_t valves_of(const Command& command) const override {
    return static_cast<std::uint16_t>(command.data1 | command.data0 << 8);
  }
};

// Answers only what it heard begin.
struct ListensForActivity final : Node {
  using Node::Node;
  iut::Capabilities capabilities() const override { return {.senses_activity = true}; }
  void on_activity(segment::PortIndex, bool begins, kernel::Time) override { has_heard |= begins; }
  void transmit(std::span<const std::uint8_t> octets, kernel::Time at) override {
    if (std::exchange(has_heard, false)) Node::transmit(octets, at);
  }
  bool has_heard = false;
};

template <typename Of>
RunningStations at(std::size_t wanted) {
  return {.make_node = [wanted](std::size_t position,
                                const NodeConfiguration& configuration) -> std::unique_ptr<NodeDevice> {
    if (position != wanted) return nullptr;
    return std::make_unique<Of>(configuration);
  }};
}

TEST(ValveBusRunningNetwork, DoesNotComeUpWithANodeThatNeverAnswers) {
  RunningNetwork network(NetworkDescription::even(0, 4, 100), 1, at<NeverAnswers>(3));
  EXPECT_FALSE(network::run_quietly(network, 10, 1).came_up);
  EXPECT_NE(network.complaint().find("node@3 did not"), std::string::npos) << network.complaint();
}

TEST(ValveBusRunningNetwork, ANodeThatAsksForActivityHearsTheLineBegin) {
  RunningNetwork network(NetworkDescription::even(0, 4, 100), 1, at<ListensForActivity>(3));
  const network::QuietRun run = network::run_quietly(network, 10, 1);
  ASSERT_TRUE(run.came_up) << network.complaint();
  EXPECT_EQ(run.counts.missing, 0U);
}

TEST(ValveBusRunningNetwork, ANodeThatAnswersNoMoreIsMissedAfterItsRetries) {
  RunningNetwork network(NetworkDescription::even(0, 4, 100), 1, at<AnswersOnce>(3));
  const network::QuietRun run = network::run_quietly(network, 10, 1);
  ASSERT_TRUE(run.came_up);
  EXPECT_GE(run.counts.missing, 9U);
  EXPECT_EQ(run.counts.missing, run.counts.detected);
  EXPECT_EQ(run.counts.retried, 2 * run.counts.missing);
  EXPECT_EQ(run.counts.accepted_wrong(), 0U);
  EXPECT_GT(run.cycles.front(), network.cycles().front().theory);
}

TEST(ValveBusRunningNetwork, ANodeThatSwapsItsBoardsShowsWordsThatNobodySent) {
  RunningNetwork network(NetworkDescription::even(0, 4, 100), 1, at<SwapsBoards>(2));
  const network::QuietRun run = network::run_quietly(network, 10, 1);
  EXPECT_GE(run.counts.accepted_wrong_outputs, 9U);
  EXPECT_EQ(run.counts.accepted_wrong_inputs, 0U);
}

// Reports a response to each read at once, and sends nothing.
class Pretends final : public HostDevice {
 public:
  void wire(segment::Port&, HostApplication& application) override { application_ = &application; }
  void set_power(bool, kernel::Time) override {}
  void set_dip(unsigned) override {}
  void write(std::span<const std::uint8_t> octets, kernel::Time now) override {
    if (octets[1] != 0) due_.push_back({octets[0], 0, 0});
    at_ = now + kernel::kMillisecond;
  }
  std::size_t fifo_room() const override { return 512 - 4 * due_.size(); }
  bool has_overflowed() const override { return false; }
  HostCounters counters(std::uint8_t) const override { return {}; }
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override {
    at_ = kernel::kNever;
    for (const HostResponse& response : std::exchange(due_, {})) application_->on_response(response, now);
  }
  kernel::Time next_time() const override { return at_; }

 private:
  HostApplication* application_ = nullptr;
  std::vector<HostResponse> due_;
  kernel::Time at_ = kernel::kNever;
};

TEST(ValveBusRunningNetwork, AHostThatOnlyReportsResponsesExchangesNoData) {
  RunningNetwork network(NetworkDescription::even(0, 4, 100), 1, {.make_host = [](const HostConfiguration&) {
                           return std::make_unique<Pretends>();
                         }});
  EXPECT_FALSE(network::run_quietly(network, 10, 1).came_up);
  EXPECT_EQ(network.state(), network::State::stopped);
}

TEST(ValveBusRunningNetwork, ComesUpAgainAfterAStop) {
  RunningNetwork network(NetworkDescription::even(0, 3, 100), 1);
  network.start();
  network.segment().run_for(200 * kernel::kMillisecond);
  EXPECT_EQ(network.state(), network::State::exchanging);
  network.stop();
  network.segment().run_for(kernel::kSecond);
  EXPECT_EQ(network.state(), network::State::stopped);
  network.start();
  EXPECT_EQ(network.state(), network::State::coming_up);
  network.segment().run_for(200 * kernel::kMillisecond);
  EXPECT_EQ(network.state(), network::State::exchanging);
}

// What a node did before a start says nothing about it after.
TEST(ValveBusRunningNetwork, DoesNotComeUpAgainWithoutANodeThatHasDied) {
  RunningNetwork network(NetworkDescription::even(0, 3, 100), 1, at<AnswersOnce>(2));
  network.start();
  network.segment().run_for(kernel::kSecond);
  ASSERT_EQ(network.state(), network::State::exchanging);
  network.stop();
  network.start();
  network.segment().run_for(network.bring_up_limit() + kernel::kSecond);
  EXPECT_EQ(network.state(), network::State::stopped);
  EXPECT_NE(network.complaint().find("node@2 did not"), std::string::npos) << network.complaint();
}

TEST(ValveBusRunningNetwork, ExposesTheSegmentOfTheHost) {
  const RunningNetwork network(NetworkDescription::even(0, 99, 1000), 1);
  const auto places = network.places();
  ASSERT_EQ(places.size(), 100U);
  EXPECT_TRUE(places[31].is_exposed);
  EXPECT_FALSE(places[32].is_exposed);
  EXPECT_FALSE(places[32].why_not.empty());
}

}  // namespace
}  // namespace fieldproof::valve_bus
