// The verbs of the program, one file each, and what they are given.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/program.hpp"
#include "cli/settings.hpp"
#include "cli/terminal.hpp"
#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

struct Session {
  const conformance::Catalogue& catalogue;  // under all disturbances
  Settings& settings;
  Terminal& terminal;
  std::vector<std::string> operands;   // selectors, case id, run directories
  std::vector<std::string> arguments;  // the command line as it was typed, program first
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
