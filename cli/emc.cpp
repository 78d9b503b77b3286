#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/burst_options.hpp"
#include "cli/emc_text.hpp"
#include "cli/exit_code.hpp"
#include "cli/implementations.hpp"
#include "cli/interruption.hpp"
#include "cli/run_setup.hpp"
#include "cli/simulated_network.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/ordered_work.hpp"
#include "emc/random_flips.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

// `fieldproof emc`: a network under bursts of each level, repetition and polarity.
namespace fieldproof::cli {
namespace {

using emc::Level;
using emc::Polarity;
using emc::Repetition;

constexpr std::array<std::string_view, 5> kBurstOptions = {"levels", "repetition", "polarity", "profile",
                                                           "worst"};

bool is_typed(const Settings& settings, std::string_view option) {
  return settings.origin(option) == Origin::command_line;
}

// Bursts, or the channel that takes their place: what is typed wins over what a file or a variable says.
bool wants_bursts(const Settings& settings) {
  if (!settings.is_set("channel")) return true;
  const auto typed =
      std::ranges::find_if(kBurstOptions, [&](auto option) { return is_typed(settings, option); });
  if (typed == kBurstOptions.end()) return false;
  if (!is_typed(settings, "channel")) return true;
  settings.refuse("channel", fmt::format("a channel takes the place of bursts; leave out --{}", *typed));
}

// "bsc:0.002".
std::vector<EmcTest> channel_tests_from(const Settings& settings) {
  std::vector<EmcTest> tests;
  for (const std::string& word : settings.words("channel")) {
    const auto flips = word.starts_with("bsc:") ? real_of(std::string_view(word).substr(4)) : std::nullopt;
    if (!flips || !(*flips >= emc::kLeastBer && *flips <= emc::kGreatestBer)) {
      settings.refuse("channel", fmt::format("'{}' is no channel; write bsc:P with P from {:g} to {:g}", word,
                                             emc::kLeastBer, emc::kGreatestBer));
    }
    EmcTest& test = tests.emplace_back();
    test.flip_probability = *flips;
  }
  return tests;
}

std::vector<EmcTest> burst_tests_from(const Settings& settings) {
  const auto repetitions = repetitions_from(settings);
  const auto polarities = polarities_from(settings);
  std::vector<EmcTest> tests;
  for (const Level& level : levels_from(settings)) {
    for (const Repetition repetition : repetitions) {
      for (const Polarity polarity : polarities) {
        EmcTest& test = tests.emplace_back();
        test.level = level;
        test.repetition = repetition;
        test.polarity = polarity;
      }
    }
  }
  return tests;
}

std::vector<EmcTest> tests_from(const Settings& settings, bool has_bursts) {
  std::vector<EmcTest> tests = has_bursts ? burst_tests_from(settings) : channel_tests_from(settings);
  if (tests.empty()) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "an empty list of levels, repetition rates or polarities leaves nothing to test");
  }
  if (tests.size() > kMostTests) {
    settings.refuse(has_bursts ? "levels" : "channel",
                    fmt::format("these are {} tests; at most {} make a campaign", tests.size(), kMostTests));
  }
  return tests;
}

// Mutants by role; the rest of the network are references.
emc::InterbusStations stations_from(const Session& session, std::size_t stations) {
  emc::InterbusStations players;
  const auto entries = session.catalogue.select(std::vector<std::string>{"interbus/**"});
  const std::vector<std::string>& texts = session.settings.list("iut");
  const auto implementations = parse_implementations(texts, session.catalogue, entries);
  for (std::size_t n = 0; n < texts.size(); ++n) {
    const std::string& text = texts[n];
    const conformance::Assignment& assigned = implementations[n];
    if (assigned.uri == "ref") continue;
    constexpr std::string_view kMutant = "mutant:";
    if (!assigned.uri.starts_with(kMutant) || (assigned.role != "slave" && assigned.role != "master")) {
      session.settings.refuse(
          "iut",
          fmt::format("'{}' cannot take part here; write slave@N=mutant:NAME or master=mutant:NAME", text));
    }
    const std::string name = assigned.uri.substr(kMutant.size());
    if (assigned.role == "master") {
      players.make_master = conformance::make_master(assigned.uri);
      continue;
    }
    const int at = std::max(assigned.position, 1);
    if (at > static_cast<int>(stations) || players.make_slave) {
      session.settings.refuse(
          "iut", fmt::format("'{}': one slave is a mutant, at a position from 1 to {}", text, stations));
    }
    players.make_slave = [at, name](int position, const interbus::SlaveConfiguration& configuration) {
      return position == at ? conformance::make_slave_mutant(name, configuration) : nullptr;
    };
  }
  return players;
}

// Runs the tests over the threads; a test is told when all before it are done.
class Campaign {
 public:
  explicit Campaign(Session& session)
      : session_(session),
        interruption_(session.settings.duration("max-time")),
        network_(simulated_network_from(session.settings)),
        stations_(stations_from(session, interbus::ring_order(network_).size())) {
    const Settings& settings = session.settings;
    done_.network = network_.name;
    done_.implementations = fmt::format("{}", fmt::join(settings.list("iut"), " "));
    done_.profile = profile_from(settings);
    done_.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
    done_.duration = virtual_time_from(settings);
    done_.has_bursts = wants_bursts(settings);
    planned_ = tests_from(settings, done_.has_bursts);
    for (EmcTest& test : planned_) {
      if (!test.has_bursts()) test.undetected = emc::undetected_cycle(network_, test.flip_probability);
    }
  }

  // Whether all tests were made.
  bool run() {
    const emc::LineResponse response(done_.profile.coupling);
    done_.threshold_volts = response.threshold_volts();
    session_.terminal.print(
        simulation_header(session_, done_.seed, session_.settings.text("network"), kCycleTimePaper));
    session_.terminal.print(emc_table_head(done_.has_bursts));
    conformance::OrderedWork<emc::ImmunityResult> work;
    work.count = planned_.size();
    work.threads = jobs_from(session_.settings);
    work.stop = interruption_.token();
    work.work = [&](std::size_t n) {
      return emc::run_immunity(network_, stations_, response, settings_of(n));
    };
    work.deliver = [&](std::size_t n, emc::ImmunityResult&& result) {
      planned_[n].result = result;
      done_.tests.push_back(planned_[n]);
      session_.terminal.print(emc_line(done_.tests.back()));
      return true;
    };
    work.idle = [&](std::size_t finished) { session_.terminal.progress(finished); };
    session_.terminal.begin_progress(planned_.size(), "tests");
    const std::size_t delivered = work.run();
    session_.terminal.end_progress();
    if (!done_.tests.empty()) {
      done_.residual = emc::frame_residual(network_, done_.tests.front().result.cycle_time);
    }
    return delivered == planned_.size();
  }

  const EmcCampaign& result() const { return done_; }
  const Interruption& interruption() const { return interruption_; }

 private:
  emc::ImmunitySettings settings_of(std::size_t n) const {
    emc::ImmunitySettings settings;
    settings.bursts.level = planned_[n].level;
    settings.bursts.repetition = planned_[n].repetition;
    settings.bursts.polarity = planned_[n].polarity;
    if (const double flips = planned_[n].flip_probability; flips > 0) {
      settings.make_channel = [flips](kernel::Random random) {
        return std::make_unique<emc::BernoulliChannel>(flips, random);
      };
    }
    settings.duration = done_.duration;
    settings.seed = kernel::Random(done_.seed).split(n).seed();
    return settings;
  }

  Session& session_;
  Interruption interruption_;
  interbus::NetworkDescription network_;
  emc::InterbusStations stations_;
  std::vector<EmcTest> planned_;
  EmcCampaign done_;
};

// On a channel of the textbooks wrong data are no failure, more of them than the theory allows are, and so is
// a network that does not work again.
bool is_failure(const EmcTest& test, std::size_t worst_allowed) {
  constexpr double kRefuted = 1e-3;
  if (test.has_bursts()) return static_cast<std::size_t>(test.result.criterion) > worst_allowed;
  const bool works_again = test.result.recovered_by_itself || test.result.recovered_after_start;
  return test.chance_of_count() < kRefuted || !works_again;
}

// A network that hardly exchanged data shows nothing of what a check lets pass.
bool says_nothing(const EmcTest& test) {
  constexpr std::uint64_t kFewCycles = 100;
  return !test.result.came_up || (!test.has_bursts() && test.result.ledger.sent < kFewCycles);
}

int code_of(const EmcCampaign& campaign, std::size_t worst_allowed) {
  const auto fails = [&](const EmcTest& test) { return is_failure(test, worst_allowed); };
  const auto came_up = [](const EmcTest& test) { return test.result.came_up; };
  if (std::ranges::all_of(campaign.tests, came_up) && std::ranges::any_of(campaign.tests, fails)) {
    return kFailed;
  }
  return std::ranges::any_of(campaign.tests, says_nothing) ? kInconclusive : kAllAsExpected;
}

}  // namespace

int emc_protocol(Session& session) {
  if (session.operands.front() != "interbus") {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("no bursts are prepared for '{}'; there is 'interbus'", session.operands.front()));
  }
  const std::size_t worst_allowed = session.settings.choice("worst");
  Campaign campaign(session);
  const bool is_complete = campaign.run();
  session.terminal.print(emc_summary(campaign.result()));
  write_document(session, "emc", emc_json(campaign.result()));
  if (!is_complete) {
    session.terminal.log(campaign.interruption().reason());
    const int signal = campaign.interruption().signal();
    return signal != 0 ? kSignalBase + signal : kNothingJudged;
  }
  const int code = code_of(campaign.result(), worst_allowed);
  if (code != kAllAsExpected) {
    session.terminal.print(
        fmt::format("reproduce: fieldproof emc interbus {}\n", session.settings.reproduce_options()));
  }
  return code;
}

}  // namespace fieldproof::cli
