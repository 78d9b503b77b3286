#include "conformance/chart.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "conformance/judging.hpp"

// Subject: what a chart makes of its steps: a procedure, the sentences of the case, and what findings name.
namespace fieldproof::conformance {
namespace {

struct CountingBench {
  std::vector<std::string> acts{};
  bool is_full = false;

  unsigned volume(unsigned quick, unsigned full) const { return is_full ? full : quick; }
};

struct CountingScene : Scene<CountingBench> {
  using Scene::Scene;

  unsigned turn = 0;
  std::string asked{};
};

using CountingCase = BenchCase<CountingBench, NoNeeds>;

ChartStep<CountingScene> ask() {
  return {"the tester asks", "an answer", [](CountingScene& scene) {
            scene.bench.acts.push_back("ask " + std::to_string(scene.round) + scene.asked);
            scene.asked = " again";
          }};
}

ChartStep<CountingScene> fail_in(unsigned round) {
  return expected<CountingScene>("no failure", [round](CountingScene& scene) {
    scene.judge.expect(scene.round != round, "failed", "no failure", "a failure");
  });
}

CountingCase case_of(std::vector<ChartStep<CountingScene>> steps) {
  TestCase test_case;
  test_case.id = "a/b/c";
  return charted<CountingCase>(std::move(test_case), Chart<CountingScene>{{2, 30}, std::move(steps)});
}

judge::CaseResult run(const CountingCase& one, CountingBench& bench, std::vector<std::string>& steps) {
  CaseJudge judge(one.test_case);
  judge.use_steps([&](const std::string& text) { steps.push_back(text); });
  return judge.run_procedure([&](CaseJudge& j) { one.procedure(bench, j); });
}

TEST(Chart, RunsItsStepsInOrderWithASceneForEachRound) {
  CountingBench bench;
  std::vector<std::string> steps;
  EXPECT_EQ(run(case_of({ask(), ask()}), bench, steps).verdict, judge::Verdict::pass);
  EXPECT_EQ(bench.acts, (std::vector<std::string>{"ask 0", "ask 0 again", "ask 1", "ask 1 again"}));
  bench = {.is_full = true};
  run(case_of({ask()}), bench, steps);
  EXPECT_EQ(bench.acts.size(), 30U);
}

TEST(Chart, MarksEachStepAndAFindingNamesItsOwn) {
  CountingBench bench;
  std::vector<std::string> steps;
  const judge::CaseResult result = run(case_of({ask(), fail_in(1), ask()}), bench, steps);
  const std::string first = "1 of 3: the tester asks; expected: an answer";
  const std::string second = "2 of 3: expected: no failure";
  const std::string third = "3 of 3: the tester asks; expected: an answer";
  EXPECT_EQ(steps, (std::vector<std::string>{first, second, third, first, second}));
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].step, second);
}

TEST(Chart, SaysInSentencesWhatIsSentAndWhatMustCome) {
  const TestCase test_case = case_of({ask(), ask(), fail_in(9)}).test_case;
  EXPECT_EQ(test_case.stimulus, "The tester asks, 2 times. All of it 30 times.");
  EXPECT_EQ(test_case.expected, "An answer, 2 times; no failure.");
  EXPECT_EQ(test_case.steps, (std::vector<std::string>{"1 of 3: the tester asks; expected: an answer",
                                                       "2 of 3: the tester asks; expected: an answer",
                                                       "3 of 3: expected: no failure"}));
}

Chart<CountingScene> walking_chart(std::size_t count) {
  Chart<CountingScene> chart{{2, 30}, {ask()}};
  chart.first = {stimulus<CountingScene>("the tester comes", [](CountingScene& scene) {
    scene.bench.acts.push_back("come");
    scene.asked = " at first";
  })};
  chart.walk = {"each door", [count](CountingScene&) { return count; }};
  return chart;
}

TEST(Chart, ComesOnceAndWalksOverAListInEachRound) {
  CountingBench bench;
  std::vector<std::string> steps;
  run(charted<CountingCase>(TestCase{}, walking_chart(2)), bench, steps);
  EXPECT_EQ(bench.acts, (std::vector<std::string>{"come", "ask 0 at first", "ask 1", "ask 2", "ask 3"}));
  EXPECT_EQ(steps[0], "1 of 2: the tester comes");
  EXPECT_EQ(steps[4], "2 of 2: the tester asks; expected: an answer");
  bench.acts.clear();
  run(charted<CountingCase>(TestCase{}, walking_chart(0)), bench, steps);
  EXPECT_EQ(bench.acts, std::vector<std::string>{"come"});
}

TEST(Chart, SaysWhatComesOnceAndWhatItWalksOver) {
  EXPECT_EQ(charted<CountingCase>(TestCase{}, walking_chart(2)).test_case.stimulus,
            "The tester comes. Then, for each door, 30 times: the tester asks.");
  EXPECT_EQ(chart::sentence({}, {"the tester asks"}, {}, "each door"), "For each door: the tester asks.");
  EXPECT_EQ(chart::sentence({"the tester comes"}, {}, {2, 30}, {}), "The tester comes.");
}

TEST(Chart, RepeatsStepsOnOneSceneAndNumbersThemOnce) {
  const auto count = stimulus<CountingScene>("it counts", [](CountingScene& scene) {
    scene.bench.acts.push_back("turn " + std::to_string(scene.turn) + scene.asked);
  });
  const CountingCase one = case_of({ask(), repeated<CountingScene>({2, 20}, {count, fail_in(1)}), ask()});
  EXPECT_EQ(one.test_case.stimulus,
            "The tester asks; 20 times (it counts); the tester asks. All of it 30 times.");
  EXPECT_EQ(one.test_case.expected, "An answer; no failure; an answer.");
  CountingBench bench;
  std::vector<std::string> steps;
  EXPECT_EQ(run(one, bench, steps).findings.at(0).step, "3 of 4: expected: no failure");
  EXPECT_EQ(bench.acts, (std::vector<std::string>{"ask 0", "turn 0 again", "turn 1 again", "ask 0 again",
                                                  "ask 1", "turn 0 again"}));
  EXPECT_EQ(std::vector(steps.begin(), steps.begin() + 6),
            (std::vector<std::string>{"1 of 4: the tester asks; expected: an answer", "2 of 4: it counts",
                                      "3 of 4: expected: no failure", "2 of 4: it counts",
                                      "3 of 4: expected: no failure",
                                      "4 of 4: the tester asks; expected: an answer"}));
}

struct GreaterScene : CountingScene {
  using CountingScene::CountingScene;
  unsigned answers = 0;
};

TEST(Chart, SaysOfStepsThatStandTogetherWhatItSaysOfTheSameOneByOne) {
  const TestCase together = case_of({repeated<CountingScene>({}, {ask(), fail_in(9)})}).test_case;
  const TestCase one_by_one = case_of({ask(), fail_in(9)}).test_case;
  EXPECT_EQ(together.stimulus, one_by_one.stimulus);
  EXPECT_EQ(together.expected, one_by_one.expected);
  EXPECT_EQ(together.steps, one_by_one.steps);
}

TEST(Chart, TakesStepsOfAScenesBase) {
  const auto answer = stimulus<GreaterScene>(
      "it answers", [](GreaterScene& scene) { scene.asked += std::to_string(++scene.answers); });
  const ChartStep<GreaterScene> twice = repeated<CountingScene>({2, 2}, {ask()});
  const auto one = charted<CountingCase>({}, Chart<GreaterScene>{{}, {ask(), answer, twice}});
  CountingBench bench;
  std::vector<std::string> steps;
  run(one, bench, steps);
  EXPECT_EQ(bench.acts, (std::vector<std::string>{"ask 0", "ask 0 again1", "ask 0 again"}));
}

}  // namespace
}  // namespace fieldproof::conformance
