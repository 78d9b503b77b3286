#include "conformance/valve_bus/node_model.hpp"

#include <gtest/gtest.h>

namespace fieldproof::conformance {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kStart;

ArrivedFrame frame_of(std::vector<std::uint8_t> octets, kernel::Duration end) {
  ArrivedFrame frame;
  frame.octets = std::move(octets);
  frame.end = kStart + end;
  return frame;
}

valve_bus::NodeConfiguration node_five(unsigned boards = 2) {
  valve_bus::NodeConfiguration configuration;
  configuration.tens = 0;
  configuration.units = 5;
  configuration.boards = boards;
  return configuration;
}

std::string reason_of(const std::optional<NodeModel::Objection>& objection) {
  return objection ? objection->reason : "";
}

TEST(NodeModel, WantsTheValvesOfAWriteInTime) {
  NodeModel model(node_five());
  EXPECT_FALSE(model.hear(frame_of({5, 0, 0xA5, 0x3C, 0x9C}, 1 * kMillisecond), 0));
  EXPECT_EQ(reason_of(model.pass(kStart + 2 * kMillisecond)), "");
  EXPECT_EQ(reason_of(model.move(0x3CA5, kStart + 3 * kMillisecond)), "");
  EXPECT_EQ(reason_of(model.pass(kStart + 9 * kMillisecond)), "");
  EXPECT_EQ(reason_of(model.move(0x3CA4, kStart + 10 * kMillisecond)), "moves_without_command");
}

TEST(NodeModel, MissesAWriteThatIsNotTaken) {
  NodeModel model(node_five());
  model.hear(frame_of({5, 0, 1, 0, 4}, 1 * kMillisecond), 0);
  EXPECT_EQ(reason_of(model.pass(kStart + 4 * kMillisecond)), "write_not_taken");
}

TEST(NodeModel, ObjectsToOtherValvesAndToEarlyOnes) {
  NodeModel model(node_five());
  model.hear(frame_of({5, 0, 1, 0, 4}, 1 * kMillisecond), 0);
  EXPECT_EQ(reason_of(model.move(2, kStart + 1500 * kMicrosecond)), "valves_wrong");
  EXPECT_EQ(reason_of(model.move(1, kStart + 900 * kMicrosecond)), "valves_wrong");
}

TEST(NodeModel, LetsAWriteGoThatTheNextOneOvertakes) {
  NodeModel model(node_five());
  model.hear(frame_of({5, 0, 1, 0, 4}, 1 * kMillisecond), 0);
  model.hear(frame_of({5, 0, 2, 0, 7}, 1300 * kMicrosecond), 0);
  EXPECT_EQ(reason_of(model.move(2, kStart + 2 * kMillisecond)), "");
  EXPECT_EQ(reason_of(model.move(1, kStart + 2100 * kMicrosecond)), "moves_without_command");
}

TEST(NodeModel, AnswersReadsOfItsOwnOnly) {
  NodeModel model(node_five());
  const auto answer = model.hear(frame_of({5, 1, 9, 9, 4}, kMillisecond), 0x0FF0);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->data0, 0xF0);
  EXPECT_EQ(answer->data1, 0x0F);
  EXPECT_FALSE(model.hear(frame_of({6, 1, 0, 0, 7}, kMillisecond), 0));
  EXPECT_FALSE(model.hear(frame_of({5, 2, 0, 0, 7}, kMillisecond), 0));
  EXPECT_FALSE(model.hear(frame_of({5, 1, 0, 0, 5}, kMillisecond), 0));
  EXPECT_FALSE(model.hear(frame_of({5, 1, 0, 0, 4, 0}, kMillisecond), 0));
  ArrivedFrame spoilt = frame_of({5, 1, 0, 0, 4}, kMillisecond);
  spoilt.is_spoilt = true;
  EXPECT_FALSE(model.hear(spoilt, 0));
}

TEST(NodeModel, KnowsOneBoardAndPowerLoss) {
  NodeModel model(node_five(1));
  EXPECT_EQ(model.hear(frame_of({5, 1, 0, 0, 4}, kMillisecond), 0xFFFF)->data1, 0);
  model.hear(frame_of({5, 0, 1, 8, 12}, kMillisecond), 0);
  EXPECT_EQ(reason_of(model.move(1, kStart + 2 * kMillisecond)), "");
  model.power_up(kStart + 5 * kMillisecond);
  EXPECT_EQ(reason_of(model.move(1, kStart + 6 * kMillisecond)), "moves_without_command");
}

}  // namespace
}  // namespace fieldproof::conformance
