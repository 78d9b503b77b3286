#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/burst_options.hpp"
#include "cli/emc_beside.hpp"
#include "cli/emc_case.hpp"
#include "cli/emc_fit.hpp"
#include "cli/emc_json.hpp"
#include "cli/emc_run.hpp"
#include "cli/emc_search.hpp"
#include "cli/emc_tests.hpp"
#include "cli/emc_text.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/networks.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "conformance/ordered_work.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

// `fieldproof emc`: a network under bursts of each level, repetition and polarity.
namespace fieldproof::cli {
namespace {

// On a channel of the textbooks wrong data are no failure, more of them than the theory allows are, and so is
// a network that does not work again.
bool is_failure(const EmcTest& test, std::size_t worst_allowed) {
  constexpr double kRefuted = 1e-3;
  if (!test.result.came_up) return false;
  if (test.has_bursts()) return static_cast<std::size_t>(test.result.criterion) > worst_allowed;
  const bool works_again = test.result.recovered_by_itself || test.result.recovered_after_start;
  return (test.has_theory() && test.chance_of_count() < kRefuted) || !works_again;
}

// Runs the tests over the threads; a test is told when all before it are done.
class Campaign {
 public:
  explicit Campaign(Session& session)
      : session_(session),
        interruption_(session.settings.duration("max-time")),
        row_(network_entry_of(session, "emc")) {
    const Settings& settings = session.settings;
    stored_.protocol = &row_;
    stored_.request = network_request(session, row_);
    stored_.network = row_.network.plan(stored_.request);
    if (row_.network.has_latch_models) stored_.latch = settings.text("latch");
    network_ = stored_.network.get();
    references_ = plan_references(row_, stored_.request);
    done_.protocol = row_.name;
    done_.network = network_->name();
    done_.exchange = network_->exchange();
    const std::string players = players_of(stored_.request.implementations);
    done_.implementations = players.empty() ? conformance::kReferenceUri : players;
    done_.profile = settings.origin("profile") == Origin::fallback
                        ? emc::Profile::named(network_->default_profile())
                        : profile_from(settings);
    done_.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
    done_.duration = stored_.duration = virtual_time_from(settings);
    stored_.bursts.profile = done_.profile;
    done_.worst = stored_.worst = static_cast<emc::Criterion>(settings.choice("worst"));
    done_.has_bursts = wants_bursts(settings);
    for (const char* option : {"search", "sensitivity"}) {
      if (!done_.has_bursts && settings.is_set(option) && is_typed(settings, option))
        settings.refuse(option, "a channel has no voltage; leave one of them out");
    }
    is_searching_ =
        done_.has_bursts && (settings.is_set("search") || settings.origin("test-levels") == Origin::fallback);
    if (!row_.undetected.caveat.empty()) done_.channel_caveats.emplace_back(row_.undetected.caveat);
    network_->make(done_.seed);  // who cannot take part ends the call, and is no verdict
    planned_ = tests_from(settings, done_.has_bursts);
    for (EmcTest& test : planned_) {
      if (test.has_bursts() || row_.undetected.parts == nullptr) continue;
      test.undetected = row_.undetected.parts(settings.text("network"), test.flip_probability);
    }
    if (settings.is_set("out")) prepare_folder(settings.text("out"));
  }

  void run() {
    const emc::LineResponse response(done_.profile.coupling);
    done_.threshold_volts = response.threshold_volts();
    session_.terminal.print(
        simulation_header(session_, done_.seed, session_.settings.text("network"), row_.network.own_network));
    session_.terminal.print(players_text(stored_.request.implementations));
    if (const std::string complaint = complaint_on_quiet_line(); !complaint.empty())
      return end_without_bursts(complaint);
    search(response);
    session_.terminal.print(emc_table_head(done_.has_bursts));
    conformance::OrderedWork<Ran> work;
    work.count = planned_.size();
    work.threads = jobs_from(session_.settings);
    work.stop = interruption_.token();
    work.work = [&](std::size_t n) { return run_beside(response, case_of(planned_[n])); };
    work.deliver = [&](std::size_t n, Ran&& ran) {
      if (!ran.result.is_complete || (ran.reference && !ran.reference->is_complete)) return false;
      planned_[n].result = std::move(ran.result);
      planned_[n].reference = std::move(ran.reference);
      if (!planned_[n].has_bursts()) planned_[n].bound_by(ran.frames);
      done_.tests.push_back(planned_[n]);
      if (done_.places.empty()) describe(ran);
      session_.terminal.print(emc_line(done_.tests.back()));
      if (!folder_.empty()) store(response, planned_[n], n + 1);
      return true;
    };
    work.idle = [&](std::size_t finished) { session_.terminal.progress(finished); };
    session_.terminal.begin_progress(planned_.size(), "tests");
    const std::size_t delivered = work.run();
    session_.terminal.end_progress();
    done_.is_complete = delivered == planned_.size() && done_.tests.size() == planned_.size();
    add_worst_probe(response);
    add_to_search();
    add_pulse(response);
    if (const std::string hint = emc_hint(done_); !hint.empty())
      session_.terminal.print(fmt::format("hint: {}\n", hint));
    if (!done_.has_bursts || !session_.settings.is_set("sensitivity") || !done_.is_complete) return;
    const auto highest = std::ranges::max_element(
        planned_, {}, [](const EmcTest& test) { return test.level.open_circuit_volts(); });
    done_.sensitivity = search_sensitivity(probing(), done_.profile.coupling, highest->level);
    session_.terminal.print(sensitivity_text(*done_.sensitivity));
  }

  const EmcCampaign& result() const { return done_; }
  const Interruption& interruption() const { return interruption_; }

 private:
  // A test, and what its network is like.
  struct Ran {
    emc::ImmunityResult result;
    std::optional<emc::ImmunityResult> reference;
    std::vector<EmcPlace> places;
    network::RecoveryLimit recovery;
    network::AcceptanceRules acceptance;
    std::vector<network::ProtectedFrame> frames;
  };

  // Of a network with implementations; one that misbehaves does so in the first test, too.
  std::string complaint_on_quiet_line() const {
    if (!references_) return {};
    try {
      return emc::complaint_on_quiet_line(*network_->make(done_.seed), done_.seed, interruption_.token());
    } catch (const iut::Misbehaviour&) {
      return {};
    }
  }

  // What is wrong without bursts is no effect of theirs.
  void end_without_bursts(const std::string& complaint) {
    session_.terminal.print(emc_table_head(done_.has_bursts));
    for (const EmcTest& planned : planned_) {
      EmcTest& test = done_.tests.emplace_back(planned);
      test.result.complaint = complaint;
      session_.terminal.print(emc_line(test));
    }
    done_.is_complete = true;
  }

  Ran run_one(const emc::LineResponse& response, const EmcCase& test) const {
    Ran ran;
    const emc::ImmunitySettings settings = immunity_settings(test, interruption_.token());
    try {
      const std::unique_ptr<network::Network> network = test.network->make(test.seed);
      for (const network::Place& place : network->places()) {
        ran.places.push_back({place.name, place.is_exposed, std::string(place.why_not),
                              kernel::kSecond / place.level_rate, place.sampling});
      }
      ran.recovery = network->recovery_limit();
      ran.acceptance = network->acceptance();
      ran.frames = network->protected_frames();
      ran.result = emc::run_immunity(*network, response, settings);
    } catch (const iut::Misbehaviour& misbehaviour) {
      ran.result = end_by(misbehaviour);
    }
    return ran;
  }

  EmcCase with_references(EmcCase test) const {
    test.network = references_;
    return test;
  }

  Ran run_beside(const emc::LineResponse& response, const EmcCase& test) const {
    Ran ran = run_one(response, test);
    if (references_ && test.flip_probability == 0 && ran.result.is_complete)
      ran.reference = run_one(response, with_references(test)).result;
    return ran;
  }

  // Signal ports are tested up to 2 kV, and the others up to 4 kV.
  void search(const emc::LineResponse& response) {
    if (!is_searching_) return;
    double top = emc::Level::standard(emc::PortKind::power, 4).open_circuit_volts();
    for (const EmcTest& test : planned_) top = std::max(top, test.level.open_circuit_volts());
    EmcProbing probes = probing();
    probes.note = [this](const EmcCase& test, const emc::ImmunityResult& result) {
      note_probe(test, result);
    };
    done_.search = search_thresholds(probes, response, top);
    if (references_) {
      probes.note = nullptr;
      for (EmcCase& test : probes.tests) test = with_references(test);
      done_.search->references = search_thresholds(probes, response, top).thresholds;
    }
    session_.terminal.print(search_text(*done_.search));
  }

  // The worst of the voltages that the table reaches.
  void note_probe(const EmcCase& probe, const emc::ImmunityResult& result) {
    const emc::BurstSettings& bursts = probe.bursts.settings;
    const auto reaches = [&](const EmcTest& test) {
      return test.level.open_circuit_volts() >= bursts.level.open_circuit_volts();
    };
    if (std::ranges::none_of(planned_, reaches)) return;
    if (worst_probe_ && worst_probe_->result.criterion >= result.criterion) return;
    worst_probe_.emplace();
    worst_probe_->level = bursts.level;
    worst_probe_->repetition = bursts.repetition;
    worst_probe_->polarity = bursts.polarity;
    worst_probe_->of_search = {probe.duration, probe.seed};
    worst_probe_->result = result;
  }

  // A probe is a test: where it saw what no test of the table shows it stands among them, and is judged.
  void add_worst_probe(const emc::LineResponse& response) {
    const auto is_as_bad = [&](const EmcTest& test) {
      return test.result.came_up && test.result.criterion >= worst_probe_->result.criterion;
    };
    if (!worst_probe_ || std::ranges::any_of(done_.tests, is_as_bad)) return;
    if (references_) {
      emc::ImmunityResult reference = run_one(response, with_references(case_of(*worst_probe_))).result;
      if (reference.is_complete) worst_probe_->reference = std::move(reference);
    }
    done_.tests.push_back(*worst_probe_);
    session_.terminal.print(emc_line(done_.tests.back()));
    if (!folder_.empty()) store(response, done_.tests.back(), done_.tests.size());
  }

  static void take_into(emc::Thresholds& found, const EmcTest& test, const emc::ImmunityResult& result) {
    if (result.came_up && result.was_disturbed())
      emc::take(found, test.level.open_circuit_volts(), result.criterion);
  }

  // The tests of the table last longer than probes, and may show what these did not.
  void add_to_search() {
    if (!done_.search) return;
    emc::Thresholds& found = done_.search->thresholds;
    std::optional<emc::Thresholds>& references = done_.search->references;
    const auto told = [&] {
      return emc::text_of(found) +
             (references ? fmt::format("\nreferences alone: {}", emc::text_of(*references)) : "");
    };
    const std::string before = told();
    for (const EmcTest& test : done_.tests) {
      take_into(found, test, test.result);
      if (test.reference && references) take_into(*references, test, *test.reference);
    }
    if (const std::string now = told(); now != before)
      session_.terminal.print(fmt::format("with the tests above: {}\n", now));
  }

  // A test of each repetition and polarity of the campaign.
  EmcProbing probing() const {
    EmcProbing made;
    made.duration = EmcProbing::duration_for(done_.duration);
    const std::size_t of_a_level = planned_.size() / levels_from(session_.settings).size();
    for (std::size_t n = 0; n < of_a_level; ++n) {
      made.tests.push_back(case_of(planned_[n]));
      made.tests.back().seed = done_.seed;
    }
    made.run = [this](const emc::LineResponse& response, const std::vector<EmcCase>& tests) {
      std::vector<emc::ImmunityResult> results;
      conformance::OrderedWork<Ran> work;
      work.count = tests.size();
      work.threads = jobs_from(session_.settings);
      work.stop = interruption_.token();
      work.work = [&](std::size_t n) { return run_one(response, tests[n]); };
      work.deliver = [&](std::size_t, Ran&& ran) {
        results.push_back(std::move(ran.result));
        return results.back().is_complete;
      };
      work.idle = [this](std::size_t) { session_.terminal.progress(0); };
      const bool is_whole = work.run() == tests.size() && results.back().is_complete;
      return is_whole ? std::optional(std::move(results)) : std::nullopt;
    };
    return made;
  }

  // Of the tests with the highest voltage the first.
  void add_pulse(const emc::LineResponse& response) {
    const auto exposed = std::ranges::find(done_.places, true, &EmcPlace::is_exposed);
    const auto highest = std::ranges::max_element(
        done_.tests, {}, [](const EmcTest& test) { return test.level.open_circuit_volts(); });
    if (!done_.has_bursts || exposed == done_.places.end() || highest == done_.tests.end()) return;
    done_.pulse =
        EmcPulse{emc::picture_of(response, highest->level.open_circuit_volts(), highest->polarity), *exposed};
  }

  void describe(const Ran& ran) {
    done_.places = ran.places;
    done_.recovery = ran.recovery;
    done_.acceptance = ran.acceptance;
    for (network::ProtectedFrame frame : ran.frames) {
      if (!ran.result.cycles.empty() && frame.distance == kernel::Duration{}) {
        frame.distance = ran.result.cycles.front().kind.theory;
      }
      done_.residuals.push_back(emc::frame_residual(frame));
    }
  }

  EmcCase case_of(const EmcTest& planned) const {
    EmcCase test = stored_;
    test.bursts.settings.level = planned.level;
    test.bursts.settings.repetition = planned.repetition;
    test.bursts.settings.polarity = planned.polarity;
    test.flip_probability = planned.flip_probability;
    test.seed = planned.of_search ? planned.of_search->seed : seed_of(test, done_.seed);
    if (planned.of_search) test.duration = planned.of_search->duration;
    return test;
  }

  // A folder that is moved still has the network of its cases.
  void prepare_folder(const std::filesystem::path& folder) {
    folder_ = folder;
    reports::check_writable(folder_ / "case.json");
    if (stored_.request.file.empty()) return;
    const std::filesystem::path copy = folder_ / "network.json";
    reports::write_text_file(copy, reports::read_text_file(stored_.request.file));
    stored_.request.file = copy.string();
  }

  // A test that fails; and the first wrong word of the campaign, in a test that ends where it was accepted.
  void store(const emc::LineResponse& response, const EmcTest& tested, std::size_t number) {
    EmcCase test = case_of(tested);
    const emc::ImmunityResult& result = tested.result;
    test.end = end_of(result);
    const std::string name = fmt::format("{}-{}-{}", row_.name, done_.seed, number);
    if (is_failure(tested, static_cast<std::size_t>(test.worst))) keep(test, name);
    if (has_first_wrong_ || !result.first_wrong) return;
    const kernel::Duration until = result.first_wrong->when - result.on + kernel::kPicosecond;
    test.duration = std::min(test.duration, until);
    test.end = end_of(run_emc_case(test, response).result);
    has_first_wrong_ = true;
    keep(test, name + "-first_wrong");
  }

  void keep(const EmcCase& test, const std::string& name) {
    const std::filesystem::path file = folder_ / (name + ".case.json");
    write_emc_case(file, test);
    session_.terminal.print(fmt::format("    stored: {}\n", file.string()));
  }

  Session& session_;
  Interruption interruption_;
  const ProtocolEntry& row_;
  const conformance::PlannedNetwork* network_ = nullptr;
  std::shared_ptr<const conformance::PlannedNetwork> references_;  // the same without implementations
  EmcCase stored_;                                                 // what all tests have in common
  std::filesystem::path folder_;                                   // of what is stored; empty: nothing is
  bool is_searching_ = false;
  bool has_first_wrong_ = false;
  std::optional<EmcTest> worst_probe_;
  std::vector<EmcTest> planned_;
  EmcCampaign done_;
};

// Where no burst met a receiver, or a channel disturbed hardly any exchange, nothing is shown. Bursts that
// are too weak to be seen are something else: that is an A.
bool says_nothing(const EmcTest& test) {
  constexpr std::uint64_t kFewCycles = 100;
  if (!test.result.came_up) return true;
  if (!test.has_bursts()) return test.result.counts.sent < kFewCycles || !test.has_theory();
  return !test.result.was_disturbed();
}

int code_of(const EmcCampaign& campaign, std::size_t worst_allowed) {
  const auto fails = [&](const EmcTest& test) { return is_failure(test, worst_allowed); };
  if (std::ranges::any_of(campaign.tests, fails)) return kFailed;
  if (campaign.tests.empty()) return kNothingJudged;
  const bool is_open = !campaign.is_complete || std::ranges::any_of(campaign.tests, says_nothing);
  return is_open ? kInconclusive : kAllAsExpected;
}

}  // namespace

int emc_protocol(Session& session) {
  if (session.settings.is_set("fit")) return fit_emc(session);
  const std::size_t worst_allowed = session.settings.choice("worst");
  Campaign campaign(session);
  campaign.run();
  session.terminal.print(emc_summary(campaign.result()));
  write_document(session, "emc", emc_json(campaign.result()));
  if (!campaign.result().is_complete) {
    session.terminal.log(campaign.interruption().reason());
    const int signal = campaign.interruption().signal();
    if (signal != 0) return kSignalBase + signal;
  }
  const int code = code_of(campaign.result(), worst_allowed);
  if (code != kAllAsExpected) {
    session.terminal.print(fmt::format("reproduce: fieldproof emc {} {}\n", session.operands.front(),
                                       session.settings.reproduce_options()));
  }
  return code;
}

}  // namespace fieldproof::cli
