#include "cli/pics_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/config/nearest.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::string_view kItems = "items";

const judge::PicsItem& item_of(const config::Member& written, std::span<const judge::PicsItem> known) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const judge::PicsItem& item) { return item.name == written.key; });
  if (found != known.end()) return *found;
  std::vector<std::string_view> names;
  for (const judge::PicsItem& item : known) names.push_back(item.name);
  if (const auto meant = config::misspelled(written.key, names)) {
    config::fail(written.value, fmt::format("there is no such item; did you mean \"{}\"?", *meant));
  }
  config::fail(written.value,
               fmt::format("there is no such item; the items are {} ('fieldproof list pics' explains them)",
                           fmt::join(names, ", ")));
}

judge::Pics::Answer answer_from(const config::Value& value, const judge::PicsItem& item) {
  switch (item.kind) {
    case judge::PicsKind::truth:
      return value.as_bool();
    case judge::PicsKind::number:
      return value.as_integer<std::int64_t>(item.least, item.most);
    case judge::PicsKind::duration:
      return value.as_duration(kernel::Duration{item.least}, kernel::Duration{item.most});
    case judge::PicsKind::text:
      break;
  }
  const std::vector<std::string_view> words(item.words.begin(), item.words.end());
  return item.words.at(value.as_choice(words));
}

}  // namespace

judge::Pics pics_from(const config::Value& items, std::span<const judge::PicsItem> known) {
  judge::Pics pics;
  for (const config::Member& written : items.as_members()) {
    const judge::PicsItem& item = item_of(written, known);
    pics.declare(item.name, answer_from(written.value, item));
  }
  return pics;
}

judge::Pics load_pics(const std::filesystem::path& file, std::span<const judge::PicsItem> known) {
  const config::Document document = config::Document::load(file);
  return config::read_object(document.root(), [&](config::ObjectReader& reader) {
    return pics_from(reader.required(kItems), known);
  });
}

std::string pics_text(const judge::Pics& pics) {
  const auto json_of = [](const auto& value) -> nlohmann::ordered_json {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, kernel::Duration>) {
      return fmt::format("{} ps", value.count());
    } else {
      return value;
    }
  };
  nlohmann::ordered_json items = nlohmann::ordered_json::object();
  for (const auto& [name, answer] : pics.items()) {
    items[name] = std::visit(json_of, answer);
  }
  return nlohmann::ordered_json{{kItems, std::move(items)}}.dump(2) + "\n";
}

}  // namespace fieldproof::cli
