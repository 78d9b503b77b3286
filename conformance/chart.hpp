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

template <typename Scene>
struct Chart {
  Rounds rounds{};
  std::vector<ChartStep<Scene>> steps;
};

namespace chart {

// "The PC orders a read; the node answers, 2 times." Equal texts that follow each other are said once.
std::string sentence(const std::vector<std::string>& clauses, const Rounds& rounds);
// "2 of 5: the node answers; expected: the host reports it"
std::string line_of(std::size_t number, std::size_t count, const std::string& stimulus,
                    const std::string& expected);

}  // namespace chart

// The case of a chart; what the test case says of stimulus and expectation comes from it.
template <typename Case, typename Scene>
Case charted(TestCase test_case, Chart<Scene> chart, decltype(Case::needs) needs = {}) {
  std::vector<std::string> stimuli;
  std::vector<std::string> expectations;
  for (const ChartStep<Scene>& step : chart.steps) {
    if (!step.stimulus.empty()) stimuli.push_back(step.stimulus);
    if (!step.expected.empty()) expectations.push_back(step.expected);
    test_case.steps.push_back(
        chart::line_of(test_case.steps.size() + 1, chart.steps.size(), step.stimulus, step.expected));
  }
  test_case.stimulus = chart::sentence(stimuli, chart.rounds);
  test_case.expected = chart::sentence(expectations, {});
  const auto procedure = [chart, lines = test_case.steps](typename Case::BenchType& bench, CaseJudge& judge) {
    const unsigned rounds = bench.volume(chart.rounds.quick, chart.rounds.full);
    for (unsigned round = 0; round < rounds; ++round) {
      Scene scene(bench, judge, round);
      for (std::size_t n = 0; n < chart.steps.size(); ++n) {
        judge.begin_step(lines[n]);
        chart.steps[n].run(scene);
      }
    }
  };
  return {std::move(test_case), procedure, std::move(needs)};
}

}  // namespace fieldproof::conformance
