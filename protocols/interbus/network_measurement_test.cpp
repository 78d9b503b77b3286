// Subject: measurements of a ring beside the closed forms of this protocol.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "harness/measure/cyclic_copy.hpp"
#include "harness/network/network_measurement.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/station_timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::kSecond;
using measure::Comparison;
using measure::Frequency;
using measure::Phase;
using network::MeasurementSettings;
using network::SignalRecord;
using network::SignalSettings;

NetworkDescription paper_at_best_cycle() {
  NetworkDescription network = paper_network();
  network.cycle_time = kPaperBestCycle;
  return network;
}

SignalRecord run_at(std::int64_t hertz, LatchModel latch = LatchModel::frame_edges,
                    Duration duration = 20 * kSecond) {
  SignalSettings settings;
  settings.wave.frequency = Frequency::from_hertz(hertz);
  settings.duration = duration;
  RunningNetwork network(paper_at_best_cycle(), {.latch = latch});
  return record_signal(network, settings);
}

double in_cycles(double picoseconds) {
  return picoseconds / static_cast<double>(kPaperBestCycle.count());
}

// The table of the skew model, written down as numbers: square waves with a duty of one half at 0.814 ms.
struct RecordedRow {
  std::int64_t hertz;
  double high_in_cycles;
  double shortest_ms;
  double longest_ms;
  double width_deviation_in_cycles;
  double least_duty;
  double largest_duty;
  double lost;
};

constexpr RecordedRow kRecordedTable[] = {
    {50, 12.285, 9.768, 10.582, 0.451, 0.488, 0.529, 0}, {150, 4.095, 3.256, 4.070, 0.293, 0.488, 0.611, 0},
    {200, 3.071, 2.442, 3.256, 0.257, 0.488, 0.651, 0},  {500, 1.229, 0.814, 1.628, 0.420, 0.407, 0.814, 0},
    {614, 1.0004, 0.814, 1.628, 0.020, 0.500, 1.0, 0},   {700, 0.878, 0.814, 0.814, 0, 0.570, 0.570, 0.1225}};

class GridTest : public testing::TestWithParam<RecordedRow> {};

TEST_P(GridTest, TheNetworkDoesWhatTheTableSays) {
  const RecordedRow& row = GetParam();
  // At 614 Hz one pulse in 2500 is two cycles long.
  const SignalRecord record =
      run_at(row.hertz, LatchModel::frame_edges, row.hertz == 614 ? 60 * kSecond : 20 * kSecond);
  const measure::EdgeSkew& skew = record.paths.front().skew;
  const auto widths = skew.widths.total();
  const auto duty = skew.duty_errors_ppm.total();
  EXPECT_NEAR(static_cast<double>(widths.min()) * 1e-9, row.shortest_ms, 1e-6);
  EXPECT_NEAR(static_cast<double>(widths.max()) * 1e-9, row.longest_ms, 1e-6);
  EXPECT_NEAR(in_cycles(widths.standard_deviation()), row.width_deviation_in_cycles, 0.02);
  EXPECT_NEAR(0.5 + 1e-6 * static_cast<double>(duty.min()), row.least_duty, 6e-4);
  EXPECT_NEAR(0.5 + 1e-6 * static_cast<double>(duty.max()), row.largest_duty, 6e-4);
  const auto pulses = static_cast<double>(skew.pulses);
  EXPECT_NEAR(static_cast<double>(skew.lost_pulses) / pulses, row.lost, 0.01);
  EXPECT_EQ(skew.lost_pulses + skew.lost_pauses == 0, row.lost == 0);
  const double came = (pulses - static_cast<double>(skew.lost_pulses)) / pulses;
  EXPECT_NEAR(in_cycles(widths.mean()) * came, row.high_in_cycles, 0.02);
}

std::string row_name(const testing::TestParamInfo<RecordedRow>& row) {
  return std::to_string(row.param.hertz) + "Hz";
}
INSTANTIATE_TEST_SUITE_P(Table, GridTest, testing::ValuesIn(kRecordedTable), row_name);

struct LatchRow {
  LatchModel latch;
  double least;  // in cycles, without the frame
  bool has_frame;
};

class LatchTest : public testing::TestWithParam<LatchRow> {};

// Of an edge: least delay, half a cycle more in the mean, one more at most, even in between.
TEST_P(LatchTest, DelaysAreThoseOfTheModel) {
  const SignalRecord record = run_at(50, GetParam().latch);
  const double frame = in_cycles(294e6);  // 147 levels from the first to the tenth telegram's end
  const double least = GetParam().least + (GetParam().has_frame ? frame : 0);
  for (const auto* delays :
       {&record.paths.front().skew.rise_delays, &record.paths.front().skew.fall_delays}) {
    const auto all = delays->total();
    EXPECT_NEAR(in_cycles(static_cast<double>(all.min())), least, 0.02);
    EXPECT_GE(in_cycles(static_cast<double>(all.min())), least - 1e-9);
    EXPECT_NEAR(in_cycles(all.mean()), least + 0.5, 0.02);
    EXPECT_NEAR(in_cycles(static_cast<double>(all.max())), least + 1, 0.02);
    EXPECT_NEAR(in_cycles(all.standard_deviation()), 0.2887, 0.02 * 0.2887);
    EXPECT_NEAR(in_cycles(static_cast<double>(all.quantile(0.5))), least + 0.5, 0.02);
    EXPECT_NEAR(in_cycles(static_cast<double>(all.quantile(0.99))), least + 0.99, 0.02);
  }
}

std::string latch_name(const testing::TestParamInfo<LatchRow>& row) {
  return std::string(name(row.param.latch));
}
INSTANTIATE_TEST_SUITE_P(Models, LatchTest,
                         testing::Values(LatchRow{LatchModel::same_instant, 1, false},
                                         LatchRow{LatchModel::frame_edges, 1, true},
                                         LatchRow{LatchModel::previous_frame, 2, false}),
                         latch_name);

TEST(NetworkMeasurementTest, SurvivorsAboveTheHighestFrequencyAreLaterByHalfTheirWidth) {
  const SignalRecord record = run_at(700);
  const auto delays = record.paths.front().skew.rise_delays.total();
  const Duration frame = sample_to_latch(paper_network());
  const Duration expected =
      mean_delay_of_survivors(LatchModel::frame_edges, kPaperBestCycle, frame, record.settings.wave.high());
  EXPECT_NEAR(in_cycles(delays.mean()), in_cycles(static_cast<double>(expected.count())), 0.02);
}

measure::Measurement measure_network(const NetworkDescription& description,
                                     const MeasurementSettings& settings,
                                     LatchModel latch = LatchModel::frame_edges) {
  return network::measure_network(
      [&](std::uint64_t) {
        return std::make_unique<RunningNetwork>(description, RunningStations{.latch = latch});
      },
      settings);
}

std::string differing(const measure::Measurement& measurement) {
  std::string text;
  for (const measure::Series& series : measurement.series) {
    for (const Comparison& one : series.comparisons) {
      if (agreement(one, measurement.tolerance_percent) == measure::Agreement::holds) continue;
      text += series.name + ": " + one.quantity + ": " + std::to_string(one.theory) + " by theory, " +
              std::to_string(one.measured) + " measured\n";
    }
  }
  return text;
}

measure::Measurement measure_signals(const NetworkDescription& network, std::vector<std::int64_t> hertz,
                                     LatchModel latch = LatchModel::frame_edges) {
  MeasurementSettings settings;
  for (const std::int64_t one : hertz) settings.signals.push_back({.frequency = Frequency::from_hertz(one)});
  settings.duration = 20 * kSecond;
  return measure_network(network, settings, latch);
}

TEST(NetworkMeasurementTest, EveryRowOfThePaperNetworkHoldsForEveryModel) {
  for (const LatchModel latch :
       {LatchModel::same_instant, LatchModel::frame_edges, LatchModel::previous_frame}) {
    SCOPED_TRACE(name(latch));
    EXPECT_EQ(differing(measure_signals(paper_at_best_cycle(), {50, 200, 700}, latch)), "");
  }
}

// Paths through branches and 400 m cables, five signals at once.
TEST(NetworkMeasurementTest, EveryRowOfAMixedLineHolds) {
  const auto network =
      NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" / "mixed_line.json");
  const measure::Measurement measurement = measure_signals(network, {50});
  EXPECT_EQ(measurement.series.size(), 6U);
  EXPECT_EQ(differing(measurement), "");
}

TEST(NetworkMeasurementTest, TheShortestCycleIsTheOneOfTheStructure) {
  const measure::Measurement measurement = measure_signals(paper_network(), {50});
  const Comparison& cycle = measurement.series.front().comparisons.front();
  EXPECT_EQ(cycle.quantity, "cycle time");
  EXPECT_DOUBLE_EQ(cycle.theory, 755.0);
  EXPECT_DOUBLE_EQ(cycle.measured, 755.0);
}

// A theory that is wrong must be seen: the same run held against a cycle that is 5 % longer.
TEST(NetworkMeasurementTest, AWrongTheoryDiffers) {
  const SignalRecord record = run_at(50);
  network::PathRecord path = record.paths.front();
  path.path.theory->cycle += kPaperBestCycle / 20;
  EXPECT_EQ(agreement(compare_path(record, path), 2, measure::Phase::quiet), measure::Agreement::differs);
  network::CycleRecord cycle = record.cycles.front();
  cycle.kind.theory += kPaperBestCycle / 20;
  EXPECT_EQ(agreement(compare_cycles(cycle.kind, cycle.times.total(), true), 2, measure::Phase::quiet),
            measure::Agreement::differs);
}

// A bound of jitter is far less than the cycle: what is five times over it is no agreement.
TEST(NetworkMeasurementTest, JitterIsHeldAgainstItsOwnBound) {
  const network::CycleKind kind{
      .name = "macrocycle", .theory = kernel::kSecond, .form = "schedule", .jitter = kernel::kMillisecond};
  const auto with_jitter = [&](kernel::Duration jitter) {
    measure::Distribution times;
    for (int n = 0; n < 1000; ++n) {
      times.add(kind.theory);
      times.add(kind.theory + jitter);
    }
    return agreement(compare_cycles(kind, times, false), 2, measure::Phase::quiet);
  };
  EXPECT_EQ(with_jitter(kernel::kMillisecond), measure::Agreement::holds);
  EXPECT_EQ(with_jitter(5 * kernel::kMillisecond), measure::Agreement::differs);
}

TEST(NetworkMeasurementTest, WhatTheInputNeverHadIsNoAgreement) {
  SignalRecord record = run_at(50, LatchModel::frame_edges, kSecond);
  record.paths.front().skew.foreign_words = 1;
  const auto rows = compare_path(record, record.paths.front());
  EXPECT_EQ(agreement(rows, 2, Phase::quiet), measure::Agreement::differs);
}

TEST(NetworkMeasurementTest, OneTrainLeavesOpenWhatItCannotShow) {
  MeasurementSettings settings;
  settings.signals = {{.frequency = Frequency::from_hertz(200)}};
  settings.duration = kernel::kPicosecond;
  EXPECT_EQ(agreement(measure_network(paper_at_best_cycle(), settings)), measure::Agreement::open);
}

TEST(NetworkMeasurementTest, ProgressIsToldForEachSignal) {
  MeasurementSettings settings;
  settings.signals = {{.frequency = Frequency::from_hertz(50)}, {.frequency = Frequency::from_hertz(60)}};
  settings.duration = kernel::kPicosecond;
  std::vector<std::size_t> done;
  settings.on_progress = [&](std::size_t count) { done.push_back(count); };
  const measure::Measurement measurement = measure_network(paper_network(), settings);
  EXPECT_EQ(done, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(measurement.series.at(1).name, "50 Hz from di16 word 0 to do16 word 0");
  EXPECT_EQ(measurement.series.at(2).name, "60 Hz from di16 word 0 to do16 word 0");
}

}  // namespace
}  // namespace fieldproof::interbus
