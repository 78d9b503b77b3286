#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/judge/verdict.hpp"
#include "harness/kernel/time.hpp"

// What a judge saw, with everything that a reader needs to believe it: a finding for every verdict but pass,
// and the result of one case. Text in these records may come from an implementation under test: whoever
// prints it escapes it for the format.
namespace fieldproof::judge {

struct Finding {
  Verdict verdict = Verdict::fail;
  std::string reason;       // stable code in words: "output_changed_by_rejected_cycle"
  std::string requirement;  // own words
  Reference reference;
  std::vector<std::string> expected;  // every admissible observation
  std::string actual;
  kernel::Time time{};           // simulated time of the observation
  std::string step{};            // of the case, where it has steps: "2 of 5: the node is polled again"
  std::string first_difference;  // field and position of the first difference, may be empty
  // What decides that it shows, each a line with what was tried instead; of sequences that are compared.
  std::vector<std::string> decisive{};
  std::vector<std::string> decode;  // layered: levels, telegrams, cycle, fields; may be empty
};

// A figure that a case measured. `low` and `high` are the limits it was held against (equal to the value
// where there is none).
struct Measurement {
  std::string name;
  std::string unit;
  double value = 0;
  double low = 0;
  double high = 0;
};

struct CaseResult {
  std::string id;
  Verdict verdict = Verdict::none;
  std::string reason;  // reason code of the heaviest finding; for not-applicable the sentence that says why
  std::string requirement;
  Reference reference;
  std::vector<Finding> findings;
  std::vector<Measurement> measurements;
  // What a case that does not pass gave the implementation otherwise than usual, for people.
  std::vector<std::string> settings{};
  // Under a plan of faults: how often each of its parts hit, in its order; of a disturbance the waves that it
  // changed.
  std::vector<std::uint64_t> planned_hits{};
  std::uint64_t seed = 0;         // seed of this case, derived from the run's seed and the id
  std::uint64_t fingerprint = 0;  // of the whole trace
  kernel::Duration virtual_time{};
  std::uint64_t wall_time_us = 0;  // the only field that differs between two equal runs
  // Whether the implementation has driven its line at all. Not stored: for a search, in which a mute one
  // would agree with everything.
  bool has_driven = true;
  std::string log;        // of the implementation, bounded
  std::string purpose{};  // label of the test purpose, "IS-14"; may be empty
  // Who runs the suite knows of this failure, for this reason and until that day; empty: nobody does.
  std::string expected_because{};
};

}  // namespace fieldproof::judge
