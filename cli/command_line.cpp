#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>

#include "cli/build_info.hpp"
#include "cli/options.hpp"
#include "cli/verb_help.hpp"
#include "cli/verbs.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

// What one subcommand collects. The library keeps pointers into it.
struct Collected {
  const Verb* verb = nullptr;
  CLI::App* app = nullptr;
  std::vector<std::string> operands;
  struct Value {
    const Option* option = nullptr;
    CLI::Option* parsed = nullptr;
    std::vector<std::string> words;
    bool is_on = false;
  };
  std::deque<Value> values;
};

// Says what is typed, where the library's own words are "operands(0x)" and "N ...".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() == nullptr) return fmt::format("Usage: {} VERB [OPTIONS]\n", name);
    std::string usage = "Usage: " + name;
    for (const CLI::Option* operand :
         app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      usage += " " + operand->get_type_name();
    return usage + " [OPTIONS]\n";
  }
  std::string make_positionals(const CLI::App*) const override { return {}; }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() == 0 ? std::string{} : " " + option->get_type_name();
  }
};

std::string help_of(const Option& option) {
  std::string help(option.help);
  if (!option.default_text.empty()) help += fmt::format(" [{}]", option.default_text);
  return help;
}

void add_option(CLI::App& app, const Option& option, Collected::Value& value) {
  std::string name = fmt::format("--{}", option.name);
  if (option.name == "runs") name = "-n," + name;
  value.option = &option;
  if (option.kind == OptionKind::flag) {
    value.parsed = app.add_flag(name, value.is_on, help_of(option));
    return;
  }
  value.parsed = app.add_option(name, value.words, help_of(option));
  value.parsed->type_name(std::string(option.value_name));
  if (option.kind == OptionKind::optional_value) value.parsed->expected(0, 1);
  value.parsed->allow_extra_args(false);
}

void add_verb(CLI::App& program, const Verb& verb, Collected& collected) {
  collected.verb = &verb;
  collected.app = program.add_subcommand(std::string(verb.name), std::string(verb.help));
  collected.app->group(std::string(help_of_verb(verb.name).group));
  collected.app->footer(footer_of(verb.name));
  if (verb.max_operands > 0) {
    CLI::Option* operands =
        collected.app->add_option("operands", collected.operands, std::string(verb.operands));
    operands->type_name(std::string(verb.operands));
    operands->expected(static_cast<int>(verb.min_operands), static_cast<int>(verb.max_operands));
    if (verb.min_operands > 0) operands->required();
  }
  for (const Option& option : options()) {
    if (is_known_to(option, verb.name)) add_option(*collected.app, option, collected.values.emplace_back());
  }
}

Command command_from(const Collected& collected) {
  Command command;
  command.verb = collected.verb->name;
  command.operands = collected.operands;
  for (const Collected::Value& value : collected.values) {
    if (value.parsed->count() == 0) continue;
    std::vector<std::string> words = value.words;
    if (value.option->kind == OptionKind::flag)
      words = value.is_on ? std::vector<std::string>{"true"} : std::vector<std::string>{};
    if (value.option->kind == OptionKind::optional_value && words.empty()) words = {""};
    command.values.emplace(value.option->name, std::move(words));
  }
  return command;
}

// The words of the table that are meant when `word` is not among them.
std::string suggestion(const std::string& word, std::string_view verb) {
  std::vector<std::string> known;
  if (word.starts_with('-')) {
    for (const Option& option : options()) {
      if (is_known_to(option, verb)) known.push_back(fmt::format("--{}", option.name));
    }
  } else if (verb.empty()) {
    for (const Verb& other : verbs()) known.emplace_back(other.name);
  }
  const auto near = config::nearest(word.substr(0, word.find('=')), std::span<const std::string>(known), 1);
  return near.empty() ? std::string{} : fmt::format("; the nearest is '{}'", near.front());
}

std::string help_about(CLI::App& program, const std::vector<std::string>& operands) {
  if (operands.empty()) {
    return program.get_formatter()->make_help(&program, program.get_name(), CLI::AppFormatMode::Normal);
  }
  const std::string& name = operands.front();
  std::vector<std::string> known;
  for (const Verb& verb : verbs()) {
    if (verb.name == name) return program.get_subcommand(name)->help("fieldproof");
    known.emplace_back(verb.name);
  }
  if (const auto text = topic_text(name)) return *text;
  for (const HelpTopic& topic : help_topics()) known.emplace_back(topic.name);
  const auto near = config::nearest(name, std::span<const std::string>(known), 1);
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no help about '{}'; the nearest is '{}'", name, near.front()));
}

[[noreturn]] void refuse(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  const std::string verb = chosen.empty() ? std::string{} : chosen.front()->get_name();
  std::string sentence = error.what();
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  const std::vector<std::string> unknown = program.remaining(true);
  if (!unknown.empty()) {
    sentence = fmt::format("'{}' is not known here{}", unknown.front(), suggestion(unknown.front(), verb));
  }
  const std::string help = verb.empty() ? "fieldproof --help" : fmt::format("fieldproof {} --help", verb);
  throw kernel::Error(kernel::ErrorKind::usage, fmt::format("{} ('{}' shows what there is)", sentence, help));
}

}  // namespace

Parsed parse_command_line(const std::vector<std::string>& arguments) {
  CLI::App program("Judges implementations of fieldbus protocols against named requirements.", "fieldproof");
  program.require_subcommand(1);
  program.formatter(std::make_shared<HelpFormatter>());
  program.footer(footer_of_program());
  program.set_version_flag("--version",
                           fmt::format("fieldproof {} ({}, {})", tool_version(), build_type(), compiler()));
  std::deque<Collected> collected;
  for (const Verb& verb : verbs()) add_verb(program, verb, collected.emplace_back());
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  if (!reversed.empty()) reversed.pop_back();
  try {
    program.parse(reversed);
  } catch (const CLI::CallForVersion& version) {
    return {std::nullopt, std::string(version.what()) + "\n"};
  } catch (const CLI::CallForHelp&) {
    return {std::nullopt, program.help()};
  } catch (const CLI::ParseError& error) {
    refuse(program, error);
  }
  for (const Collected& candidate : collected) {
    if (!candidate.app->parsed()) continue;
    if (candidate.verb->name == "help") return {std::nullopt, help_about(program, candidate.operands)};
    return {command_from(candidate), {}};
  }
  throw kernel::Error(kernel::ErrorKind::usage, "no verb is given; 'fieldproof --help' shows what there is");
}

}  // namespace fieldproof::cli
