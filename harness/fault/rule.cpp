#include "harness/fault/rule.hpp"

#include <utility>

#include "harness/fault/cases.hpp"

namespace fieldproof::fault {

bool fits(std::string_view pattern, std::string_view name) {
  // Where to go on after a mismatch: the last star takes one character more.
  std::size_t star = std::string_view::npos;
  std::size_t taken = 0;
  std::size_t p = 0;
  std::size_t n = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::string_view word_of(const Effect& effect) {
  return std::visit(Cases{
                        [](const Flip&) { return std::string_view("flip"); },
                        [](const Force&) { return std::string_view("force"); },
                        [](const Delay&) { return std::string_view("delay"); },
                        [](const Drop&) { return std::string_view("drop"); },
                        [](const Repeat&) { return std::string_view("repeat"); },
                        [](const Insert&) { return std::string_view("insert"); },
                        [](const Mute&) { return std::string_view("mute"); },
                    },
                    effect);
}

Rule flip_level(std::string receiver, std::string field, std::uint32_t level) {
  Rule rule;
  rule.when.receiver = std::move(receiver);
  rule.when.field = std::move(field);
  rule.effect = Flip{{level}};
  return rule;
}

Rule drop_frame(std::string receiver, std::string frame_kind, std::uint64_t number) {
  Rule rule;
  rule.when.receiver = std::move(receiver);
  rule.when.frame_kind = std::move(frame_kind);
  rule.when.frame = Numbers::only(number);
  rule.scope = Scope::frame;
  rule.effect = Drop{};
  return rule;
}

Rule mute(std::string receiver, kernel::Time from, kernel::Duration duration) {
  Rule rule;
  rule.when.receiver = std::move(receiver);
  rule.when.from = from;
  rule.scope = Scope::transmission;
  rule.effect = Mute{duration};
  rule.times = 1;
  return rule;
}

}  // namespace fieldproof::fault
