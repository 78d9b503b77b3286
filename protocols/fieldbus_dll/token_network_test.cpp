#include "protocols/fieldbus_dll/token_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using testing::HasSubstr;

std::string network_text(const std::string& node, const std::string& rest = "") {
  return R"({"name": "n", "bit_rate": "1 Mbit/s", "nodes": [)" + node +
         R"(], "urgent_delay": {"at_most": "20 ms", "share": 0.99})" + rest + "}";
}

const std::string kGoodNode = R"({"count": 3, "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 8}})";

TokenNetwork read_network(const std::string& text) {
  return TokenNetwork::read(config::Document::parse(text, "n.json"));
}

std::string refusal(const std::string& text) {
  try {
    read_network(text);
  } catch (const kernel::Error& error) {
    return error.what();
  }
  return "taken";
}

TEST(TokenNetwork, ReadsNodesAndBound) {
  const TokenNetwork network = read_network(network_text(kGoodNode));
  ASSERT_EQ(network.traffic.nodes.size(), 3U);
  EXPECT_EQ(network.traffic.nodes[2].streams[traffic::kUrgent].length, 600 * kernel::kMicrosecond);
  EXPECT_DOUBLE_EQ(network.traffic.nodes[2].streams[traffic::kUrgent].per_ms, 0.008);
  EXPECT_EQ(network.bound.at_most, 20 * kernel::kMillisecond);
  EXPECT_EQ(network.bound.share, 0.99);
}

TEST(TokenNetwork, SaysWhereAFileIsWrong) {
  EXPECT_THAT(refusal("{}"), HasSubstr("name"));
  EXPECT_THAT(refusal(network_text(R"({"overhead": "1 ms"})")), HasSubstr("/nodes"));
  EXPECT_THAT(refusal(network_text(R"({"overhead": "0 ms"})")), HasSubstr("/nodes/0/overhead"));
  EXPECT_THAT(refusal(network_text(R"({"overhead": "1 ms", "urgent": {"octets": 0, "per_s": 8}})")),
              HasSubstr("/nodes/0/urgent/octets"));
  EXPECT_THAT(refusal(network_text(R"({"overhead": "1 ms", "urgent": {"octets": 9, "per_s": 1e-9}})")),
              HasSubstr("/nodes/0/urgent/per_s"));
  EXPECT_THAT(
      refusal(network_text(R"({"count": 40, "overhead": "1 ms"}, {"count": 40, "overhead": "1 ms"})")),
      HasSubstr("/nodes/1"));
  EXPECT_THAT(refusal(network_text(kGoodNode, R"(, "shedule": {})")), HasSubstr("shedule"));
  EXPECT_THAT(refusal(network_text(kGoodNode, R"(, "schedule": {"macrocycle": "10 ms",
              "items": [{"offset": "0 ms", "length": "9.5 ms"}]})")),
              HasSubstr("/schedule"));
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
