#include "protocols/interbus/attached_master.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "harness/field/facts.hpp"
#include "harness/iut/acting_device.hpp"
#include "harness/iut/limits.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::interbus {
namespace {

using iut::ActingDevice;
using kernel::kMillisecond;
using kernel::kNever;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr kernel::Time kStartedAt{5 * kMillisecond};
constexpr kernel::Time kCalledAt{20 * kMillisecond};

void drive_something(iut::Bench& bench) {
  line::Waveform wave{kCalledAt, 500'000, {}};
  wave.levels.append(0b10110, 5);
  bench.transmit(0, wave);
}

void end_good_cycle(iut::Bench& bench) {
  drive_something(bench);
  bench.write(kCycleEnd, 3, kCalledAt);
}

class AttachedMasterTest : public testing::Test, private segment::Port {
 protected:
  AttachedMasterTest() { master_.wire(*this); }

  void start() { master_.start(kStartedAt); }
  // What is told about an implementation that acts so; empty when there is nothing wrong with it.
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    if (device_.power.empty()) start();
    try {
      master_.on_time(kCalledAt);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kImpossible);
      return done.what();
    }
    return {};
  }
  std::string complaint_about(iut::Item item, std::uint64_t value) {
    return complaint([=](iut::Bench& bench) { bench.write(item, value, kCalledAt); });
  }
  // What was ordered after the start, and when.
  std::vector<std::uint16_t> ordered() const {
    std::vector<std::uint16_t> all;
    for (const ActingDevice::Heard& heard : device_.heard) {
      EXPECT_EQ(heard.port, kApplicationPort);
      all.push_back(heard.character.data);
    }
    return all;
  }

  ActingDevice device_{iut::UnitKind::levels};
  int well_ended_ = 0;
  AttachedMaster master_{
      iut::Attachment{&device_, nullptr, [this] { ++well_ended_; }}, {}, "interbus/master/x", 7};
  std::vector<line::Waveform> driven_;

 private:
  void drive(line::Waveform& wave) override { driven_.push_back(std::move(wave)); }
};

// ---- settings ----

TEST(MasterSettings, ComeBack) {
  MasterConfiguration configuration;
  configuration.cycle_time = kernel::Duration{1'234'567'891};
  configuration.expected = {{0x0008, 0, -1, false}, {0x01BE, 1, 0, true}, {0x1FFF, 300, 1, false}};
  configuration.copy = {{3, 0}, {0xFFF, 0xABC}};
  Rules& rules = configuration.rules;
  rules.bit_rate = 2'000'000;
  rules.software_time = kernel::Duration{7};
  rules.telegram_gap_millibits = 0;
  rules.status_pitch_bits = 9;
  rules.forward_delay_half_bits = 5;
  rules.return_delay_half_bits = 1;
  rules.cable_delay_ps_per_m = 4'321;
  rules.loopback_word = 0x1234;
  rules.frame_check = "CRC-16/KERMIT";
  rules.status_clean = 0x8000;
  rules.end_telegrams = 2;
  rules.silence_limit = 7 * kMillisecond;
  rules.stop_after_bad_cycles = 3;
  rules.quality_bad_cycles = 4;
  rules.quality_window_cycles = 77;
  rules.max_stations = 9;
  rules.max_io_points = 96;
  rules.max_levels = 2;
  rules.max_cable_m = 100;
  rules.control_local_off = 0x0100;
  rules.message_check_error = 0x1000;
  rules.telegram.header = {line::HeaderLevel::flag, line::HeaderLevel::select, line::HeaderLevel::control};
  rules.length_codes = {{0, 0}, {31, 200}};
  const iut::CaseBegin begin{"x", 1, master_settings(configuration)};
  const MasterConfiguration told = master_configuration_of(begin);
  EXPECT_EQ(begin.settings, master_settings(told));
  EXPECT_EQ(told.cycle_time, configuration.cycle_time);
  EXPECT_EQ(told.expected, configuration.expected);
  ASSERT_EQ(told.copy.size(), 2U);
  EXPECT_EQ(told.copy[1].output_word, 0xABCU);
  ASSERT_EQ(told.rules.length_codes.size(), 2U);
  EXPECT_EQ(told.rules.length_codes[1].words, 200);
  EXPECT_EQ(told.rules.telegram, rules.telegram);
  // But for what no master looks at, nothing is as the reference has it.
  Rules same = rules;
  same.length_codes = {};
  Rules back = told.rules;
  back.length_codes = {};
  const auto values = [](const Rules& of) {
    std::vector<std::string> all;
    for (const field::Fact& fact : field::facts_of(kRulesTable, of))
      all.push_back(fact.name + " " + fact.value);
    return all;
  };
  EXPECT_EQ(values(back), values(same));
}

TEST(MasterSettings, ThePublishedLengthCodesAreTold) {
  const MasterConfiguration told = master_configuration_of({"x", 1, master_settings({})});
  EXPECT_EQ(told.rules.length_codes.size(), published_length_codes().size());
  for (const LengthCode& one : published_length_codes()) {
    EXPECT_EQ(std::ranges::count_if(
                  told.rules.length_codes,
                  [&](const LengthCode& back) { return back.code == one.code && back.words == one.words; }),
              1)
        << int{one.code};
  }
}

TEST(MasterSettings, ValuesOutsideOfTheirRangeAreRefused) {
  const field::Settings impossible{{"status_pitch_bits", 0},
                                   {"quality_bad_cycles", -5},
                                   {"max_stations", 1'000'000},
                                   {"expected", 1'000'000'000},
                                   {"cycle_time", -1}};
  for (const auto& one : impossible) {
    try {
      master_configuration_of({"x", 1, {one}});
      ADD_FAILURE() << one.first;
    } catch (const kernel::Error& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("'" + one.first + "' is " + std::to_string(one.second)));
    }
  }
}

// ---- what the bench does ----

TEST_F(AttachedMasterTest, SupplyComesWithTheFirstStart) {
  EXPECT_EQ(device_.told.id, "interbus/master/x");
  EXPECT_TRUE(device_.power.empty());
  start();
  master_.start(kCalledAt);
  EXPECT_EQ(device_.power, std::vector<bool>{true});
  EXPECT_THAT(ordered(), ElementsAre(1, 1));
  EXPECT_EQ(device_.heard.back().now, kCalledAt);
}

TEST_F(AttachedMasterTest, OrdersAreCharactersOfTheApplication) {
  start();
  device_.heard.clear();
  master_.write_output(0x123, 0xBEEF, kCalledAt);
  master_.request_id_cycle(kCalledAt);
  master_.stop(kCalledAt);
  EXPECT_THAT(ordered(), ElementsAre(4, 0x123, 0xBEEF, 3, 2));
  for (const ActingDevice::Heard& heard : device_.heard) EXPECT_EQ(heard.now, kCalledAt);
}

TEST_F(AttachedMasterTest, WordBeyondAllImagesIsNotOrdered) {
  start();
  device_.heard.clear();
  master_.write_output(kMostMasterWords, 1, kCalledAt);
  EXPECT_THAT(ordered(), ElementsAre());
}

TEST_F(AttachedMasterTest, OrdersWithinTheHookComeBehindTheCall) {
  start();
  device_.heard.clear();
  std::size_t heard_in_the_call = 1;
  master_.on_cycle_end([&](kernel::Time now, bool, bool) { master_.write_output(1, 2, now); });
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              end_good_cycle(bench);
              heard_in_the_call = device_.heard.size();
            }),
            "");
  EXPECT_EQ(heard_in_the_call, 0U);
  EXPECT_THAT(ordered(), ElementsAre(4, 1, 2));
}

TEST_F(AttachedMasterTest, OrdersWithinTheHookCanBeReadAtOnce) {
  start();
  device_.heard.clear();
  master_.on_cycle_end([&](kernel::Time now, bool, bool) {
    master_.write_output(0x123, 0xBEEF, now);
    master_.request_id_cycle(now);
  });
  std::vector<std::uint64_t> orders;
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              end_good_cycle(bench);
              do {
                orders.push_back(bench.read(kNextOrder, kCalledAt));
              } while (orders.back() != 0);
            }),
            "");
  EXPECT_THAT(orders, ElementsAre(0xBEEF'0123'0004, 3, 0));
  EXPECT_THAT(ordered(), ElementsAre());
}

TEST_F(AttachedMasterTest, ManyOrdersComeOneBehindTheOther) {
  start();
  device_.heard.clear();
  master_.on_cycle_end([&](kernel::Time now, bool, bool) {
    for (unsigned word = 0; word < kMostMasterWords; ++word) master_.write_output(word, 1, now);
  });
  EXPECT_EQ(complaint(&end_good_cycle), "");
  EXPECT_EQ(ordered().size(), 3 * kMostMasterWords);
}

TEST_F(AttachedMasterTest, EndedOneIsNotCalledAgainAndKeepsWhatItHasTold) {
  EXPECT_EQ(complaint_about(kDataCycles, 5), "");
  device_.next = kCalledAt;
  master_.end();
  master_.end();
  EXPECT_EQ(device_.ends, 1);
  EXPECT_EQ(well_ended_, 1);
  device_.heard.clear();
  master_.start(kCalledAt);
  master_.on_time(kCalledAt);
  EXPECT_TRUE(device_.heard.empty());
  EXPECT_EQ(master_.next_time(), kNever);
  EXPECT_EQ(master_.status().data_cycles, 5U);
}

// ---- what the implementation does ----

TEST_F(AttachedMasterTest, StatusIsWhatWasWritten) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              const auto write = [&](iut::Item item, std::uint64_t value) {
                bench.write(item, value, kCalledAt);
              };
              write(kMasterState, 5);
              write(kDataCycles, 1'000'000'007);
              write(kIdCycles, 3);
              write(kRejectedCycles, 12);
              write(kRejectedDataCycles, 11);
              write(kConsecutiveBad, 10);
              write(kQualityBit, 1);
              write(kCycleTime, 755'000'000);
              write(kFaultPlace, std::uint64_t{1} << 32 | 2 | 0 << 16);
              write(kFoundStation, 0x0008);
              write(kFoundStation + 1, 0x1'0001'0001'01BE);
              write(kStationMessages, 2);
              write(kStationMessages + 1, 3);
              write(kStationCount, 2);
              write(kErrorText, 0x6976'6564'206F'6E20);  // " no devi"
              write(kErrorText + 1, 0x1B65'63);          // "ce" ESC
            }),
            "");
  MasterStatus expected;
  expected.state = MasterState::bus_stop;
  expected.stations = {{0x0008, 0, -1, false}, {0x01BE, 1, 0, true}};
  expected.configuration_error =
      " no devi"
      "ce\\x1B";
  expected.data_cycles = 1'000'000'007;
  expected.id_cycles = 3;
  expected.rejected_cycles = 12;
  expected.rejected_data_cycles = 11;
  expected.consecutive_bad = 10;
  expected.quality_bit = true;
  expected.has_fault_location = true;
  expected.fault_location = {1, -1};
  expected.peripheral_faults = {1};
  expected.reconfigurations = {0, 1};
  expected.cycle_time = 755 * kernel::kMicrosecond;
  EXPECT_EQ(master_.status(), expected) << master_.status().configuration_error;
}

TEST_F(AttachedMasterTest, HookSeesWhatTheCycleHasChanged) {
  std::vector<std::uint64_t> seen;
  master_.on_cycle_end([&](kernel::Time now, bool is_data, bool is_accepted) {
    EXPECT_EQ(now, kCalledAt);
    seen = {master_.status().data_cycles, master_.input(1), master_.output(2), is_data ? 1U : 0U,
            is_accepted ? 1U : 0U};
  });
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              bench.write(kDataCycles, 9, kCalledAt);
              bench.write(kInputImage + 1, 0xCAFE, kCalledAt);
              bench.write(kOutputImage + 2, 0xBEEF, kCalledAt);
              drive_something(bench);
              bench.write(kCycleEnd, 1, kCalledAt);
              bench.write(kDataCycles, 10, kCalledAt);
            }),
            "");
  EXPECT_THAT(seen, ElementsAre(9, 0xCAFE, 0xBEEF, 1, 0));
}

TEST_F(AttachedMasterTest, DrivesItsLine) {
  EXPECT_EQ(complaint(&drive_something), "");
  ASSERT_EQ(driven_.size(), 1U);
  EXPECT_EQ(driven_[0].start, kCalledAt);
}

TEST_F(AttachedMasterTest, CycleWithinAnOrderIsImpossible) {
  class EndsCycle final : public iut::Device {
   public:
    iut::UnitKind unit_kind() const override { return iut::UnitKind::levels; }
    bool begin(const iut::CaseBegin&, iut::Bench& bench) override {
      bench_ = &bench;
      return true;
    }
    void set_power(bool, kernel::Time) override {}
    void receive(unsigned, std::span<const iut::Character>, kernel::Time now) override {
      bench_->write(kCycleEnd, 1, now);
    }
    void receive(unsigned, const line::Waveform&) override {}
    void on_time(kernel::Time) override {}
    kernel::Time next_time() const override { return kNever; }
    void end() override {}

   private:
    iut::Bench* bench_ = nullptr;
  } device;
  AttachedMaster master(iut::Attachment{&device, nullptr, {}}, {}, "interbus/master/x", 7);
  EXPECT_THROW(master.start(kStartedAt), iut::Misbehaviour);
}

TEST_F(AttachedMasterTest, AskingForTheSameInstantWithoutEndIsAFlood) {
  device_.at_time = [this](iut::Bench&) { device_.next = kCalledAt; };
  start();
  const auto call_again = [this] {
    for (unsigned n = 0; n < 2 * iut::kMostActions + 2; ++n) master_.on_time(kCalledAt);
  };
  EXPECT_THROW(call_again(), iut::Misbehaviour);
}

TEST_F(AttachedMasterTest, ImplementationInCharactersCannotBeAttached) {
  ActingDevice in_characters(iut::UnitKind::characters);
  EXPECT_THROW(AttachedMaster(iut::Attachment{&in_characters, nullptr, {}}, {}, "interbus/master/x", 7),
               kernel::Error);
}

TEST_F(AttachedMasterTest, RingOfMoreWordsThanThereAreIsImpossible) {
  EXPECT_THAT(complaint([](iut::Bench& bench) {
                bench.write(kFoundStation, 0x1000'0000, kCalledAt);
                bench.write(kFoundStation + 1, 0x1'0000, kCalledAt);
                bench.write(kStationCount, 1, kCalledAt);
                bench.write(kStationCount, 2, kCalledAt);
              }),
              HasSubstr("finds stations with 4097 words"));
}

struct WrongAct {
  const char* sentence;
  void (*act)(iut::Bench&);
};

class AttachedMasterActs : public AttachedMasterTest, public testing::WithParamInterface<WrongAct> {};

TEST_P(AttachedMasterActs, IsImpossible) {
  EXPECT_THAT(complaint(GetParam().act), HasSubstr(GetParam().sentence));
  EXPECT_EQ(master_.next_time(), kNever);
  device_.heard.clear();
  master_.stop(kCalledAt);
  EXPECT_TRUE(device_.heard.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, AttachedMasterActs,
    testing::Values(
        WrongAct{"writes item 11, which a master does not have",
                 [](iut::Bench& bench) { bench.write(11, 0, kCalledAt); }},
        WrongAct{"has driven nothing since the one before",
                 [](iut::Bench& bench) {
                   end_good_cycle(bench);
                   bench.write(kCycleEnd, 3, kCalledAt);
                 }},
        WrongAct{"writes item 288, which", [](iut::Bench& bench) { bench.write(0x120, 0, kCalledAt); }},
        WrongAct{"writes item 20480, which", [](iut::Bench& bench) { bench.write(0x5000, 0, kCalledAt); }},
        WrongAct{"writes 6 to item 0, which goes up to 5",
                 [](iut::Bench& bench) { bench.write(kMasterState, 6, kCalledAt); }},
        WrongAct{"writes 65536 to item 12288",
                 [](iut::Bench& bench) { bench.write(kInputImage, 0x1'0000, kCalledAt); }},
        WrongAct{"writes 4 to item 10", [](iut::Bench& bench) { bench.write(kCycleEnd, 4, kCalledAt); }},
        WrongAct{"goes up to 4096", [](iut::Bench& bench) { bench.write(kStationCount, 4097, kCalledAt); }},
        WrongAct{"ask for a call then",
                 [](iut::Bench& bench) { bench.write(kDataCycles, 1, kCalledAt + kMillisecond); }},
        WrongAct{"reports something to its application at",
                 [](iut::Bench& bench) { bench.write(kDataCycles, 1, kCalledAt - kMillisecond); }},
        WrongAct{"a master has 11 to read", [](iut::Bench& bench) { bench.read(0, kCalledAt); }},
        WrongAct{"drives port 1",
                 [](iut::Bench& bench) {
                   line::Waveform wave{kCalledAt, 500'000, {}};
                   wave.levels.append(0b1, 1);
                   bench.transmit(1, wave);
                 }},
        WrongAct{"this master has announced levels",
                 [](iut::Bench& bench) { bench.send(0, kCalledAt, std::array<std::uint16_t, 1>{1}); }}));

// ---- a master of ours ----

class NoBench final : public iut::Bench {
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
  void transmit(unsigned, line::Waveform&) override {}
  void write(iut::Item, std::uint64_t, kernel::Time) override {}
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }
};

TEST(ServedMasterTest, OrderThatThereIsNotIsRefused) {
  NoBench bench;
  ServedMaster served(
      [](const MasterConfiguration& configuration) { return std::make_unique<Master>(configuration); });
  served.begin({"interbus/master/x", 1, {}}, bench);
  const auto hear = [&](std::vector<std::uint16_t> words) {
    std::vector<iut::Character> characters;
    for (const std::uint16_t word : words) characters.push_back({kStartedAt, kStartedAt, word});
    served.receive(kApplicationPort, characters, kStartedAt);
  };
  EXPECT_NO_THROW(hear({1}));
  for (const std::vector<std::uint16_t>& wrong :
       {std::vector<std::uint16_t>{}, {0}, {5}, {1, 1}, {4, 1}, {4, 1, 2, 3}}) {
    EXPECT_THROW(hear(wrong), kernel::Error) << testing::PrintToString(wrong);
  }
}

}  // namespace
}  // namespace fieldproof::interbus
