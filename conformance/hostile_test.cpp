// Subject: what becomes of a run when an implementation does the worst.
#include <dirent.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "conformance/catalogue.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/runner.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/iut/pool.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

// Its station outside comes from this pool.
Attach attached_from(iut::DevicePool& pool) {
  return [&pool](const iut::RoleName&, const IutRequest& request) -> std::optional<iut::Attachment> {
    if (!request.uri.starts_with("exec:")) return std::nullopt;
    const auto lease = std::make_shared<iut::DevicePool::Lease>(pool.take());
    return iut::Attachment{&**lease, lease, [lease] { lease->set_reusable(); }};
  };
}

// A role, and three of its cases in the order of the suite; the worst is done in the second.
struct AttackedRole {
  iut::RoleName name;
  std::string before;
  std::string attacked;
  std::string behind;
  std::unique_ptr<Suite> (*suite)(iut::DevicePool&);

  std::string prefix() const { return name.protocol + "/" + name.role + "/"; }
};

const AttackedRole kNodeRole{
    {"valve_bus", "node"},
    "write/drives_the_valves",
    "read/is_answered",
    "command/undefined_commands_are_ignored",
    [](iut::DevicePool& pool) { return valve_bus_suite({.attach = attached_from(pool)}); }};
const AttackedRole kDeviceRole{
    {"fieldbus_dll", "ff_device"},
    "probe/is_answered",
    "token/is_returned_once",
    "publisher/the_latest_write_is_published",
    [](iut::DevicePool& pool) { return fieldbus_dll_suite({.attach = attached_from(pool)}); }};

struct Worst {
  std::string act;
  std::string reason;
};

const std::vector<Worst>& worst_acts() {
  static const std::vector<Worst> all = {
      {"exit_0", "implementation_crashed"},
      {"exit_255", "implementation_crashed"},
      {"quick_exit", "implementation_crashed"},
      {"bus_error", "implementation_crashed"},
      {"illegal_instruction", "implementation_crashed"},
      {"broken_pipe", "implementation_crashed"},
      {"quit", "implementation_crashed"},
      {"alarm", "implementation_crashed"},
      {"null_pointer", "implementation_crashed"},
      {"endless_recursion", "implementation_crashed"},
      {"throws", "implementation_crashed"},
      {"stops_itself", "implementation_hangs"},
      {"sleeps", "implementation_hangs"},
      {"waits_for_input", "implementation_hangs"},
      {"many_children", "implementation_hangs"},
      {"length_of_three_octets", "implementation_hangs"},
      {"type_zero", "implementation_sends_garbage"},
      {"longest_message_and_one", "implementation_sends_garbage"},
      {"all_ones", "implementation_sends_garbage"},
      {"zeros_for_ever", "implementation_sends_garbage"},
      {"hello_again", "implementation_sends_garbage"},
      {"value_for_nothing", "implementation_sends_garbage"},
      {"power_to_the_bench", "implementation_sends_garbage"},
      {"empty_done", "implementation_sends_garbage"},
      {"drives_a_port_without_end", "implementation_asks_the_impossible"},
      {"writes_all_ones", "implementation_asks_the_impossible"},
      {"writes_item_0xffff", "implementation_asks_the_impossible"},
      {"reads_item_0xffff", "implementation_asks_the_impossible"},
      {"writes_in_the_past", "implementation_asks_the_impossible"},
      {"exit_3", "implementation_crashed"},
      {"abort", "implementation_crashed"},
      {"segv", "implementation_crashed"},
      {"kill", "implementation_crashed"},
      {"term", "implementation_crashed"},
      {"floating_point", "implementation_crashed"},
      {"last_words", "implementation_crashed"},
      {"leave_a_child", "implementation_crashed"},
      {"close_output", "implementation_gone"},
      {"hang", "implementation_hangs"},
      {"hang_for_all_signals", "implementation_hangs"},
      {"spin", "implementation_hangs"},
      {"flood_the_log", "implementation_hangs"},
      {"half_a_message", "implementation_hangs"},
      {"no_length", "implementation_sends_garbage"},
      {"endless_length", "implementation_sends_garbage"},
      {"unknown_type", "implementation_sends_garbage"},
      {"cut_content", "implementation_sends_garbage"},
      {"content_too_long", "implementation_sends_garbage"},
      {"words_of_the_bench", "implementation_sends_garbage"},
      {"printed_text", "implementation_sends_garbage"},
      {"answers_twice", "implementation_sends_garbage"},
      {"refuses_in_the_middle", "implementation_sends_garbage"},
      {"flood", "implementation_floods"},
      {"time_stands_still", "implementation_floods"},
      {"time_creeps", "implementation_floods"},
      {"drives_more_than_a_line", "implementation_asks_the_impossible"},
      {"drives_in_the_past", "implementation_asks_the_impossible"},
      {"drives_backwards", "implementation_asks_the_impossible"},
      {"drives_for_ever", "implementation_asks_the_impossible"},
      {"drives_another_port", "implementation_asks_the_impossible"},
      {"writes_what_is_not_there", "implementation_asks_the_impossible"},
      {"writes_too_much", "implementation_asks_the_impossible"},
      {"reads_what_is_not_there", "implementation_asks_the_impossible"},
  };
  return all;
}

// Before a case has begun it may be refused, and nothing may be done yet; after its end nothing may be done
// any more.
std::string expected_reason(const Worst& worst, std::string_view call) {
  if (call == "begin" && worst.act == "refuses_in_the_middle") return "implementation_refuses_case";
  if (call == "begin" && worst.act == "flood") return "implementation_asks_the_impossible";
  const bool is_act = worst.reason == "implementation_asks_the_impossible" || worst.act == "flood";
  if (call == "end" && is_act) return "implementation_sends_garbage";
  return worst.reason;
}

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

// What the processes of this test have on their command line, and no others.
std::string mark() {
  return fmt::format("mark-{}", ::getpid());
}

// Processes of the hostile program, whoever their parent is.
std::size_t hostile_processes() {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    // A process that ends while it is looked at cannot be read: this way that is no more than an empty line.
    std::ostringstream line;
    line << std::ifstream(entry.path() / "cmdline").rdbuf();
    if (line.str().find(mark()) != std::string::npos) ++count;
  }
  return count;
}

// What a loaded machine, under a sanitizer, may take for a run; and what a call may take of one that is right
// but for the worst. Where the bench waits as long as it may the limit is shorter: it holds for the cases
// before and after it too, in which the implementation is right.
constexpr std::chrono::milliseconds kPatience{20'000};
constexpr std::chrono::milliseconds kShortest{2'000};

// A child keeps the output open of one that is gone.
bool makes_the_bench_wait(const Worst& worst) {
  return worst.reason == "implementation_hangs" || worst.act == "leave_a_child";
}

struct Attack {
  const AttackedRole* role;
  std::string call;

  friend void PrintTo(const Attack& one, std::ostream* out) {
    *out << one.role->name.role << " " << one.call;
  }
};

// The run of three cases of which the second meets the worst; what the reference does is what the others are.
class HostileStation : public testing::TestWithParam<Attack> {
 protected:
  std::vector<judge::CaseResult> run(const Worst& worst) {
    const AttackedRole& role = *GetParam().role;
    const std::string uri = fmt::format("exec:{} {} {} {} {}", FIELDPROOF_HOSTILE_STATION, worst.act,
                                        GetParam().call, role.attacked, mark());
    iut::PeerLimits limits;
    limits.start = kPatience;
    limits.call = makes_the_bench_wait(worst) ? kShortest : kPatience;
    iut::DevicePool pool(uri, role.name, limits);
    const auto suite = role.suite(pool);
    conformance::Setup setup;
    setup.volume = Volume::quick;
    setup.implementations = {{role.name.role, 0, uri}};
    std::vector<judge::CaseResult> results;
    for (const TestCase& one : suite->cases()) {
      if (one.id != role.prefix() + role.before && one.id != role.prefix() + role.attacked &&
          one.id != role.prefix() + role.behind) {
        continue;
      }
      results.push_back(run_case({suite.get(), &one}, setup).outcome.result);
    }
    return results;
  }
};

TEST(HostileActs, AreManyAndEachOnce) {
  std::set<std::string> names;
  for (const Worst& worst : worst_acts()) EXPECT_TRUE(names.insert(worst.act).second) << worst.act;
  EXPECT_GE(names.size(), 60U);
}

TEST_P(HostileStation, CostsItsOwnVerdictAndNoOther) {
  const std::size_t descriptors = open_descriptors();
  for (kernel::FewerIfSanitized few(3); const Worst& worst : worst_acts()) {
    if (few.leaves_out()) continue;
    // After the end of a case nobody asks for a next time.
    if (worst.act.starts_with("time_") && GetParam().call == "end") continue;
    SCOPED_TRACE(fmt::format("{} in {}", worst.act, GetParam().call));
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<judge::CaseResult> results = run(worst);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience);
    ASSERT_EQ(results.size(), 3U);
    EXPECT_EQ(results[0].verdict, judge::Verdict::pass) << results[0].reason;
    EXPECT_EQ(results[1].verdict, judge::Verdict::fail);
    if (worst.act == "answers_twice") {
      // One answer too many is seen at once, or by what it does to those after it.
      const bool is_blamed = results[1].reason.starts_with("implementation_");
      EXPECT_TRUE(is_blamed || GetParam().role == &kDeviceRole) << results[1].reason;
    } else {
      EXPECT_EQ(results[1].reason, expected_reason(worst, GetParam().call));
    }
    EXPECT_EQ(results[2].verdict, judge::Verdict::pass) << results[2].reason;
    EXPECT_EQ(open_descriptors(), descriptors);
    EXPECT_EQ(hostile_processes(), 0U);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
  }
}

INSTANTIATE_TEST_SUITE_P(InEachCall, HostileStation,
                         testing::Values(Attack{&kNodeRole, "begin"}, Attack{&kNodeRole, "power"},
                                         Attack{&kNodeRole, "receive"}, Attack{&kNodeRole, "end"},
                                         Attack{&kDeviceRole, "power"}, Attack{&kDeviceRole, "receive"}),
                         [](const auto& one) { return one.param.role->name.role + "_" + one.param.call; });

}  // namespace
}  // namespace fieldproof::conformance
