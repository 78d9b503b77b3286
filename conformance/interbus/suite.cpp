#include "conformance/interbus/suite.hpp"
#include "conformance/interbus/slave_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

#include "conformance/case_recorder.hpp"
#include "conformance/interbus/master_cases.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/master_sequence.hpp"
#include "conformance/interbus/network_bench.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/cycle_dissector.hpp"
#include "protocols/interbus/embedded_schemas.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/master_settings.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

[[noreturn]] void refuse(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

fault::Plan load_plan(const Setup& setup, const interbus::Rules& rules, const InterbusGiven& given) {
  return fault::load_plan(setup.plan_file, {.telegrams = &line::shared_telegram_code(rules.telegram),
                                            .disturbances = given.disturbances});
}

// What a run needs besides its case: the assignment of the case's role, the files that are named, and the two
// recorders. Made anew for each run, so runs share nothing.
class Run {
 public:
  Run(const TestCase& test_case, const Setup& setup, const InterbusGiven& given)
      : test_case_(test_case), setup_(setup), given_(given), devices_(test_case, setup, given.attach) {
    if (!setup.network_file.empty()) network_ = interbus::NetworkDescription::load(setup.network_file);
    if (!setup.plan_file.empty()) {
      plan_ = load_plan(setup, network_ ? network_->rules : interbus::Rules{}, given);
    }
    assigned_ = assigned_to(test_case, setup);
  }

  // Throw for a setup that the cases of the role cannot be run with.
  void check(const SlaveCase& slave_case);
  void check(const MasterCase& master_case);
  void check(const NetworkCase& network_case);
  judge::Pics pics(const SlaveCase& slave_case);
  // Makes each implementation once, before anything is judged.
  void try_out();

  Outcome run(const SlaveCase& slave_case);
  Outcome run(const MasterCase& master_case);
  Outcome run(const NetworkCase& network_case);

 private:
  using MakeSlave =
      std::function<std::unique_ptr<interbus::SlaveDevice>(const interbus::SlaveConfiguration&)>;
  using MakeMaster =
      std::function<std::unique_ptr<interbus::MasterDevice>(const interbus::MasterConfiguration&)>;
  MakeSlave slave_maker(const std::string& uri);
  MakeMaster master_maker(const std::string& uri);
  SlaveSetting slave_setting();
  interbus::NetworkDescription network() const;
  NetworkParts network_parts(std::size_t stations);
  void finish(Outcome& outcome, const trace::Trace& trace, kernel::Time now) const;
  trace::Recorder& recorder_of(const trace::Trace& trace, const interbus::Rules& rules);
  void keep(Outcome& outcome);

  const TestCase& test_case_;
  const Setup& setup_;
  const InterbusGiven& given_;
  Assignment assigned_;
  std::optional<interbus::NetworkDescription> network_;
  fault::Plan plan_;
  CaseDevices devices_;
  CaseRecorder recorder_;
};

// Each slave is one of its own, also of an implementation outside.
Run::MakeSlave Run::slave_maker(const std::string& uri) {
  return [this, uri](const interbus::SlaveConfiguration& configuration) {
    return devices_.make<interbus::SlaveRole>(
        uri, configuration,
        [this, uri](const interbus::SlaveConfiguration& of) -> std::unique_ptr<interbus::SlaveDevice> {
          if (uri == kReferenceUri) return std::make_unique<interbus::Slave>(of);
          if (uri == kOwnUri && given_.own_slave) return given_.own_slave(devices_.request(uri), of);
          return make_slave_mutant(mutant_of(uri, "INTERBUS slave"), of);
        });
  };
}

Run::MakeMaster Run::master_maker(const std::string& uri) {
  return [this, uri](const interbus::MasterConfiguration& configuration) {
    return devices_.make<interbus::MasterRole>(uri, configuration, [this, uri](const auto& of) {
      if (uri == kOwnUri && given_.own_master) return given_.own_master(devices_.request(uri), of);
      return conformance::make_master(uri)(of);
    });
  };
}

void Run::finish(Outcome& outcome, const trace::Trace& trace, kernel::Time now) const {
  outcome.result.purpose = test_case_.purpose;
  outcome.result.seed = setup_.seed;
  outcome.result.fingerprint = trace.fingerprint();
  outcome.result.virtual_time = now - kernel::kStart;
}

trace::Recorder& Run::recorder_of(const trace::Trace& trace, const interbus::Rules& rules) {
  return recorder_.start(trace, std::make_shared<interbus::CycleDissector>(rules));
}

void Run::keep(Outcome& outcome) {
  recorder_.keep(outcome);
  devices_.keep(outcome);
}

void Run::try_out() {
  if (devices_.is_played_back()) return;
  for (const Assignment& assignment : setup_.implementations) {
    const std::string role = assignment.role.empty() ? test_case_.role() : assignment.role;
    if (role == "slave") slave_maker(assignment.uri)({});
    if (role == "master") master_maker(assignment.uri)({});
  }
}

SlaveSetting Run::slave_setting() {
  SlaveSetting setting;
  setting.make_slave = slave_maker(assigned_.uri);
  setting.position = assigned_.position == 0 ? 1 : assigned_.position;
  setting.stations = setting.position;
  setting.network = network_;
  setting.plan = plan_;
  setting.seed = setup_.seed;
  setting.volume = setup_.volume;
  setting.pics = setup_.pics;
  setting.stresses = given_.stresses;
  return setting;
}

// A case for a slave judges one; a second one would stand in the ring and never be looked at.
void Run::check(const SlaveCase& slave_case) {
  const auto is_slave = [](const Assignment& one) { return one.role.empty() || one.role == "slave"; };
  const auto count = std::count_if(setup_.implementations.begin(), setup_.implementations.end(), is_slave);
  if (count > 1) {
    refuse(
        fmt::format("the cases for a slave judge one slave, {} are given; leave one of them, or select the "
                    "cases for a network ('interbus/network/**')",
                    count));
  }
  slave_network(slave_case.needs, slave_setting());
}

judge::Pics Run::pics(const SlaveCase& slave_case) {
  SlaveSetting setting = slave_setting();
  setting.make_slave = nullptr;
  return SlaveBench(slave_case.needs, setting).pics();
}

Outcome Run::run(const SlaveCase& slave_case) {
  SlaveSetting setting = slave_setting();
  if (setup_.record) {
    setting.make_recorder = [this](const trace::Trace& trace, const interbus::Rules& rules) {
      return &recorder_of(trace, rules);
    };
  }
  Outcome outcome;
  outcome.result = run_slave_case(slave_case, setting);
  outcome.result.purpose = test_case_.purpose;
  keep(outcome);
  return outcome;
}

void Run::check(const MasterCase&) {
  if (network_) refuse("cases for a master make the rings that they need; leave out the network");
  if (!plan_.empty()) refuse("cases for a master bring their own faults; leave out the plan");
}

Outcome Run::run(const MasterCase& master_case) {
  check(master_case);
  MasterBench bench(master_maker(assigned_.uri), setup_.seed, setup_.volume,
                    setup_.pics.value_or(judge::Pics{}), given_.stresses);
  if (setup_.record) {
    bench.segment().trace().set_recorder(&recorder_of(bench.segment().trace(), bench.rules()));
  }
  CaseJudge judge(test_case_);
  judge.use_clock([&] { return bench.now(); });
  Outcome outcome;
  outcome.result = judge.run_procedure([&](CaseJudge& j) {
    master_case.procedure(bench, j);
    bench.line_watch().judge(j);
    bench.finish();
  });
  finish(outcome, bench.segment().trace(), bench.now());
  keep(outcome);
  return outcome;
}

NetworkParts Run::network_parts(std::size_t stations) {
  NetworkParts parts;
  std::map<int, MakeSlave> slaves;
  for (const Assignment& assignment : setup_.implementations) {
    if (assignment.uri == kReferenceUri) continue;
    if (assignment.role == "slave") {
      slaves[assignment.position == 0 ? 1 : assignment.position] = slave_maker(assignment.uri);
    } else if (assignment.role == "master") {
      parts.make_master = master_maker(assignment.uri);
    } else {
      parts = mutant_network(mutant_of(assignment.uri, "INTERBUS network"), stations);
    }
  }
  if (slaves.empty()) return parts;
  if (slaves.rbegin()->first > static_cast<int>(stations)) {
    refuse(fmt::format("there is no slave at position {}; the network has {}", slaves.rbegin()->first,
                       stations));
  }
  parts.make_slave = [slaves](int position, const interbus::SlaveConfiguration& configuration) {
    const auto assigned = slaves.find(position);
    return assigned == slaves.end() ? nullptr : assigned->second(configuration);
  };
  return parts;
}

// A coupler with an input and an output terminal behind it, and a station of two words: the least network
// that has everything.
interbus::NetworkDescription small_network() {
  using interbus::StationDescription;
  interbus::NetworkDescription network;
  network.name = "coupler, two terminals, station of two words";
  StationDescription coupler{
      .name = "coupler", .id_code = 0x0008, .cable_m = 0, .is_local = false, .branch = {}};
  coupler.branch.push_back(
      {.name = "inputs", .id_code = 0x01BE, .cable_m = 0, .is_local = true, .branch = {}});
  coupler.branch.push_back(
      {.name = "outputs", .id_code = 0x01BD, .cable_m = 0, .is_local = true, .branch = {}});
  network.stations.push_back(coupler);
  network.stations.push_back(
      {.name = "station", .id_code = 0x0203, .cable_m = 0, .is_local = false, .branch = {}});
  network.copy.push_back({.from = "inputs", .input_word = 0, .to = "outputs", .output_word = 0});
  return network;
}

interbus::NetworkDescription Run::network() const {
  return network_ ? *network_ : small_network();
}

void Run::check(const NetworkCase&) {
  network_parts(interbus::ring_order(network()).size());
}

Outcome Run::run(const NetworkCase& network_case) {
  check(network_case);
  const interbus::NetworkDescription network = this->network();
  // Made within the procedure: what an implementation does when it is powered is its verdict, too.
  std::optional<NetworkBench> bench;
  CaseJudge judge(test_case_);
  judge.use_clock([&] { return bench ? bench->segment().now() : kernel::kStart; });
  Outcome outcome;
  outcome.result = judge.run_procedure([&](CaseJudge& j) {
    bench.emplace(network, network_parts(interbus::ring_order(network).size()), plan_, setup_.seed,
                  setup_.volume, given_.stresses);
    if (setup_.record) {
      bench->segment().trace().set_recorder(&recorder_of(bench->segment().trace(), network.rules));
    }
    network_case.procedure(*bench, j);
    bench->line_watch().judge(j);
    bench->finish();
  });
  if (!bench) return outcome;
  finish(outcome, bench->segment().trace(), bench->segment().now());
  outcome.result.planned_hits = bench->planned_hits();
  keep(outcome);
  return outcome;
}

class InterbusSuite final : public Suite {
 public:
  explicit InterbusSuite(InterbusGiven given) : given_(std::move(given)) {
    const auto add = [&](const auto& cases) {
      for (const auto& one : cases) {
        if (given_.stresses.empty() && has_tag(one.test_case, kStressTag)) continue;
        cases_.push_back(one.test_case);
        runs_[one.test_case.id] = [&one](Run& run) { return run.run(one); };
        checks_[one.test_case.id] = [&one](Run& run) { run.check(one); };
      }
    };
    for (const SlaveCase& one : slave_cases()) slave_cases_[one.test_case.id] = &one;
    add(slave_cases());
    add(master_cases());
    add(network_cases());
    checks_[blank_sequence_case().test_case.id] = [](Run& run) { run.check(blank_sequence_case()); };
    checks_[master_sequence_role().test_case.id] = [](Run& run) { run.check(MasterCase{}); };
    for (const auto* list : {&slave_mutants(), &master_mutants(), &network_mutants()}) {
      std::ranges::copy_if(*list, std::back_inserter(mutants_),
                           [&](const Mutant& one) { return !only_left_out_cases_name(one); });
    }
  }

  std::string_view protocol() const override { return "interbus"; }
  std::vector<std::string> roles() const override { return {"slave", "master", "network"}; }
  bool has_own(std::string_view role) const override {
    return role == "slave" ? bool(given_.own_slave) : role == "master" && bool(given_.own_master);
  }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Mutant>& mutants() const override { return mutants_; }

  int last_position() const override { return static_cast<int>(interbus::Rules{}.max_stations); }
  std::vector<judge::PicsItem> pics_items() const override {
    std::vector<judge::PicsItem> items = slave_pics_items();
    for (judge::PicsItem& item : master_pics_items()) items.push_back(std::move(item));
    return items;
  }
  std::vector<field::NamedTable> tables() const override {
    return {{"slave", &interbus::kSlaveTable},
            {"master", &interbus::kMasterTable},
            {"rules", &interbus::kRulesTable}};
  }
  std::vector<field::NamedSchema> schemas() const override { return {{"network", interbus::network_schema}}; }
  std::optional<judge::Pics> declared_pics(const TestCase& test_case, const Setup& setup) const override {
    const auto slave_case = slave_cases_.find(test_case.id);
    if (!setup.pics || slave_case == slave_cases_.end()) return setup.pics;
    return Run(test_case, setup, given_).pics(*slave_case->second);
  }

  // These do not depend on how the network writes its telegrams.
  std::vector<std::string> caveats(const Setup& setup) const override {
    if (setup.plan_file.empty()) return {};
    return load_plan(setup, interbus::Rules{}, given_).caveats();
  }

  std::vector<fault::PlanPart> plan_parts(const Setup& setup) const override {
    if (setup.plan_file.empty()) return {};
    return load_plan(setup, interbus::Rules{}, given_).parts();
  }

  void check(const TestCase& test_case, const Setup& setup) const override {
    Run one(test_case, setup, given_);
    checks_.at(test_case.id)(one);
    one.try_out();
  }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    Run one(test_case, setup, given_);
    return runs_.at(test_case.id)(one);
  }

  std::span<const SequenceRole> sequence_roles() const override {
    static const std::array roles{slave_sequence_role(), master_sequence_role()};
    return roles;
  }
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence,
                       const Setup& setup) const override {
    if (role.test_case.role() == "master") {
      const auto play = [&sequence](MasterBench& bench, CaseJudge& judge) {
        run_master_sequence(sequence, bench, judge);
      };
      return Run(role.test_case, setup, given_).run(MasterCase{role.test_case, play});
    }
    const auto procedure = [&sequence](SlaveBench& bench, CaseJudge& judge) {
      run_slave_sequence(sequence, bench, judge);
    };
    return Run(role.test_case, setup, given_).run(SlaveCase{role.test_case, procedure});
  }

 private:
  // Networks that only bursts tell are no hole of a suite that was given none.
  bool only_left_out_cases_name(const Mutant& mutant) const {
    const auto names = [&](const TestCase& one) {
      return one.role() == mutant.role && std::ranges::any_of(one.catches, [&](const MustCatch& caught) {
               return caught.mutant == mutant.name;
             });
    };
    return std::ranges::none_of(cases_, names) &&
           std::ranges::any_of(network_cases(), [&](const NetworkCase& one) { return names(one.test_case); });
  }

  // What a setup is looked at with before the first sequence.
  static const SlaveCase& blank_sequence_case() {
    static const SlaveCase blank{slave_sequence_role().test_case, nullptr};
    return blank;
  }

  InterbusGiven given_;
  std::vector<TestCase> cases_;
  std::vector<Mutant> mutants_;
  std::map<std::string, std::function<Outcome(Run&)>, std::less<>> runs_;
  std::map<std::string, std::function<void(Run&)>, std::less<>> checks_;
  std::map<std::string, const SlaveCase*, std::less<>> slave_cases_;
};

}  // namespace

std::unique_ptr<Suite> interbus_suite(InterbusGiven given) {
  return std::make_unique<InterbusSuite>(std::move(given));
}

}  // namespace fieldproof::conformance
