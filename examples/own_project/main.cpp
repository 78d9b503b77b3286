// The program of fieldproof with all its verbs, over the suites of this project.
#include <cli/attachments.hpp>
#include <cli/program.hpp>

#include "suites.hpp"

using namespace fieldproof;

// The program says what disturbs the lines: `shrink` and `replay` want other bursts than `run`.
static cli::Suites suites(const cli::Disturbances& disturbances) {
  return island::suites({.node = {.attached = cli::attached_nodes()},
                         .disturbances = disturbances.of_plans,
                         .stresses = disturbances.stresses});
}

int main(int argc, char** argv) {
  return cli::run_program(argc, argv, &suites);
}
