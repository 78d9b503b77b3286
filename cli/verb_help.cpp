#include "cli/verb_help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cli/options.hpp"
#include "cli/protocol_entry.hpp"
#include "harness/kernel/check.hpp"
#include "papers/catalogue.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::string_view kJudge = "Judge an implementation";
constexpr std::string_view kAgain = "A stored run or case";
constexpr std::string_view kNetwork = "Networks and numbers";
constexpr std::string_view kKnow = "Look up";

// clang-format off
constexpr std::array kHelp = {
    VerbHelp{"run", kJudge, {{
        {"run '{role}/**' --iut exec:./device", "every case of a role against your process"},
        {"run +must --iut {name}@3=unix:./device.sock --html report.html --sarif ci.sarif", "by a tag; your device at the third place of a network"},
        {"run --failed --iut exec:./device --record all", "what failed in the last run, with the trace of each case"}}}},
    VerbHelp{"check", kJudge, {{
        {"check {role} --iut exec:./device", "2000 random sequences, compared with the reference"},
        {"check {role} --iut plugin:./device.so --cases 20000 --seed 7", "more of them, from another seed"},
        {"check {role} --iut mutant:NAME --case found.json", "keep what was found, for replay"}}}},
    VerbHelp{"fuzz", kJudge, {{
        {"fuzz {role} --iut plugin:./libdevice.so --max-time 15min", "guided by the coverage of your own library"},
        {"fuzz {role} --iut plugin:./device.so?in-process --corpus kept", "in this process, which sees coverage; goes on where the last search ended"},
        {"fuzz {role} --iut ref --input crash-1234 --case found.json", "an input of a fuzz target as a case"}}}},
    VerbHelp{"matrix", kJudge, {{
        {"matrix {protocol}", "which case kills which mutant of the reference"},
        {"matrix {protocol} --jobs 2 --json matrix.json", "the same as JSON"},
        {"matrix {role} --sequences", "after how many commands of check each mutant is found"}}}},
    VerbHelp{"campaign", kJudge, {{
        {"campaign examples/campaigns/roles.json --dry-run", "how many jobs, and about how long"},
        {"campaign examples/campaigns/small.json --workers 2 --out nightly", "run it; the sum of all is nightly/campaign.json"},
        {"campaign --resume nightly", "go on after a kill; with mpirun in front, on many machines"}}}},
    VerbHelp{"verify", kJudge, {{
        {"verify '{role}/**' --iut exec:./device", "is your process deterministic: run twice, compare bit for bit"},
        {"verify '{role}/**' -n 5", "five times"},
        {"verify found.case.json", "a stored case"}}}},
    VerbHelp{"doctor", kJudge, {{
        {"doctor", "what this machine has, and how well it knows instants"},
        {"doctor --iut exec:./device", "can it be attached, which roles does it serve, how fast does it answer"},
        {"doctor --iut 'serial:/dev/ttyUSB0?baud=62500&format=8e1'", "the same at a serial line"}}}},
    VerbHelp{"station", kJudge, {{
        {"station {role} ref", "the reference on standard input and output"},
        {"station {role} mutant:NAME", "a mutant of it, as if it were yours"},
        {"station {role} ref --serial ./line", "on a pseudo terminal, in wall-clock time"}}}},
    VerbHelp{"new", kJudge, {{
        {"new {role}", "a process in Python, in a folder with the name of the role"},
        {"new {role} --lang c --out firmware", "a shared library in C, and the header that it needs"},
        {"new {role} --lang cpp", "one in C++"}}}},
    VerbHelp{"judge", kAgain, {{
        {"judge runs/latest", "the verdicts again, from what was recorded, without the implementation"},
        {"judge runs/latest --quiet", "the exit code only"},
        {"judge ci-artifacts/run --allow-inconclusive", "an inconclusive verdict is no failure"}}}},
    VerbHelp{"replay", kAgain, {{
        {"replay runs/latest/cases/CASE/case.json", "one case again, compared bit for bit"},
        {"replay found.case.json --iut exec:./device --bits", "print each transmission"},
        {"replay found.case.json --pcapng found.pcapng", "look at it in Wireshark"}}}},
    VerbHelp{"shrink", kAgain, {{
        {"shrink found.case.json", "the fewest commands, faults and flipped bits that still fail"},
        {"shrink found.case.json --case small.json", "written there"},
        {"shrink bursts/{protocol}-1-1.case.json", "a test of emc: the shortest time, the fewest bursts and bits"}}}},
    VerbHelp{"diff", kAgain, {{
        {"diff runs/before runs/after", "new failures, fixed ones, drifted measurements"},
        {"diff runs/before runs/latest --json diff.json", "the same as JSON"},
        {"diff main/run branch/run", "of two branches"}}}},
    VerbHelp{"report", kAgain, {{
        {"report --history nightly --last 50 --html history.html", "how the last runs went, what is flaky, what began to fail, what drifts"},
        {"report runs/latest emc.json measure.json --html report.html --title Acceptance --device N8", "a run as one page, with bursts and cycle times of the same device, and a cover to hand it over"},
        {"report shard1 shard2 shard3 --junit ci.xml --sarif ci.sarif", "the parts of --shard 1/3 to 3/3 as one run"}}}},
    VerbHelp{"emc", kNetwork, {{
        {"emc {protocol} --iut {name}@2=exec:./device", "burst immunity of a network with your device in it"},
        {"emc {protocol} --test-levels 1..4 --json emc.json", "all levels, as JSON for report"},
        {"emc {protocol} --network network.json --worst B --out bursts", "a network of yours; C fails, and is stored for replay and shrink"}}}},
    VerbHelp{"measure", kNetwork, {{
        {"measure {protocol} --iut {name}@2=exec:./device", "cycle time, jitter and skew with your device in the network"},
        {"measure {protocol} --network network.json --json measure.json", "of a network of yours"},
        {"measure {protocol} --bursts 3,100kHz,+", "quiet, during bursts, and after them"}}}},
    VerbHelp{"residual", kNetwork, {{
        {"residual --fcs CRC-16/IBM-3740 --bits 128", "undetected errors of a frame check, exact"},
        {"residual --fcs CRC-32 --bits 4096 --ber 1e-4", "at one bit-error rate"},
        {"residual --fcs CRC-16/IBM-3740 --bits 128 --samples 1000000", "with a simulation"}}}},
    VerbHelp{"plan", kNetwork, {{
        {"plan examples/foundation.json", "the target rotation time that keeps the bound in the file"},
        {"plan examples/bandwidth.json --json plan.json", "sampling periods, slots and packet lengths of control loops, also as JSON"},
        {"help plan", "its options"}}}},
    VerbHelp{"paper", kNetwork, {{
        {"paper foundation", "published figures, and what is reproduced of them"},
        {"paper foundation --duration 60s", "a longer experiment"},
        {"paper foundation --json paper.json", "for report"}}}},
    VerbHelp{"list", kKnow, {{
        {"list '{role}/**'", "the ids of cases"},
        {"list mutants", "the reference's seeded faults"},
        {"list pics {role}", "what a PICS may declare, and what is taken where it does not"}}}},
    VerbHelp{"explain", kKnow, {{
        {"explain CASE-ID", "what a case requires, by which source, and what it kills"},
        {"explain {role}", "the settings of a role"},
        {"explain bit_rate", "unit, range and source of a number"}}}},
    VerbHelp{"schema", kKnow, {{
        {"schema", "the names of all schemas"},
        {"schema {protocol}/network", "of a file that describes a network"},
        {"schema {role}", "of the settings that a role is given"}}}},
    VerbHelp{"help", kKnow, {{
        {"help run", "the same as run --help"},
        {"help iut", "all that --iut can say"},
        {"help exit-codes", "what a script can rely on"}}}},
};

constexpr std::array kTopics = {
    HelpTopic{"iut", "what --iut can say",
R"(  ref                          the built-in reference of the role (the default)
  mutant:NAME                  the reference with one seeded fault; 'fieldproof list mutants' has the names
  exec:./program ARGUMENTS     a process of yours that talks on its standard input and output
  unix:/path, tcp:HOST:PORT    a process that listens there
  plugin:./libx.so             a shared library behind one C header; ?in-process: faster, without protection
  serial:/dev/ttyX?baud=N&format=8e1   a box at a serial line, in wall-clock time
  ROLE=URI, ROLE@N=URI         which role it plays, and at which place: slave@3=exec:./slave; ROLE may be
                               PROTOCOL/ROLE
)"},
    HelpTopic{"selectors", "which cases",
R"(  PROTOCOL/ROLE/CHAPTER/CASE        one case, by its id; 'fieldproof list' prints them
  'PROTOCOL/ROLE/**'                all below; * is one part of an id
  +must                             by a tag
  '!PROTOCOL/ROLE/long*'            not these
  @file                             selectors from a file, one a line
)"},
    HelpTopic{"exit-codes", "what a script can rely on",
R"(    0  all judged cases pass, warn, or fail as the baseline expects
    1  at least one unexpected failure; a finding of check or fuzz
    2  no failure, but an inconclusive verdict
    3  no failure, but a stale baseline or another fingerprint
    4  nothing was judged
    5  the implementation cannot be used
   64  the call is wrong          65  a file is wrong
   70  an error of fieldproof     74  output could not be written
  130  interrupted               143  terminated; what was judged is kept
)"},
    HelpTopic{"verdicts", "what is said of a case",
R"(  pass             the requirement is kept
  warn             kept, but with something that users should know
  fail             broken; the finding says what was expected and what was seen
  inconclusive     not decided: a precondition failed, or an instant is nearer to its limit than it is known
  error            the bench could not judge
  not-applicable   the implementation does not have what the case is about
)"},
};
// clang-format on

const HelpTopic* find_topic(std::string_view name) {
  const auto found = std::ranges::find(kTopics, name, &HelpTopic::name);
  return found == kTopics.end() ? nullptr : &*found;
}

}  // namespace

std::string command_of(const Example& example) {
  // A program without a role of its own shows where one stands.
  static constexpr Role kNamed{"PROTOCOL", "ROLE", {}, nullptr, nullptr};
  const std::vector<const Role*> known = roles();
  const Role& role = known.empty() ? kNamed : *known.front();
  return fmt::format(fmt::runtime(example.command), fmt::arg("role", role.path()),
                     fmt::arg("name", role.name), fmt::arg("protocol", role.protocol));
}

const VerbHelp& help_of_verb(std::string_view verb) {
  const auto found = std::ranges::find(kHelp, verb, &VerbHelp::verb);
  FIELDPROOF_CHECK(found != kHelp.end(), "a verb has no help");
  return *found;
}

std::span<const HelpTopic> help_topics() {
  return kTopics;
}

std::optional<std::string> topic_text(std::string_view name) {
  const HelpTopic* topic = find_topic(name);
  if (topic == nullptr) return std::nullopt;
  return fmt::format("{}: {}\n\n{}", topic->name, topic->title, topic->text);
}

std::string footer_of(std::string_view verb) {
  std::string text;
  if (find_option("iut", verb) != nullptr)
    text = fmt::format("Implementations (--iut):\n{}\n", find_topic("iut")->text);
  if (verb == "paper") {
    text += "Papers (NAME), the first by default:\n";
    for (const papers::Paper& one : papers::catalogue())
      text += fmt::format("  {:<16}{}\n", one.name, one.title);
    text += '\n';
  }
  text += "Examples:\n";
  for (const Example& one : help_of_verb(verb).examples) {
    text += fmt::format("  fieldproof {}\n      {}\n", command_of(one), one.what);
  }
  return text;
}

std::string footer_of_program() {
  std::string text = "'fieldproof help VERB' has its options and examples. More pages:\n";
  for (const HelpTopic& topic : kTopics) text += fmt::format("  help {:12} {}\n", topic.name, topic.title);
  return text;
}

}  // namespace fieldproof::cli
