#include "cli/pics_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/protocol_entry.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

// The paths of the roles that have the item.
std::vector<std::string> owners_of(const std::string& item, const conformance::Catalogue& catalogue) {
  std::vector<std::string> paths;
  for (const auto& suite : catalogue.suites())
    for (const conformance::RoleRow& row : suite->role_rows())
      if (std::ranges::count(row.pics_items, item, &judge::PicsItem::name) > 0)
        paths.push_back(fmt::format("{}/{}", suite->protocol(), row.name));
  return paths;
}

bool is_meant(const std::string& judged, const std::string& owner) {
  if (judged == owner) return true;
  return find_role(judged) == nullptr && judged.starts_with(owner.substr(0, owner.find('/') + 1));
}

}  // namespace

void expect_items_of(const std::vector<std::string>& judged, const judge::Pics& pics,
                     const std::string& pics_file, const conformance::Catalogue& catalogue) {
  for (const auto& [item, answer] : pics.items()) {
    const std::vector<std::string> owners = owners_of(item, catalogue);
    const bool is_asked_for = std::ranges::any_of(owners, [&](const std::string& owner) {
      return std::ranges::any_of(judged, [&](const std::string& path) { return is_meant(path, owner); });
    });
    if (is_asked_for) continue;
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("{}: \"{}\" is an item of {}; judged is {} ('fieldproof list pics {}' has its items)",
                    pics_file, item, fmt::join(owners, " and "), fmt::join(judged, " and "), judged.front()));
  }
}

}  // namespace fieldproof::cli
