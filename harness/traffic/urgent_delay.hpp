#pragma once

#include <vector>

#include "harness/kernel/time.hpp"

// How long urgent data wait for the token of a Foundation Fieldbus: the analytical model of S. H. Hong and
// B. K. Son, "Delay Analysis of Urgent Data in the Foundation Fieldbus and Experimental Verification", 2003,
// equations (1) to (26), with every quantity in between. Numbers in brackets are those of its equations.
//
// The token goes round; each visit takes one urgent packet, and one time-available packet while the rotation
// before was shorter than the target rotation time (TTRT). Rotations are taken as independent and equally
// distributed, which is the assumption of the model and its main error.
//
// Three places of the paper contradict themselves. The consistent reading is computed, what is printed stands
// beside it:
//   (3)   lacks the factor rho11^j, which (16) and (20) have; `printed_mass` is what (3) sums up to
//   (14)  an atom at the TTRT belongs to ATRT >= TTRT, as the text says: mu sums what is below
//   (26)  begins with n = 1 and leaves out the packet that finds nobody; `delay_as_printed` does so
// Times are whole picoseconds, because ATRT and TTRT are compared for equality; means are milliseconds.
namespace fieldproof::traffic {

// Packets arrive in each queue as a Poisson stream; a queue is as long as it needs to be.
struct UrgentTraffic {
  unsigned urgent_queues = 16;          // N0
  unsigned available_queues = 16;       // N1
  kernel::Duration urgent_length{};     // L0, on the line
  kernel::Duration available_length{};  // L1
  kernel::Duration empty_rotation{};    // R: of a token that nobody uses
  kernel::Duration target_rotation{};   // TTRT
  double urgent_per_ms = 0;             // lambda0, in each queue
  double available_per_ms = 0;          // lambda1

  // U, of which 1 is what the line carries without any token.
  double load() const;
};

// The traffic of the paper, section V: 16 nodes at 1 Mbit/s with 75 and 267 octets, R = 16 ms. The rates are
// those of a load U with lambda0 : lambda1 = urgent_share : available_share.
UrgentTraffic paper_traffic(double load, double urgent_share, double available_share,
                            kernel::Duration target_rotation);
// Rates for a load, with the lengths that the traffic has.
void set_load(UrgentTraffic& traffic, double load, double urgent_share, double available_share);

// A time of rotation and how probable it is.
struct RotationAtom {
  kernel::Duration time;
  double probability;
};

enum class Balance {
  as_published,    // (5), (8), (11): each priority of the token as if it lasted for ever
  flow_conserving  // what arrives in a mean rotation leaves in it; time-available data within P1 of them
};

struct UrgentDelay {
  // What the model could not say anything about: the queues below grow without end, and no mean is given.
  bool is_urgent_unstable = false;
  bool is_available_saturated = false;  // of `flow_conserving`: each visit finds a packet, and more are left

  double mean_0 = 0, mean_1 = 0;              // (6), (9), of T0 and T1
  double rho_00 = 0, rho_10 = 0, rho_11 = 0;  // (7), (10), (11)
  double printed_mass = 0;                    // of (3) without the factor; 1 would be a distribution
  double mu_0 = 0, mu_1 = 0;                  // (14)
  double priority_0 = 0, priority_1 = 0;      // (15): P0, P1
  std::vector<RotationAtom> rotation;         // (16), in order of time, each time once
  double mean_rotation = 0;                   // (18)
  double mean_square_rotation = 0;            // of (16), ms^2
  double mean_residual = 0;                   // of (17)
  double rho = 0;                             // lambda0 * mean_rotation; 1 - pi_0
  std::vector<double> at_visit;               // (24): pi_i
  std::vector<double> at_departure;           // (23): p_n, from n = 0 on
  double mean_at_departure = 0;

  double delay_as_printed = 0;  // (26)
  double delay = 0;             // (26) with the packet that finds nobody
  // The same without what (26) counts twice: the rotation of the packet in transmission has begun already.
  double delay_without_own_rotation = 0;

  double cumulative(kernel::Duration time) const;        // (19)
  double residual_density(kernel::Duration time) const;  // (20), 1/ms
  double mean_of_nth(unsigned n) const;                  // of (22), n from 1 on, ms
};

// Throws kernel::Error(configuration) for a traffic that is none: a length, a rate or a rotation that is
// negative, no queue, a load that is no number.
UrgentDelay urgent_delay(const UrgentTraffic& traffic, Balance balance = Balance::as_published);

// Throws as `urgent_delay` does.
void check(const UrgentTraffic& traffic);

}  // namespace fieldproof::traffic
