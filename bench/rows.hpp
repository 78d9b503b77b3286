// The rows of the benchmark table: what is measured, beside whom, and what is hoped for.
//
// A row makes a batch: a callable that does a fixed amount of work and returns how many units that was
// (events, octets, cycles). Rows of one group do the same work; a row without `against` is a peer, a row with
// it is compared with the fastest row of its group whose name begins with `against`. Rows are registered by a
// constant of type Rows in any *_bench.cpp; the table is ordered by group, and within a group as registered.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace fieldproof::bench {

// Does some work and returns the number of units done.
using Batch = std::function<std::uint64_t()>;

struct Row {
  std::string group;
  std::string name;
  std::string unit;             // what a batch counts, in the plural: "events"
  std::string against;          // beginning of the peers' names; empty: this row is a peer
  double target_ratio;          // this row's rate over the fastest peer's; 0: none is asked for
  std::function<Batch()> make;  // sets up, outside the measured time
  // It waits for another thread or process: its rate is per second of the clock, not of processor time.
  bool waits = false;
};

// Adds rows to the table of the program.
class Rows {
 public:
  explicit Rows(std::vector<Row> rows);
};

// All rows, groups in alphabetical order.
std::vector<Row> all_rows();

}  // namespace fieldproof::bench
