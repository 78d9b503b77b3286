#include "protocols/bandwidth/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/field/json_schema.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::bandwidth {
namespace {

using testing::HasSubstr;

Network read(const std::string& text) {
  return Network::read(config::Document::parse(text, "n.json"));
}

std::string with_loops(const std::string& loops, const std::string& rest = "", int nodes = 6) {
  return R"({"name": "n", "nodes": )" + std::to_string(nodes) + R"(, "loops": [)" + loops + "]" + rest + "}";
}

const std::string kLoop = R"({"bound": "60 ms", "sensor": 2, "controller": 4})";

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const kernel::Error& error) {
    return error.what();
  }
  return "taken";
}

TEST(BandwidthNetwork, ReadsLoopsAndQueues) {
  const Network network = read(with_loops(kLoop, R"(, "access": "polling", "rule": "sharp",
      "server_overhead": "60 us", "empty_answer": "40 us", "length_rule": "printed",
      "real_time": [{"first": 5, "last": 5, "mean_gap": "1 s"}], "non_real_time": [{"first": 0, "last": 3}])"));
  EXPECT_EQ(network.access, Access::polling);
  EXPECT_EQ(network.length_rule, LengthRule::printed);
  const Demand demand = network.demand();
  EXPECT_EQ(demand.rule, Rule::sharp);
  EXPECT_EQ(demand.overhead, 100 * kernel::kMicrosecond) << "an empty answer is part of it";
  EXPECT_EQ(demand.real_time_queues, 1U);
  const Allocation allocation = allocate(demand);
  const WindowTraffic traffic = network.traffic(allocation);
  EXPECT_EQ(traffic.non_real_time.size(), 4U);
  EXPECT_EQ(traffic.loops[0].controller, 4);
  EXPECT_EQ(traffic.non_real_time_packet, allocation.longest_printed);
  EXPECT_EQ(traffic.empty_answer, 40 * kernel::kMicrosecond);
}

TEST(BandwidthNetwork, SaysWhereAFileIsWrong) {
  EXPECT_THAT(refusal("{}"), HasSubstr("name"));
  EXPECT_THAT(refusal(R"({"name": "n", "loops": []})"), HasSubstr("nodes"));
  EXPECT_THAT(refusal(with_loops("")), HasSubstr("/loops"));
  EXPECT_THAT(refusal(with_loops("{}")), HasSubstr("/loops/0: a loop has a \"bound\""));
  EXPECT_THAT(refusal(with_loops(R"({"bound": "60 ms", "sensr": 1})")), HasSubstr("sensr"));
  EXPECT_THAT(refusal(with_loops(kLoop, "", 129)), HasSubstr("/nodes"));
  EXPECT_THAT(refusal(with_loops(kLoop, "", 4)),
              HasSubstr("node 4 has periodic data, and the server visits"));
  EXPECT_THAT(refusal(with_loops(kLoop + "," + kLoop)), HasSubstr("node 2 has periodic data twice"));
  EXPECT_THAT(refusal(with_loops(R"({"bound": "2 us"})")), HasSubstr("/loops/0/bound"));
  EXPECT_THAT(refusal(with_loops(kLoop, R"(, "empty_answer": "1 us")")), HasSubstr("/empty_answer"));
  EXPECT_THAT(refusal(with_loops(kLoop, R"(, "non_real_time": [{"first": 3, "last": 1}])")),
              HasSubstr("/non_real_time"));
  EXPECT_THAT(refusal(with_loops(kLoop, R"(, "real_time": [{"last": 3}, {"first": 3, "last": 4}])")),
              HasSubstr("node 3 has a real-time queue twice"));
  EXPECT_THAT(refusal(with_loops(R"({"bound": "60 ms", "skew": "20 ms"})")), HasSubstr("less than a slot"));
  EXPECT_THAT(refusal(with_loops(R"({"bound": "60 ms", "skew": "19.999 ms"})")), HasSubstr("taken"));
  EXPECT_THAT(refusal(with_loops(kLoop + R"(, {"bound": "1 s"}, {"bound": "1 s"}, {"bound": "1 s"})")),
              HasSubstr("4 loops have 8 nodes with data"));
}

TEST(BandwidthNetworkSchema, HasTheRowsOfTheTable) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/bandwidth/bandwidth_network.schema.json");
  auto shipped = nlohmann::ordered_json::parse(file)["properties"];
  shipped.erase("$schema");
  shipped.erase("name");
  const auto wanted = field::properties_of(kNetworkTable);
  EXPECT_EQ(shipped, wanted) << wanted.dump(2);
}

}  // namespace
}  // namespace fieldproof::bandwidth
