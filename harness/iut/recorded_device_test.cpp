#include "harness/iut/recorded_device.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/arbitrary_text.hpp"

namespace fieldproof::iut {
namespace {

// What a bench meets, in words.
class NotingBench final : public Bench {
 public:
  void set_driver(unsigned port, bool is_on, kernel::Time when) override {
    note("driver " + std::to_string(port) + (is_on ? " on" : " off"), when);
  }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    std::string line = "characters " + std::to_string(port);
    for (const std::uint16_t one : characters) line += " " + std::to_string(one);
    note(line, start);
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    note("levels " + std::to_string(port) + " " + std::to_string(wave.levels.size()) + " " +
             std::to_string(wave.levels.empty() ? 0 : wave.levels.window(0)),
         wave.start);
    wave.levels.clear();
  }
  void write(Item item, std::uint64_t value, kernel::Time when) override {
    note("write " + std::to_string(item) + " " + std::to_string(value), when);
  }
  std::uint64_t read(Item item, kernel::Time when) override {
    note("read " + std::to_string(item), when);
    return 7;
  }
  void set_uncertainty(TimingUncertainty uncertainty) override {
    note("uncertain " + std::to_string(uncertainty.later.count()), kernel::kStart);
  }

  std::vector<std::string> lines;

 private:
  void note(const std::string& what, kernel::Time when) {
    lines.push_back(what + " at " + std::to_string(when.time_since_epoch().count()));
  }
};

class StoredRecording {
 public:
  explicit StoredRecording(const DeviceRecording& recording)
      : path_(std::filesystem::path(testing::TempDir()) /
              ("recording_" + std::to_string(getpid()) + ".json")) {
    std::ofstream(path_) << recording.text();
  }
  ~StoredRecording() { std::filesystem::remove(path_); }
  DeviceRecording load() const { return DeviceRecording::load(path_); }

 private:
  std::filesystem::path path_;
};

kernel::Time at(std::int64_t ticks) {
  return kernel::Time{kernel::Duration{ticks}};
}

// One thing that an implementation does, drawn.
void do_something(Bench& bench, unsigned kind, std::uint64_t value, std::int64_t when) {
  switch (kind % 6) {
    case 0:
      return bench.send(2, at(when), std::array{static_cast<std::uint16_t>(value), std::uint16_t{3}});
    case 1: {
      line::Waveform wave{at(when), 1'000'000, {}};
      wave.levels.append(value, static_cast<unsigned>(1 + value % 64));
      return bench.transmit(1, wave);
    }
    case 2:
      return bench.write(static_cast<Item>(value), value, at(when));
    case 3:
      return bench.set_driver(static_cast<unsigned>(value % 4), value % 2 == 1, at(when));
    case 4:
      bench.read(static_cast<Item>(value), at(when));
      return;
    default:
      return bench.set_uncertainty({{}, kernel::Duration{when}});
  }
}

// A case: supply, then its time again and again.
void call_all(Attachment attachment, Bench& bench, std::vector<kernel::Time>& nexts) {
  Device& device = *attachment.device;
  ASSERT_TRUE(device.begin({"case", 1, {}}, bench));
  device.set_power(true, kernel::kStart);
  while (device.next_time() != kernel::kNever) {
    nexts.push_back(device.next_time());
    device.on_time(device.next_time());
  }
  device.end();
}

RC_GTEST_PROP(RecordedDevice, DoesAgainWhatItDid,
              (std::vector<std::tuple<unsigned, std::uint64_t, std::uint32_t>> acts)) {
  auto acting = std::make_shared<ActingDevice>(UnitKind::levels);
  std::size_t done = 0;
  acting->at_begin = [&](Bench&) { acting->next = at(1); };
  acting->at_time = [&](Bench& bench) {
    if (done == acts.size()) return;
    const auto& [kind, value, when] = acts[done++];
    do_something(bench, kind, value, when);
    acting->next = at(static_cast<std::int64_t>(done) + 1);
  };
  DeviceRecording recording;
  NotingBench first;
  std::vector<kernel::Time> first_nexts;
  call_all(recorded({acting.get(), acting, {}}, recording), first, first_nexts);
  const StoredRecording stored(recording);
  const DeviceRecording loaded = stored.load();
  NotingBench again;
  std::vector<kernel::Time> again_nexts;
  call_all(played_back(loaded, 0), again, again_nexts);
  RC_ASSERT(again.lines == first.lines);
  RC_ASSERT(again_nexts == first_nexts);
}

RC_GTEST_PROP(RecordedDevice, MisbehaviourComesAgainWithItsWords, ()) {
  const std::string sentence = *kernel::arbitrary_text();
  auto acting = std::make_shared<ActingDevice>(UnitKind::characters);
  acting->at_begin = [&](Bench&) { acting->next = at(1); };
  acting->at_time = [&](Bench&) { throw Misbehaviour(reasons::kHangs, sentence, {sentence, "second"}); };
  DeviceRecording recording;
  NotingBench bench;
  std::vector<kernel::Time> nexts;
  RC_ASSERT_THROWS_AS(call_all(recorded({acting.get(), acting, {}}, recording), bench, nexts), Misbehaviour);
  const StoredRecording stored(recording);
  const DeviceRecording loaded = stored.load();
  try {
    call_all(played_back(loaded, 0), bench, nexts);
    RC_FAIL("it did not misbehave");
  } catch (const Misbehaviour& done) {
    RC_ASSERT(done.reason() == reasons::kHangs);
    RC_ASSERT(done.evidence().size() == 2U);
  }
}

// Whoever asked for activity is called with it again, and acts again.
TEST(RecordedDevice, ActivityIsPlayedBack) {
  auto acting = std::make_shared<ActingDevice>(UnitKind::characters);
  Bench* of_case = nullptr;
  acting->at_begin = [&](Bench& bench) { of_case = &bench; };
  acting->at_activity = [&](bool begins) { of_case->write(3, begins ? 1 : 0, at(7)); };
  DeviceRecording recording;
  const auto call = [](const Attachment& attachment, Bench& bench) {
    ASSERT_TRUE(attachment.device->begin({"case", 1, {}}, bench));
    attachment.device->on_activity(0, true, at(5));
    attachment.device->on_activity(0, false, at(6));
    attachment.device->end();
  };
  NotingBench before;
  call(recorded({acting.get(), acting, {}}, recording), before);
  const StoredRecording stored(recording);
  const DeviceRecording loaded = stored.load();
  NotingBench after;
  const Attachment again = played_back(loaded, 0);
  EXPECT_TRUE(again.device->capabilities().senses_activity);
  call(again, after);
  EXPECT_EQ(before.lines, after.lines);
  EXPECT_EQ(after.lines.size(), 2U);
}

TEST(RecordedDevice, AnotherCallThanWasRecordedIsRefused) {
  auto acting = std::make_shared<ActingDevice>(UnitKind::levels);
  DeviceRecording recording;
  NotingBench bench;
  std::vector<kernel::Time> nexts;
  call_all(recorded({acting.get(), acting, {}}, recording), bench, nexts);
  const Attachment again = played_back(recording, 0);
  again.device->begin({"case", 1, {}}, bench);
  try {
    again.device->set_power(true, at(1));
    ADD_FAILURE() << "it was taken";
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    EXPECT_NE(std::string(error.what()).find("call 1 of device 0 is 'power'"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(played_back(recording, 1), kernel::Error);
}

TEST(RecordedDevice, WhatCouldNotBeAttachedFailsAgain) {
  DeviceRecording recording;
  record_failure(recording, Misbehaviour(reasons::kCrashed, "it has ended at once"));
  const StoredRecording stored(recording);
  const DeviceRecording loaded = stored.load();
  try {
    played_back(loaded, 0);
    ADD_FAILURE() << "it was attached";
  } catch (const Misbehaviour& done) {
    EXPECT_EQ(done.reason(), reasons::kCrashed);
    EXPECT_STREQ(done.what(), "it has ended at once");
  }
}

TEST(RecordedDevice, RecordingThatGrowsTooLongSaysSo) {
  auto acting = std::make_shared<ActingDevice>(UnitKind::levels);
  int left = 40;
  acting->at_begin = [&](Bench&) { acting->next = at(1); };
  acting->at_time = [&](Bench& bench) {
    line::Waveform wave{at(1), 1'000'000, {}};
    for (int n = 0; n < 1 << 16; ++n) wave.levels.append(0, 64);
    bench.transmit(0, wave);
    if (--left > 0) acting->next = at(100 - left);
  };
  DeviceRecording recording;
  NotingBench bench;
  std::vector<kernel::Time> nexts;
  call_all(recorded({acting.get(), acting, {}}, recording), bench, nexts);
  EXPECT_TRUE(recording.is_truncated());
  EXPECT_LE(recording.text().size(), 2 * DeviceRecording::kMostOctets);
}

// A case of many sequences makes one device for each of them.
TEST(RecordedDevice, ThousandsInOneRecordingAreLoadedAgain) {
  DeviceRecording recording;
  for (int n = 0; n < 20'000; ++n) recording.add({});
  EXPECT_FALSE(recording.is_truncated());
  EXPECT_EQ(StoredRecording(recording).load().devices().size(), 20'000U);
}

TEST(RecordedDevice, MoreOfThemThanARecordingHoldsAreSaid) {
  DeviceRecording recording;
  for (std::size_t n = 0; n < DeviceRecording::kMostOctets / 200; ++n) recording.add({});
  EXPECT_TRUE(recording.is_truncated());
  EXPECT_LE(recording.text().size(), 2 * DeviceRecording::kMostOctets);
}

}  // namespace
}  // namespace fieldproof::iut
