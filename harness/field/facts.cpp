#include "harness/field/facts.hpp"

#include <algorithm>

#include "harness/field/custom.hpp"
#include "harness/field/walk.hpp"
#include "harness/field/words.hpp"

namespace fieldproof::field {
namespace {

constexpr std::string_view kSetForThisRun = "set for this run; not from a source";

Fact set_for_this_run(std::string name, std::string value) {
  return {std::move(name), std::move(value), kSetForThisRun, judge::Standing::own};
}

Fact fact_of_number(const Leaf& leaf) {
  const About& about = leaf.row.about;
  const std::int64_t number = leaf.number();
  std::string value = text_of(leaf.row, number);
  if (number == leaf.reference_number()) return {leaf.name, std::move(value), about.source, about.standing};
  const auto named = std::ranges::find(about.alternatives, number, &Alternative::value);
  if (named == about.alternatives.end()) return set_for_this_run(leaf.name, std::move(value));
  return {leaf.name, std::move(value), named->source, named->standing};
}

void add_facts_of_custom(const Leaf& leaf, std::vector<Fact>& facts) {
  const auto facts_of = leaf.row.custom->facts;
  if (facts_of == nullptr) return;
  const std::vector<Fact> reference = facts_of(leaf.name, leaf.row.member(leaf.reference));
  std::vector<Fact> all = facts_of(leaf.name, leaf.row.member(leaf.object));
  for (std::size_t n = 0; n < all.size(); ++n) {
    const bool is_as_made = n < reference.size() && all[n].value == reference[n].value;
    facts.push_back(is_as_made ? std::move(all[n])
                               : set_for_this_run(std::move(all[n].name), std::move(all[n].value)));
  }
}

Fact fact_of_list(const Leaf& leaf) {
  const About& about = leaf.row.about;
  std::string value = text_of_list(leaf.row, leaf.row.member(leaf.object));
  if (value == text_of_list(leaf.row, leaf.row.member(leaf.reference))) {
    return {leaf.name, std::move(value), about.source, about.standing};
  }
  return set_for_this_run(leaf.name, std::move(value));
}

}  // namespace

std::vector<Fact> facts_of_any(const AnyTable& table, const void* object) {
  std::vector<Fact> facts;
  walk(table, object, [&](const Leaf& leaf) {
    if (leaf.row.kind == Kind::custom) {
      add_facts_of_custom(leaf, facts);
    } else {
      facts.push_back(leaf.row.kind == Kind::list ? fact_of_list(leaf) : fact_of_number(leaf));
    }
  });
  return facts;
}

}  // namespace fieldproof::field
