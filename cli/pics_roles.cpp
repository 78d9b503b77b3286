#include "cli/pics_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/protocol_entry.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

bool has_item(const Role& role, const std::string& item) {
  if (role.pics_items == nullptr) return false;
  const std::vector<judge::PicsItem> items = role.pics_items();
  return std::ranges::find(items, item, &judge::PicsItem::name) != items.end();
}

std::vector<const Role*> roles_with(const std::string& item) {
  std::vector<const Role*> all = roles();
  std::erase_if(all, [&](const Role* role) { return !has_item(*role, item); });
  return all;
}

bool is_meant(const std::string& judged, const Role& role) {
  if (judged == role.path()) return true;
  return find_role(judged) == nullptr && judged.starts_with(std::string(role.protocol) + "/");
}

}  // namespace

void expect_items_of(const std::vector<std::string>& judged, const judge::Pics& pics,
                     const std::string& pics_file) {
  for (const auto& [item, answer] : pics.items()) {
    const std::vector<const Role*> owners = roles_with(item);
    // An item that no row has is one of a suite of the program's own.
    const bool is_asked_for =
        owners.empty() || std::ranges::any_of(owners, [&](const Role* owner) {
          return std::ranges::any_of(judged, [&](const std::string& path) { return is_meant(path, *owner); });
        });
    if (is_asked_for) continue;
    std::vector<std::string> paths;
    for (const Role* owner : owners) paths.push_back(owner->path());
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("{}: \"{}\" is an item of {}; judged is {} ('fieldproof list pics {}' has its items)",
                    pics_file, item, fmt::join(paths, " and "), fmt::join(judged, " and "), judged.front()));
  }
}

}  // namespace fieldproof::cli
