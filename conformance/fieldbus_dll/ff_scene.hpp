#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/link_scene.hpp"

// The words of charts for stations of the profile FF-P, with those of every profile.
namespace fieldproof::conformance {

// What the steps of one round share.
struct FfScene final : LinkScene {
  FfScene(FfBench& bench_, CaseJudge& judge_, unsigned round_)
      : LinkScene(bench_, judge_, round_, bench_.response_delay()), bench(bench_) {}

  bool submit(Priority priority, const Octets& dlsdu) override { return bench.submit(priority, dlsdu); }
  // `answer` is the first DT1, or what returned the token without one.
  void expect_used(const std::vector<Octets>& dlsdus, const DlsduReasons& reasons) override;
  void expect_serves() override { conformance::expect_serves(bench, judge); }

  // Each but the station's own, turn by turn; in a quick run every seventh.
  std::uint8_t other_node() const {
    return static_cast<std::uint8_t>(bench.node() + 1 + turn * bench.volume(7U, 1U));
  }

  FfBench& bench;
  std::vector<DrivenDlpdu> driven{};  // by a scheduler, while it was served
  std::vector<Octets> written{};      // into the first buffer
  DrivenDlpdu before{};               // a DT3 before `answer`
  kernel::Duration latency{};         // from a PT to what is sent under it
};

using FfStep = ChartStep<FfScene>;

inline FfCase on_chart(TestCase test_case, Chart<FfScene> chart, FfNeeds needs = {}) {
  return charted<FfCase>(std::move(test_case), std::move(chart), needs);
}

// Codes that are not the usual ones, each of them.
void with_other_codes(fieldbus_dll::FfConfiguration& configuration);

namespace ff_chart {

using namespace link_chart;

inline FfStep repeat(Rounds times, std::vector<FfStep> steps) {
  return repeated<FfScene>(times, std::move(steps));
}

FfStep pt(LinkScene::Priority least, unsigned duration);
// For the station; where, when it is not the usual link.
FfStep pn(const std::string& where = "");
FfStep cd();
FfStep activation();
FfStep probe_response(const std::string& reason, const std::string& reason_wrong = "dlpdu_wrong");
// What the tester sent last to the user.
FfStep delivered(std::string reason);
FfStep nothing_delivered(std::string reason);
// The answer is a DT3 with what was written last.
FfStep as_written();
// The DT3 that the tester sent last is delivered, and nothing else was.
FfStep published_delivered();
// Of the first buffer.
FfStep write(std::size_t size);

// All nodes of a scheduler's link return their tokens at once, for so many octet durations: `driven`.
FfStep serve(Rounds octets);
// It drove one of this kind meanwhile.
FfStep has_driven(const std::string& what, bool (*is_one)(const FfBench&, const DrivenDlpdu&),
                  std::string reason);

}  // namespace ff_chart
}  // namespace fieldproof::conformance
