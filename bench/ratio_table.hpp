// Measures rows side by side and prints their ratios as a table in Markdown.
//
// Machines of continuous integration change speed by a factor of two for minutes. So all rows take turns in
// every round, a calibration loop first, and the best of all rounds is compared with the best. Rates are per
// second of processor time.
#pragma once

#include <ostream>
#include <string>

namespace fieldproof::bench {

struct RatioOptions {
  unsigned rounds = 7;
  double seconds_per_turn = 0.02;  // processor time that a row gets in a round
  std::string only;                // measure groups that contain this text
  double slack = 0.15;             // a ratio may be this part below its target before it counts as missed
};

// Returns the number of rows that missed their target.
unsigned print_ratio_table(const RatioOptions& options, std::ostream& out);

}  // namespace fieldproof::bench
