// The program of fieldproof with all its verbs, over the suites of this project.
#include <cli/attachments.hpp>
#include <cli/program.hpp>
#include <emc/burst_stress.hpp>
#include <emc/plan_disturbances.hpp>

#include "suites.hpp"

using namespace fieldproof;

static cli::Suites suites() {
  return island::suites({.node = {.attached = cli::attached_nodes()},
                         .disturbances = emc::plan_disturbances(),
                         .stresses = emc::catalogue_stresses()});
}

int main(int argc, char** argv) {
  return cli::run_program(argc, argv, &suites);
}
