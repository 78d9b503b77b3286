#include "reports/schema_check.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "reports/embedded_schemas.hpp"
#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

constexpr std::string_view kStationSchema = R"({
  "type": "object",
  "required": ["name"],
  "properties": {
    "name": {"type": "string", "pattern": "[a-z]+"},
    "level": {"type": "integer", "minimum": 1, "maximum": 4},
    "volts": {"type": "number", "exclusiveMinimum": 0},
    "kind": {"enum": ["a", "b", null]},
    "version": {"const": "one/1"},
    "flag": {"type": ["boolean", "null"]},
    "value": {"anyOf": [{"type": "number"}, {"enum": ["nan"]}]},
    "parts": {"type": "array", "maxItems": 2, "items": {"$ref": "#/definitions/part"}}
  },
  "additionalProperties": false,
  "definitions": {"part": {"type": "object", "required": ["id"], "properties": {"id": {"type": "integer"}}}}
})";

std::string refusal(const std::string& text, std::string_view schema = kStationSchema) {
  const config::Document document = config::Document::parse(text, "sample.json");
  try {
    check_against_schema(document.root(), schema);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "";
}

TEST(SchemaCheck, TakesWhatTheSchemaAllows) {
  for (const char* text :
       {R"({"name": ""})", R"({"name": "x", "level": 1})", R"({"name": "x", "level": 4})",
        R"({"name": "x", "volts": 1})", R"({"name": "x", "kind": null})",
        R"({"name": "x", "version": "one/1"})", R"({"name": "x", "flag": null})",
        R"({"name": "x", "flag": true})", R"({"name": "x", "value": "nan"})",
        R"({"name": "x", "value": 2.5})", R"({"name": "x", "parts": [{"id": 1, "more": 2}, {"id": 2}]})"}) {
    EXPECT_EQ(refusal(text), "") << text;
  }
}

TEST(SchemaCheck, RefusesTheRestWithItsPlace) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"([])", "type object"},
      {R"({})", "\"name\" is missing"},
      {R"({"name": 1})", "/name"},
      {R"({"name": "x", "level": 0})", "minimum 1"},
      {R"({"name": "x", "level": 5})", "maximum 4"},
      {R"({"name": "x", "level": 1.5})", "type integer"},
      {R"({"name": "x", "volts": 0})", "exclusiveMinimum 0"},
      {R"({"name": "x", "kind": "c"})", "one of"},
      {R"({"name": "x", "kind": 0})", "one of"},
      {R"({"name": "x", "version": "one/2"})", "one of"},
      {R"({"name": "x", "flag": 1})", "boolean or null"},
      {R"({"name": "x", "value": "inf"})", "/value"},
      {R"({"name": "x", "parts": [{"id": 1}, {}]})", "/parts/1"},
      {R"({"name": "x", "parts": [{"id": 1}, {"id": 2}, {"id": 3}]})", "/parts"},
      {R"({"name": "x", "other": 1})", "\"other\""},
  };
  for (const auto& [text, told] : wrong) {
    const std::string sentence = refusal(text);
    EXPECT_NE(sentence.find(told), std::string::npos) << text << "\n" << sentence;
    EXPECT_EQ(sentence.find("sample.json:1"), 0U) << sentence;
  }
}

TEST(SchemaCheck, ASchemaBeyondItIsABrokenPromise) {
  EXPECT_THROW(refusal("{}", R"({"minProperties": 1})"), kernel::BrokenInvariant);
  EXPECT_THROW(refusal("{}", R"({"$ref": "other.schema.json"})"), kernel::BrokenInvariant);
  EXPECT_THROW(refusal("{}", R"({"type": "tuple"})"), kernel::BrokenInvariant);
}

TEST(SchemaCheck, TheShippedSchemasTakeTheSamplesAndNoPartOfThem) {
  const std::pair<std::string, std::string_view> documents[] = {
      {sample_emc().dump(), emc_schema},
      {sample_residual().dump(), residual_schema},
      {measurement_json(sample_measurement()), measurement_schema},
      {publication_json(sample_publication()), publication_schema},
      {sample_timeline("x"), timeline_schema},
  };
  for (const auto& [text, schema] : documents) {
    EXPECT_EQ(refusal(text, schema), "");
    const auto whole = nlohmann::json::parse(text);
    const auto rules = nlohmann::json::parse(schema);
    for (const auto& key : rules.at("required")) {
      auto part = whole;
      part.erase(key.get<std::string>());
      EXPECT_NE(refusal(part.dump(), schema).find(key.get<std::string>()), std::string::npos) << key;
    }
  }
}

}  // namespace
}  // namespace fieldproof::reports
