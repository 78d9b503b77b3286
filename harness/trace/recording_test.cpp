// Subject: what a recording keeps of a trace, where it ends, and the lines that are written from it.
#include "harness/trace/recording.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "harness/trace/dissector.hpp"

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
  EXPECT_EQ(text_lines(recording, PlainDissector()),
            (std::vector<std::string>{"0 s  line  4 levels  at 1000000 levels/s  [0110]",
                                      "4.000 us  station  output = 7", "1.000 us  line  fault: flip"}));
}

TEST_F(RecordingTest, StepsOfTheCaseStandBeforeWhatHappensInThem) {
  BoundedRecorder recorder(trace);
  record(recorder);
  trace.step(kStart, "1 of 2: ask");
  trace.observe(station, kStart, "output", 7);
  trace.observe(station, kStart + kMicrosecond, "output", 8);
  trace.step(kStart + 2 * kMicrosecond, "2 of 2: wait");
  EXPECT_EQ(text_lines(recorder.take(), PlainDissector()),
            (std::vector<std::string>{"0 s  step 1 of 2: ask", "0 s  station  output = 7",
                                      "1.000 us  station  output = 8", "2.000 us  step 2 of 2: wait"}));
}

TEST_F(RecordingTest, KeepsTheLastStepsOfManyAndSaysSo) {
  BoundedRecorder recorder(trace, 4);
  record(recorder);
  for (int n = 0; n < 9; ++n) trace.step(kStart + n * kMicrosecond, std::to_string(n));
  const Recording recording = recorder.take();
  EXPECT_TRUE(recording.is_cut);
  ASSERT_FALSE(recording.steps.empty());
  EXPECT_LE(recording.steps.size(), 4U);
  EXPECT_EQ(recording.steps.back().text, "8");
}

TEST_F(RecordingTest, ChannelsThatAreAddedLaterHaveTheirNames) {
  BoundedRecorder recorder(trace);
  record(recorder);
  trace.observe(line, kStart, "a");
  const Channel late = trace.add_channel("late");
  trace.observe(late, kStart, "b");
  EXPECT_EQ(recorder.take().channels, (std::vector<std::string>{"line", "station", "late"}));
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
  trace.step(kStart, "1 of 2: ask");
  other.driven(line, sent);
  EXPECT_EQ(trace.fingerprint(), other.fingerprint());
  EXPECT_EQ(trace.record_count(), other.record_count());
}

std::vector<std::string> observed(const Recording& recording) {
  std::vector<std::string> texts;
  for (const Record& record : recording.records) {
    if (const auto* one = std::get_if<Observation>(&record)) texts.push_back(one->what);
  }
  return texts;
}

TEST_F(RecordingTest, KeepsTheLastRecordsOfALongRun) {
  BoundedRecorder recorder(trace, 4);
  record(recorder);
  for (const char* what : {"a", "b", "c", "d"}) trace.observe(line, kStart, what);
  const Recording all = recorder.take();
  EXPECT_FALSE(all.is_cut);
  EXPECT_EQ(observed(all), (std::vector<std::string>{"a", "b", "c", "d"}));
  for (const char* what : {"a", "b", "c", "d", "e"}) trace.observe(line, kStart, what);
  const Recording last = recorder.take();
  EXPECT_TRUE(last.is_cut);
  EXPECT_EQ(observed(last), (std::vector<std::string>{"c", "d", "e"}));
  EXPECT_TRUE(recorder.take().records.empty());
}

TEST(Recording, IsTakenWhenItsTraceIsGone) {
  std::optional<Trace> trace(std::in_place);
  BoundedRecorder recorder(*trace);
  trace->set_recorder(&recorder);
  trace->observe(trace->add_channel("line"), kStart, "a");
  trace.reset();
  const Recording recording = recorder.take();
  EXPECT_EQ(recording.channels, (std::vector<std::string>{"line"}));
  EXPECT_EQ(recording.records.size(), 1U);
}

TEST_F(RecordingTest, KeepsNoMoreLevelsThanItsBound) {
  BoundedRecorder recorder(trace, 100, 20);
  record(recorder);
  for (int n = 0; n < 5; ++n) trace.driven(line, wave_of(kStart + n * kMicrosecond, 0, 6));
  const Recording recording = recorder.take();
  EXPECT_TRUE(recording.is_cut);
  ASSERT_EQ(recording.records.size(), 2U);
  EXPECT_EQ(time_of(recording.records.back()), kStart + 4 * kMicrosecond);
}

TEST_F(RecordingTest, HasNoHoleWhereATransmissionIsTooLong) {
  BoundedRecorder recorder(trace, 100, 20);
  record(recorder);
  trace.observe(line, kStart, "before");
  trace.driven(line, wave_of(kStart, 0, 11));
  trace.observe(line, kStart, "behind");
  const Recording recording = recorder.take();
  EXPECT_TRUE(recording.is_cut);
  EXPECT_EQ(observed(recording), (std::vector<std::string>{"behind"}));
}

TEST_F(RecordingTest, AChangeIsThatOfItsTransmissionInBothParts) {
  BoundedRecorder recorder(trace, 4);
  record(recorder);
  const auto drive = [&](int us) { trace.driven(line, wave_of(kStart + us * kMicrosecond, 0b0110, 4)); };
  const auto change = [&](int us) {
    const std::vector<line::Waveform> arrivals = {wave_of(kStart + us * kMicrosecond, 0b0010, 4)};
    trace.changed(line, kStart + us * kMicrosecond, wave_of(kStart + us * kMicrosecond, 0b0110, 4), arrivals);
  };
  for (const int us : {0, 10, 20, 30, 40}) drive(us);
  for (const int us : {40, 0, 20})
    change(us);  // the first transmission is forgotten, its change is kept apart
  const Recording recording = recorder.take();
  ASSERT_EQ(recording.records.size(), 3U);
  const auto changed = [&](std::size_t n) { return std::get<Transmission>(recording.records[n]).change; };
  ASSERT_TRUE(changed(0) && changed(2));
  EXPECT_FALSE(changed(1));
  EXPECT_EQ(recording.changes.at(*changed(0)).sent.start, kStart + 20 * kMicrosecond);
  EXPECT_EQ(recording.changes.at(*changed(2)).sent.start, kStart + 40 * kMicrosecond);
  EXPECT_EQ(recording.changes.size(), 3U);
}

TEST_F(RecordingTest, WhatArrivesAsItWasSentIsNoChange) {
  BoundedRecorder recorder(trace);
  record(recorder);
  const line::Waveform sent = wave_of(kStart, 0b0110, 4);
  trace.driven(line, sent);
  trace.changed(line, kStart, sent, std::vector{sent});
  EXPECT_TRUE(recorder.take().changes.empty());
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
  const Recording recording = recorder.take();
  for (const Fault* one : FaultIndex(recording).of(change)) told += one->text + " ";
  EXPECT_EQ(told, "10 13 ");
}

}  // namespace
}  // namespace fieldproof::trace
