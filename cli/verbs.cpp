#include "cli/verbs.hpp"

#include <array>

namespace fieldproof::cli {
namespace {

constexpr std::size_t kAny = 100'000;

// clang-format off
constexpr std::array kVerbs = {
    Verb{"run", "[SELECTOR...]", 0, kAny, "judge an implementation by the selected cases", &run},
    Verb{"check", "PROTOCOL/ROLE", 1, 1, "random sequences of commands and faults against the reference of the role; what fails is made as small as it can be", &check},
    Verb{"fuzz", "PROTOCOL/ROLE", 1, 1, "the sequences of check, mutated towards what an instrumented implementation has not passed yet", &fuzz_role},
    Verb{"campaign", "[FILE.json]", 0, 1, "many jobs of the verbs above, over all cores or the ranks of mpirun; what is judged survives a kill", &run_campaign},
    Verb{"matrix", "PROTOCOL[/ROLE]", 1, 1, "which case kills which mutant, or how soon random sequences find it; 1 if one survives", &matrix},
    Verb{"verify", "SELECTOR...|CASEFILE", 1, kAny, "run cases several times; equal seeds must give equal fingerprints", &verify},
    Verb{"doctor", "", 0, 0, "can the implementation be attached, and how well does this machine know instants", &doctor},
    Verb{"station", "PROTOCOL/ROLE [ref|mutant:NAME|plugin:LIBRARY|exec:PROGRAM]", 1, 2, "play a station on standard input and output, for --iut exec:, or on a serial line", &station},
    Verb{"new", "PROTOCOL/ROLE", 1, 1, "write a device of a role to begin with, in Python, C or C++, that can be judged at once", &new_device},
    Verb{"judge", "RUNDIR", 1, 1, "judge a stored run again, without the implementation", &judge_again},
    Verb{"replay", "CASEFILE", 1, 1, "run a stored case again and compare it bit for bit", &replay},
    Verb{"shrink", "CASEFILE", 1, 1, "make a stored case that fails smaller: the fewest commands, faults and flipped bits", &shrink},
    Verb{"diff", "RUN_A RUN_B", 2, 2, "new failures, fixed ones and drifted measurements", &diff},
    Verb{"report", "[RUNDIR|FILE...]", 0, kAny, "stored runs and documents (emc, measure, paper, residual, matrix, campaign) as one HTML page; a run, or all parts of one that --shard cut, in the formats of CI servers", &report},
    Verb{"emc", "PROTOCOL", 1, 1, "a network under IEC 61000-4-4 bursts: criterion and error statistics by test level, repetition, polarity", &emc_protocol},
    Verb{"measure", "PROTOCOL", 1, 1, "cycle time, jitter and skew of a network, with the closed forms they are compared with", &measure_protocol},
    Verb{"residual", "", 0, 0, "probability that a frame check does not detect a corrupted telegram", &residual},
    Verb{"plan", "NETWORK.json", 1, 1, "what keeps the bounds of a network file, proven by simulation: the target rotation time of a Foundation Fieldbus, or sampling periods and packet lengths of control loops", &plan},
    Verb{"paper", "[NAME]", 0, 1, "what a paper published, next to what is reproduced of it; without a name, the first of them", &paper},
    Verb{"list", "[SELECTOR...|protocols|mutants|pics [ROLE]]", 0, kAny,
         "cases, mutants, protocols or items of a PICS; why a case does not apply", &list},
    Verb{"explain", "CASE-ID|PROTOCOL/ROLE|NUMBER", 1, 1, "of a case: requirement, source, stimulus, expected and what it kills; of a role: its settings; of a number: unit, range and source", &explain},
    Verb{"schema", "[NAME]", 0, 1, "the JSON Schema of a file, or of the settings of a role; without a name, all names", &schema},
    Verb{"help", "[VERB|PAGE]", 0, 1, "options and examples of a verb, or a page: iut, selectors, exit-codes, verdicts", nullptr},
};
// clang-format on

}  // namespace

std::span<const Verb> verbs() {
  return kVerbs;
}

}  // namespace fieldproof::cli
