// The program of fieldproof over a protocol that it does not know: one row.
#include <array>

#include <cli/program.hpp>

#include "poll.hpp"

int main(int argc, char** argv) {
  using namespace fieldproof;
  const std::array<cli::ProtocolEntry, 1> protocols{{
      {.name = "poll",
       .suite = &poll::suite,
       .network = {.own_network = "of a master and three responders", .plan = &poll::plan}},
  }};
  return cli::run_program(argc, argv, protocols);
}
