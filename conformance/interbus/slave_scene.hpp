#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// The words of charts for a slave: what arrives at its receiver, and what has to come of it. The reason codes
// are those of slave_expect.hpp, where a word is given none.
namespace fieldproof::conformance {

// What the steps of one round share.
struct SlaveScene : Scene<SlaveBench> {
  using Scene::Scene;

  std::vector<std::uint16_t> words{};  // of the last data cycle without a fault
  std::string fault{};                 // of the last one with a fault
  kernel::Time last{};                 // end of the last telegram before a silence
};

using SlaveStep = ChartStep<SlaveScene>;
using SlaveChart = Chart<SlaveScene>;

// What not every case has.
struct SlaveExtras {
  std::vector<PartialSource> details{};
  std::vector<std::string> tags{};  // besides "must", which each has
  Applicability only_for{};
  SlaveNeeds needs{};
};

// The id is what comes after "interbus/slave/".
SlaveCase slave_case(std::string_view id, std::string_view purpose, std::string_view requirement,
                     judge::Reference reference, std::vector<MustCatch> catches, SlaveChart chart,
                     SlaveExtras extras = {});

namespace slave_chart {

// Each bit of each word, so that nothing that is taken over is missed.
std::vector<std::uint16_t> inverted_outputs(SlaveBench& bench);

using RuleBits = std::uint16_t interbus::Rules::*;

// A step that needs bench and judge only: also loops, statistics and long trains, which stay code.
inline SlaveStep step(std::string text, std::string outcome, void (*run)(SlaveBench&, CaseJudge&)) {
  return {std::move(text), std::move(outcome), [run](SlaveScene& scene) { run(scene.bench, scene.judge); }};
}

SlaveStep identified(const std::string& whom = "the slave");
SlaveStep data_cycle();
// Of words that differ from the outputs; it is taken over, or the reason is this one.
SlaveStep good_cycle(std::string reason = "valid_cycle_rejected");
SlaveStep status_telegrams(std::size_t count);
SlaveStep silence(std::string text, kernel::Duration (*of)(const interbus::Rules&));

// A data cycle of which one level arrives flipped; all its words differ from the outputs.
using MakeLevel = std::function<std::size_t(SlaveScene&, const CyclePlace&)>;
SlaveStep flipped(std::string text, MakeLevel level);
SlaveStep flipped_bit();  // of loopback word, process data and check, at random
// Of the telegram that has the turn, as for a walk over all of them.
SlaveStep stop_bit_missing();
// The walk over the telegrams of a data cycle, `last` of them not; and the one that has the turn.
Walk<SlaveScene> each_telegram(std::string text, std::size_t last, std::size_t times = 1);
std::size_t telegram_in_turn(const SlaveScene& scene, const CyclePlace& cycle, std::size_t last);

SlaveStep shown(std::string reason = "valid_cycle_rejected");
// The register left, then what came in, with a right check and status word.
SlaveStep answered();
SlaveStep unchanged(std::string reason, std::string why_not);
SlaveStep all_safe();
SlaveStep rejected();
// The fault has changed no output, but where what arrived is by chance a right cycle.
SlaveStep not_taken_over();

// An ID cycle brings this message and no other; none for null.
SlaveStep message(RuleBits bit, std::string reason, std::string why);
// An ID cycle says of a check error what it should, whatever else it says.
SlaveStep check_error(bool is_reported, std::string reason, std::string why);

}  // namespace slave_chart
}  // namespace fieldproof::conformance
