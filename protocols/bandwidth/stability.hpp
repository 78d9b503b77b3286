#pragma once

#include "protocols/bandwidth/allocation.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

// Does what arrives fit the line in the mean? The paper refers to O. C. Ibe and X. Cheng (1988) for it and
// prints no formula; this is derived from the balance of a slot:
//   gbar L_p + T_1 N_c lambda_c L_c + q R + n (R + N_n L_n) = T_1
// with gbar data of a slot in the mean, q the share of slots with data (each has one rotation without
// non-real-time packets) and n the visits of a saturated non-real-time queue in a slot. Where q and gbar are
// 0 this is lambda_i R < 1 - rho, the condition of Ibe and Cheng for one packet a visit.
namespace fieldproof::bandwidth {

struct Stability {
  double periodic = 0;           // share of the line (rho_p)
  double real_time = 0;          // rho_c
  double non_real_time = 0;      // rho_n
  double server = 0;             // q R / T_1 + lambda_max R
  double saturated_packets = 0;  // n: of each non-real-time queue in a slot, where all always have one

  double load() const { return periodic + real_time + non_real_time + server; }
  bool is_stable() const { return load() < 1; }
};

Stability stability(const WindowTraffic& traffic, const Allocation& allocation);

}  // namespace fieldproof::bandwidth
