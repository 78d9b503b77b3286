// Subject: what a recording keeps of a trace, where it ends, and the lines that are written from it.
#include "harness/trace/recording.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/trace/notation.hpp"

namespace fieldproof::trace {
namespace {

using kernel::kMicrosecond;
using kernel::kStart;

line::Waveform wave_of(kernel::Time start, std::uint64_t levels, unsigned count) {
  line::Waveform wave{start, 1'000'000, {}};
  wave.levels.append(levels, count);
  return wave;
}

class RecordingTest : public ::testing::Test {
 protected:
  void record(BoundedRecorder& recorder) { trace.set_recorder(&recorder); }

  Trace trace;
  Channel line = trace.add_channel("line");
  Channel station = trace.add_channel("station");
};

TEST_F(RecordingTest, KeepsRecordsAsTheyWereTold) {
  BoundedRecorder recorder(trace);
  record(recorder);
  trace.driven(line, wave_of(kStart, 0b0110, 4));
  trace.observe(station, kStart + 4 * kMicrosecond, "output", 7);
  trace.fault(line, kStart + kMicrosecond, "flip");
  const Recording recording = recorder.take();
  EXPECT_EQ(recording.channels, (std::vector<std::string>{"line", "station"}));
  EXPECT_FALSE(recording.is_cut);
  EXPECT_EQ(text_lines(recording, PlainNotation()),
            (std::vector<std::string>{"0 s  line  4 levels  at 1000000 levels/s  [0110]",
                                      "4.000 us  station  output = 7", "1.000 us  line  fault: flip"}));
}

TEST_F(RecordingTest, ChannelsThatAreAddedLaterHaveTheirNames) {
  BoundedRecorder recorder(trace);
  record(recorder);
  trace.observe(line, kStart, "a");
  const Channel late = trace.add_channel("late");
  trace.observe(late, kStart, "b");
  EXPECT_EQ(recorder.recording().channels, (std::vector<std::string>{"line", "station", "late"}));
}

TEST_F(RecordingTest, RecordingCostsTheFingerprintNothing) {
  Trace other;
  other.add_channel("line");
  other.add_channel("station");
  BoundedRecorder recorder(trace);
  record(recorder);
  const line::Waveform sent = wave_of(kStart, 0b0110, 4);
  trace.driven(line, sent);
  trace.changed(line, kStart, sent, {});
  other.driven(line, sent);
  EXPECT_EQ(trace.fingerprint(), other.fingerprint());
  EXPECT_EQ(trace.record_count(), other.record_count());
}

TEST_F(RecordingTest, EndsAtItsBoundOfRecords) {
  BoundedRecorder recorder(trace, 2);
  record(recorder);
  trace.observe(line, kStart, "a");
  trace.driven(line, wave_of(kStart, 0, 4));
  EXPECT_FALSE(recorder.recording().is_cut);
  trace.observe(line, kStart, "c");
  EXPECT_TRUE(recorder.recording().is_cut);
  EXPECT_EQ(recorder.recording().records.size(), 2U);
}

TEST_F(RecordingTest, EndsAtItsBoundOfLevelsAndHasNoHole) {
  BoundedRecorder recorder(trace, 100, 10);
  record(recorder);
  trace.driven(line, wave_of(kStart, 0, 10));
  EXPECT_FALSE(recorder.recording().is_cut);
  trace.driven(line, wave_of(kStart, 0, 1));
  trace.observe(line, kStart, "behind");
  EXPECT_TRUE(recorder.recording().is_cut);
  EXPECT_EQ(recorder.recording().records.size(), 1U);
}

TEST_F(RecordingTest, AChangeIsThatOfItsTransmissionAlsoBehindTheBound) {
  BoundedRecorder recorder(trace, 2);
  record(recorder);
  trace.driven(line, wave_of(kStart, 0b0110, 4));
  trace.driven(line, wave_of(kStart + 10 * kMicrosecond, 0b0110, 4));
  trace.observe(line, kStart, "behind");
  line::Waveform sent = wave_of(kStart + 12 * kMicrosecond, 0b0110, 4);
  const std::vector<line::Waveform> arrivals = {wave_of(kStart + 12 * kMicrosecond, 0b0010, 4)};
  trace.changed(line, kStart + 10 * kMicrosecond, sent, arrivals);
  const Recording recording = recorder.take();
  EXPECT_FALSE(std::get<Transmission>(recording.records[0]).change.has_value());
  ASSERT_EQ(std::get<Transmission>(recording.records[1]).change, std::size_t{0});
  EXPECT_EQ(recording.changes.at(0).sent.start, sent.start);
  EXPECT_EQ(recording.changes.at(0).arrivals.size(), 1U);
}

TEST_F(RecordingTest, WhatArrivesAsItWasSentIsNoChange) {
  BoundedRecorder recorder(trace);
  record(recorder);
  const line::Waveform sent = wave_of(kStart, 0b0110, 4);
  trace.driven(line, sent);
  trace.changed(line, kStart, sent, std::vector{sent});
  EXPECT_TRUE(recorder.recording().changes.empty());
}

TEST_F(RecordingTest, ChangesAreToldInOneClause) {
  const line::Waveform sent = wave_of(kStart, 0b0110, 4);
  const auto told = [&](std::vector<line::Waveform> arrivals) {
    return describe(Change{0, sent, std::move(arrivals)});
  };
  EXPECT_EQ(told({}), "lost on the way");
  EXPECT_EQ(told({wave_of(kStart, 0b0010, 4)}), "level 2 changed");
  EXPECT_EQ(told({wave_of(kStart, 0b1001, 4)}), "levels 0, 1, 2, 3 changed");
  EXPECT_EQ(told({wave_of(kStart + kMicrosecond, 0b0110, 4)}), "1.000 us late");
  EXPECT_EQ(told({wave_of(kStart + kMicrosecond, 0b0111, 4)}), "1.000 us late, level 0 changed");
  EXPECT_EQ(told({wave_of(kStart, 0b0110, 3)}), "arrives with 3 levels instead of 4");
  EXPECT_EQ(told({sent, wave_of(kStart + 9 * kMicrosecond, 0, 1)}), "arrives as 2 transmissions");
}

TEST_F(RecordingTest, FaultsOfAChangeLieWithinWhatWasSent) {
  BoundedRecorder recorder(trace);
  record(recorder);
  const auto fault = [&](Channel channel, int us) {
    trace.fault(channel, kStart + us * kMicrosecond, std::to_string(us));
  };
  fault(line, 14);
  fault(line, 10);
  fault(line, 13);
  fault(line, 9);
  fault(station, 11);
  const Change change{line, wave_of(kStart + 10 * kMicrosecond, 0, 4), {}};
  std::string told;
  for (const Fault* one : FaultIndex(recorder.recording()).of(change)) told += one->text + " ";
  EXPECT_EQ(told, "10 13 ");
}

}  // namespace
}  // namespace fieldproof::trace
