// Reads the words of the command line by the tables of verbs and options. The only place that knows the
// library which does it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/settings.hpp"

namespace fieldproof::cli {

struct Parsed {
  std::optional<Command> command;  // nothing: `text` is the whole answer (help, version)
  std::string text;
};

// Throws kernel::Error(usage) for words that the tables do not know, with the nearest one.
Parsed parse_command_line(const std::vector<std::string>& arguments);

}  // namespace fieldproof::cli
