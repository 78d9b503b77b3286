#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"
#include "conformance/fieldbus_dll/link_scene.hpp"

// The words of charts for stations of the profile ISA-D, with those of every profile.
namespace fieldproof::conformance {

// What the steps of one round share.
struct IsaScene final : LinkScene {
  IsaScene(IsaBench& bench_, CaseJudge& judge_, unsigned round_)
      : LinkScene(bench_, judge_, round_, bench_.reply_wait()), bench(bench_) {}

  bool submit(Priority priority, const Octets& dlsdu) override {
    return bench.submit_unit_data(priority, dlsdu);
  }
  // `answer` is the first DU, or the EE without one.
  void expect_used(const std::vector<Octets>& dlsdus, const DlsduReasons& reasons) override;
  void expect_serves() override { conformance::expect_serves(bench, judge); }
  // V(MID) after `answer`, or so much later; runs until they are over.
  void reply(const Octets& octets, kernel::Duration later = {});

  IsaBench& bench;
  TokenUse use{};              // of the token that was sent last
  kernel::Duration latency{};  // from an ES to what is sent under it
};

using IsaStep = ChartStep<IsaScene>;

inline IsaCase on_chart(TestCase test_case, Chart<IsaScene> chart, IsaNeeds needs = {}) {
  return charted<IsaCase>(std::move(test_case), std::move(chart), std::move(needs));
}

namespace isa_chart {

using namespace link_chart;

inline IsaStep repeat(Rounds times, std::vector<IsaStep> steps) {
  return repeated<IsaScene>(times, std::move(steps));
}

IsaStep et(LinkScene::Priority least);
IsaStep es(LinkScene::Priority least, unsigned duration);
IsaStep cd(LinkScene::Priority least);
// Of the EE after the data.
IsaStep end_reason(fieldbus_dll::EndReason reason);
// What the tester sent last to the user, `reason` when it does not get it; its deliveries are forgotten.
IsaStep delivered(const std::string& what, std::string reason);
// The next token of a schedule: `answer`.
IsaStep delegated(const std::string& what);

}  // namespace isa_chart
}  // namespace fieldproof::conformance
