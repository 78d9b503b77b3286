#include "cli/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>

#include "cli/command_line.hpp"
#include "cli/exit_code.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

int serve(const Command& command, const std::vector<std::string>& arguments, Suites (*make_suites)()) {
  const auto verb =
      std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == command.verb; });
  FIELDPROOF_CHECK(verb != verbs().end(), "the command line gives a verb that the table does not have");
  Settings settings(command, process_environment());
  Terminal terminal;
  if (find_option("print-config", verb->name) != nullptr && settings.is_set("print-config")) {
    terminal.print(settings.describe());
    return kAllAsExpected;
  }
  if (find_option("quiet", verb->name) != nullptr) terminal.set_quiet(settings.is_set("quiet"));
  const conformance::Catalogue catalogue(make_suites());
  Session session{catalogue, settings, terminal, command.operands, arguments};
  return verb->serve(session);
}

}  // namespace

int run_program(int argc, const char* const* argv, Suites (*make_suites)()) {
  try {
    const std::vector<std::string> arguments(argv, argv + argc);
    const Parsed parsed = parse_command_line(arguments);
    if (!parsed.command) {
      fmt::print("{}", parsed.text);
      return kAllAsExpected;
    }
    return serve(*parsed.command, arguments, make_suites);
  } catch (const kernel::Error& error) {
    fmt::print(stderr, "fieldproof: {}\n", error.what());
    return error.exit_code();
  } catch (const std::exception& failure) {
    fmt::print(stderr, "fieldproof: internal error: {}\n", failure.what());
    return kInternal;
  }
}

}  // namespace fieldproof::cli
