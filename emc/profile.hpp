#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emc/coupling.hpp"
#include "harness/config/document.hpp"

// A named set of coupling parameters: an installation and its receivers. Ten are built in; more come from
// files:
//
//   { "name": "line_7", "title": "line 7, pigtails", "based_on": "B",
//     "coupling": { "shield_db": 24, "common_mode_limit_v": null } }
//
// What is not said is taken from the profile it is based on, else from the defaults of `Coupling`. A limit of
// null is none.
namespace fieldproof::emc {

struct Profile {
  std::string name;
  std::string title;
  Coupling coupling;

  static std::span<const Profile> built_in();
  // A built-in profile, by its name in any case of letters; else a usage error that names the nearest.
  static const Profile& named(std::string_view name);
  // The same in a file, written exactly.
  static const Profile& named(const config::Value& name);

  static Profile read(const config::Value& root);
  static Profile load(const std::filesystem::path& path);
};

// The name of a built-in profile, else an object with every parameter that `Profile::read` takes; both are
// JSON.
std::string json_text(const Profile& profile);

// What a report must say about results of the profile: what is uncalibrated, and what that leaves standing.
std::vector<std::string> caveats_of(const Profile& profile);

}  // namespace fieldproof::emc
