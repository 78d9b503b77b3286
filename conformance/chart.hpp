#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
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

// What every scene has; one of a bench adds what its steps share besides.
template <typename BenchType>
struct Scene {
  Scene(BenchType& bench_, CaseJudge& judge_, unsigned round_)
      : bench(bench_), judge(judge_), round(round_) {}

  BenchType& bench;
  CaseJudge& judge;
  unsigned round;  // from 0
};

// How often all steps are run.
struct Rounds {
  unsigned quick = 1;
  unsigned full = 1;
};

template <typename Scene>
struct ChartStep {
  std::string stimulus;  // what the tester does: "the PC orders a read"; empty: it waits for what must come
  std::string expected;  // what must come: "the host polls the node"; empty: nothing is required
  std::function<void(Scene&)> run;
  Rounds times{};  // of the steps within this one
  // In place of `run`, see `repeated`; else null. Shared, because g++ 12 fails on a vector of its own type
  // here.
  std::shared_ptr<const std::vector<ChartStep>> steps{};

  // A step of a scene is one of each scene that is derived from it.
  template <typename More>
    requires(std::derived_from<More, Scene> && !std::same_as<More, Scene>)
  operator ChartStep<More>() const {
    if (!steps) return {stimulus, expected, run};
    using Steps = std::vector<ChartStep<More>>;
    return {stimulus, expected, run, times, std::make_shared<const Steps>(steps->begin(), steps->end())};
  }
};

template <typename Scene>
ChartStep<Scene> stimulus(std::string text, std::function<void(Scene&)> run) {
  return {std::move(text), {}, std::move(run)};
}

template <typename Scene>
ChartStep<Scene> expected(std::string text, std::function<void(Scene&)> run) {
  return {{}, std::move(text), std::move(run)};
}

// Steps that are run again and again within a round, on its scene, where `scene.turn` counts from 0. Not
// within each other, and once at least.
template <typename Scene>
ChartStep<Scene> repeated(Rounds times, std::vector<ChartStep<Scene>> steps) {
  using Steps = std::vector<ChartStep<Scene>>;
  return {{}, {}, {}, times, std::make_shared<const Steps>(std::move(steps))};
}

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

// The clauses of the steps.
struct Words {
  std::vector<std::string> stimuli{};
  std::vector<std::string> expectations{};
  std::vector<std::string> steps{};  // "the node answers; expected: the host reports it"

  void add(const std::string& stimulus, const std::string& expected);
  void add_repeated(const Words& inner, const Rounds& times);
};

// "The node is powered. Then, for each register, 20 times: the PC orders a read; the node answers, 2 times."
// Equal clauses that follow each other are listed once, with their number.
std::string sentence(const std::vector<std::string>& first, const std::vector<std::string>& clauses,
                     const Rounds& rounds, const std::string& over);
// Fills in the case from its steps: stimulus, expectation, and steps as "2 of 5: ...".
void describe(TestCase& test_case, const Words& first, const Words& words, const Rounds& rounds,
              const std::string& over);

template <typename Scene>
Words words_of(const std::vector<ChartStep<Scene>>& steps) {
  Words words;
  for (const ChartStep<Scene>& step : steps) {
    if (!step.steps) {
      words.add(step.stimulus, step.expected);
    } else {
      words.add_repeated(words_of(*step.steps), step.times);
    }
  }
  return words;
}

// Gives where the lines of what follows begin.
template <typename Scene>
std::size_t run_steps(const std::vector<ChartStep<Scene>>& steps, Scene& scene, auto& bench, CaseJudge& judge,
                      const std::vector<std::string>& lines, std::size_t line = 0) {
  for (const ChartStep<Scene>& step : steps) {
    if (!step.steps) {
      judge.begin_step(lines[line++]);
      step.run(scene);
      continue;
    }
    const std::size_t first = line;
    const unsigned turns = bench.volume(step.times.quick, step.times.full);
    for (unsigned turn = 0; turn < turns; ++turn) {
      if constexpr (requires { scene.turn; }) scene.turn = turn;
      line = run_steps(*step.steps, scene, bench, judge, lines, first);
    }
  }
  return line;
}

}  // namespace chart

// The case of a chart; what the test case says of stimulus and expectation comes from it.
template <typename Case, typename Scene>
Case charted(TestCase test_case, Chart<Scene> chart, decltype(Case::needs) needs = {}) {
  const chart::Words before = chart::words_of(chart.first);
  chart::describe(test_case, before, chart::words_of(chart.steps), chart.rounds, chart.walk.over);
  const auto procedure = [chart, first_lines = before.steps.size(), lines = test_case.steps](
                             typename Case::BenchType& bench, CaseJudge& judge) {
    std::size_t rounds = 1;
    for (std::size_t round = 0; round < rounds; ++round) {
      Scene scene(bench, judge, static_cast<unsigned>(round));
      if (round == 0) {
        chart::run_steps(chart.first, scene, bench, judge, lines);
        rounds = bench.volume(chart.rounds.quick, chart.rounds.full) *
                 (chart.walk.count ? chart.walk.count(scene) : 1);
      }
      if (round < rounds) chart::run_steps(chart.steps, scene, bench, judge, lines, first_lines);
    }
  };
  return {std::move(test_case), procedure, std::move(needs)};
}

}  // namespace fieldproof::conformance
