// The verbs of the program, one file each, and what they are given.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/program.hpp"
#include "cli/settings.hpp"
#include "cli/terminal.hpp"
#include "conformance/catalogue.hpp"
#include "harness/judge/input_file.hpp"

namespace fieldproof::cli {

class Session {
 public:
  Session(Settings& settings_, Terminal& terminal_, std::vector<std::string> operands_,
          std::vector<std::string> arguments_)
      : settings(settings_),
        terminal(terminal_),
        operands(std::move(operands_)),
        arguments(std::move(arguments_)) {}

  // Of all protocols, under all disturbances. It is made when it is asked for first: a station that is called
  // once a case, and the verbs of networks, do without it.
  const conformance::Catalogue& catalogue() const;

  Settings& settings;
  Terminal& terminal;
  std::vector<std::string> operands;   // selectors, case id, run directories
  std::vector<std::string> arguments;  // the command line as it was typed, program first
  // For its document: as they were before the verb began.
  std::vector<judge::InputFile> inputs{};

 private:
  mutable std::once_flag is_made_;
  mutable std::unique_ptr<const conformance::Catalogue> catalogue_;
};

// Each answers with the exit code of the program.
int list(Session& session);
int run(Session& session);
int explain(Session& session);
int schema(Session& session);
int matrix(Session& session);
int run_campaign(Session& session);
int replay(Session& session);
int check(Session& session);
int fuzz_role(Session& session);
int shrink(Session& session);
int verify(Session& session);
int judge_again(Session& session);
int diff(Session& session);
int residual(Session& session);
int emc_protocol(Session& session);
int measure_protocol(Session& session);
int paper(Session& session);
int plan(Session& session);
int report(Session& session);
int station(Session& session);
int new_device(Session& session);
int doctor(Session& session);

struct Verb {
  std::string_view name;
  std::string_view operands;  // as the help shows them
  std::size_t min_operands = 0;
  std::size_t max_operands = 0;
  std::string_view help;
  int (*serve)(Session&) = nullptr;  // null: the command line answers it
};

std::span<const Verb> verbs();

}  // namespace fieldproof::cli
