#include "harness/network/turnaround.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace fieldproof::network {
namespace {

using kernel::kMicrosecond;
using kernel::kStart;

line::Waveform wave_at(std::int64_t microseconds, std::size_t idle, std::size_t low) {
  line::Waveform wave{kStart + microseconds * kMicrosecond, 1'000'000, {}};
  wave.levels.append_idle(idle);
  wave.levels.append_fill(false, low);
  return wave;
}

class TurnaroundTest : public ::testing::Test {
 protected:
  Turnaround meter(AnswerBegin begin) {
    return Turnaround(begin, [this](kernel::Time asked, kernel::Time answered) {
      seen_.push_back((answered - asked) / kMicrosecond);
    });
  }
  std::vector<std::int64_t> seen_;
};

TEST_F(TurnaroundTest, TheFirstTransmissionAfterAQuestionIsItsAnswer) {
  Turnaround one = meter(AnswerBegin::first_level);
  one.on_wave(wave_at(5, 0, 8));
  one.ask(kStart + 100 * kMicrosecond);
  one.on_wave(wave_at(90, 0, 8));
  one.on_wave(wave_at(130, 4, 8));
  one.on_wave(wave_at(200, 0, 8));
  EXPECT_EQ(seen_, (std::vector<std::int64_t>{30}));
}

TEST_F(TurnaroundTest, AnAnswerBeginsWithItsStartBitWhereTheDriverIsOnBefore) {
  Turnaround one = meter(AnswerBegin::start_level);
  one.ask(kStart + 100 * kMicrosecond);
  one.on_wave(wave_at(120, 7, 0));
  one.on_wave(wave_at(130, 4, 8));
  EXPECT_EQ(seen_, (std::vector<std::int64_t>{34}));
}

TEST_F(TurnaroundTest, WhatBeginsAfterAFrameOfSomebodyElseAnswersThat) {
  Turnaround one = meter(AnswerBegin::first_level);
  one.ask(kStart + 100 * kMicrosecond);
  one.expire(kStart + 120 * kMicrosecond);
  one.on_wave(wave_at(150, 0, 8));
  one.ask(kStart + 200 * kMicrosecond);
  one.expire(kStart + 230 * kMicrosecond);
  one.on_wave(wave_at(230, 0, 8));
  EXPECT_EQ(seen_, (std::vector<std::int64_t>{30})) << "its own frame is the answer";
}

TEST_F(TurnaroundTest, AQuestionThatNobodyAnswersIsNotCounted) {
  Turnaround one = meter(AnswerBegin::first_level);
  one.ask(kStart + 100 * kMicrosecond);
  one.ask(kStart + 300 * kMicrosecond);
  one.on_wave(wave_at(310, 0, 8));
  one.ask(kStart + 400 * kMicrosecond);
  one.forget();
  one.on_wave(wave_at(410, 0, 8));
  EXPECT_EQ(seen_, (std::vector<std::int64_t>{10}));
}

}  // namespace
}  // namespace fieldproof::network
