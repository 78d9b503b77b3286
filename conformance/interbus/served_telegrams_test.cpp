// Subject: slaves and masters that are called as an implementation outside which hears and says telegrams:
// the suites judge them as they do inside, but for what only levels can show.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/telegram_speaker.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::MasterConfiguration;
using interbus::SlaveConfiguration;

const Suite& judged_inside() {
  static const auto suite = interbus_suite();
  return *suite;
}

iut::Attachment speaker_of(std::unique_ptr<iut::Device> served, unsigned line_ports) {
  const auto device = std::make_shared<interbus::TelegramSpeaker>(std::move(served), line_ports);
  return {device.get(), device, {}};
}

// Plays a station by name as one outside; an empty name is the reference.
std::unique_ptr<Suite> in_telegrams(const std::string& mutant) {
  const auto slave = [mutant]() {
    return std::make_unique<interbus::ServedSlave>([mutant](const SlaveConfiguration& told) {
      return mutant.empty() ? std::make_unique<interbus::Slave>(told) : slave_mutants().make(mutant, told);
    });
  };
  const auto master = [mutant]() {
    return std::make_unique<interbus::ServedMaster>([mutant](const MasterConfiguration& told) {
      return mutant.empty() ? std::make_unique<interbus::Master>(told) : master_mutants().make(mutant, told);
    });
  };
  return interbus_suite(
      {.attach = [slave, master](const iut::RoleName& role,
                                 const IutRequest& request) -> std::optional<iut::Attachment> {
        if (request.uri != "outside") return std::nullopt;
        return role.role == "slave" ? speaker_of(slave(), 3) : speaker_of(master(), 1);
      }});
}

Setup telegram_setup(const std::string& role, const std::string& uri) {
  Setup setup;
  setup.implementations.push_back({role, 0, uri});
  setup.seed = 1;
  setup.volume = Volume::quick;
  setup.explains = false;
  return setup;
}

// Cases about nothing but the levels of a slave's lines.
const std::set<std::string>& of_levels() {
  static const std::set<std::string> ids{"interbus/slave/compared/edges_at_both_limits",
                                         "interbus/slave/compared/returned_edges_at_both_limits",
                                         "interbus/slave/telegram/short_glitch_is_ignored",
                                         "interbus/slave/timing/bit_rate_within_one_percent_is_accepted",
                                         "interbus/slave/timing/edge_jitter_is_accepted",
                                         "interbus/slave/timing/pulses_leave_retimed"};
  return ids;
}

// Mutants that cannot be said in telegrams: of a receiver or a driver of levels.
const std::set<std::string>& unsayable() {
  static const std::set<std::string> names{"start_bit_not_validated",
                                           "follows_any_rate",
                                           "clock_too_fast",
                                           "does_not_retime",
                                           "no_clock_tolerance",
                                           "master_drives_over_itself",
                                           "samples_late",
                                           "samples_late_on_the_way_back",
                                           "takes_glitches_on_the_way_back",
                                           "drops_a_cut_telegram",
                                           "loses_the_rest_of_a_cut_telegram"};
  return names;
}

void expect_reference_is_judged_as_inside(const std::string& role) {
  const auto suite = in_telegrams("");
  int judged = 0;
  for (kernel::FewerIfSanitized few(4); const TestCase& test_case : suite->cases()) {
    if (test_case.role() != role || few.leaves_out()) continue;  // the way out and back is the same for all
    ++judged;
    const Outcome told = suite->run(test_case, telegram_setup(role, "outside"));
    const Outcome known = judged_inside().run(test_case, telegram_setup(role, "ref"));
    if (of_levels().contains(test_case.id)) {
      EXPECT_EQ(told.result.verdict, judge::Verdict::not_applicable) << test_case.id;
      EXPECT_NE(told.result.reason.find("receives and sends telegrams"), std::string::npos) << test_case.id;
      continue;
    }
    EXPECT_EQ(told.result.verdict, known.result.verdict) << test_case.id << told.result.reason;
    EXPECT_EQ(told.result.reason, known.result.reason) << test_case.id;
  }
  EXPECT_GT(judged, kernel::kIsSanitized ? 10 : 40);
}

TEST(ServedTelegrams, ReferenceSlaveIsJudgedInEveryCaseAsInside) {
  expect_reference_is_judged_as_inside("slave");
}

TEST(ServedTelegrams, ReferenceMasterIsJudgedInEveryCaseAsInside) {
  expect_reference_is_judged_as_inside("master");
}

struct Deviating {
  std::string role;
  std::string name;
  friend void PrintTo(const Deviating& one, std::ostream* out) { *out << one.role << " " << one.name; }
};

class TelegramMutants : public testing::TestWithParam<Deviating> {};

// In the cases that name it and are not about levels alone.
TEST_P(TelegramMutants, AreJudgedAsInside) {
  const auto& [role, name] = GetParam();
  const auto suite = in_telegrams(name);
  int judged = 0;
  for (const TestCase& test_case : suite->cases()) {
    const bool is_named = std::ranges::count(test_case.catches, name, &MustCatch::mutant) > 0;
    if (test_case.role() != role || !is_named || of_levels().contains(test_case.id)) continue;
    ++judged;
    const Outcome told = suite->run(test_case, telegram_setup(role, "outside"));
    const Outcome known = judged_inside().run(test_case, telegram_setup(role, "mutant:" + name));
    EXPECT_EQ(told.result.verdict, known.result.verdict) << test_case.id << told.result.reason;
    // A cycle that comes in telegrams is known at its end: that the outputs are old is seen as their absence.
    const bool is_seen_later = name == "outputs_one_cycle_late" && known.result.reason != told.result.reason;
    const std::string seen = known.result.reason == "outputs_not_sent" ? "cycle_wrong" : "outputs_not_sent";
    EXPECT_EQ(told.result.reason, is_seen_later ? seen : known.result.reason) << test_case.id;
  }
  EXPECT_GT(judged, 0);
}

std::vector<Deviating> all_mutants() {
  std::vector<Deviating> all;
  const auto add = [&](const std::string& role, const std::string& name) {
    if (!unsayable().contains(name) && !unsayable().contains(role + "_" + name)) all.push_back({role, name});
  };
  for (const Mutant& one : slave_mutants().mutants()) add("slave", one.name);
  for (const Mutant& one : master_mutants().mutants()) {
    if (!one.is_for_check) add("master", one.name);  // no case names those
  }
  return kernel::fewer_if_sanitized(4, std::move(all));
}

INSTANTIATE_TEST_SUITE_P(All, TelegramMutants, testing::ValuesIn(all_mutants()),
                         [](const testing::TestParamInfo<Deviating>& one) {
                           return one.param.role + "_" + one.param.name;
                         });

}  // namespace
}  // namespace fieldproof::conformance
