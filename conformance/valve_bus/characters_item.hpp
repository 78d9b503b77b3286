#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "harness/judge/pics.hpp"

namespace fieldproof::conformance {

// Applies only where the implementation talks in this character format, or has not said in which.
inline std::function<std::optional<std::string>(const judge::Pics&)> for_characters(std::string profile) {
  return [profile = std::move(profile)](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.text("characters", profile) == profile) return std::nullopt;
    return "the implementation does not talk in characters " + profile;
  };
}

}  // namespace fieldproof::conformance
