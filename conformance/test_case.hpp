#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/sequence.hpp"
#include "harness/fault/plan_part.hpp"
#include "harness/field/named_table.hpp"
#include "harness/iut/limits.hpp"
#include "harness/judge/finding.hpp"
#include "harness/judge/pics.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

// One test case, one mutant, and the suite of a protocol that runs a case against an implementation.
// There is one definition of a case: the command line, GoogleTest and the matrix all use it.
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

struct TestCase {
  std::string id;       // "interbus/slave/data_cycle/weight_four_codeword_is_accepted"; never reused
  std::string purpose;  // the label of the test purpose, "IS-14"
  std::string requirement;
  judge::Reference reference;
  std::vector<PartialSource> details{};
  std::string stimulus;
  std::string expected;
  std::vector<std::string> tags;  // "must", "timing", "long", "canary" ...
  std::vector<MustCatch> catches;
  // Roles of implementations that the case judges besides its own: those of the parts of a network.
  std::vector<std::string> parts{};
  // Nothing, or the sentence that says why the case does not apply to such an implementation.
  std::function<std::optional<std::string>(const judge::Pics&)> not_applicable{};

  std::string role() const;  // second part of the id
  // What a finding with this reason rests on.
  const judge::Reference& reference_of(std::string_view reason) const;
  // What a pass rests on: the case's own source and every detail, because a failure in either would be one of
  // the case. The weakest standing decides.
  judge::Reference rests_on() const;
};

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
  Volume volume = Volume::full;
  iut::PeerLimits limits{};  // of implementations in other processes
  bool record = false;       // keep the trace and what the implementations did (bounded) in the outcome
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

// A role that has commands and a model.
struct SequenceRole {
  TestCase test_case;  // "valve_bus/node/check/follows_the_model"
  SequenceVocabulary vocabulary;
};

// A protocol's suite. `run` never throws for a misbehaving implementation: that is a verdict. It throws
// kernel::Error for a setup that cannot be served, naming what would be right.
class Suite {
 public:
  Suite() = default;
  Suite(const Suite&) = delete;
  Suite& operator=(const Suite&) = delete;
  virtual ~Suite() = default;

  virtual std::string_view protocol() const = 0;
  virtual std::vector<std::string> roles() const = 0;
  virtual const std::vector<TestCase>& cases() const = 0;
  virtual const std::vector<Mutant>& mutants() const = 0;
  virtual Outcome run(const TestCase& test_case, const Setup& setup) const = 0;

  // Whether the program brought an implementation of this role along, with the URI `own`.
  virtual bool has_own(std::string_view /*role*/) const { return false; }
  // The farthest position of a role on a network of the suite's own.
  virtual int last_position() const { return 1; }
  // What a PICS of this protocol may answer.
  virtual std::vector<judge::PicsItem> pics_items() const { return {}; }
  // The settings of each role, by its name, and the numbers of the protocol as "rules".
  virtual std::vector<field::NamedTable> tables() const { return {}; }
  // Of the files that describe an installation of this protocol.
  virtual std::vector<field::NamedSchema> schemas() const { return {}; }
  // The answers of the setup, completed by what the suite takes for granted; nothing when the setup has none.
  virtual std::optional<judge::Pics> declared_pics(const TestCase&, const Setup& setup) const {
    return setup.pics;
  }
  // What a report must say about all results under this setup; sentences.
  virtual std::vector<std::string> caveats(const Setup&) const { return {}; }
  // The parts of the setup's plan of faults, in the order in which results count their hits.
  virtual std::vector<fault::PlanPart> plan_parts(const Setup&) const { return {}; }
  // What `check` draws sequences of, by role.
  virtual std::span<const SequenceRole> sequence_roles() const { return {}; }
  // One run of a sequence of one of these roles on a bench of its own, judged by the model of the role; as
  // for `run`, the seed of the setup is that of the case.
  virtual Outcome run_sequence(const SequenceRole& role, const Sequence& sequence, const Setup& setup) const;

  // Throws the kernel::Error of `run` for files and places of this setup, without running anything.
  virtual void check(const TestCase&, const Setup&) const {}
};

}  // namespace fieldproof::conformance
