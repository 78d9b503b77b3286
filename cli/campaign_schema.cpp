#include <nlohmann/json.hpp>

#include "cli/campaign_plan.hpp"
#include "cli/named_schemas.hpp"

// The schema of the file of a campaign, made of the table of options.
namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

// What one job is given for an option.
ordered_json value_schema(const Option* option) {
  if (option == nullptr) return {{"type", "string"}, {"pattern", "^[^-]"}};
  if (option->kind == OptionKind::flag) return {{"type", "boolean"}};
  const bool is_choice = option->value_name.find('|') != std::string_view::npos &&
                         option->value_name.find("FILE") == std::string_view::npos;
  if (option->value_name == "N")
    return {{"type", {"integer", "string"}}, {"minimum", 0}, {"pattern", "^[0-9]+$"}};
  if (!is_choice) return {{"type", {"string", "number"}}, {"minLength", 1}};
  ordered_json words = ordered_json::array();
  for (std::size_t begin = 0; begin <= option->value_name.size();) {
    const std::size_t end = std::min(option->value_name.find('|', begin), option->value_name.size());
    words.push_back(option->value_name.substr(begin, end - begin));
    begin = end + 1;
  }
  return {{"enum", words}};
}

// One value, one after the other, or a range.
ordered_json axis_schema(const Option* option, std::string_view meaning) {
  const ordered_json one = value_schema(option);
  ordered_json items = one;
  if (option == nullptr || option->kind == OptionKind::list)
    items = {{"anyOf", {one, {{"type", "array"}, {"minItems", 1}, {"items", one}}}}};
  ordered_json forms = ordered_json::array({one, {{"type", "array"}, {"minItems", 1}, {"items", items}}});
  if (option != nullptr && option->value_name == "N") forms.push_back({{"$ref", "#/definitions/range"}});
  return {{"description", meaning}, {"anyOf", std::move(forms)}};
}

// Verbs share their options.
ordered_json row_schema(std::string_view verb, ordered_json& definitions) {
  ordered_json properties = {
      {"verb", {{"const", verb}}},
      {"of", axis_schema(nullptr,
                         "Selectors, a protocol or a role; an array inside the array is all for one job.")}};
  for (const Option& option : options()) {
    if (!is_of_a_row(option, verb)) continue;
    const std::string key = file_key(option);
    definitions[key] = axis_schema(&option, option.help);
    properties[key] = {{"$ref", "#/definitions/" + key}};
  }
  return {{"type", "object"},
          {"additionalProperties", false},
          {"required", {"verb"}},
          {"properties", std::move(properties)}};
}

ordered_json object_schema(std::string_view meaning, ordered_json properties, const ordered_json& required) {
  return {{"description", meaning},
          {"type", "object"},
          {"additionalProperties", false},
          {"required", required},
          {"properties", std::move(properties)}};
}

ordered_json budget_schema() {
  const ordered_json goal = object_schema(
      "Ends the campaign when the share of exchanges in which a wrong word was accepted is shown to be below "
      "the rate, or "
      "above it.",
      {{"rate", {{"type", "number"}, {"minimum", 1e-15}, {"maximum", 0.5}}},
       {"level",
        {{"description", "Default 0.95."}, {"type", "number"}, {"minimum", 0.5}, {"maximum", 0.999999}}},
       {"of",
        {{"description", "All exchanges, the default, or those whose data differed."},
         {"enum", {"sent", "data_differed"}}}}},
      {"rate"});
  return object_schema(
      "When it is enough.",
      {{"time", {{"description", "\"8 h\"; the rest is left for --resume."}, {"type", "string"}}},
       {"jobs", {{"type", "integer"}, {"minimum", 1}, {"maximum", 1'000'000}}},
       {"confidence", goal}},
      ordered_json::array());
}

}  // namespace

std::string campaign_schema_text() {
  ordered_json rows = ordered_json::array();
  ordered_json definitions = {
      {"range", object_schema("from, from + 1 ...: so many numbers.",
                              {{"from", {{"type", "integer"}, {"minimum", 0}}},
                               {"count", {{"type", "integer"}, {"minimum", 1}, {"maximum", 1'000'000}}}},
                              {"from", "count"})}};
  for (const std::string_view verb : campaign_verbs()) rows.push_back(row_schema(verb, definitions));
  const ordered_json schema = {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "Campaign"},
      {"description",
       "Many jobs, for fieldproof campaign. Comments are allowed. A row is the product of its values: what "
       "it is about changes the slowest, of the options the last one the fastest. What a verb refuses is "
       "refused before anything runs."},
      {"type", "object"},
      {"additionalProperties", false},
      {"required", {"jobs"}},
      {"properties",
       {{"$schema", {{"description", "For editors."}}},
        {"title", {{"type", "string"}}},
        {"job_limit", {{"description", "After which a job is killed; default \"1 h\"."}, {"type", "string"}}},
        {"budget", budget_schema()},
        {"jobs",
         {{"type", "array"}, {"minItems", 1}, {"maxItems", 1000}, {"items", {{"oneOf", std::move(rows)}}}}}}},
      {"definitions", std::move(definitions)}};
  return schema.dump(2) + "\n";
}

}  // namespace fieldproof::cli
