#include "conformance/valve_bus/node_cases.hpp"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <utility>

namespace fieldproof::conformance {
namespace {

NodeCase canary() {
  TestCase test_case;
  test_case.id = "valve_bus/node/canary/a_failure_is_seen";
  test_case.purpose = "canary";
  test_case.requirement = "a failure of this suite is seen";
  test_case.reference = valve_sources::own("rules of the suite");
  test_case.stimulus = "A read.";
  test_case.expected = "The verdict is fail: the case asks for an answer that no node gives.";
  test_case.tags = {"canary"};
  return {test_case, [](NodeBench& bench, CaseJudge& judge) {
            bench.read();
            bench.settle();
            const auto answers = bench.answers();
            judge.expect(answers.size() == 1 && answers.front().characters.size() == 300, "canary",
                         "an answer of 300 octets", "it was shorter");
          }};
}

// On a real line an instant is known to some microseconds. One that lies closer to its limit says nothing; a
// case of which most say nothing has not shown what was to be judged.
void judge_instants(const InstantLedger& instants, CaseJudge& judge) {
  const auto microseconds = [](kernel::Duration time) { return static_cast<double>(time.count()) * 1e-6; };
  if (instants.greatest_doubt > kernel::Duration{})
    judge.measure("greatest uncertainty U of an instant", "us", microseconds(instants.greatest_doubt));
  if (instants.in_doubt == 0) return;
  judge.measure("instants closer to a limit than U", "", static_cast<double>(instants.in_doubt));
  if (instants.in_doubt <= instants.sure) return;
  judge.inconclusive("timing_in_doubt", {{"instants that are known better than their distance from a limit"},
                                         fmt::format("{} of {} were closer than U, which was {} at least",
                                                     instants.in_doubt, instants.in_doubt + instants.sure,
                                                     kernel::describe(instants.least_doubt_open))});
}

}  // namespace

const std::vector<NodeCase>& node_cases() {
  static const std::vector<NodeCase> cases = [] {
    std::vector<NodeCase> all;
    for (auto chapter :
         {node_write_cases, node_read_cases, node_address_cases, node_check_cases, node_framing_cases,
          node_timing_cases, node_line_cases, node_power_cases, node_immunity_cases}) {
      std::vector<NodeCase> cases_of_chapter = chapter();
      std::move(cases_of_chapter.begin(), cases_of_chapter.end(), std::back_inserter(all));
    }
    all.push_back(canary());
    return all;
  }();
  return cases;
}

judge::CaseResult run_node_case(const NodeCase& node_case, const NodeSetting& setting) {
  // Made within the procedure: what an implementation does when it is powered is its verdict, too.
  std::optional<NodeBench> bench;
  CaseJudge judge(node_case.test_case);
  judge.use_clock([&] { return bench ? bench->now() : kernel::kStart; });
  judge.use_decode([&] { return bench ? bench->decode_lines() : std::vector<std::string>{}; });
  judge::CaseResult result = judge.run_procedure([&](CaseJudge& j) {
    bench.emplace(node_case.needs, setting);
    node_case.procedure(*bench, j);
    bench->line_watch().judge(j);
    bench->finish();
    judge_instants(bench->instants(), j);
  });
  result.seed = setting.seed;
  if (!bench) return result;
  result.fingerprint = bench->segment().trace().fingerprint();
  result.virtual_time = bench->now() - kernel::kStart;
  result.planned_hits = bench->planned_hits();
  return result;
}

namespace valve_sources {
judge::Reference paper(std::string place) {
  return {"Kim, Seo and Lee, pneumatic control by fieldbus", std::move(place), judge::Standing::seed};
}
judge::Reference calculated(std::string place) {
  return {"computed from the block check", std::move(place), judge::Standing::calc};
}
judge::Reference own(std::string place) {
  return {"this project's choice", std::move(place), judge::Standing::own};
}
judge::Reference derived(std::string place) {
  return {"follows from Kim, Seo and Lee", std::move(place), judge::Standing::derived};
}
}  // namespace valve_sources

std::function<std::optional<std::string>(const judge::Pics&)> for_node_with(std::string item,
                                                                            std::string sentence) {
  return [item = std::move(item),
          sentence = std::move(sentence)](const judge::Pics& pics) -> std::optional<std::string> {
    // What is not answered is as the bench's own node is.
    if (pics.completed_by(declared_node()).supports(item)) return std::nullopt;
    return sentence;
  };
}

std::function<std::optional<std::string>(const judge::Pics&)> for_characters(std::string profile) {
  return [profile = std::move(profile)](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.text("characters", profile) == profile) return std::nullopt;
    return fmt::format("the node does not talk in characters {}", profile);
  };
}

}  // namespace fieldproof::conformance
