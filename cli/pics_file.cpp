#include "cli/pics_file.hpp"

namespace fieldproof::cli {

judge::Pics pics_from(const config::Value& items) {
  judge::Pics pics;
  for (const config::Member& item : items.as_members()) {
    const std::string name(item.key);
    switch (item.value.kind()) {
      case config::ValueKind::boolean:
        pics.declare(name, item.value.as_bool());
        break;
      case config::ValueKind::integer:
        pics.declare(name, item.value.as_integer<std::int64_t>());
        break;
      case config::ValueKind::string:
        pics.declare(name, std::string(item.value.as_string()));
        break;
      default:
        config::fail(item.value, "an item is answered by true, false, a whole number or a text");
    }
  }
  return pics;
}

judge::Pics load_pics(const std::filesystem::path& file) {
  const config::Document document = config::Document::load(file);
  return config::read_object(
      document.root(), [](config::ObjectReader& reader) { return pics_from(reader.required("items")); });
}

}  // namespace fieldproof::cli
