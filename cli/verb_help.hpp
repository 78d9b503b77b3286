// What `fieldproof help` and `--help` print besides the rows of verbs and options: groups, examples, and
// pages about what several verbs share.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fieldproof::cli {

struct Example {
  // Without "fieldproof "; {role}, {name} and {protocol} are those of the first role that the program knows.
  std::string_view command;
  std::string_view what;
};
std::string command_of(const Example& example);

struct VerbHelp {
  std::string_view verb;
  std::string_view group;
  std::array<Example, 3> examples;
};

// The row of a verb; each verb has one.
const VerbHelp& help_of_verb(std::string_view verb);

// A page that is no verb: "iut", "selectors", "exit-codes", "verdicts".
struct HelpTopic {
  std::string_view name;
  std::string_view title;
  std::string_view text;
};
std::span<const HelpTopic> help_topics();
// Nothing for a name that is none.
std::optional<std::string> topic_text(std::string_view name);

// What stands below the options of a verb: the kinds of `--iut` where it has that option, and its examples.
std::string footer_of(std::string_view verb);
// What stands below the list of verbs.
std::string footer_of_program();

}  // namespace fieldproof::cli
