#include "protocols/interbus/telegram_front.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/ring.hpp"

namespace fieldproof::interbus {
namespace {

using testing::HasSubstr;

using TelegramWords = std::vector<std::uint16_t>;

constexpr kernel::Time kSaidAt{20 * kernel::kMillisecond};
constexpr std::uint16_t kStatus = 0;

std::vector<iut::Character> heard_of(TelegramFront& front, const line::Waveform& wave) {
  std::vector<iut::Character> heard;
  front.hear(0, wave, [&](auto telegrams) { heard.insert(heard.end(), telegrams.begin(), telegrams.end()); });
  return heard;
}

std::uint16_t telegram_of(unsigned word) {
  const bool is_data = (word >> kTelegramHeaderBit & line::kDataTelegram) != 0;
  return static_cast<std::uint16_t>(is_data ? word & 0x7FF : word & 0x300);
}

RC_GTEST_PROP(TelegramFrontProperty, WhatIsSaidIsHeard, (std::vector<std::uint16_t> words)) {
  Rules rules;
  rules.bit_rate = *rc::gen::element(500'000, 2'000'000);
  rules.telegram.control_level = *rc::gen::arbitrary<bool>();
  rules.telegram.most_significant_first = *rc::gen::arbitrary<bool>();
  TelegramWords said;
  for (const std::uint16_t word : words) said.push_back(telegram_of(word));
  TelegramFront speaker(rules);
  TelegramFront hearer(rules);
  const std::vector<iut::Character> heard = heard_of(hearer, speaker.levels_of(kSaidAt, said));
  RC_ASSERT(heard.size() == said.size());
  kernel::Time start = kSaidAt;
  for (std::size_t n = 0; n < heard.size(); ++n) {
    RC_ASSERT(heard[n].data == said[n]);
    RC_ASSERT(heard[n].start == start);
    RC_ASSERT(!heard[n].is_stop_missing);
    start = heard[n].busy_until;
  }
  RC_ASSERT(hearer.next_time() == kernel::kNever);
}

RC_GTEST_PROP(TelegramFrontProperty, AnyWordIsATelegramOrRefused, (std::uint16_t word)) {
  TelegramFront front{Rules{}};
  const bool is_telegram = word == telegram_of(word);
  try {
    front.levels_of(kSaidAt, TelegramWords{word});
    RC_ASSERT(is_telegram);
  } catch (const iut::Misbehaviour& refused) {
    RC_ASSERT(!is_telegram);
    RC_ASSERT(refused.reason() == iut::reasons::kImpossible);
  }
}

TEST(TelegramFront, MissingStopLevelIsAFlagAndALongReceptionComesInParts) {
  const Rules rules;
  TelegramFront front(rules);
  const TelegramWords said(TelegramFront::kMostAtOnce + 1, kStatus);
  line::Waveform wave = TelegramFront(rules).levels_of(kSaidAt, said);
  wave.levels.set(wave.levels.size() - 1, false);
  std::vector<std::size_t> parts;
  bool is_stop_missing = false;
  front.hear(0, wave, [&](auto telegrams) {
    parts.push_back(telegrams.size());
    is_stop_missing = telegrams.back().is_stop_missing;
  });
  EXPECT_EQ(parts, (std::vector<std::size_t>{TelegramFront::kMostAtOnce, 1}));
  EXPECT_TRUE(is_stop_missing);
}

TEST(TelegramFront, CutTelegramIsToldWhenItIsOver) {
  const Rules rules;
  TelegramFront front(rules);
  line::Waveform wave = TelegramFront(rules).levels_of(kSaidAt, TelegramWords{0x4FF});
  wave.levels.resize(6);
  EXPECT_TRUE(heard_of(front, wave).empty());
  const kernel::Time end = kernel::level_time(kSaidAt, line::kDataTelegramLevels, rules.bit_rate);
  EXPECT_EQ(front.next_time(), end);
  std::vector<iut::Character> heard;
  const auto tell = [&](unsigned port, auto telegrams) {
    EXPECT_EQ(port, 0U);
    heard.assign(telegrams.begin(), telegrams.end());
  };
  front.complete(end - kernel::kMicrosecond, tell);
  EXPECT_TRUE(heard.empty());
  front.complete(end, tell);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard.front().data, 0x4FF);
  EXPECT_EQ(heard.front().start, kSaidAt);
  EXPECT_EQ(front.next_time(), kernel::kNever);
}

// ---- a slave that hears telegrams ----

class SlaveOfTelegrams : public testing::Test, private segment::Station {
 protected:
  SlaveOfTelegrams() {
    network_.stations = {{.name = "iut", .id_code = 0x0203}, {.name = "neighbour", .id_code = 0x0103}};
    ring_ = std::make_unique<Ring>(
        segment_, network_, segment_.attach(*this, "tester"),
        [this](int position, const SlaveConfiguration& configuration) -> std::unique_ptr<SlaveDevice> {
          if (position != 1) return nullptr;
          return std::make_unique<AttachedSlave>(iut::Attachment{&device_, nullptr, {}}, configuration,
                                                 "interbus/slave/x", 7);
        });
    device_.next = kSaidAt;
    segment_.refresh(ring_->seat(1));
  }

  std::string complaint(iut::ActingDevice::Act act) {
    device_.at_time = std::move(act);
    try {
      segment_.run_until(kSaidAt + kernel::kMillisecond);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kImpossible);
      return done.what();
    }
    return {};
  }

  NetworkDescription network_;
  iut::ActingDevice device_{iut::UnitKind::telegrams};
  segment::Segment segment_;
  std::unique_ptr<Ring> ring_;
  std::vector<line::Waveform> returned_;

 private:
  void receive(segment::PortIndex, const line::Waveform& reception) override {
    returned_.push_back(reception);
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
};

TEST_F(SlaveOfTelegrams, IsToldThemWhenTheReceptionBegins) {
  line::Waveform wave = TelegramFront(network_.rules).levels_of(kSaidAt, TelegramWords{0x5A7, kStatus});
  wave.start = kernel::kStart + kernel::kMillisecond;
  const kernel::Time start = wave.start;
  ring_->out().drive(wave);
  segment_.run_until(start);
  ASSERT_EQ(device_.heard.size(), 2U);
  EXPECT_EQ(device_.heard[0].now, start);
  EXPECT_EQ(device_.heard[0].character.data, 0x5A7);
  EXPECT_EQ(device_.heard[1].now, start);
  EXPECT_EQ(device_.heard[1].character.start, device_.heard[0].character.busy_until);
}

TEST_F(SlaveOfTelegrams, SaysThem) {
  EXPECT_EQ(complaint([](iut::Bench& bench) { bench.send(0, kSaidAt, TelegramWords{kStatus}); }), "");
  ASSERT_EQ(returned_.size(), 1U);
  EXPECT_EQ(returned_.front().levels.text(), "00001");
}

struct Hostile {
  const char* sentence;
  unsigned port;
  kernel::Time start;
  TelegramWords said;
};
class HostileTelegrams : public SlaveOfTelegrams, public testing::WithParamInterface<Hostile> {};

TEST_P(HostileTelegrams, AreImpossible) {
  EXPECT_THAT(
      complaint([](iut::Bench& bench) { bench.send(GetParam().port, GetParam().start, GetParam().said); }),
      HasSubstr(GetParam().sentence));
}

constexpr kernel::Time kPast = kSaidAt - kernel::kMillisecond;
constexpr kernel::Time kFar{5'000 * kernel::kSecond};
INSTANTIATE_TEST_SUITE_P(All, HostileTelegrams,
                         testing::Values(Hostile{"one has an octet, SL", 0, kSaidAt, {0x0800}},
                                         Hostile{"says the telegram FFFFh", 0, kSaidAt, {0, 0xFFFF}},
                                         Hostile{"a status telegram with an octet", 0, kSaidAt, {0x0301}},
                                         Hostile{"drives no level", 0, kSaidAt, {}},
                                         Hostile{"drives from", 0, kPast, {0}},
                                         Hostile{"drives from", 0, kFar, {0}},
                                         Hostile{"drives from", 0, kernel::kNever, {0}},
                                         Hostile{"drives port 1, where nothing", 1, kSaidAt, {0}},
                                         Hostile{"drives port 255, where nothing", 255, kSaidAt, {0}}));

TEST_F(SlaveOfTelegrams, MaySayNoLevels) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                line::Waveform wave{kSaidAt, 500'000, {}};
                wave.levels.append(0b10000, 5);
                bench.transmit(0, wave);
              }),
              HasSubstr("this slave has announced telegrams"));
}

}  // namespace
}  // namespace fieldproof::interbus
