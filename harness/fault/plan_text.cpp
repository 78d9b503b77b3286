// The canonical text of a plan and its hash.

#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "harness/fault/cases.hpp"
#include "harness/fault/plan_file.hpp"

namespace fieldproof::fault {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

Json json_of(const Numbers& numbers) {
  if (numbers == Numbers::only(numbers.first)) return numbers.first;
  Json json = Json::object();
  if (numbers.first != 0) json["from"] = numbers.first;
  if (numbers.last != kUnlimited) json["to"] = numbers.last;
  if (numbers.every != 1) json["every"] = numbers.every;
  return json;
}

Json json_of(const After& after) {
  Json json{{"observation", after.observation}};
  if (after.channel != "*") json["channel"] = after.channel;
  if (after.nth != 1) json["nth"] = after.nth;
  if (after.lasting != kernel::Duration::max()) json["for"] = kernel::describe(after.lasting);
  return json;
}

Json json_of(const When& when);

Json json_of(const std::vector<When>& whens) {
  Json json = Json::array();
  for (const When& when : whens) json.push_back(json_of(when));
  return json;
}

Json json_of(const When& when) {
  Json json = Json::object();
  if (when.receiver != "*") json["receiver"] = when.receiver;
  if (when.frame_kind != "*") json["frame"] = when.frame_kind;
  if (when.frame != Numbers{}) json["frame_number"] = json_of(when.frame);
  if (when.unit != Numbers{}) json["unit"] = json_of(when.unit);
  if (when.field != "*") json["field"] = when.field;
  if (when.bit != Numbers{}) json["bit"] = json_of(when.bit);
  if (when.from != When{}.from) json["from"] = kernel::describe(when.from - kernel::kStart);
  if (when.to != When{}.to) json["to"] = kernel::describe(when.to - kernel::kStart);
  if (when.chance < 1.0) json["chance"] = when.chance;
  if (when.after) json["after"] = json_of(*when.after);
  if (!when.all_of.empty()) json["all_of"] = json_of(when.all_of);
  if (!when.any_of.empty()) json["any_of"] = json_of(when.any_of);
  if (!when.none_of.empty()) json["none_of"] = json_of(when.none_of);
  return json;
}

Json details_of(const Effect& effect) {
  Json json = Json::object();
  std::visit(Cases{
                 [&](const Flip& flip) {
                   if (!flip.levels.empty()) json["levels"] = flip.levels;
                 },
                 [&](const Force& force) {
                   json["level"] = force.level ? 1 : 0;
                   if (force.duration != kernel::Duration{}) {
                     json["duration"] = kernel::describe(force.duration);
                   } else if (force.count != 0) {
                     json["count"] = force.count;
                   }
                 },
                 [&](const Delay& delay) { json["duration"] = kernel::describe(delay.duration); },
                 [](const Drop&) {},
                 [&](const Repeat& repeat) {
                   if (repeat.count != 1) json["count"] = repeat.count;
                   if (repeat.gap != kernel::Duration{}) json["gap"] = kernel::describe(repeat.gap);
                 },
                 [&](const Insert& insert) {
                   json["levels"] = insert.levels.text();
                   if (insert.is_behind) json["behind"] = true;
                 },
                 [&](const Mute& mute) { json["duration"] = kernel::describe(mute.duration); },
             },
             effect);
  return json;
}

std::string_view scope_word(Scope scope) {
  switch (scope) {
    case Scope::level:
      return "level";
    case Scope::field:
      return "field";
    case Scope::unit:
      return "unit";
    case Scope::frame:
      return "frame";
    case Scope::transmission:
      return "transmission";
  }
  return "";
}

Json json_of(const Rule& rule) {
  Json json = Json::object();
  if (!rule.name.empty()) json["name"] = rule.name;
  if (rule.when != When{}) json["when"] = json_of(rule.when);
  if (rule.scope != Scope::field) json["scope"] = scope_word(rule.scope);
  json["effect"][std::string(fault::word_of(rule.effect))] = details_of(rule.effect);
  if (rule.times != kUnlimited) json["times"] = rule.times;
  return json;
}

Json json_of(const Disturbance& disturbance) {
  Json json = Json::object();
  if (!disturbance.name.empty()) json["name"] = disturbance.name;
  if (disturbance.receiver != "*") json["receiver"] = disturbance.receiver;
  if (disturbance.from != kernel::kStart) json["from"] = kernel::describe(disturbance.from - kernel::kStart);
  if (disturbance.to != kernel::kNever) json["to"] = kernel::describe(disturbance.to - kernel::kStart);
  json[disturbance.model.kind] = Json::parse(disturbance.model.parameters);
  return json;
}

}  // namespace

std::string canonical_text(const Plan& plan) {
  Json rules = Json::array();
  for (const Rule& rule : plan.rules()) rules.push_back(json_of(rule));
  Json json{{"rules", std::move(rules)}};
  for (const Disturbance& one : plan.disturbances()) json["disturbances"].push_back(json_of(one));
  return json.dump(2) + "\n";
}

std::uint64_t hash_of(const Plan& plan) {
  // FNV-1a, 64 bit.
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char octet : canonical_text(plan)) {
    hash = (hash ^ static_cast<unsigned char>(octet)) * 0x100000001B3;
  }
  return hash;
}

}  // namespace fieldproof::fault
