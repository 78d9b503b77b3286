#pragma once

#include <string>

#include "harness/config/document.hpp"
#include "protocols/fieldbus_dll/target_plan.hpp"

// A network whose target rotation time is to be planned, as a file has it (token_network.schema.json).
namespace fieldproof::fieldbus_dll {

struct TokenNetwork {
  std::string name;
  traffic::TokenTraffic traffic;  // without a target
  DelayBound bound;

  // Throws kernel::Error(configuration), which says where and what would be right.
  static TokenNetwork read(const config::Document& document);
};

}  // namespace fieldproof::fieldbus_dll
