// Subject: members in a file, as the reader takes them and as the schema describes them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "harness/config/document.hpp"
#include "harness/field/json_reader.hpp"
#include "harness/field/json_schema.hpp"
#include "harness/field/sample_table.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::field {
namespace {

Sample read(const std::string& text) {
  const config::Document document = config::Document::parse(text, "x.json");
  Sample sample;
  config::read_object(document.root(),
                      [&](config::ObjectReader& reader) { read_members(reader, kSampleTable, sample); });
  return sample;
}

std::string refusal_of(const std::string& text) {
  try {
    read(text);
  } catch (const kernel::Error& error) {
    return error.what();
  }
  return "none";
}

TEST(FieldJson, MembersAreReadAsTheirRowsSay) {
  const Sample sample = read(R"({"inside_code": "0xB0", "bit_rate": "2 Mbit/s", "limit": "1.5 ms",
      "is_loud": true, "colour": "green", "pair": [3, 4], "live": [16, "0x20"],
      "items": [{"at": 1, "lasts": "2 us"}, {}]})");
  EXPECT_EQ(sample.inside.code, 0xB0);
  EXPECT_EQ(sample.inside.half_bits, 3U);
  EXPECT_EQ(sample.bit_rate, 2'000'000);
  EXPECT_EQ(sample.limit, 1'500 * kernel::kMicrosecond);
  EXPECT_TRUE(sample.is_loud);
  EXPECT_EQ(sample.colour, SampleColour::green);
  EXPECT_EQ(sample.pair, (std::array<std::uint16_t, 2>{3, 4}));
  EXPECT_EQ(sample.live, (std::vector<std::uint8_t>{0x10, 0x20}));
  EXPECT_EQ(sample.items, (std::vector<SampleItem>{{1, 2 * kernel::kMicrosecond}, {}}));
}

TEST(FieldJson, RefusalsSayWhatWouldBeRight) {
  EXPECT_EQ(refusal_of(R"({"bitrate": "2 Mbit/s"})"),
            "x.json:1: /bitrate: key \"bitrate\" is not known here; did you mean \"bit_rate\"?");
  EXPECT_NE(refusal_of(R"({"bit_rate": "100 bit/s"})").find("/bit_rate"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"limit": "2 s"})").find("write at most 1.000 s"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"colour": "gren"})").find("green"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"pair": [1]})"), "none");
  EXPECT_NE(refusal_of(R"({"live": [15]})"), "none");
  EXPECT_NE(refusal_of(R"({"items": [{"at": 100}]})"), "none");
  EXPECT_NE(refusal_of(R"({"note": "x"})"), "none");
}

TEST(FieldJson, SchemaHasTheSameMembers) {
  const auto properties = properties_of(kSampleTable);
  EXPECT_EQ(properties.size(), 9U);
  EXPECT_EQ(properties["inside_half_bits"]["maximum"], 9);
  EXPECT_EQ(properties["inside_code"]["oneOf"][1]["pattern"], "^0[xX]0*[0-9A-Fa-f]{1,2}$");
  EXPECT_EQ(properties["colour"]["enum"], nlohmann::ordered_json({"red", "green"}));
  EXPECT_EQ(properties["items"]["items"]["properties"]["at"]["maximum"], 99);
  EXPECT_EQ(properties["bit_rate"]["description"], "On the line.");
}

TEST(FieldJson, SettingsSchemaNamesEachElementOfAList) {
  const auto schema = settings_schema_of(kSampleTable, "a sample");
  EXPECT_EQ(schema["properties"]["live"]["maximum"], 4);
  EXPECT_EQ(schema["patternProperties"]["^items_[0-9]+_at$"]["maximum"], 99);
  EXPECT_EQ(schema["properties"]["limit"]["$comment"], "ps");
  EXPECT_FALSE(schema["additionalProperties"]);
}

}  // namespace
}  // namespace fieldproof::field
