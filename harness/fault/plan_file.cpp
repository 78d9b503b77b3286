#include "harness/fault/plan_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace fieldproof::fault {
namespace {

using config::ObjectReader;
using config::Value;

constexpr std::size_t kMostRules = 10'000;
constexpr std::size_t kMostLevels = 100'000;

std::string pattern(const Value& value) {
  const std::string_view text = value.as_string();
  if (text.empty()) config::fail(value, "the name is empty; write a name, or \"*\" for any");
  return std::string(text);
}

// `smallest` is where the counting begins: also of "every" without "from".
Numbers read_numbers(const Value& value, std::uint64_t smallest) {
  if (!value.is_object()) return Numbers::only(value.as_integer<std::uint64_t>(smallest));
  return config::read_object(value, [&](ObjectReader& object) {
    Numbers numbers;
    numbers.first = smallest;
    if (const auto from = object.optional("from")) numbers.first = from->as_integer<std::uint64_t>(smallest);
    if (const auto to = object.optional("to")) numbers.last = to->as_integer<std::uint64_t>(numbers.first);
    if (const auto every = object.optional("every")) numbers.every = every->as_integer<std::uint64_t>(1);
    return numbers;
  });
}

After read_after(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    After after;
    after.observation = pattern(object.required("observation"));
    if (const auto channel = object.optional("channel")) after.channel = pattern(*channel);
    if (const auto nth = object.optional("nth")) after.nth = nth->as_integer<std::uint64_t>(1);
    if (const auto lasting = object.optional("for")) {
      after.lasting = lasting->as_duration(kernel::kPicosecond, kLongestDuration);
    }
    return after;
  });
}

When read_when(const Value& value);

std::vector<When> read_whens(const Value& value) {
  std::vector<When> whens;
  for (const Value& element : value.as_array(1)) whens.push_back(read_when(element));
  return whens;
}

// The window of a rule or of a disturbance.
template <typename Windowed>
void read_window(ObjectReader& object, Windowed& windowed) {
  if (const auto from = object.optional("from"))
    windowed.from = kernel::kStart + from->as_duration({}, kLongestDuration);
  const auto to = object.optional("to");
  if (!to) return;
  windowed.to = kernel::kStart + to->as_duration({}, kLongestDuration);
  if (windowed.to <= windowed.from || windowed.to == kernel::kStart) {
    config::fail(*to, "the window ends before it begins; write an instant after \"from\"");
  }
}

When read_when(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    When when;
    if (const auto name = object.optional("receiver")) when.receiver = pattern(*name);
    if (const auto kind = object.optional("frame")) when.frame_kind = pattern(*kind);
    if (const auto number = object.optional("frame_number")) when.frame = read_numbers(*number, 1);
    if (const auto unit = object.optional("unit")) when.unit = read_numbers(*unit, 0);
    if (const auto field = object.optional("field")) when.field = pattern(*field);
    if (const auto bit = object.optional("bit")) when.bit = read_numbers(*bit, 0);
    read_window(object, when);
    if (const auto chance = object.optional("chance")) when.chance = chance->as_number(0.0, 1.0);
    if (const auto after = object.optional("after")) when.after = read_after(*after);
    if (const auto all = object.optional("all_of")) when.all_of = read_whens(*all);
    if (const auto any = object.optional("any_of")) when.any_of = read_whens(*any);
    if (const auto none = object.optional("none_of")) when.none_of = read_whens(*none);
    return when;
  });
}

Flip read_flip(ObjectReader& object) {
  Flip flip;
  if (const auto levels = object.optional("levels")) {
    for (const Value& level : levels->as_array(1, kMostLevels)) {
      flip.levels.push_back(level.as_integer<std::uint32_t>(0, kMostLevels));
    }
  }
  return flip;
}

Force read_force(ObjectReader& object) {
  Force force;
  force.level = object.required("level").as_integer<int>(0, 1) == 1;
  if (const auto count = object.optional("count")) force.count = count->as_integer<std::uint32_t>(1);
  if (const auto duration = object.optional("duration")) {
    if (force.count != 0) {
      config::fail(*duration, "\"count\" already says how far the level is forced; leave one of the two out");
    }
    force.duration = duration->as_duration(kernel::kPicosecond, kLongestDuration);
  }
  return force;
}

line::Levels read_levels(const Value& value) {
  const std::string_view text = value.as_string();
  if (text.empty() || text.size() > kMostLevels || text.find_first_not_of("01") != std::string_view::npos) {
    config::fail(value, "levels are written as 0 and 1, the first level first, for example \"0101\"");
  }
  return line::Levels::of_text(text);
}

line::Levels read_telegram(const Value& value, const PlanReading& reading) {
  if (reading.telegrams == nullptr) {
    config::fail(value, "this line has no telegrams; write \"levels\" instead");
  }
  return config::read_object(value, [&](ObjectReader& object) {
    std::uint8_t header = 0;
    std::uint8_t data = 0;
    const auto select = object.optional("select");
    const auto control = object.optional("control");
    if (select && select->as_bool()) header |= line::kSelect;
    if (control && control->as_bool()) header |= line::kControl;
    if (const auto octet = object.optional("data")) {
      header |= line::kDataTelegram;
      data = octet->as_hex_or_integer<std::uint8_t>();
    }
    line::Levels levels;
    reading.telegrams->append(levels, header, data);
    return levels;
  });
}

Insert read_insert(ObjectReader& object, const PlanReading& reading) {
  Insert insert;
  const auto levels = object.optional("levels");
  const auto telegram = object.optional("telegram");
  if (levels.has_value() == telegram.has_value()) {
    config::fail(object.value(), "what is inserted is not clear; write either \"levels\" or \"telegram\"");
  }
  insert.levels = levels ? read_levels(*levels) : read_telegram(*telegram, reading);
  if (const auto behind = object.optional("behind")) insert.is_behind = behind->as_bool();
  return insert;
}

Repeat read_repeat(ObjectReader& object) {
  Repeat repeat;
  if (const auto count = object.optional("count")) repeat.count = count->as_integer<std::uint32_t>(1, 1'000);
  if (const auto gap = object.optional("gap")) repeat.gap = gap->as_duration({}, kLongestDuration);
  return repeat;
}

kernel::Duration read_duration(ObjectReader& object) {
  return object.required("duration").as_duration(kernel::kPicosecond, kLongestDuration);
}

Effect read_effect(const Value& value, const PlanReading& reading) {
  return config::read_object(value, [&](ObjectReader& object) {
    std::vector<Effect> effects;
    const auto read = [&](std::string_view word, const auto& read_one) {
      const auto member = object.optional(word);
      if (member) effects.push_back(config::read_object(*member, read_one));
    };
    read("flip", [](ObjectReader& o) { return Effect(read_flip(o)); });
    read("force", [](ObjectReader& o) { return Effect(read_force(o)); });
    read("delay", [](ObjectReader& o) { return Effect(Delay{read_duration(o)}); });
    read("drop", [](ObjectReader&) { return Effect(Drop{}); });
    read("repeat", [](ObjectReader& o) { return Effect(read_repeat(o)); });
    read("insert", [&](ObjectReader& o) { return Effect(read_insert(o, reading)); });
    read("mute", [](ObjectReader& o) { return Effect(Mute{read_duration(o)}); });
    // A misspelled effect is told by the reader of the object, which knows the nearest one.
    if (effects.empty() && !object.has_unread()) {
      config::fail(value, "a rule has one effect; write for example { \"flip\": {} }");
    }
    if (effects.size() > 1) config::fail(value, "a rule has one effect; write a rule for each");
    return effects.empty() ? Effect{} : effects.front();
  });
}

constexpr std::array<std::string_view, 5> kScopes{"level", "field", "unit", "frame", "transmission"};

Rule read_rule(const Value& value, const PlanReading& reading) {
  return config::read_object(value, [&](ObjectReader& object) {
    Rule rule;
    if (const auto name = object.optional("name")) rule.name = std::string(name->as_string());
    if (const auto when = object.optional("when")) rule.when = read_when(*when);
    if (const auto scope = object.optional("scope")) {
      rule.scope = static_cast<Scope>(scope->as_choice(kScopes));
    }
    rule.effect = read_effect(object.required("effect"), reading);
    if (const auto times = object.optional("times")) rule.times = times->as_integer<std::uint64_t>(1);
    return rule;
  });
}

DisturbanceModel read_model(ObjectReader& object, std::span<const DisturbanceKind> kinds) {
  if (kinds.empty()) config::fail(object.value(), "this program has no disturbances; leave it out");
  std::vector<DisturbanceModel> models;
  std::vector<std::string_view> words;
  for (const DisturbanceKind& kind : kinds) {
    if (const auto member = object.optional(kind.word)) models.push_back(kind.read(*member));
    words.push_back(kind.word);
  }
  if (models.size() > 1) config::fail(object.value(), "a disturbance is one thing; write one for each");
  // A misspelled word is told by the reader of the object, which knows the nearest one.
  if (models.empty() && !object.has_unread()) {
    config::fail(object.value(),
                 fmt::format("it is not said what disturbs; write one of {}", fmt::join(words, ", ")));
  }
  return models.empty() ? DisturbanceModel{} : std::move(models.front());
}

Disturbance read_disturbance(const Value& value, const PlanReading& reading) {
  return config::read_object(value, [&](ObjectReader& object) {
    Disturbance disturbance;
    if (const auto name = object.optional("name")) disturbance.name = std::string(name->as_string());
    if (const auto receiver = object.optional("receiver")) disturbance.receiver = pattern(*receiver);
    read_window(object, disturbance);
    disturbance.model = read_model(object, reading.disturbances);
    return disturbance;
  });
}

}  // namespace

// A file that says neither what its rules are nor what disturbs is some other file.
Plan read_plan(const Value& value, const PlanReading& reading) {
  return config::read_object(value, [&](ObjectReader& object) {
    Plan plan;
    const auto disturbances = object.optional("disturbances");
    const auto rules = disturbances ? object.optional("rules") : object.required("rules");
    if (rules) {
      for (const Value& rule : rules->as_array(0, kMostRules)) plan.add(read_rule(rule, reading));
    }
    if (disturbances) {
      for (const Value& one : disturbances->as_array(0, kMostDisturbances)) {
        plan.add(read_disturbance(one, reading));
      }
    }
    return plan;
  });
}

Plan load_plan(const std::filesystem::path& path, const PlanReading& reading) {
  const config::Document document = config::Document::load(path);
  return read_plan(document.root(), reading);
}

}  // namespace fieldproof::fault
