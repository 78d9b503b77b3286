// The program of fieldproof with all its verbs, over the suites of this project.
#include <array>

#include <cli/program.hpp>

#include "suites.hpp"

using namespace fieldproof;

int main(int argc, char** argv) {
  const std::array<cli::ProtocolEntry, 2> protocols{{
      {.name = "valve_bus", .suite = &island::valve_bus_suite},
      {.name = "island", .suite = &island::product_suite},
  }};
  return cli::run_program(argc, argv, protocols);
}
