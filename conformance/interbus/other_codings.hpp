#pragma once

#include <span>
#include <string_view>

#include "protocols/interbus/rules.hpp"

// Codings other than usual: each alone, so that a finding names the setting that was ignored, and all at
// once.
namespace fieldproof::conformance {

using ChangeOfRules = void (*)(interbus::Rules&);

struct OtherCoding {
  std::string_view id;       // of its case: another_select_level
  std::string_view setting;  // as the page names it, with the value: "select_level 0"
  ChangeOfRules change;
  std::string_view mutant;  // of a slave that does not look at the setting
  std::string_view does;    // that one, in words; empty where it is a mutant of another chapter
  ChangeOfRules keep;       // what that one does after the change
  std::string_view reason;  // for which it fails
};

std::span<const OtherCoding> other_codings();

// Each coding of a telegram, a status word, a control word and a message.
void change_each_coding(interbus::Rules& rules);

}  // namespace fieldproof::conformance
