#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::config {
namespace {

struct Station {
  std::string name;
  int length = 0;
};

Station station(const Value& value) {
  return read_object(value, [](ObjectReader& o) {
    Station read;
    read.name = o.required("name").as_string();
    if (const auto length = o.optional("length")) read.length = length->as_integer<int>(0, 64);
    return read;
  });
}

std::string station_error(const std::string& text) {
  const Document document = Document::parse(text, "x.json");
  try {
    (void)station(document.root());
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

TEST(ObjectReader, ReadsRequiredAndOptionalKeysInAnyOrder) {
  const Document document = Document::parse(R"([{"length": 16, "name": "a"}, {"name": "b"}])", "x.json");
  const auto stations = document.root().as_array();
  EXPECT_EQ(station(stations[0]).name, "a");
  EXPECT_EQ(station(stations[0]).length, 16);
  EXPECT_EQ(station(stations[1]).length, 0);
}

TEST(ObjectReader, RefusesAnUnknownKeyWithTheNearestKnownOne) {
  EXPECT_EQ(station_error("{\"name\": \"a\",\n\"lenght\": 16}"),
            "x.json:2: /lenght: key \"lenght\" is not known here; did you mean \"length\"?");
  EXPECT_EQ(station_error("{\"name\": \"a\", \"colour\": 16}"),
            "x.json:1: /colour: key \"colour\" is not known here; known are name, length");
}

TEST(ObjectReader, NamesTheNearestWrittenKeyWhenOneIsMissing) {
  EXPECT_EQ(station_error("{}"), "x.json:1: the top level: key \"name\" is missing; add it");
  EXPECT_EQ(station_error("{\n\"length\": 1,\n\"Name\": \"a\"}"),
            "x.json:1: the top level: key \"name\" is missing; \"Name\" on line 3 is near to it");
}

TEST(ObjectReader, NamesTheFirstOfManyUnknownKeys) {
  std::string text = "{\"name\": \"a\"";
  for (int n = 0; n < (kernel::kIsSanitized ? 2'000 : 20'000); ++n)
    text += ",\n\"" + std::to_string(n) + std::string(300, 'n') + "\": 0";
  EXPECT_TRUE(station_error(text + "}").starts_with("x.json:2: /0nnn"));
  EXPECT_NE(station_error("{\"nome\": 1, " + text.substr(14) + "}").find("\"nome\" on line 1"),
            std::string::npos);
}

TEST(ObjectReader, RefusesWhatIsNoObject) {
  EXPECT_EQ(station_error("[]"), "x.json:1: the top level: this is an array; write an object");
}

TEST(ObjectReader, AllowsASchemaAtTheTopLevelOnly) {
  EXPECT_EQ(station_error(R"({"$schema": "station.schema.json", "name": "a"})"), "no error");
  const Document document = Document::parse(R"([{"$schema": "x", "name": "a"}])", "x.json");
  EXPECT_THROW((void)station(document.root().as_array()[0]), kernel::Error);
}

TEST(ObjectReader, RefusesKeysOfAnObjectWithoutKeys) {
  const Document document = Document::parse("{\"a\": 1}", "x.json");
  try {
    read_object(document.root(), [](ObjectReader&) {});
    FAIL() << "an unread key was accepted";
  } catch (const kernel::Error& error) {
    EXPECT_STREQ(error.what(), "x.json:1: /a: key \"a\" is not known here; remove it");
  }
}

TEST(ObjectReader, AnErrorOfTheReadingCodeIsNotHiddenByUnreadKeys) {
  const Document document = Document::parse("{\"a\": 1}", "x.json");
  EXPECT_THROW(read_object(document.root(), [](ObjectReader&) { throw std::out_of_range("mine"); }),
               std::out_of_range);
}

}  // namespace
}  // namespace fieldproof::config
