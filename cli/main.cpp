#include "cli/program.hpp"
#include "cli/suites.hpp"

int main(int argc, char** argv) {
  return fieldproof::cli::run_program(argc, argv, &fieldproof::cli::suites);
}
