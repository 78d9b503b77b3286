#include "cli/probe/probe_suite.hpp"
#include "cli/program.hpp"

int main(int argc, char** argv) {
  return fieldproof::cli::run_program(argc, argv, fieldproof::cli::probe_protocols());
}
