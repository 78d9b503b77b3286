#include "harness/field/walk.hpp"

namespace fieldproof::field {
namespace {

void walk_part(const Part& part, const std::string& prefix, const void* object, const void* reference,
               const Visit& visit) {
  for (const Row& row : part.table->rows) {
    if (row.kind == Kind::internal || !part.has(row.name)) continue;
    if (row.kind == Kind::part) {
      walk_part(row.part, prefix + std::string(row.part.prefix), row.member(object), row.member(reference),
                visit);
    } else {
      visit({prefix + std::string(row.name), row, object, reference});
    }
  }
}

}  // namespace

void walk(const AnyTable& table, const void* object, const Visit& visit) {
  walk_part({.table = &table}, {}, object, table.reference(), visit);
}

void walk(const AnyTable& table, const Visit& visit) {
  walk(table, table.reference(), visit);
}

std::string element_name(const Leaf& list, std::size_t n, std::string_view column) {
  std::string name = list.name + "_" + std::to_string(n + list.row.list.first_number);
  if (!column.empty()) name += "_" + std::string(column);
  return name;
}

bool is_plain(const AnyTable& element) {
  return element.rows.size() == 1 && element.rows.front().name.empty();
}

}  // namespace fieldproof::field
