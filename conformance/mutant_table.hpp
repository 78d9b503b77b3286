#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/test_case.hpp"

// The mutants of one role: their names, and how each is made. A row makes `Made` from `From`: a device from
// its configuration, or the parts of a network from the number of its stations.
namespace fieldproof::conformance {

// Throws kernel::Error(usage) with the nearest of the names that there are.
[[noreturn]] void refuse_mutant(std::string_view role, std::string_view name,
                                std::span<const std::string_view> names);

template <typename Made, typename From>
class MutantTable {
 public:
  using Make = std::function<Made(const From&)>;

  struct Row {
    std::string_view name;
    std::string_view label;  // of the specification's list; may be empty
    std::string_view description;
    Make make;
    bool is_for_check = false;
  };
  using Group = std::vector<Row> (*)();

  MutantTable(std::string_view role, std::initializer_list<Group> groups) : role_(role) {
    for (const Group group : groups) {
      for (Row& row : group()) rows_.push_back(std::move(row));
    }
  }

  // They show in sequences only.
  static std::vector<Row> for_check(std::vector<Row> rows) {
    for (Row& row : rows) row.is_for_check = true;
    return rows;
  }

  std::vector<Mutant> mutants() const {
    std::vector<Mutant> all;
    for (const Row& row : rows_) {
      all.push_back({std::string(row.name), std::string(row.label), std::string(role_),
                     std::string(row.description), row.is_for_check});
    }
    return all;
  }

  const std::vector<Row>& rows() const { return rows_; }
  // Throws kernel::Error(usage) for a name that is not there, with the nearest ones.
  const Make& maker(std::string_view name) const {
    std::vector<std::string_view> names;
    for (const Row& row : rows_) {
      if (row.name == name) return row.make;
      names.push_back(row.name);
    }
    refuse_mutant(role_, name, names);
  }
  Made make(std::string_view name, const From& from) const { return maker(name)(from); }

 private:
  std::string_view role_;
  std::vector<Row> rows_;
};

// ---- devices: the reference with one decision overridden, or with one number of its rules changed ----

template <typename Device, typename Configuration>
using DeviceMutants = MutantTable<std::unique_ptr<Device>, Configuration>;

// A station of a class of its own; `more` are further arguments of its constructor.
template <typename Station, typename... More>
auto mutant(More... more) {
  return [=](const auto& configuration) { return std::make_unique<Station>(configuration, more...); };
}
template <typename Station, typename Change>
auto with_rules(Change change) {
  return [change](auto configuration) {
    change(configuration.rules);
    return std::make_unique<Station>(configuration);
  };
}

}  // namespace fieldproof::conformance
