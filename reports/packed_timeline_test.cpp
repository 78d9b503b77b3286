#include "reports/packed_timeline.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "harness/kernel/error.hpp"
#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson stored() {
  return OrderedJson::parse(sample_timeline("x"));
}

std::string time_of(const OrderedJson& packed, const OrderedJson& since) {
  const auto begin = std::stoll(packed.at("begin_ps").get<std::string>());
  return std::to_string(begin + std::stoll(since.get<std::string>()));
}

TEST(PackedTimeline, SaysTheSame) {
  const OrderedJson packed = packed_timeline(stored());
  const auto text = [&](const OrderedJson& place) { return packed["texts"].at(place.get<std::size_t>()); };
  EXPECT_EQ(packed["channels"], (OrderedJson{"master to slave", kHostileName}));
  ASSERT_EQ(packed["transmissions"].size(), stored()["transmissions"].size());
  for (std::size_t n = 0; n < packed["transmissions"].size(); ++n) {
    const OrderedJson& one = packed["transmissions"][n];
    const OrderedJson said = stored()["transmissions"][n];
    EXPECT_EQ(one[0], said["channel"]);
    EXPECT_EQ(time_of(packed, one[1]), said["start_ps"].get<std::string>());
    const auto end = std::stoll(one[1].get<std::string>()) + std::stoll(one[2].get<std::string>());
    EXPECT_EQ(time_of(packed, std::to_string(end)), said["end_ps"].get<std::string>());
    EXPECT_EQ(text(one[3]), said["text"]);
    EXPECT_EQ(one[4], said["levels"]);
    EXPECT_EQ(one[5] == 1, said["is_changed"].get<bool>());
  }
  for (std::size_t n = 0; n < stored()["observations"].size(); ++n) {
    const OrderedJson& one = packed["observations"][n];
    EXPECT_EQ(time_of(packed, one[1]), stored()["observations"][n]["time_ps"].get<std::string>());
    EXPECT_EQ(text(one[2]), "output word 0");
    EXPECT_EQ(text(one[3]), "0xa5ff");
    EXPECT_EQ(text(packed["faults"][n][2]), "flips level 6");
  }
  EXPECT_EQ(text(packed["findings"][0][3]), kHostileName);
  EXPECT_EQ(text(packed["steps"][0][1]), "1 of 2: the master sends frames");
  EXPECT_EQ(time_of(packed, packed["steps"][1][0]), stored()["steps"][1]["time_ps"].get<std::string>());
  EXPECT_EQ(time_of(packed, packed["windows"][0][2]), stored()["windows"][0]["to_ps"].get<std::string>());
  EXPECT_LT(packed.dump().size(), stored().dump().size() / 2);
}

TEST(PackedTimeline, KeepsTheWholeRangeOfTime) {
  using Limits = std::numeric_limits<std::int64_t>;
  OrderedJson timeline = stored();
  timeline["faults"][0]["time_ps"] = std::to_string(Limits::min());
  timeline["findings"][0]["time_ps"] = std::to_string(Limits::max());
  const OrderedJson packed = packed_timeline(timeline);
  EXPECT_EQ(packed["begin_ps"], std::to_string(Limits::min()));
  EXPECT_EQ(packed["faults"][0][1], "0");
  EXPECT_EQ(packed["findings"][0][0], std::to_string(std::numeric_limits<std::uint64_t>::max()));
}

TEST(PackedTimeline, RefusesATimeThatIsNone) {
  for (const char* wrong : {"", "1.5", "x", "9223372036854775808", "1 "}) {
    OrderedJson timeline = stored();
    timeline["faults"][1]["time_ps"] = wrong;
    EXPECT_THROW(packed_timeline(timeline), kernel::Error) << wrong;
  }
}

TEST(PackedTimeline, OfNothingIsNothing) {
  OrderedJson timeline = stored();
  for (const char* kind : {"transmissions", "faults", "observations", "findings", "windows", "steps"}) {
    timeline[kind] = OrderedJson::array();
  }
  const OrderedJson packed = packed_timeline(timeline);
  EXPECT_EQ(packed["begin_ps"], "0");
  EXPECT_TRUE(packed["texts"].empty());
}

}  // namespace
}  // namespace fieldproof::reports
