#pragma once

#include <optional>
#include <string>
#include <utility>

#include "conformance/test_case.hpp"
#include "harness/judge/pics.hpp"

// To which implementations a case applies, by what their PICS says.
namespace fieldproof::conformance {

using Applicability = decltype(TestCase::not_applicable);

// Where the implementation talks in this character format, or has not said in which.
inline Applicability for_characters(std::string profile) {
  return [profile = std::move(profile)](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.text("characters", profile) == profile) return std::nullopt;
    return "the implementation does not talk in characters " + profile;
  };
}

// Where the item is supported, or is not. What is not answered is as the bench's own station, `declared`.
inline Applicability for_item(std::string item, bool is_supported, judge::Pics declared,
                              std::string sentence) {
  return [item = std::move(item), is_supported, declared = std::move(declared),
          sentence = std::move(sentence)](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.completed_by(declared).supports(item) == is_supported) return std::nullopt;
    return sentence;
  };
}

// Where the item has this answer, or is not answered, so that the bench can give it.
inline Applicability for_answer(std::string item, judge::Pics::Answer answer) {
  return [item = std::move(item),
          answer = std::move(answer)](const judge::Pics& pics) -> std::optional<std::string> {
    const auto declared = pics.items().find(item);
    if (declared == pics.items().end() || declared->second == answer) return std::nullopt;
    return "the implementation does not declare \"" + item + "\" as " + judge::answer_text(answer);
  };
}

// Where both say so.
inline Applicability for_both(Applicability one, Applicability other) {
  return [one = std::move(one), other = std::move(other)](const judge::Pics& pics) {
    auto why_not = one(pics);
    return why_not ? why_not : other(pics);
  };
}

}  // namespace fieldproof::conformance
