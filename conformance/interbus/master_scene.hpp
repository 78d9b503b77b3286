#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/interbus/master_cases.hpp"

// The words of charts for a master: what the ring does, what the application does, what has to come of it.
namespace fieldproof::conformance {

// What the steps of one round share.
struct RingScene : Scene<MasterBench> {
  using Scene::Scene;

  MasterBench::Suffered suffered{};  // by the last cycle with a fault
  std::uint16_t held = 0;            // inputs that have to stay
};

using MasterStep = ChartStep<RingScene>;
using MasterChart = Chart<RingScene>;

// The id is what comes after "interbus/master/".
MasterCase master_case(std::string_view id, std::string_view purpose, std::string_view requirement,
                       judge::Reference reference, std::vector<std::string> tags,
                       std::vector<MustCatch> catches, MasterChart chart);
MasterCase resting_also_on(PartialSource detail, MasterCase one);

namespace master_chart {

using Ring = std::vector<interbus::VirtualStation>;
using Prepare = void (*)(MasterBench&);
inline constexpr std::uint16_t kOneWord = 0x0103;  // the ID code of a station with inputs and outputs

// A step that needs bench and judge only: also loops, statistics and long runs, which stay code.
using Procedure = void (*)(MasterBench&, CaseJudge&);
inline MasterStep step(std::string text, std::string outcome, Procedure run) {
  return {std::move(text), std::move(outcome), [run](RingScene& scene) { run(scene.bench, scene.judge); }};
}

// A fresh master on this ring; it recognises it and runs. `prepare` sets rules and configuration before.
MasterStep in_run(std::string where, Ring ring, Prepare prepare = nullptr);
// On the ring of the cycle-time paper: two input and output octets each.
MasterStep in_run(Prepare prepare = nullptr);
MasterStep data_cycles(unsigned count);
// What the rounds walk over, so many.
Walk<RingScene> each(std::string over, std::size_t count);

// A bit of the first input word changed after the last station.
void spoil(interbus::CycleFaults& faults);
void expect_next_cycle(MasterBench& bench, CaseJudge& judge);

// A data cycle that suffers faults is rejected, for this reason when not, and the inputs stay.
using MakeFaults = std::function<void(RingScene&, interbus::CycleFaults&)>;
MasterStep rejected(std::string how, std::string reason, MakeFaults faults);

// Four more data cycles of so many stations without words take, within 2 %, what the delays of all stations
// and of the cables (`of_cable`) make of them; else this is the reason.
inline constexpr std::uint16_t kNoWord = 0x0003;  // the ID code of a station without a register
void expect_cycle_time_without_words(MasterBench& bench, CaseJudge& judge, std::size_t stations,
                                     kernel::Duration of_cable, std::string_view reason);

// The master is no more in run, and names an error of configuration.
MasterStep configuration_error(std::string text, std::string reason);

}  // namespace master_chart
}  // namespace fieldproof::conformance
