// The table of verbs and options: what the command line, the environment, a configuration file, `--help` and
// `--print-config` know. A new option is a row here and a property of configuration.schema.json, a new
// verb a row in verbs.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::cli {

enum class OptionKind {
  flag,            // no value
  value,           // one value
  optional_value,  // a value that may be left out
  list,            // may be given several times
};

struct Option {
  std::string_view name;  // "max-time": --max-time, FIELDPROOF_MAX_TIME, "max_time" in a file
  OptionKind kind = OptionKind::value;
  std::string_view value_name;    // "N", "FILE"
  std::string_view default_text;  // empty: none
  std::string_view verbs;         // "run verify": where it is known
  std::string_view help;
  bool is_of_the_moment = false;   // only on the command line: says what to do now, not how
  bool decides_outcome = false;    // belongs to the command that reproduces a result
  bool decides_exit_code = false;  // what the verdicts of the run mean; a run that is finished later keeps it
};

std::span<const Option> options();

bool is_known_to(const Option& option, std::string_view verb);
const Option* find_option(std::string_view name, std::string_view verb);

inline constexpr std::string_view kVariablePrefix = "FIELDPROOF_";
std::string environment_name(const Option& option);  // "FIELDPROOF_MAX_TIME"
std::string file_key(const Option& option);          // "max_time"

}  // namespace fieldproof::cli
