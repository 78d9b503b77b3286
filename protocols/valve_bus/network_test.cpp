#include "protocols/valve_bus/network.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/kernel/error.hpp"

namespace fieldproof::valve_bus {
namespace {

NetworkDescription read(const std::string& text) {
  const config::Document document = config::Document::parse(text, "bus.json");
  return NetworkDescription::read(document.root());
}

std::string refusal_of(const std::string& text) {
  try {
    read(text);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "";
}

TEST(ValveBusNetwork, ReadsNodesAlongTheCable) {
  const NetworkDescription network = read(R"({"name": "a", "bit_rate_switches": 1, "cable": "400 m",
      "characters": "P1", "writes": false,
      "nodes": [{"address": 7, "at": "20 m"}, {"address": 99, "at": "390 m"}],
      "copy": [{"from": 7, "to": 99}]})");
  ASSERT_EQ(network.nodes.size(), 2U);
  EXPECT_EQ(network.nodes[1].address, 99U);
  EXPECT_EQ(network.rules.bit_rate, dip_bit_rates()[1]);
  EXPECT_EQ(network.rules.characters, CharacterProfile::even_parity);
  EXPECT_FALSE(network.writes);
  EXPECT_EQ(distance_to(network, 1), kernel::Duration{390 * 5'000});
}

TEST(ValveBusNetwork, SpreadsANumberOfNodesEvenly) {
  const NetworkDescription network = read(R"({"name": "a", "nodes": 99})");
  EXPECT_EQ(network.nodes.size(), 99U);
  EXPECT_EQ(network.nodes.back().at_m, 1000);
  EXPECT_EQ(repeaters_before(network.rules, 30), 0U);
  EXPECT_EQ(repeaters_before(network.rules, 31), 1U);
  EXPECT_EQ(repeaters_before(network.rules, 98), 3U);
}

TEST(ValveBusNetwork, RefusesWhatNoBusIs) {
  for (const char* number : {"0", "-1", "100", "256"}) {
    const std::string refusal = refusal_of(R"({"name": "a", "nodes": )" + std::string(number) + "}");
    EXPECT_NE(refusal.find("write 1 to 99, because two decimal switches"), std::string::npos) << refusal;
  }
  EXPECT_NE(refusal_of(R"({"name": "a", "nodes": [{"address": 0}]})").find("1 to 99"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"name": "a", "nodes": [{"address": 3}, {"address": 3}]})").find("there already"),
            std::string::npos);
  EXPECT_NE(
      refusal_of(R"({"name": "a", "cable": "10 m", "nodes": [{"address": 3, "at": "11 m"}]})").find("10 m"),
      std::string::npos);
  EXPECT_NE(refusal_of(R"({"name": "a", "cable": "1001 m", "nodes": 31})").find("RS-485"), std::string::npos);
  EXPECT_EQ(refusal_of(R"({"name": "a", "cable": "2 km", "nodes": 32})"), "") << "a repeater more";
  EXPECT_NE(refusal_of(R"({"name": "a", "nodes": 2, "copy": [{"from": 1, "to": 3}]})").find("address 3"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"name": "a", "nodes": 2, "speed": 1})").find("speed"), std::string::npos);
  EXPECT_THROW(NetworkDescription::even(0, 0, 1000), kernel::Error);
  EXPECT_THROW(NetworkDescription::even(8, 1, 1000), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::valve_bus
