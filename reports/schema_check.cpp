#include "reports/schema_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using config::Value;
using config::ValueKind;
using Json = nlohmann::ordered_json;

struct TypeName {
  ValueKind kind;
  std::string_view name;
};

constexpr std::array kTypes = {
    TypeName{ValueKind::null, "null"},       TypeName{ValueKind::boolean, "boolean"},
    TypeName{ValueKind::integer, "integer"}, TypeName{ValueKind::number, "number"},
    TypeName{ValueKind::string, "string"},   TypeName{ValueKind::array, "array"},
    TypeName{ValueKind::object, "object"},
};

bool has_type(const Value& value, const std::string& type) {
  if (type == "number" && value.kind() == ValueKind::integer) return true;
  const auto row = std::ranges::find(kTypes, type, &TypeName::name);
  FIELDPROOF_CHECK(row != kTypes.end(), "a shipped schema names a type of JSON");
  return value.kind() == row->kind;
}

// Values that schemas name one by one are strings, numbers, booleans and null.
bool is_equal(const Value& value, const Json& allowed) {
  if (allowed.is_string()) return value.is_string() && value.as_string() == allowed.get<std::string>();
  if (allowed.is_boolean())
    return value.kind() == ValueKind::boolean && value.as_bool() == allowed.get<bool>();
  if (allowed.is_number()) {
    return has_type(value, "number") && value.as_number() == allowed.get<double>();
  }
  return allowed.is_null() && value.is_null();
}

class Check {
 public:
  explicit Check(const Json& root) : root_(root) {}

  void hold(const Value& value, const Json& schema) const {
    for (const auto& [keyword, rule] : schema.items()) hold(value, schema, keyword, rule);
  }

 private:
  void hold(const Value& value, const Json& schema, const std::string& keyword, const Json& rule) const {
    if (keyword == "type") {
      hold_type(value, rule);
    } else if (keyword == "required") {
      hold_required(value, rule);
    } else if (keyword == "properties") {
      hold_properties(value, rule);
    } else if (keyword == "additionalProperties") {
      if (rule == false) refuse_unlisted(value, schema.at("properties"));
    } else if (keyword == "items") {
      if (!value.is_array()) return;
      for (const Value& element : value.as_array()) hold(element, rule);
    } else if (keyword == "maxItems") {
      if (value.is_array()) value.as_array(0, rule.get<std::size_t>());
    } else if (keyword == "enum" || keyword == "const") {
      hold_choice(value, rule);
    } else if (keyword == "$ref") {
      hold(value, target_of(rule.get<std::string>()));
    } else if (keyword == "anyOf") {
      hold_any(value, rule);
    } else {
      hold_bound(value, keyword, rule);
    }
  }

  static void hold_type(const Value& value, const Json& rule) {
    const Json types = rule.is_array() ? rule : Json::array({rule});
    std::string names;
    for (const Json& type : types) {
      if (has_type(value, type.get<std::string>())) return;
      names += (names.empty() ? "" : " or ") + type.get<std::string>();
    }
    config::fail(value, fmt::format("the value must be of the type {}", names));
  }

  static void hold_required(const Value& value, const Json& rule) {
    if (!value.is_object()) return;
    const auto members = value.as_members();
    for (const Json& key : rule) {
      const auto name = key.get<std::string>();
      if (std::ranges::find(members, name, &config::Member::key) == members.end()) {
        config::fail(value, fmt::format("the key \"{}\" is missing", name));
      }
    }
  }

  void hold_properties(const Value& value, const Json& rule) const {
    if (!value.is_object()) return;
    for (const config::Member& member : value.as_members()) {
      const auto known = rule.find(std::string(member.key));
      if (known != rule.end()) hold(member.value, *known);
    }
  }

  static void refuse_unlisted(const Value& value, const Json& properties) {
    if (!value.is_object()) return;
    for (const config::Member& member : value.as_members()) {
      if (properties.contains(std::string(member.key))) continue;
      config::fail(member.value,
                   fmt::format("no such document has a key \"{}\"", kernel::escaped_line(member.key)));
    }
  }

  static void hold_choice(const Value& value, const Json& rule) {
    const Json choices = rule.is_array() ? rule : Json::array({rule});
    if (std::ranges::any_of(choices, [&](const Json& allowed) { return is_equal(value, allowed); })) return;
    config::fail(value, fmt::format("the value must be one of {}", choices.dump()));
  }

  void hold_any(const Value& value, const Json& rule) const {
    for (const Json& one : rule) {
      try {
        return hold(value, one);
      } catch (const kernel::Error&) {
        if (&one == &rule.back()) throw;
      }
    }
  }

  static void hold_bound(const Value& value, const std::string& keyword, const Json& rule) {
    static constexpr std::array<std::string_view, 6> kSilent = {"$schema", "title",       "description",
                                                                "pattern", "definitions", "default"};
    if (std::ranges::find(kSilent, keyword) != kSilent.end()) return;
    const bool is_known = keyword == "minimum" || keyword == "maximum" || keyword == "exclusiveMinimum";
    FIELDPROOF_CHECK(is_known, "the shipped schemas use the keywords that this check knows");
    if (!has_type(value, "number")) return;
    const double number = value.as_number();
    const auto bound = rule.get<double>();
    const bool holds = keyword == "minimum"   ? number >= bound
                       : keyword == "maximum" ? number <= bound
                                              : number > bound;
    if (!holds) config::fail(value, fmt::format("the number must keep the {} {}", keyword, rule.dump()));
  }

  const Json& target_of(const std::string& reference) const {
    FIELDPROOF_CHECK(reference.starts_with("#/"), "a shipped schema refers into itself");
    return root_.at(Json::json_pointer(reference.substr(1)));
  }

  const Json& root_;
};

}  // namespace

void check_against_schema(const Value& value, std::string_view schema) {
  const Json root = Json::parse(schema);
  Check(root).hold(value, root);
}

}  // namespace fieldproof::reports
