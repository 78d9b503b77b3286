#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/running_case.hpp"
#include "conformance/sequence_families.hpp"
#include "conformance/suite.hpp"
#include "harness/field/pics.hpp"

// Rows of a suite for roles whose cases run on a bench.
//
// A `Setting` says who plays, and how: seed, volume, stresses and make_recorder; where the bench has them
// also pics, plan and make_device. A role is a `Kind`, see conformance/case_devices.hpp.
namespace fieldproof::conformance {

template <typename Case>
struct SequenceRow {
  const SequenceRole& (*role)();
  void (*run)(const Sequence&, typename Case::BenchType&, CaseJudge&);
  decltype(Case::needs) needs{};
};

// Cases on a bench, whoever plays.
template <typename Case, typename Setting, typename Dissector>
struct CaseRole {
  std::string_view name;
  const std::vector<Case>& (*cases)();
  // What is not the same for all benches.
  void (*adjust)(Setting&, RunningCase&) = nullptr;
  // Throws kernel::Error for a setup that the case cannot be run with.
  void (*check)(const Case&, const Setting&, const RunningCase&) = nullptr;
  judge::CaseResult (*run)(const Case&, const Setting&) = [](const Case& one, const Setting& setting) {
    return run_on_bench(one, setting);
  };
  // The answers of the setup, completed by those of the bench; null: nothing completes them.
  judge::Pics (*declared_pics)(const Case&, const Setting&) = nullptr;
  // What a PICS of the role may answer, and what is taken where it does not.
  std::vector<judge::PicsItem> (*pics_items)() = nullptr;
  judge::Pics (*usual_answers)() = nullptr;
  const field::AnyTable* settings = nullptr;
  // The items of its PICS are its settings: what a sequence begins with is declared.
  bool are_settings_declared = false;
  std::optional<SequenceRow<Case>> sequences{};
  std::optional<SequenceRow<Case>> more_sequences{};

  // The same but for who plays.
  Setting setting(RunningCase& run_of_case) const {
    Setting made;
    const Disturbances& disturbances = run_of_case.given().disturbances;
    made.seed = run_of_case.setup().seed;
    made.volume = run_of_case.setup().volume;
    made.stresses = disturbances.stresses;
    if constexpr (requires { made.link_stresses; }) made.link_stresses = &disturbances.link_stresses;
    if constexpr (requires { made.pics; }) made.pics = run_of_case.pics();
    if constexpr (requires { made.settings; }) {
      const field::Settings& given = run_of_case.settings();
      if (are_settings_declared && !given.empty()) {
        if (!made.pics) made.pics.emplace();
        field::declare_settings(*settings, given, *made.pics);
      } else {
        made.settings = given;
      }
    }
    if constexpr (requires { made.plan; }) made.plan = run_of_case.plan();
    if (run_of_case.is_recorded()) {
      made.make_recorder = [&run_of_case](const trace::Trace& trace, const auto& rules) {
        return &run_of_case.start_recorder(trace, std::make_shared<Dissector>(rules));
      };
    }
    if (adjust != nullptr) adjust(made, run_of_case);
    return made;
  }

  Case find(const TestCase& test_case) const {
    for (const Case& one : cases())
      if (one.test_case.id == test_case.id) return one;
    // One of sequences is none of `cases`, and has no procedure yet.
    Case blank{test_case, nullptr};
    if (sequences) blank.needs = sequences->needs;
    return blank;
  }
};

namespace bench_role {

// `play` puts an implementation into a setting.
template <typename Case, typename Setting, typename Dissector, typename Play>
RoleRow row_of(const CaseRole<Case, Setting, Dissector>& role, Play play) {
  RoleRow row;
  row.name = role.name;
  // Two roles of one bench may have one list of cases.
  for (const Case& one : role.cases())
    if (one.test_case.role() == role.name) row.cases.push_back(one.test_case);
  if (role.pics_items != nullptr) {
    row.pics_items = role.pics_items();
    row.usual_answers = role.usual_answers();
  }
  row.settings = role.settings;
  const auto run_case = [role, play](const Case& one, RunningCase& run, bool has_to_drive) {
    Setting setting = role.setting(run);
    play(setting, run);
    judge::CaseResult result = role.run(one, setting);
    if (has_to_drive) require_driven(one, setting, result);
    return result;
  };
  const auto run_sequences = [role, run_case](const Case& one, RunningCase& run) {
    return run_families(one,
                        {.vocabulary = role.sequences->role().vocabulary,
                         .seed = run.setup().seed,
                         .volume = run.setup().volume,
                         .sequences = run.setup().sequences,
                         .most_shrinking_commands = run.explains() ? kShrinkingCommands : 0},
                        [&](const Case& asked) { return run_case(asked, run, false); });
  };
  row.run = [role, run_case, run_sequences](const TestCase& test_case, RunningCase& run) {
    const Case one = role.find(test_case);
    Outcome outcome{one.families ? run_sequences(one, run) : run_case(one, run, true), {}};
    run.keep(outcome);
    return outcome;
  };
  row.check = [role](const TestCase& test_case, RunningCase& run) {
    const Setting setting = role.setting(run);
    if (role.check != nullptr) role.check(role.find(test_case), setting, run);
  };
  if (role.declared_pics != nullptr) {
    row.declared_pics = [role](const TestCase& test_case, RunningCase& run) -> std::optional<judge::Pics> {
      if (!run.pics()) return std::nullopt;
      return role.declared_pics(role.find(test_case), role.setting(run));
    };
  }
  const auto sequences_of = [run_case](const SequenceRow<Case>& made) -> RoleSequences {
    return {made.role(), [made, run_case](const Sequence& sequence, RunningCase& run) {
              Case one{run.test_case(), nullptr, made.needs};
              one.procedure = [&](auto& bench, CaseJudge& judge) {
                if (!sequence.settings.empty())
                  judge.begin_step("with " + settings_text(sequence.settings, made.role().vocabulary));
                made.run(sequence, bench, judge);
              };
              // Who searches counts the silent ones.
              return run_case(one, run, false);
            }};
  };
  if (role.sequences) row.sequences = sequences_of(*role.sequences);
  if (role.more_sequences) row.more_sequences = sequences_of(*role.more_sequences);
  return row;
}

}  // namespace bench_role

// A role whose cases bring all players along.
template <typename Case, typename Setting, typename Dissector>
RoleRow row_of(const CaseRole<Case, Setting, Dissector>& role) {
  return bench_role::row_of(role, [](Setting&, RunningCase&) {});
}

// Who can play a role in the program itself.
template <typename Kind>
struct Stations {
  using Configuration = typename Kind::Configuration;

  std::string_view what;  // "INTERBUS slave"
  const DeviceMutants<typename Kind::Device, Configuration>& (*mutants)();
  // That implementations are tried out with.
  Configuration (*configuration)() = [] { return Configuration{}; };
};

// A role in which one implementation is judged.
template <typename Kind, typename Reference, typename Case, typename Setting, typename Dissector>
RoleRow row_of(const Stations<Kind>& stations, const CaseRole<Case, Setting, Dissector>& role) {
  const auto maker = [stations](const std::string& uri, RunningCase& run) {
    return run.maker<Kind, Reference>(uri, stations.mutants(), stations.what);
  };
  RoleRow row = bench_role::row_of(role, [maker](Setting& setting, RunningCase& run) {
    setting.make_device = maker(run.assigned().uri, run);
  });
  row.mutants = stations.mutants().mutants();
  row.try_out = [stations, maker](const std::string& uri, RunningCase& run) {
    maker(uri, run)(stations.configuration());
  };
  return row;
}

}  // namespace fieldproof::conformance
