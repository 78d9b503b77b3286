#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/bench_case.hpp"

// A case that is a sequence, as data: steps in the words of its protocol. From the chart come the procedure,
// the stimulus and the expectation that `explain` and the report show, and the marks on the time line;
// a finding names the step in which it was made. Loops over what was found, statistics and searches stay
// code.
//
// A protocol gives a scene for each bench: what the steps of one round share (the node that is asked, the
// response that is given), made anew for each round of `Scene(bench, judge, round)`, rounds from 0; and
// words: functions that give a step.
namespace fieldproof::conformance {

template <typename Scene>
struct ChartStep {
  std::string stimulus;  // what the tester does: "the PC orders a read"; empty: it waits for what must come
  std::string expected;  // what must come: "the host polls the node"; empty: nothing is required
  std::function<void(Scene&)> run;
};

template <typename Scene>
ChartStep<Scene> stimulus(std::string text, std::function<void(Scene&)> run) {
  return {std::move(text), {}, std::move(run)};
}

template <typename Scene>
ChartStep<Scene> expected(std::string text, std::function<void(Scene&)> run) {
  return {{}, std::move(text), std::move(run)};
}

// How often all steps are run.
struct Rounds {
  unsigned quick = 1;
  unsigned full = 1;
};

// A list that each of the rounds walks over: "each bit of the check", and how many there are. What has the
// turn follows from `scene.round`, which counts on from walk to walk.
template <typename Scene>
struct Walk {
  std::string over{};
  std::function<std::size_t(Scene&)> count{};
};

template <typename Scene>
struct Chart {
  Rounds rounds{};
  std::vector<ChartStep<Scene>> steps;
  std::vector<ChartStep<Scene>> first{};  // in front of the others, in the first round only
  Walk<Scene> walk{};
};

namespace chart {

// "The PC orders a read; the node answers, 2 times." Equal texts that follow each other are said once.
std::string sentence(const std::vector<std::string>& clauses, const Rounds& rounds);
// "The node is powered. Then, for each register, 20 times: the PC orders a read; the node answers."
std::string sentence(const std::vector<std::string>& first, const std::vector<std::string>& clauses,
                     const Rounds& rounds, const std::string& over);
// "2 of 5: the node answers; expected: the host reports it"
std::string line_of(std::size_t number, std::size_t count, const std::string& stimulus,
                    const std::string& expected);

}  // namespace chart

template <typename Scene>
struct StepTexts {
  std::vector<std::string> stimuli{};
  std::vector<std::string> expectations{};

  explicit StepTexts(const std::vector<ChartStep<Scene>>& steps) {
    for (const ChartStep<Scene>& step : steps) {
      if (!step.stimulus.empty()) stimuli.push_back(step.stimulus);
      if (!step.expected.empty()) expectations.push_back(step.expected);
    }
  }
};

// The case of a chart; what the test case says of stimulus and expectation comes from it.
template <typename Case, typename Scene>
Case charted(TestCase test_case, Chart<Scene> chart, decltype(Case::needs) needs = {}) {
  const StepTexts<Scene> before(chart.first);
  const StepTexts<Scene> after(chart.steps);
  test_case.stimulus = chart::sentence(before.stimuli, after.stimuli, chart.rounds, chart.walk.over);
  test_case.expected = chart::sentence(before.expectations, after.expectations, {}, {});
  const std::size_t count = chart.first.size() + chart.steps.size();
  for (const auto* steps : {&chart.first, &chart.steps}) {
    for (const ChartStep<Scene>& step : *steps) {
      test_case.steps.push_back(
          chart::line_of(test_case.steps.size() + 1, count, step.stimulus, step.expected));
    }
  }
  const auto procedure = [chart, lines = test_case.steps](typename Case::BenchType& bench, CaseJudge& judge) {
    std::size_t rounds = 1;
    for (std::size_t round = 0; round < rounds; ++round) {
      Scene scene(bench, judge, static_cast<unsigned>(round));
      const auto run = [&](const std::vector<ChartStep<Scene>>& steps, std::size_t line) {
        for (const ChartStep<Scene>& step : steps) {
          judge.begin_step(lines[line++]);
          step.run(scene);
        }
      };
      if (round == 0) {
        run(chart.first, 0);
        rounds = bench.volume(chart.rounds.quick, chart.rounds.full) *
                 (chart.walk.count ? chart.walk.count(scene) : 1);
      }
      if (round < rounds) run(chart.steps, chart.first.size());
    }
  };
  return {std::move(test_case), procedure, std::move(needs)};
}

}  // namespace fieldproof::conformance
