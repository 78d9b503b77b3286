#include "conformance/valve_bus/host_cases.hpp"

#include <iterator>
#include <optional>
#include <utility>

#include "conformance/valve_bus/node_cases.hpp"

namespace fieldproof::conformance {
namespace {

HostCase host_canary() {
  TestCase test_case;
  test_case.id = "valve_bus/host/canary/a_failure_is_seen";
  test_case.purpose = "canary";
  test_case.requirement = "a failure of this suite is seen";
  test_case.reference = valve_sources::own("rules of the suite");
  test_case.stimulus = "A read.";
  test_case.expected = "The verdict is fail: the case asks for a frame that no host sends.";
  test_case.tags = {"canary"};
  return {test_case, [](HostBench& bench, CaseJudge& judge) {
            bench.order({5, 1, 0, 0});
            const auto frame = bench.next_frame(bench.patience());
            judge.expect(frame && frame->sent.characters.size() == 300, "canary", "a frame of 300 octets",
                         "it was shorter");
          }};
}

}  // namespace

const std::vector<HostCase>& host_cases() {
  static const std::vector<HostCase> cases = [] {
    std::vector<HostCase> all;
    for (auto chapter : {host_request_cases, host_response_cases, host_retry_cases, host_fifo_cases,
                         host_timing_cases, host_line_cases, host_cycle_cases, host_dip_cases}) {
      std::vector<HostCase> cases_of_chapter = chapter();
      std::move(cases_of_chapter.begin(), cases_of_chapter.end(), std::back_inserter(all));
    }
    all.push_back(host_canary());
    return all;
  }();
  return cases;
}

judge::CaseResult run_host_case(const HostCase& host_case, const HostSetting& setting) {
  // Made within the procedure: what an implementation does when it is powered is its verdict, too.
  std::optional<HostBench> bench;
  CaseJudge judge(host_case.test_case);
  judge.use_clock([&] { return bench ? bench->now() : kernel::kStart; });
  judge.use_decode([&] { return bench ? bench->decode_lines() : std::vector<std::string>{}; });
  judge::CaseResult result = judge.run_procedure([&](CaseJudge& j) {
    bench.emplace(host_case.needs, setting);
    host_case.procedure(*bench, j);
    bench->line_watch().judge(j);
    bench->finish();
  });
  result.seed = setting.seed;
  if (!bench) return result;
  result.fingerprint = bench->segment().trace().fingerprint();
  result.virtual_time = bench->now() - kernel::kStart;
  result.planned_hits = bench->planned_hits();
  return result;
}

std::function<std::optional<std::string>(const judge::Pics&)> for_host_with(std::string item,
                                                                            std::string sentence) {
  return [item = std::move(item),
          sentence = std::move(sentence)](const judge::Pics& pics) -> std::optional<std::string> {
    // What is not answered is as the bench's own host is.
    if (pics.completed_by(declared_host()).supports(item)) return std::nullopt;
    return sentence;
  };
}

std::function<std::optional<std::string>(const judge::Pics&)> for_host_without(std::string item,
                                                                               std::string sentence) {
  return [item = std::move(item),
          sentence = std::move(sentence)](const judge::Pics& pics) -> std::optional<std::string> {
    if (!pics.completed_by(declared_host()).supports(item)) return std::nullopt;
    return sentence;
  };
}

std::function<std::optional<std::string>(const judge::Pics&)> for_plain_writes() {
  return [](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.supports("acknowledges_writes")) return "the host waits for an acknowledge behind each write";
    if (pics.supports("verifies_writes")) return "the host sends a read behind each write";
    return std::nullopt;
  };
}

}  // namespace fieldproof::conformance
