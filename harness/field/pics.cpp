#include "harness/field/pics.hpp"

#include <algorithm>

#include "harness/field/walk.hpp"

namespace fieldproof::field {
namespace {

bool is_asked(const Row& row) {
  return row.kind != Kind::list && row.kind != Kind::custom;
}

judge::PicsItem item_of(const Leaf& leaf) {
  const About& about = leaf.row.about;
  judge::PicsItem item{.name = leaf.name, .meaning = std::string(about.meaning)};
  item.least = about.range.least;
  item.most = about.range.most;
  switch (leaf.row.kind) {
    case Kind::truth:
      item.kind = judge::PicsKind::truth;
      break;
    case Kind::choice:
      item.kind = judge::PicsKind::text;
      for (const Choice& choice : about.choices) item.words.emplace_back(choice.name);
      break;
    case Kind::duration:
      item.kind = judge::PicsKind::duration;
      break;
    default:
      item.kind = judge::PicsKind::number;
  }
  return item;
}

judge::Pics::Answer answer_of(const Row& row, std::int64_t number) {
  switch (row.kind) {
    case Kind::truth:
      return number != 0;
    case Kind::duration:
      return kernel::Duration{number};
    case Kind::choice: {
      const auto& choices = row.about.choices;
      return std::string(std::ranges::find(choices, number, &Choice::value)->name);
    }
    default:
      return number;
  }
}

void take(const Row& row, const judge::Pics::Answer& answer, void* object) {
  if (const auto* truth = std::get_if<bool>(&answer)) return row.set(object, *truth ? 1 : 0);
  if (const auto* number = std::get_if<std::int64_t>(&answer)) return row.set(object, *number);
  if (const auto* span = std::get_if<kernel::Duration>(&answer)) return row.set(object, span->count());
  const auto choice = std::ranges::find(row.about.choices, std::get<std::string>(answer), &Choice::name);
  if (choice != row.about.choices.end()) row.set(object, choice->value);
}

}  // namespace

std::vector<judge::PicsItem> pics_items_of(const AnyTable& table) {
  std::vector<judge::PicsItem> items;
  walk(table, [&](const Leaf& leaf) {
    if (is_asked(leaf.row)) items.push_back(item_of(leaf));
  });
  return items;
}

judge::Pics declared_by_any(const AnyTable& table, const void* object) {
  judge::Pics pics;
  walk(table, object, [&](const Leaf& leaf) {
    if (is_asked(leaf.row)) pics.declare(leaf.name, answer_of(leaf.row, leaf.number()));
  });
  return pics;
}

void declare_settings(const AnyTable& table, const Settings& settings, judge::Pics& pics) {
  const GivenSettings given(settings);
  walk(table, [&](const Leaf& leaf) {
    if (!is_asked(leaf.row)) return;
    if (const auto number = given.find(leaf.name)) pics.declare(leaf.name, answer_of(leaf.row, *number));
  });
}

void take_pics_of_any(const AnyTable& table, const judge::Pics& pics, void* object) {
  walk(table, object, [&](const Leaf& leaf) {
    const auto answer = pics.items().find(leaf.name);
    if (answer == pics.items().end() || !is_asked(leaf.row)) return;
    take(leaf.row, answer->second, const_cast<void*>(leaf.object));
  });
}

}  // namespace fieldproof::field
