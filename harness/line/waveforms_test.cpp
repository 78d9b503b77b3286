#include "harness/line/waveforms.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/line/written_wave.hpp"

namespace fieldproof::line {
namespace {

bool is_same(const Waveform& a, const Waveform& b) {
  return a.start == b.start && a.rate == b.rate && a.levels == b.levels;
}

// Up to 300 levels, often none.
Waveform arbitrary_wave() {
  const std::size_t size = *rc::gen::element<std::size_t>(0, 3, 300);
  Waveform wave = wave_of(*rc::gen::container<std::string>(size, rc::gen::element('0', '1')));
  wave.rate = *rc::gen::inRange(1, 5);
  return wave;
}

// One step with the list and with a plain vector.
void step(Waveforms& list, std::vector<Waveform>& model) {
  switch (*rc::gen::inRange(0, 6)) {
    case 0: {
      const Waveform& added = list.add();
      RC_ASSERT(is_same(added, Waveform{}));
      model.emplace_back();
      break;
    }
    case 1: {
      model.push_back(arbitrary_wave());
      list.add(model.back());
      break;
    }
    case 2: {
      model.push_back(arbitrary_wave());
      Waveform taken = model.back();
      list.take(taken);
      break;
    }
    case 3:
      list.drop_empty();
      std::erase_if(model, [](const Waveform& wave) { return wave.levels.empty(); });
      break;
    case 4: {
      Waveforms other = std::move(list);
      RC_ASSERT(list.empty());  // NOLINT(bugprone-use-after-move): it holds none, by contract
      list = std::move(other);
      break;
    }
    default:
      list.clear();
      model.clear();
  }
}

RC_GTEST_PROP(Waveforms, HoldWhatAVectorHolds, ()) {
  Waveforms list;
  std::vector<Waveform> model;
  for (int steps = *rc::gen::inRange(0, 40); steps > 0; --steps) {
    step(list, model);
    RC_ASSERT(list.size() == model.size());
    RC_ASSERT(std::equal(list.begin(), list.end(), model.begin(), is_same));
  }
}

TEST(Waveforms, FillTheMemoryThatTheyHad) {
  Waveforms list;
  const Waveform wave = wave_of("0101");
  const std::uint64_t* words = list.add(wave).levels.words();
  list.clear();
  EXPECT_EQ(list.add(wave).levels.words(), words);
  list.clear();
  EXPECT_EQ(list.add().levels.words(), words);
  EXPECT_TRUE(list.front().levels.empty());
}

}  // namespace
}  // namespace fieldproof::line
