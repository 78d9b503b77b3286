#pragma once

#include "harness/field/field.hpp"

// The numbers of the choice between two channels that carry the same. All are this project's choice: the
// paper names the dual channel manager, and says no more of it.
namespace fieldproof::token_bus {

struct ChannelRules {
  unsigned skew_symbols = 8;     // that one channel may be later than the other
  unsigned errors_in_a_row = 3;  // spoiled transmissions, then a channel has a fault
  unsigned clean_in_a_row = 3;   // clean transmissions, then it has none

  friend bool operator==(const ChannelRules&, const ChannelRules&) = default;
};

extern const field::Table<ChannelRules> kChannelRulesTable;

}  // namespace fieldproof::token_bus
