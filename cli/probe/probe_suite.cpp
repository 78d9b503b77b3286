#include "cli/probe/probe_suite.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <iterator>
#include <thread>

#include "conformance/suite_of_functions.hpp"
#include "harness/config/document.hpp"
#include "harness/iut/device_recording.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::cli {
namespace {

using conformance::Outcome;
using conformance::Setup;
using conformance::SuiteOfFunctions;
using conformance::TestCase;
using judge::Verdict;

// Who plays the role of the case.
std::string implementation_of(const TestCase& test_case, const Setup& setup) {
  for (const conformance::Assignment& assignment : setup.implementations) {
    if (assignment.role.empty() || assignment.role == test_case.role()) return assignment.uri;
  }
  return "ref";
}

Outcome judged(const Setup& setup, Verdict verdict, const std::string& reason = {}) {
  Outcome outcome;
  outcome.result.verdict = verdict;
  outcome.result.reason = reason;
  kernel::Random random(setup.seed);
  outcome.result.fingerprint = random.next();
  outcome.result.virtual_time = kernel::kMillisecond;
  outcome.result.measurements = {{"delay", "us", static_cast<double>(random.below(100)), 0, 100}};
  if (verdict != Verdict::pass && verdict != Verdict::not_applicable) {
    judge::Finding finding;
    finding.verdict = verdict;
    finding.reason = reason;
    finding.requirement = "what the probe asks for";
    finding.reference = {"the probe", "", judge::Standing::own};
    finding.expected = {"0x0001"};
    finding.actual = "0x0002";
    finding.time = kernel::kStart + 3 * kernel::kMicrosecond;
    outcome.result.findings = {finding};
  }
  if (setup.record) {
    outcome.recording.trace.channels = {"line"};
    line::Waveform wave{kernel::kStart, 1'000'000, {}};
    wave.levels.append(outcome.result.fingerprint, 64);
    outcome.recording.trace.records = {
        trace::Observation{0, kernel::kStart, "begins", 0},
        trace::Transmission{0, std::move(wave), std::nullopt},
    };
    // What the probe did is what is judged.
    auto devices = std::make_shared<iut::DeviceRecording>();
    devices->add({.failure = iut::Misbehaved{reason, std::string(judge::name(verdict)), {}}});
    outcome.recording.devices = std::move(devices);
  }
  return outcome;
}

// The recording says the verdict that it was made with.
Outcome judged_from_recording(const Setup& setup) {
  const auto recording = iut::DeviceRecording::load(setup.playback_file);
  FIELDPROOF_CHECK(recording.devices().size() == 1 && recording.devices().front().failure,
                   "the probe plays back what is no recording of its own");
  const iut::Misbehaved& done = *recording.devices().front().failure;
  return judged(setup, judge::verdict_from(done.sentence).value(), done.reason);
}

// Passes, but fails for `reason` on the mutant.
SuiteOfFunctions::Function failing_on(const std::string& mutant, std::string reason) {
  return
      [uri = "mutant:" + mutant, reason = std::move(reason)](const TestCase& test_case, const Setup& setup) {
        const std::string implementation = implementation_of(test_case, setup);
        if (!setup.playback_file.empty()) return judged_from_recording(setup);
        if (implementation == "mutant:unreachable") {
          throw kernel::Error(kernel::ErrorKind::implementation,
                              "the station does not answer; connect it and start again");
        }
        return implementation == uri ? judged(setup, Verdict::fail, reason) : judged(setup, Verdict::pass);
      };
}

SuiteOfFunctions::Function answering(Verdict verdict, std::string reason) {
  return [verdict, reason = std::move(reason)](const TestCase&, const Setup& setup) {
    if (!setup.playback_file.empty()) return judged_from_recording(setup);
    return judged(setup, verdict, reason);
  };
}

TestCase named(const std::string& id, std::vector<std::string> tags = {},
               std::vector<conformance::MustCatch> catches = {}) {
  TestCase test_case;
  test_case.id = id;
  test_case.purpose = fmt::format("P-{}", id.substr(id.rfind('/') + 1));
  test_case.requirement = "what the probe asks for";
  test_case.reference = {"the probe", "", judge::Standing::own};
  test_case.stimulus = "none";
  test_case.expected = "0x0001";
  test_case.tags = std::move(tags);
  test_case.catches = std::move(catches);
  return test_case;
}

void add_ends(SuiteOfFunctions& suite) {
  suite.add(named("odd/end/fails", {"odd"}), answering(Verdict::fail, "always"));
  suite.add(named("odd/end/warns", {"odd"}), answering(Verdict::warn, "odd_but_allowed"));
  suite.add(named("odd/end/is_inconclusive", {"odd"}), answering(Verdict::inconclusive, "too_close"));
  suite.add(named("odd/end/does_not_apply", {"odd"}), answering(Verdict::not_applicable, "no such option"));
  suite.add(named("odd/end/breaks", {"odd"}), [](const TestCase&, const Setup&) -> Outcome {
    FIELDPROOF_CHECK(false, "the probe breaks as it promised");
    return {};
  });
  suite.add(named("odd/end/fails_once", {"once"}), [](const TestCase&, const Setup& setup) {
    static std::atomic<unsigned> calls{0};
    return calls++ == 0 ? judged(setup, Verdict::fail, "first_time") : judged(setup, Verdict::pass);
  });
  suite.add(named("odd/end/never_repeats", {"odd"}), [](const TestCase&, const Setup& setup) {
    static std::atomic<std::uint64_t> calls{0};
    Outcome outcome = judged(setup, Verdict::pass);
    outcome.result.fingerprint = ++calls;
    if (setup.record)
      outcome.recording.trace.records.emplace_back(trace::Observation{0, kernel::kStart, "call", calls});
    return outcome;
  });
}

void add_slow(SuiteOfFunctions& suite) {
  for (int i = 0; i < 40; ++i) {
    suite.add(
        named(fmt::format("odd/slow/case_{:02}", i), {"slow"}), [i](const TestCase&, const Setup& setup) {
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
          return i % 4 == 1 ? judged(setup, Verdict::fail, "each_fourth") : judged(setup, Verdict::pass);
        });
  }
}

void add_items(SuiteOfFunctions& suite) {
  suite.add(judge::PicsItem{"x", judge::PicsKind::truth, "whether there is an x"});
  suite.add(judge::PicsItem{"n", judge::PicsKind::number, "how many n there are", 9});
  suite.add(judge::PicsItem{"s", judge::PicsKind::text, "what s is", 0, {"zero", "last"}});
  suite.set_last_position(8);
}

std::unique_ptr<SuiteOfFunctions> good_suite() {
  auto suite = std::make_unique<SuiteOfFunctions>("probe", std::vector<std::string>{"station"});
  suite->add({"swapped", "M1", "station", "swaps the octets of a word"});
  suite->add({"late", "M2", "station", "answers late"});
  add_items(*suite);
  for (const char* name : {"word_is_latched", "word_is_held", "word_is_cleared"}) {
    suite->add(named(fmt::format("probe/station/data/{}", name), {"must"}, {{"swapped", "wrong_word"}}),
               failing_on("swapped", "wrong_word"));
  }
  suite->add(named("probe/station/time/answer_is_in_time", {"must", "timing"}, {{"late", "late_answer"}}),
             failing_on("late", "late_answer"));
  suite->add(named("probe/station/canary", {"canary"}), answering(Verdict::fail, "canary"));
  return suite;
}

std::unique_ptr<SuiteOfFunctions> odd_suite() {
  auto suite = std::make_unique<SuiteOfFunctions>("odd", std::vector<std::string>{"end", "slow"});
  suite->add({"unseen", "M1", "end", "nothing catches it"});
  add_ends(*suite);
  add_slow(*suite);
  return suite;
}

std::unique_ptr<SuiteOfFunctions> gone_suite() {
  auto suite = std::make_unique<SuiteOfFunctions>("gone", std::vector<std::string>{"station"});
  suite->add({"unreachable", "M1", "station", "does not answer at all"});
  suite->add(named("gone/station/is_there"), failing_on("unreachable", "unreachable"));
  return suite;
}

// There is no line to disturb.
template <auto make>
std::unique_ptr<conformance::Suite> undisturbed(conformance::SuiteGiven) {
  return make();
}

}  // namespace

std::span<const ProtocolEntry> probe_protocols() {
  static constexpr std::array kProtocols{ProtocolEntry{"probe", {}, undisturbed<good_suite>},
                                         ProtocolEntry{"odd", {}, undisturbed<odd_suite>},
                                         ProtocolEntry{"gone", {}, undisturbed<gone_suite>}};
  return kProtocols;
}

}  // namespace fieldproof::cli
