// The values of the options of one call, each with its origin: command line over environment over
// configuration file over a stored run over default.
//
// Contract: the getters read a value as what it must be and refuse it with its origin otherwise: one of the
// command line is kernel::Error(usage), any other kernel::Error(configuration) that names the variable, or
// file, line and JSON pointer. A file may set options of other verbs; they are checked by their type when the
// verb asks.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"

namespace fieldproof::cli {

enum class Origin { fallback, stored_run, file, environment, command_line };

struct Setting {
  std::vector<std::string> values;
  Origin origin = Origin::fallback;
  std::string place;  // "--seed", "FIELDPROOF_SEED", "lab.json:3: /seed"
};

// What the command line says, before anything is understood.
struct Command {
  std::string verb;
  std::vector<std::string> operands;
  std::map<std::string, std::vector<std::string>, std::less<>> values;  // by option name
};

// Value of an environment variable, nothing when it is not set or empty.
using Environment = std::function<std::optional<std::string>(const std::string&)>;
Environment process_environment();
// One sentence for each "FIELDPROOF_..." of these "NAME=value" that is the variable of no option.
std::vector<std::string> unknown_variables(const char* const* variables);

// "90s", "1.5 min": a time of whole milliseconds, with ms, s, min or h; nothing for what is none.
std::optional<std::chrono::milliseconds> duration_of(std::string_view written);

class Settings {
 public:
  Settings(const Command& command, const Environment& environment);

  // Takes over from a configuration file what has only a default until now; from a stored run only what
  // decides the outcome or the exit code.
  void add_file(const std::filesystem::path& file, Origin origin);

  bool is_set(std::string_view name) const;  // a flag that is on, a value that is given
  const std::vector<std::string>& list(std::string_view name) const;
  std::string text(std::string_view name) const;  // empty when there is none
  std::uint64_t number(std::string_view name, std::uint64_t min, std::uint64_t max) const;
  std::vector<double> reals(std::string_view name) const;
  // Of an option whose values are lists themselves, "a,b": the words of all of them.
  std::vector<std::string> words(std::string_view name) const;
  std::optional<std::chrono::milliseconds> duration(std::string_view name) const;
  // One of the words that the table lists as the option's value: "quick|full".
  std::size_t choice(std::string_view name) const;

  // As if it had never been given.
  void reset(std::string_view name);

  Origin origin(std::string_view name) const { return setting(name).origin; }
  [[noreturn]] void refuse(std::string_view name, const std::string& sentence) const;

  // Every value with its origin, one line each.
  std::string describe() const;
  // The values that are no default, as a configuration file that gives them again; paths are absolute.
  std::string as_file() const;
  // The options that decide the outcome and are no default, with their values; the seed always: the default
  // may change, the result that was printed does not.
  std::vector<std::pair<const Option*, const std::vector<std::string>*>> deciding() const;
  // The same, quoted for a shell: "--seed 7 --iut slave=mutant:x".
  std::string reproduce_options() const;

 private:
  const Setting& setting(std::string_view name) const;

  std::string verb_;
  std::map<std::string, Setting, std::less<>> settings_;
};

}  // namespace fieldproof::cli
