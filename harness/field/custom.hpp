// A member that is no number and no list of numbers: what stands for it in each view is written by hand.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/field/facts.hpp"
#include "harness/field/settings.hpp"

namespace fieldproof::config {
class Value;
}

namespace fieldproof::field {

// One line of a table for people.
struct SettingWords {
  std::string_view name;
  std::string_view range;
  std::string_view meaning;
};

// `member` is the member itself. What is null does not exist for this member.
struct Custom {
  void (*put)(const void* member, Settings& settings) = nullptr;
  void (*take)(const GivenSettings& given, void* member) = nullptr;
  std::span<const SettingWords> words{};
  std::vector<Fact> (*facts)(std::string_view name, const void* member) = nullptr;
  void (*read)(const config::Value& value, void* member) = nullptr;
  std::string_view schema{};  // JSON
};

}  // namespace fieldproof::field
