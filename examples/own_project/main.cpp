// The program of fieldproof with all its verbs, over the suites of this project.
#include <array>

#include <cli/attachments.hpp>
#include <cli/program.hpp>

#include "suites.hpp"

using namespace fieldproof;

// Lines are disturbed as the program says: `shrink` and `replay` want other bursts than `run`.
static std::unique_ptr<conformance::Suite> of_valve_bus(const conformance::Attach& attach,
                                                        const cli::Disturbances& disturbances) {
  return island::valve_bus_suite(
      {.attach = attach, .disturbances = disturbances.of_plans, .stresses = disturbances.stresses});
}

static std::unique_ptr<conformance::Suite> of_product(const conformance::Attach&, const cli::Disturbances&) {
  return island::product_suite();
}

int main(int argc, char** argv) {
  const std::array<cli::ProtocolEntry, 2> protocols{{
      {.name = "valve_bus", .suite = &of_valve_bus},
      {.name = "island", .suite = &of_product},
  }};
  return cli::run_program(argc, argv, protocols);
}
