#include "protocols/interbus/attached_slave.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/ring.hpp"

namespace fieldproof::interbus {
namespace {

using iut::ActingDevice;
using kernel::kMillisecond;
using kernel::kNever;
using kernel::kStart;
using testing::HasSubstr;

constexpr kernel::Time kNow{20 * kMillisecond};

StationDescription station(const char* name, std::uint16_t id_code) {
  return {.name = name, .id_code = id_code, .cable_m = 0, .is_local = false, .branch = {}};
}

// The device in a ring with one station after it.
class AttachedSlaveTest : public testing::Test, private segment::Station {
 protected:
  AttachedSlaveTest() { network_.stations = {station("iut", 0x0203), station("neighbour", 0x0103)}; }

  void attach() {
    ring_ = std::make_unique<Ring>(
        segment_, network_, segment_.attach(*this, "tester"),
        [this](int position, const SlaveConfiguration& configuration) -> std::unique_ptr<SlaveDevice> {
          if (position != 1) return nullptr;
          return std::make_unique<AttachedSlave>(
              iut::Attachment{&device_, nullptr, [this] { ++well_ended_; }}, configuration,
              "interbus/slave/x", 7);
        });
    device_.next = kNow;
    segment_.refresh(ring_->seat(1));
  }
  // What is told about an implementation that acts so; empty when there is nothing wrong with it.
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    if (!ring_) attach();
    try {
      segment_.run_until(kNow + kMillisecond);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kImpossible);
      return done.what();
    }
    return {};
  }
  static line::Waveform wave_at(kernel::Time start) {
    line::Waveform wave{start, 500'000, {}};
    wave.levels.append(0b10110, 5);
    return wave;
  }

  NetworkDescription network_;
  ActingDevice device_{iut::UnitKind::levels};
  segment::Segment segment_;
  std::unique_ptr<Ring> ring_;
  int well_ended_ = 0;
  std::vector<line::Waveform> returned_;

 private:
  void receive(segment::PortIndex, const line::Waveform& reception) override {
    returned_.push_back(reception);
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kNever; }
};

SlaveConfiguration back(const SlaveConfiguration& configuration) {
  return slave_configuration_of({"x", 1, slave_settings(configuration)});
}

TEST_F(AttachedSlaveTest, SettingsComeBack) {
  SlaveConfiguration configuration;
  configuration.id_code = 0x1ABC;
  configuration.words = 7;
  configuration.has_branch = true;
  Rules& rules = configuration.rules;
  rules.bit_rate = 2'000'000;
  rules.forward_delay_half_bits = 5;
  rules.return_delay_half_bits = 1;
  rules.status_marked = 0x8001;
  rules.control_reset = 0x0100;
  rules.message_check_error = 0x1000;
  rules.silence_limit = 7 * kMillisecond;
  rules.frame_check = "CRC-16/KERMIT";
  rules.telegram.header = {line::HeaderLevel::flag, line::HeaderLevel::select, line::HeaderLevel::control};
  rules.telegram.control_level = false;
  rules.telegram.most_significant_first = false;
  const SlaveConfiguration told = back(configuration);
  EXPECT_EQ(told.id_code, configuration.id_code);
  EXPECT_EQ(told.words, configuration.words);
  EXPECT_TRUE(told.has_branch);
  EXPECT_EQ(told.rules.telegram, rules.telegram);
  EXPECT_EQ(told.rules.frame_check, rules.frame_check);
  EXPECT_EQ(told.rules.silence_limit, rules.silence_limit);
  EXPECT_EQ(slave_settings(told), slave_settings(configuration));
}

TEST_F(AttachedSlaveTest, SlaveOnALocalBusComesBackWithItsDelays) {
  SlaveConfiguration configuration;
  configuration.is_local = true;
  configuration.rules.local_delay_half_bits = 2;
  EXPECT_EQ(back(configuration).rules.forward_delay_half_bits, 2U);
  EXPECT_EQ(back(configuration).rules.return_delay_half_bits, 2U);
}

TEST_F(AttachedSlaveTest, SettingsThatNobodyKnowsAreRefused) {
  iut::CaseBegin begin{"x", 1, slave_settings(SlaveConfiguration{})};
  for (auto& [name, value] : begin.settings) {
    if (name == "check_polynomial") value = 0x1234;
  }
  EXPECT_THROW(slave_configuration_of(begin), kernel::Error);
}

TEST_F(AttachedSlaveTest, DeviceIsToldTheCaseAndSupplied) {
  attach();
  EXPECT_EQ(device_.told.id, "interbus/slave/x");
  EXPECT_EQ(device_.told.seed, 7U);
  EXPECT_EQ(device_.told.settings, slave_settings(ring_->configuration(1)));
  EXPECT_EQ(device_.power, std::vector<bool>{true});
  ring_->end();
  ring_->end();
  EXPECT_EQ(device_.ends, 1);
  EXPECT_EQ(well_ended_, 1);
}

TEST_F(AttachedSlaveTest, ImplementationInCharactersCannotBeAttached) {
  ActingDevice in_characters(iut::UnitKind::characters);
  EXPECT_THROW(AttachedSlave(iut::Attachment{&in_characters, nullptr, {}}, {}, "interbus/slave/x", 7),
               kernel::Error);
}

TEST_F(AttachedSlaveTest, ReceptionIsToldWhenItBegins) {
  attach();
  line::Waveform wave = wave_at(kStart + kMillisecond);
  const line::Waveform sent = wave;
  ring_->out().drive(wave);
  segment_.run_until(sent.start);
  ASSERT_EQ(device_.heard_levels.size(), 1U);
  EXPECT_EQ(device_.heard_levels.front().port, kFromUpstream);
  EXPECT_EQ(device_.heard_levels.front().wave.start, sent.start);
  EXPECT_EQ(device_.heard_levels.front().wave.levels.text(), sent.levels.text());
}

TEST_F(AttachedSlaveTest, DrivesWhereSomethingIsPluggedIn) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              line::Waveform wave = wave_at(kNow);
              bench.transmit(kFromUpstream, wave);
              wave = wave_at(kNow);
              bench.transmit(kFromRemote, wave);
            }),
            "");
  EXPECT_EQ(returned_.size(), 1U);
}

TEST_F(AttachedSlaveTest, DriveWhereNothingIsPluggedInIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                line::Waveform wave = wave_at(kNow);
                bench.transmit(kFromBranch, wave);
              }),
              HasSubstr("drives port 1, where nothing is plugged in"));
}

TEST_F(AttachedSlaveTest, DriveInThePastIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                line::Waveform wave = wave_at(kNow - kMillisecond);
                bench.transmit(kFromUpstream, wave);
              }),
              HasSubstr("drives from"));
}

// Each of them may be: together they would fill the memory.
TEST_F(AttachedSlaveTest, DrivesMoreThanItsLinesCarry) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                for (int n = 0; n < 6; ++n) {
                  line::Waveform wave = wave_at(kNow);
                  wave.levels.append_idle(1'000'000);
                  bench.transmit(kFromUpstream, wave);
                }
              }),
              HasSubstr("has driven 12.000060 s of levels until 20.000 ms"));
}

class AttachedSlaveFloods : public AttachedSlaveTest {
 protected:
  std::string flood_of(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    attach();
    try {
      segment_.run_until(kNow + kMillisecond);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kFloods);
      return done.what();
    }
    return {};
  }
};

TEST_F(AttachedSlaveFloods, MovesItsOutputsWithoutEnd) {
  EXPECT_THAT(flood_of([](iut::Bench& bench) {
                while (true) bench.write(0, 1, kNow);
              }),
              HasSubstr("3020001 times until 20.000 ms"));
}

TEST_F(AttachedSlaveFloods, DrivesFinerLevelsThanAnybodyLooksAt) {
  EXPECT_THAT(flood_of([](iut::Bench& bench) {
                for (int n = 0; n < 13; ++n) {
                  line::Waveform wave{kNow, 100'000'000'000, {}};
                  wave.levels.append_idle(10'000'000);
                  bench.transmit(kFromUpstream, wave);
                }
              }),
              HasSubstr("has driven 130000000 levels until 20.000 ms"));
}

TEST_F(AttachedSlaveFloods, AsksForTheSameInstantWithoutEnd) {
  EXPECT_THAT(flood_of([this](iut::Bench&) { device_.next = kNow; }),
              HasSubstr("20000 calls since 20.000 ms"));
}

TEST_F(AttachedSlaveFloods, CreepsOn) {
  EXPECT_THAT(flood_of([this, n = 0](iut::Bench&) mutable { device_.next = kNow + kernel::Duration{++n}; }),
              HasSubstr("20000 calls since 20.0000"));
}

// A clock of 100 MHz.
TEST_F(AttachedSlaveFloods, FastClockIsNone) {
  EXPECT_EQ(
      flood_of([this, n = 0](iut::Bench&) mutable { device_.next = kNow + ++n * 10 * kernel::kNanosecond; }),
      "");
}

TEST_F(AttachedSlaveTest, CharactersAreImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.send(0, kNow, std::array<std::uint16_t, 1>{1}); }),
              HasSubstr("this slave has announced levels"));
}

TEST_F(AttachedSlaveTest, TerminalsAreReadAndWrittenByWord) {
  attach();
  ring_->terminals(1).set_input(1, 0xBEEF);
  ring_->slave(1).set_next_present(false, false);
  std::vector<std::uint64_t> read;
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              for (const iut::Item item :
                   {iut::Item{0x101}, kPeripheralFault, kReconfiguration, kRemotePlugged, kBranchPlugged}) {
                read.push_back(bench.read(item, kNow));
              }
              bench.write(1, 0xCAFE, kNow);
            }),
            "");
  EXPECT_THAT(read, testing::ElementsAre(0xBEEF, 0, 0, 0, 0));
  EXPECT_EQ(ring_->terminals(1).outputs(), (std::vector<std::uint16_t>{0, 0xCAFE}));
}

TEST_F(AttachedSlaveTest, BridgeOfAPlugWithAStationBehindItIsClosed) {
  std::uint64_t remote = 0;
  EXPECT_EQ(complaint([&](iut::Bench& bench) { remote = bench.read(kRemotePlugged, kNow); }), "");
  EXPECT_EQ(remote, 1U);
}

class AttachedSlaveWrites : public AttachedSlaveTest,
                            public testing::WithParamInterface<std::pair<iut::Item, std::uint64_t>> {};

TEST_P(AttachedSlaveWrites, OfWordsThatItDoesNotHaveAreImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.write(GetParam().first, GetParam().second, kNow); }),
              HasSubstr("2 output words"));
}

INSTANTIATE_TEST_SUITE_P(Words, AttachedSlaveWrites,
                         testing::Values(std::pair{iut::Item{2}, std::uint64_t{0}},
                                         std::pair{iut::Item{0}, std::uint64_t{0x1'0000}},
                                         std::pair{kInputWord, std::uint64_t{1}},
                                         std::pair{iut::Item{0xFFFF}, std::uint64_t{1}}));

// Each word by itself.
TEST_F(AttachedSlaveTest, OutputsBeforeTheLastOnesAreImpossible) {
  const auto written = [&](iut::Item second) {
    return complaint([=](iut::Bench& bench) {
      bench.write(0, 1, kNow + kMillisecond);
      bench.write(second, 1, kNow);
    });
  };
  EXPECT_THAT(written(0), HasSubstr("lies before the last one"));
  EXPECT_EQ(written(1), "");
}

TEST_F(AttachedSlaveTest, InputThatItDoesNotHaveIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.read(0x102, kNow); }), HasSubstr("2 input words"));
}

TEST_F(AttachedSlaveTest, OneThatDidWrongIsNotCalledAgain) {
  EXPECT_NE(complaint([](iut::Bench& bench) { bench.read(0x102, kNow); }), "");
  device_.next = kNow;
  EXPECT_EQ(ring_->slave(1).next_time(), kNever);
  ring_->end();
  EXPECT_EQ(device_.ends, 0);
  EXPECT_EQ(well_ended_, 0);
}

}  // namespace
}  // namespace fieldproof::interbus
