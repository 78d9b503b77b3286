#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/test_case.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

// The mutant stations of one profile, by role: their names, and how each is made.
namespace fieldproof::conformance {

template <typename Device, typename Configuration>
struct MutantTable {
  using Make = std::function<std::unique_ptr<Device>(const Configuration&)>;

  struct Row {
    std::string_view name;
    std::string_view label;
    std::string_view description;
    Make make;
    bool is_for_check = false;
  };
  struct Role {
    std::string_view role;
    std::vector<Row> rows;
  };

  template <typename Mutant, typename... More>
  static Make station(More... more) {
    return
        [=](const Configuration& configuration) { return std::make_unique<Mutant>(configuration, more...); };
  }
  // Under rules with one number changed.
  template <typename Station, typename Change>
  static Make with_rules(Change change) {
    return [change](const Configuration& configuration) {
      Configuration changed = configuration;
      change(changed.rules);
      return std::make_unique<Station>(changed);
    };
  }

  std::vector<Mutant> mutants() const {
    std::vector<Mutant> all;
    for (const Role& role : roles) {
      for (const Row& row : role.rows) {
        all.push_back({std::string(row.name), std::string(row.label), std::string(role.role),
                       std::string(row.description), row.is_for_check});
      }
    }
    return all;
  }

  // Throws kernel::Error(usage) for a name that is none of this role, with the nearest ones.
  std::unique_ptr<Device> make(std::string_view role, std::string_view name,
                               const Configuration& configuration) const {
    std::vector<std::string_view> names;
    for (const Role& one : roles) {
      if (one.role != role) continue;
      for (const Row& row : one.rows) {
        if (row.name == name) return row.make(configuration);
        names.push_back(row.name);
      }
    }
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("there is no mutant {} \"{}\"; near are {}", role, name,
                                    fmt::join(config::nearest(name, names, 3), ", ")));
  }

  std::vector<Role> roles;
};

}  // namespace fieldproof::conformance
