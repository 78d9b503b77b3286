#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "cli/embedded_schemas.hpp"
#include "cli/named_schemas.hpp"
#include "cli/sequence_file.hpp"

// The schema of a sequence: what is the same for all roles stands in sequence.schema.json, the rest is made
// of the vocabularies.
namespace fieldproof::cli {
namespace {

using conformance::SequenceRole;
using conformance::SequenceWord;
using nlohmann::ordered_json;

ordered_json whole_number(std::int64_t least, std::int64_t most) {
  return {{"type", "integer"}, {"minimum", least}, {"maximum", most}};
}

std::string as_sentence(std::string_view text) {
  std::string sentence = std::string(text) + ".";
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence;
}

ordered_json object_of(ordered_json properties, const ordered_json& required) {
  return {{"type", "object"},
          {"additionalProperties", false},
          {"required", required},
          {"properties", std::move(properties)}};
}

ordered_json schema_of(const SequenceWord& word) {
  ordered_json properties{{"do", {{"const", word.word}}}};
  for (const conformance::SequenceNumber& number : word.numbers)
    properties[std::string(number.name)] = whole_number(number.least, number.most);
  if (word.most_octets > 0) {
    properties["octets"] = {
        {"type", "array"}, {"minItems", 1}, {"maxItems", word.most_octets}, {"items", whole_number(0, 255)}};
  }
  ordered_json required = ordered_json::array();
  for (const auto& member : properties.items()) required.push_back(member.key());
  if (word.most_octets > 0 || word.units > 0) properties["faults"] = {{"$ref", "#/definitions/faults"}};
  ordered_json schema{{"description", as_sentence(word.meaning)}};
  schema.update(object_of(std::move(properties), required));
  return schema;
}

ordered_json schema_of(const SequenceRole& role) {
  ordered_json commands = ordered_json::array();
  for (const SequenceWord& word : role.vocabulary.words) commands.push_back(schema_of(word));
  ordered_json settings = ordered_json::object();
  for (const conformance::SequenceSetting& setting : role.vocabulary.settings) {
    ordered_json number{{"description", as_sentence(setting.row->about.meaning)}};
    number.update(whole_number(setting.least, setting.most));
    settings[setting.name] = std::move(number);
  }
  return {{"if", {{"properties", {{"role", {{"const", role_path(role)}}}}}}},
          {"then",
           {{"properties",
             {{"settings", object_of(std::move(settings), ordered_json::array())},
              {"commands", {{"items", {{"oneOf", std::move(commands)}}}}}}}}}};
}

}  // namespace

std::string sequence_schema_text(const conformance::Catalogue& catalogue) {
  ordered_json schema = ordered_json::parse(sequence_schema);
  ordered_json paths = ordered_json::array();
  for (const auto& suite : catalogue.suites()) {
    for (const SequenceRole& role : suite->sequence_roles()) {
      paths.push_back(role_path(role));
      schema["allOf"].push_back(schema_of(role));
    }
  }
  schema["properties"]["role"] = {{"enum", std::move(paths)}};
  return schema.dump(2) + "\n";
}

}  // namespace fieldproof::cli
