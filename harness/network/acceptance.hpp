#pragma once

#include "harness/kernel/time.hpp"

// The numbers by which it is decided whether an installation works: what criterion C and D mean. One member
// each, with source and standing in its row of `kAcceptanceTable`. A network takes its numbers from here and
// from nowhere else.
namespace fieldproof::field {
template <typename T>
struct Table;
}

namespace fieldproof::network {

struct AcceptanceRules {
  unsigned recovery_cycles = 2;  // within which all data are exchanged again
  // Without an exchange: the network has stopped.
  unsigned silence_cycles = 2;
  kernel::Duration least_silence = 100 * kernel::kMillisecond;
  kernel::Duration least_bring_up = 10 * kernel::kSecond;
  // How long recovery is waited for at least, beyond its limit too.
  unsigned limits_waited = 10;
  unsigned least_exchanges_waited = 1'000;
  kernel::Duration least_time_waited = 5 * kernel::kSecond;
  kernel::Duration pause_before_start = 50 * kernel::kMillisecond;

  friend bool operator==(const AcceptanceRules&, const AcceptanceRules&) = default;
};

extern const field::Table<AcceptanceRules> kAcceptanceTable;

}  // namespace fieldproof::network
