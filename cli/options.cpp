#include "cli/options.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace fieldproof::cli {
namespace {

using enum OptionKind;

// clang-format off
constexpr std::array kOptions = {
    Option{"iut", list, "[ROLE[@POSITION]=]URI", "ref", "run verify replay emc measure check doctor fuzz list",
           "implementation under test, in which role and place; see below", false, true},
    Option{"seed", value, "N", "1", "run verify matrix residual measure paper emc check plan fuzz", "seed of the run, 0 to 2^64-1", false, true},
    Option{"volume", value, "quick|full", "full", "run verify", "how many repetitions a case makes", false, true},
    Option{"network", value, "FILE", "", "run verify measure emc", "network description instead of the suite's own", false, true},
    Option{"faults", value, "FILE", "", "run verify", "declared faults and disturbances of the line", false, true},
    Option{"pics", value, "FILE", "", "run verify list check station fuzz", "what the implementation declares about itself", false, true},
    Option{"jobs", value, "N", "all cores", "run verify matrix emc", "threads; the results are the same for any number"},
    Option{"out", value, "DIR", "runs/<utc>-<seed>", "run", "directory of the run"},
    Option{"out", value, "DIR", "", "emc", "where each test that fails, and the first wrong word, leave a file for replay and shrink"},
    Option{"out", value, "DIR", "campaigns/<name of the file>", "campaign", "directory of the campaign"},
    Option{"workers", value, "N", "all cores; 1 for each rank of mpirun", "campaign", "jobs at a time, each in a process; the results are the same for any number"},
    Option{"out", value, "DIR", "<role>", "new", "the folder that it is written to", true},
    Option{"lang", value, "python|c|cpp", "python", "new", "a process in Python, or a shared library in C or C++", true},
    Option{"record", value, "none|failed|all", "failed", "run", "which cases keep their trace"},
    Option{"junit", value, "FILE", "", "run report", "also write the JUnit report here; beyond 10 MB the rest goes to FILE-2 and so on"},
    Option{"sarif", value, "FILE", "", "run report", "also write what did not pass as SARIF 2.1.0 here, for code scanning"},
    Option{"ctrf", value, "FILE", "", "run report", "also write the result as CTRF (JSON) here"},
    Option{"github", flag, "", "", "run report", "print annotations for GitHub Actions, and add to the summary of the step"},
    Option{"html", value, "FILE", "", "run report", "also write the report as one HTML page here"},
    Option{"history", value, "DIR", "", "report", "how the runs below this folder went one after another: counts, times, measured numbers, what is flaky, what began to fail", true},
    Option{"last", value, "N", "200", "report", "with --history: of the last N runs", true},
    Option{"compare", flag, "", "", "report", "the second of two runs beside the first: what changed, and the time lines of a case side by side", true},
    Option{"title", value, "TEXT", "", "report", "a cover with this title: what was tested with what, and what came out"},
    Option{"device", value, "TEXT", "", "report", "on the cover: what was tested, as its maker calls it"},
    Option{"customer", value, "TEXT", "", "report", "on the cover: for whom"},
    Option{"note", value, "TEXT", "", "report", "on the cover: what else is to be said"},
    Option{"json", value, "FILE", "", "run report matrix diff residual measure paper emc plan fuzz", "also write the result as JSON here"},
    Option{"json", flag, "", "", "list", "print JSON", true},
    Option{"needs", value, "FILE", "", "list", "write the requirements of the cases here, as needs.json for sphinx-needs", true},
    Option{"ctest", value, "FILE", "", "list", "write a test of CTest per case here, against what --iut names", true},
    Option{"strict", flag, "", "", "run", "warn and inconclusive count as fail", false, false, true},
    Option{"allow-inconclusive", flag, "", "", "run replay judge verify", "an inconclusive verdict, or a run that --max-time ended, gives 0, not 2", false, false, true},
    Option{"baseline", value, "FILE", "", "run", "failures that are expected, each with its reason and its last day; one that is stale gives 3", false, false, true},
    Option{"confirm", value, "N", "0", "run", "a failure must come again N times, else it is inconclusive", false, true},
    Option{"shard", value, "I/N", "", "run list", "only each N-th of the selected cases, from the I-th on: one of N runs that are all of them together", false, false, true},
    Option{"call-limit", value, "T", "2s", "run verify check replay shrink emc measure fuzz", "how long an implementation in another process may take for one call", false, true},
    Option{"case-limit", value, "T", "10min", "run verify check replay shrink emc measure fuzz", "and for all calls of a case; in derived/ and compared/ of each sequence", false, true},
    Option{"reset", value, "COMMAND", "", "run", "a command of the shell that resets the implementation before each case, whose id is $1; cases then run one by one", false, true},
    Option{"fail-fast", flag, "", "", "run", "stop after the first case that fails"},
    Option{"max-time", value, "T", "", "run matrix emc measure check shrink fuzz campaign", "stop after this time: 90s, 15min, 2h"},
    Option{"signal", list, "F,F...", "50Hz,150Hz,200Hz", "measure", "frequencies of the square waves; where none is said those of these that the network can carry, or one that it can", false, true},
    Option{"duration", value, "T", "60s", "measure paper emc", "virtual time of each signal or test", false, true},
    Option{"test-levels", list, "L,L...", "1..4", "emc", "test levels of signal ports: 1, 1..4, or volts x:1000, x:1000..4500:500", false, true},
    Option{"search", flag, "", "", "emc", "find from which voltage on each criterion is seen, also where --test-levels is given", false, true},
    Option{"sensitivity", flag, "", "", "emc", "at the highest level: over which range of each parameter of the coupling that nobody measured the criterion stays", false, true},
    Option{"fit", value, "FILE", "", "emc", "hold a laboratory's counts (CSV) against the burst model instead of simulating; see docs/measure.md", true, true},
    Option{"bits", value, "N", "", "emc", "with --fit: levels of a frame on the line, where it is not what its check covers", false, true},
    Option{"repetition", list, "R,R...", "5kHz,100kHz", "emc", "5kHz, 100kHz, or 2.5kHz of edition 1", false, true},
    Option{"polarity", list, "+,-", "+,-", "emc", "of all pulses of a test", false, true},
    Option{"channel", list, "bsc:P,...", "", "emc", "instead of bursts, a channel on which each bit flips with this chance, to hold the frame check's theory against", false, true},
    Option{"profile", value, "NAME|FILE", "of the protocol", "measure emc", "installation and receivers: A, A2, A3, B, B2, C, D, E, E2, F or a file", false, true},
    Option{"worst", value, "A|B|C", "B", "emc", "the worst performance criterion that does not fail", false, true},
    Option{"bursts", value, "L[,R[,P]]", "", "measure", "bursts while measuring, as 3 or x:1000,100kHz,-; quiet, burst and recovery are reported separately", false, true},
    Option{"latch", value, "M1|M2|M3", "M2", "measure emc", "when INTERBUS slaves sample inputs: M1 at the latch of outputs, M2 at the start of a frame, M3 at the end of the one before", false, true},
    Option{"quiet", flag, "", "", "run matrix verify judge measure paper emc check shrink fuzz campaign", "no line per case and no progress"},
    Option{"failed", optional_value, "RUNDIR", "", "run", "only the cases that failed in that run (runs/latest)", true},
    Option{"resume", value, "RUNDIR", "", "run", "finish a run that was stopped or killed", true},
    Option{"resume", value, "DIR", "", "campaign", "finish a campaign that was stopped or killed; FILE.json may be left out", true},
    Option{"dry-run", flag, "", "", "campaign", "check the file, count its jobs, and estimate their time from the first job of each row", true},
    Option{"watch", value, "DIR", "", "campaign", "show how far a campaign is that runs elsewhere, until it ends", true},
    Option{"measurements", flag, "", "", "run", "print what each case measured, with its limits"},
    Option{"count", flag, "", "", "list", "print the number only", true},
    Option{"bits", flag, "", "", "replay", "print the whole recording", true},
    Option{"pcapng", value, "FILE", "", "replay", "write the recording as a capture for Wireshark here", true},
    Option{"vcd", value, "FILE", "", "replay", "write the recording as a wave dump (VCD) here", true},
    Option{"cases", value, "N", "2000", "check fuzz", "how many sequences are drawn at most", true},
    Option{"case", value, "FILE", "<role>-<seed>.case.json, <file>.shrunk.json", "check shrink fuzz", "where what was found is written, for replay", true},
    Option{"corpus", value, "DIR", "", "fuzz", "begin with the sequences that an earlier search left in this folder, and leave there what is enough to pass what all have passed", true},
    Option{"corpus-out", value, "DIR", "", "fuzz", "leave them in this folder instead", true},
    Option{"input", value, "FILE", "", "fuzz", "no search: run this input of a fuzz target, or this sequence of a corpus, and write it as a case (--case)", true},
    Option{"units", value, "levels|telegrams", "levels", "station", "what a built-in INTERBUS station receives and sends", true},
    Option{"serial", value, "LINE", "", "station", "play it in wall-clock time on this serial line; a name that is not there yet becomes a pseudo terminal", true},
    Option{"upper", value, "PATH|-|none", "-", "station", "with --serial: where the upper tester's channel is: a socket to listen at, the standard streams, or none", true},
    Option{"runs", value, "N", "2", "verify", "how often each case is run (also -n)", true},
    Option{"declared", flag, "", "", "matrix", "of the mutants of a case only those that it declares to catch: every gap of the suite in a tenth of the time", false, true},
    Option{"sequences", flag, "", "", "matrix", "sequences of check in the place of cases: after how many commands each mutant is found", false, true},
    Option{"seeds", value, "N", "5", "matrix", "with --sequences: how many seeds", false, true},
    Option{"commands", value, "N", "1000000", "matrix", "with --sequences: how many commands each mutant is given at most under each seed", false, true},
    Option{"fcs", value, "NAME", "", "residual", "frame check by its catalogue name: CRC-16/IBM-3740, CRC-32", false, true},
    Option{"bits", value, "N", "", "residual", "length of message and check", false, true},
    Option{"ber", list, "P", "<1e-6 to 1e-2 and 0.5>", "residual", "bit-error rate", false, true},
    Option{"samples", value, "N", "0", "residual", "also simulate: so many telegrams counted, and patterns of flips drawn", false, true},
    Option{"messages", value, "N", "3600", "residual", "messages per hour, for the rate per hour", false, true},
    Option{"receivers", value, "N", "1", "residual", "receivers of each message, for the rate per hour", false, true},
    Option{"config", value, "FILE", "", "run verify matrix list residual measure paper emc report check fuzz campaign", "configuration file (JSON, comments allowed)"},
    Option{"print-config", flag, "", "", "run verify matrix list residual measure paper emc report check fuzz campaign", "print every value with its origin and stop", true},
};
// clang-format on

}  // namespace

std::span<const Option> options() {
  return kOptions;
}

bool is_known_to(const Option& option, std::string_view verb) {
  std::string_view rest = option.verbs;
  while (!rest.empty()) {
    const std::size_t space = rest.find(' ');
    if (rest.substr(0, space) == verb) return true;
    if (space == std::string_view::npos) return false;
    rest.remove_prefix(space + 1);
  }
  return false;
}

const Option* find_option(std::string_view name, std::string_view verb) {
  const auto found = std::find_if(kOptions.begin(), kOptions.end(), [&](const Option& option) {
    return option.name == name && is_known_to(option, verb);
  });
  return found == kOptions.end() ? nullptr : &*found;
}

std::string environment_name(const Option& option) {
  std::string name(kVariablePrefix);
  for (const char c : option.name) {
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return name;
}

std::string file_key(const Option& option) {
  std::string key(option.name);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

}  // namespace fieldproof::cli
