#include "cli/program.hpp"
#include "cli/protocols.hpp"

int main(int argc, char** argv) {
  return fieldproof::cli::run_program(argc, argv, fieldproof::cli::built_in_protocols());
}
