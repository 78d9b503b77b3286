#include "harness/field/json_schema.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/field/custom.hpp"
#include "harness/field/walk.hpp"
#include "harness/field/words.hpp"

namespace fieldproof::field {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDurationPattern = "^[0-9]+(\\.[0-9]+)? ?(ps|ns|us|ms|s)$";
constexpr const char* kBitRatePattern = "^[0-9]+(\\.[0-9]+)? ?(|k|M|G)bit/s$";

std::string sentence(std::string_view meaning) {
  std::string text(meaning);
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') {
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  }
  return text + ".";
}

Json described(std::string_view meaning) {
  Json json = Json::object();
  if (!meaning.empty()) json["description"] = sentence(meaning);
  return json;
}

void add_range(Json& json, const Range& range) {
  json["type"] = "integer";
  json["minimum"] = range.least;
  json["maximum"] = range.most;
}

Json schema_of_number(const About& about) {
  Json json = described(about.meaning);
  switch (about.unit.notation) {
    case Notation::bit_rate:
      json["type"] = "string";
      json["pattern"] = kBitRatePattern;
      break;
    case Notation::hexadecimal: {
      Json whole;
      add_range(whole, about.range);
      const std::size_t digits = fmt::format("{:X}", about.range.most).size();
      json["oneOf"] = Json::array(
          {whole, {{"type", "string"}, {"pattern", fmt::format("^0[xX]0*[0-9A-Fa-f]{{1,{}}}$", digits)}}});
      break;
    }
    case Notation::decimal:
      add_range(json, about.range);
  }
  return json;
}

Json schema_of_one(const Row& row) {
  const About& about = row.about;
  if (row.kind == Kind::number) return schema_of_number(about);
  Json json = described(about.meaning);
  if (row.kind == Kind::truth) {
    json["type"] = "boolean";
  } else if (row.kind == Kind::duration) {
    json["type"] = "string";
    json["pattern"] = kDurationPattern;
  } else {
    json["enum"] = Json::array();
    for (const Choice& choice : about.choices) json["enum"].push_back(choice.name);
  }
  return json;
}

Json object_of(Json properties) {
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

Json schema_of_list(const Row& row) {
  const List& list = row.list;
  Json json = described(row.about.meaning);
  json["type"] = "array";
  if (list.is_of_fixed_size) json["minItems"] = list.most;
  json["maxItems"] = list.most;
  json["items"] = is_plain(*list.element) ? schema_of_one(list.element->rows.front())
                                          : object_of(properties_of(*list.element));
  return json;
}

Json schema_of_custom(const Row& row) {
  Json json = described(row.about.meaning);
  json.update(Json::parse(row.custom->schema));
  return json;
}

Json setting(const Row& row) {
  std::string meaning(row.about.meaning);
  if (row.kind == Kind::choice) meaning += (meaning.empty() ? "" : "; ") + setting_range_text(row);
  Json json = described(meaning);
  if (const std::string unit = setting_unit_text(row); !unit.empty()) json["$comment"] = unit;
  add_range(json, row.about.range);
  return json;
}

void add_list_settings(const Leaf& leaf, Json& properties, Json& patterns) {
  const List& list = leaf.row.list;
  if (!list.is_of_fixed_size) {
    Json size = described(fmt::format("how many of {}: {}", leaf.name, leaf.row.about.meaning));
    add_range(size, {0, static_cast<std::int64_t>(list.most)});
    properties[leaf.name] = std::move(size);
  }
  for (const Row& column : list.element->rows) {
    const std::string tail = column.name.empty() ? "" : fmt::format("_{}", column.name);
    patterns[fmt::format("^{}_[0-9]+{}$", leaf.name, tail)] = setting(column);
  }
}

Json item_schema(const judge::PicsItem& item) {
  Json json = described(item.meaning);
  switch (item.kind) {
    case judge::PicsKind::truth:
      json["type"] = "boolean";
      break;
    case judge::PicsKind::number:
      add_range(json, {item.least, item.most});
      break;
    case judge::PicsKind::text:
      json["enum"] = item.words;
      break;
    case judge::PicsKind::duration:
      json["type"] = "string";
      json["pattern"] = kDurationPattern;
      break;
  }
  return json;
}

}  // namespace

Json properties_of(const AnyTable& table) {
  Json properties = Json::object();
  walk(table, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::list) {
      properties[leaf.name] = schema_of_list(leaf.row);
    } else if (leaf.row.kind != Kind::custom) {
      properties[leaf.name] = schema_of_one(leaf.row);
    } else if (leaf.row.custom->read != nullptr) {
      properties[leaf.name] = schema_of_custom(leaf.row);
    }
  });
  return properties;
}

Json settings_schema_of(const AnyTable& table, std::string_view role) {
  Json properties = Json::object();
  Json patterns = Json::object();
  walk(table, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::list) {
      add_list_settings(leaf, properties, patterns);
    } else if (leaf.row.kind == Kind::custom) {
      for (const SettingWords& words : leaf.row.custom->words) {
        Json json = described(words.meaning);
        json["type"] = "integer";
        json["$comment"] = words.range;
        properties[std::string(words.name)] = std::move(json);
      }
    } else {
      properties[leaf.name] = setting(leaf.row);
    }
  });
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", fmt::format("Settings of {}", role)},
              {"description",
               "What an implementation of this role is given at the beginning of a case, by name and number. "
               "Durations are picoseconds, truths 0 or 1."}};
  schema.update(object_of(std::move(properties)));
  if (!patterns.empty()) schema["patternProperties"] = std::move(patterns);
  return schema;
}

Json properties_of(std::span<const judge::PicsItem> items) {
  Json properties = Json::object();
  for (const judge::PicsItem& item : items) properties[item.name] = item_schema(item);
  return properties;
}

}  // namespace fieldproof::field
