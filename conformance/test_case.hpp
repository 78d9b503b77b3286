#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/derived_sequences.hpp"
#include "conformance/sequence.hpp"
#include "harness/iut/limits.hpp"
#include "harness/judge/finding.hpp"
#include "harness/judge/pics.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

// One test case, one mutant, and what decides a run of a case and comes of it (conformance/suite.hpp makes
// it). There is one definition of a case: the command line, GoogleTest and the matrix all use it.
namespace fieldproof::iut {
class DeviceRecording;
}

namespace fieldproof::conformance {

// A mutant that a case must catch, and the reason code of the finding that proves that it was caught for
// the right cause.
struct MustCatch {
  std::string mutant;
  std::string reason;
};

// A part of what a case requires that has a source of its own, usually a weaker one than the case: findings
// with one of these reasons rest on it instead.
struct PartialSource {
  judge::Reference reference;
  std::vector<std::string> reasons;
};

// What the page requires where an implementation differs for this reason, in one sentence: the requirement of
// a finding of a case that is about everything at once.
struct ReasonRule {
  std::string_view reason;
  std::string_view rule;
};

struct TestCase {
  std::string id;       // "PROTOCOL/ROLE/data_cycle/weight_four_codeword_is_accepted"; never reused
  std::string purpose;  // the label of the test purpose, "IS-14"
  std::string requirement;
  judge::Reference reference;
  std::vector<PartialSource> details{};
  std::span<const ReasonRule> rules{};  // must outlive the case; may be none
  std::string stimulus{};
  std::string expected{};
  std::vector<std::string> steps{};  // where the case is a sequence, see conformance/chart.hpp
  std::vector<std::string> tags;     // "must", "timing", "long", "canary" ...
  std::vector<MustCatch> catches;
  // Roles of implementations that the case judges besides its own: those of the parts of a network.
  std::vector<std::string> parts{};
  // Nothing, or the sentence that says why the case does not apply to such an implementation.
  std::function<std::optional<std::string>(const judge::Pics&)> not_applicable{};

  std::string role() const;  // second part of the id
  // What a finding with this reason says is required: its rule, else the requirement of the case.
  std::string_view requirement_of(std::string_view reason) const;
  // What a finding with this reason rests on.
  const judge::Reference& reference_of(std::string_view reason) const;
  // What a pass rests on: the case's own source and every detail, because a failure in either would be one of
  // the case. The weakest standing decides.
  judge::Reference rests_on() const;
};

// A case about what an implementation must do; stimulus, expected and steps come from its chart.
TestCase must_case(std::string id, std::string purpose, std::string requirement, judge::Reference reference,
                   std::vector<MustCatch> catches, std::vector<PartialSource> details = {});

// Adds the details to the case, but for reasons that details of its own are about.
void rest_also_on(TestCase& test_case, const std::vector<PartialSource>& details);

bool has_tag(const TestCase& test_case, std::string_view tag);

// A case that must fail on every implementation, to show that a failure is seen at all.
bool is_canary(const TestCase& test_case);

// The reference station with one decision, or one number, changed.
struct Mutant {
  std::string name;   // "crc_preset_zero"
  std::string label;  // of the specification's list, "MS1"; may be empty
  std::string role;   // "slave"
  std::string description;
  bool is_for_check = false;  // shows in sequences only: `check` must find it, and the matrix leaves it out
};

// Who plays a role: "slave@3=mutant:crc_preset_zero".
struct Assignment {
  std::string role;  // empty: the role of the case
  int position = 0;  // 1 is next to the master; 0: the protocol's default
  std::string uri = "ref";
};

// How many repetitions a case makes: `full` is what the test purpose prints; `quick` keeps every kind of
// stimulus and shortens the long repetitions (used by the matrix and under sanitizers).
enum class Volume { quick, full };

std::string_view name(Volume volume);

// Everything that decides the outcome of a case, besides the case itself.
struct Setup {
  std::uint64_t seed = 1;
  std::vector<Assignment> implementations;
  std::string network_file;  // empty: the suite's own network
  std::string plan_file;     // additional declared faults; empty: none
  std::optional<judge::Pics> pics;
  field::Settings settings{};  // of a sequence
  Volume volume = Volume::full;
  std::optional<std::size_t> sequences{};  // of each case that has some; nothing: as many as the volume says
  iut::PeerLimits limits{};                // of implementations in other processes
  bool explains = true;  // of sequences that fail: the smallest, and what decides; false: the verdict only
  bool record = false;   // keep the trace and what the implementations did (bounded) in the outcome
  // The implementations of this program are called as those outside are, too: what can be recorded of them,
  // and played back, is the same to the bit.
  bool as_device = false;
  std::string
      playback_file{};  // what a run recorded of them plays the implementations; empty: they are there
};

// A record of everything on the line and at the upper tester, for replay and for people.
struct Recording {
  trace::Recording trace;
  std::shared_ptr<const trace::Dissector> dissector;    // of the protocol on these lines; null: not known
  std::shared_ptr<const iut::DeviceRecording> devices;  // what the implementations did; null: not kept
  bool truncated = false;                               // a bound was reached

  const trace::Dissector& told_in() const;
  // One line for each record, in one dissector for people and programs.
  std::vector<std::string> lines() const { return trace::text_lines(trace, told_in()); }
};

struct Outcome {
  judge::CaseResult result;
  Recording recording;
  bool happens_once = false;  // on a real line: a second run is another one, and has another fingerprint
};

// A mutant that a case of derived sequences must catch.
struct DerivedCatch {
  DerivedKind kind;
  MustCatch caught;
};

// A role that has commands and a model.
struct SequenceRole {
  TestCase test_case;  // "PROTOCOL/ROLE/check/follows_the_model"
  SequenceVocabulary vocabulary;
  std::vector<DerivedCatch> derived_catches{};
  // How many times as long as usual a sequence takes: a quick run has so many fewer derived ones.
  std::size_t cost = 1;
  // How many states of its reference walks look for. A station that acts by itself is in another state at
  // each instant, and has more than can be visited.
  std::size_t most_states = 60;
};

}  // namespace fieldproof::conformance
