#include "cli/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>

#include "cli/command_line.hpp"
#include "cli/disturbances.hpp"
#include "cli/exit_code.hpp"
#include "cli/input_files.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

int serve(const Command& command, const std::vector<std::string>& arguments, Terminal& terminal) {
  const auto verb =
      std::find_if(verbs().begin(), verbs().end(), [&](const Verb& v) { return v.name == command.verb; });
  FIELDPROOF_CHECK(verb != verbs().end(), "the command line gives a verb that the table does not have");
  Settings settings(command, process_environment());
  for (const std::string& sentence : unknown_variables(environ)) print_log_line(sentence);
  if (find_option("print-config", verb->name) != nullptr && settings.is_set("print-config")) {
    terminal.print(settings.describe());
    return kAllAsExpected;
  }
  if (find_option("quiet", verb->name) != nullptr) terminal.set_quiet(settings.is_set("quiet"));
  Session session{settings, terminal, command.operands, arguments};
  if (find_option("json", verb->name) != nullptr && settings.is_set("json")) {
    date_of_document();
    session.inputs = input_files_of(session);
  }
  return verb->serve(session);
}

// A caller who reads only the exit code must not take a result that was lost for one that was told.
int code_after_output(int code, const Terminal& terminal) {
  return code == kAllAsExpected && terminal.has_lost_result() ? kResultLost : code;
}

}  // namespace

const conformance::Catalogue& Session::catalogue() const {
  std::call_once(is_made_, [&] {
    catalogue_ = std::make_unique<const conformance::Catalogue>(make_suites(all_disturbances()));
  });
  return *catalogue_;
}

int run_program(int argc, const char* const* argv, std::span<const ProtocolEntry> protocols) {
  use_protocols(protocols);
  secure_standard_streams();
  try {
    Terminal terminal;
    const std::vector<std::string> arguments(argv, argv + argc);
    const Parsed parsed = parse_command_line(arguments);
    int code = kAllAsExpected;
    if (parsed.command) {
      code = serve(*parsed.command, arguments, terminal);
    } else {
      terminal.print(parsed.text);
    }
    return code_after_output(code, terminal);
  } catch (const iut::Misbehaviour& done) {
    print_log_line(done.what());
    for (const std::string& line : done.evidence()) print_log_line(line);
    return done.exit_code();
  } catch (const iut::CannotBeDone& what) {
    // Within a case it makes that not applicable; what ends a whole network is no verdict about the station.
    const kernel::Error error(kernel::ErrorKind::implementation,
                              fmt::format("the implementation cannot take part in this: {}", what.what()));
    print_log_line(error.what());
    return error.exit_code();
  } catch (const kernel::Error& error) {
    print_log_line(error.what());
    return error.exit_code();
  } catch (const std::exception& failure) {
    print_log_line(fmt::format("internal error: {}", failure.what()));
    return kInternal;
  }
}

}  // namespace fieldproof::cli
