#include "protocols/valve_bus/attached_node.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/iut/acting_device.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/valve_block.hpp"

namespace fieldproof::valve_bus {
namespace {

using iut::ActingDevice;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kNever;
using kernel::kSecond;
using kernel::kStart;

constexpr kernel::Time kNow{20 * kMillisecond};

// A device at a line, that acts at kNow.
class AttachedNodeTest : public testing::Test, private segment::Station, private segment::Tap {
 protected:
  AttachedNodeTest() { line_.tap_driven(*this); }

  void attach() {
    iut::Attachment attachment{&device_, nullptr, [this] { ++well_ended_; }};
    node_ = std::make_unique<AttachedNode>(attachment, configuration_, "valve_bus/node/x", 7);
    place_ = &line_.attach("node/in", segment_.attach(*node_, "node"), 0, {});
    node_->wire(*place_, boards_);
    host_ = &line_.attach("host/in", segment_.attach(*this, "host"), 0, {});
    node_->set_power(true, kStart);
  }
  // What is told about an implementation that acts so; empty when there is nothing wrong with it.
  std::string complaint(ActingDevice::Act act) {
    device_.at_time = std::move(act);
    device_.next = kNow;
    if (!node_) attach();
    segment_.run_until(kNow - kMillisecond);
    try {
      segment_.run_for(10 * kMillisecond);
    } catch (const iut::Misbehaviour& done) {
      EXPECT_EQ(done.reason(), iut::reasons::kImpossible);
      return done.what();
    } catch (const kernel::Error& error) {
      return error.what();
    }
    return {};
  }

  NodeConfiguration configuration_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  ValveBlock boards_;
  ActingDevice device_{iut::UnitKind::characters};
  std::unique_ptr<AttachedNode> node_;
  segment::MediumPort* host_ = nullptr;
  segment::MediumPort* place_ = nullptr;  // of the node
  std::vector<line::Waveform> driven_;
  int well_ended_ = 0;

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kNever; }
  void on_wave(const line::Waveform& wave) override { driven_.push_back(wave); }
};

TEST_F(AttachedNodeTest, SettingsComeBack) {
  for (const bool other : {false, true}) {
    if (other) {
      configuration_.rules.bit_rate = 9600;
      configuration_.rules.characters = CharacterProfile::eight_bits;
      configuration_.rules.answers_writes = true;
      configuration_.rules.loss_limit = 250 * kMillisecond;
      configuration_.address_tens = 9;
      configuration_.address_units = 8;
      configuration_.boards = 1;
    }
    const NodeConfiguration back = node_configuration_of({"x", 1, node_settings(configuration_)});
    EXPECT_EQ(back.rules, configuration_.rules);
    EXPECT_EQ(back.address_tens, configuration_.address_tens);
    EXPECT_EQ(back.address_units, configuration_.address_units);
    EXPECT_EQ(back.boards, configuration_.boards);
  }
}

TEST_F(AttachedNodeTest, DeviceIsToldTheCase) {
  attach();
  EXPECT_EQ(device_.told.id, "valve_bus/node/x");
  EXPECT_EQ(device_.told.seed, 7U);
  EXPECT_EQ(device_.told.settings, node_settings(configuration_));
}

TEST_F(AttachedNodeTest, ImplementationInTelegramsCannotBeAttached) {
  ActingDevice in_telegrams(iut::UnitKind::telegrams);
  EXPECT_THAT(
      [&] { AttachedNode(iut::Attachment{&in_telegrams, nullptr, {}}, {}, "valve_bus/node/x", 7); },
      testing::ThrowsMessage<kernel::Error>(testing::HasSubstr("characters or levels; this implementation")));
}

TEST_F(AttachedNodeTest, RefusedCaseIsMisbehaviourAndNotEndedWell) {
  device_.serves = false;
  EXPECT_THROW(attach(), iut::Misbehaviour);
  EXPECT_EQ(device_.ends, 0);
  EXPECT_EQ(well_ended_, 0);
}

TEST_F(AttachedNodeTest, CaseEndsWellUnlessTheDeviceDidWrong) {
  attach();
  node_.reset();
  EXPECT_EQ(device_.ends, 1);
  EXPECT_EQ(well_ended_, 1);
}

// A whole transmission, said ahead.
void transmit(iut::Bench& bench, kernel::Time on, kernel::Time start, kernel::Time off,
              const std::vector<std::uint16_t>& characters) {
  bench.set_driver(0, true, on);
  bench.send(0, start, characters);
  bench.set_driver(0, false, off);
}

// A UART sends octet by octet; each instant is rounded for itself, here down.
TEST_F(AttachedNodeTest, CharactersOfTheirOwnMessagesDoNotOverlap) {
  EXPECT_EQ(complaint([](iut::Bench& bench) {
              const std::int64_t character = 11'000'000'000'000 / 375'000;
              for (std::int64_t n = 0; n < 9; ++n) {
                const kernel::Time start = kNow + kernel::Duration{n * 11'000'000'000'000 / 375'000};
                transmit(bench, start, start, start + kernel::Duration{character}, {0x155});
              }
            }),
            "");
  ASSERT_EQ(driven_.size(), 9U);
  for (std::size_t n = 1; n < driven_.size(); ++n) {
    EXPECT_GE(driven_[n].start, driven_[n - 1].end());
    EXPECT_LE(driven_[n].start - driven_[n - 1].end(), kernel::kNanosecond);
  }
}

TEST_F(AttachedNodeTest, NothingIsDoneWithoutSupply) {
  device_.next = kNow;  // before it is seated: nobody asks again
  attach();
  node_->set_power(false, kStart);
  EXPECT_THAT(complaint([](iut::Bench& bench) { bench.write(kValves, 1, kNow); }),
              testing::HasSubstr("acts without supply"));
}

TEST_F(AttachedNodeTest, DeviceThatDidWrongIsNotCalledAgain) {
  EXPECT_NE(complaint([](iut::Bench& bench) { bench.write(1, 0, kNow); }), "");
  device_.next = kNow;
  EXPECT_EQ(node_->next_time(), kNever);
  node_.reset();
  EXPECT_EQ(device_.ends, 0);
  EXPECT_EQ(well_ended_, 0);
}

TEST_F(AttachedNodeTest, CharactersAreHeardWhenTheyAreOver) {
  attach();
  CharacterCodec codec(configuration_.rules);
  const std::vector<std::uint8_t> octets{0x12, 0xFE};
  codec.drive(*host_, octets, kStart + kMillisecond, {});
  segment_.run_for(10 * kMillisecond);
  ASSERT_EQ(device_.heard.size(), 2U);
  EXPECT_EQ(device_.heard[0].character.start, kStart + kMillisecond);
  EXPECT_EQ(device_.heard[0].character.data, 0x112);  // the ninth bit is 1
  EXPECT_EQ(device_.heard[1].character.data, 0x1FE);
  EXPECT_FALSE(device_.heard[1].character.is_stop_missing || device_.heard[1].character.is_parity_wrong);
}

TEST_F(AttachedNodeTest, ActivityBeginsWithTheFirstStartBitAndEndsAfterTheLastCharacter) {
  attach();
  place_->sense_activity();
  const kernel::Time begin = kStart + kMillisecond;
  const kernel::Time end =
      CharacterCodec(configuration_.rules).drive(*host_, std::vector<std::uint8_t>{0x12, 0xFE}, begin, {});
  segment_.run_until(begin + 10 * kMicrosecond);
  EXPECT_THAT(device_.activity, testing::ElementsAre(testing::Pair(true, begin)));
  EXPECT_TRUE(device_.heard.empty());
  segment_.run_for(10 * kMillisecond);
  EXPECT_THAT(device_.activity, testing::ElementsAre(testing::Pair(true, begin), testing::Pair(false, end)));
  EXPECT_EQ(device_.heard.size(), 2U);
}

TEST_F(AttachedNodeTest, TransmissionHasTheDriverAroundItsCharacters) {
  const kernel::Duration bit = bits(configuration_.rules, 1);
  const kernel::Time start = kNow + 3 * bit;
  const kernel::Time off = start + 2 * character_time(configuration_.rules) + 2 * bit;
  EXPECT_EQ(complaint([&](iut::Bench& bench) { transmit(bench, start - bit, start, off, {0x141, 0x142}); }),
            "");
  ASSERT_EQ(driven_.size(), 2U);  // idle with a character, a character with idle
  EXPECT_EQ(driven_[0].start, start - bit);
  EXPECT_EQ(driven_[0].levels.size(), 12U);
  EXPECT_EQ(driven_[1].levels.size(), 13U);
  EXPECT_LE(std::chrono::abs(driven_[1].end() - off), kernel::kNanosecond);
}

// What is on the line, whatever the pieces.
struct OnTheLine {
  std::vector<std::pair<kernel::Time, kernel::Time>> driven;  // without a gap
  std::vector<line::UartCharacter> heard;
};

OnTheLine on_the_line(const std::vector<line::Waveform>& waves, const Rules& rules) {
  OnTheLine all;
  CharacterCodec codec(rules);
  for (const line::Waveform& wave : waves) {
    const bool follows =
        !all.driven.empty() && std::chrono::abs(wave.start - all.driven.back().second) <= kernel::kNanosecond;
    if (!follows) all.driven.emplace_back(wave.start, wave.end());
    all.driven.back().second = wave.end();
    codec.decode(wave, [&](const line::UartCharacter& one) { all.heard.push_back(one); });
  }
  return all;
}

// A processor that runs: it knows of no step before its time has come, and is told none of the bench's.
TEST_F(AttachedNodeTest, DriverAndCharactersAreSaidEachAtItsOwnTime) {
  const kernel::Duration character = character_time(configuration_.rules);
  const kernel::Duration odd{3'141'592};  // no multiple of a bit
  const kernel::Time first = kNow + odd;
  const kernel::Time second = first + character + 2 * odd;
  const kernel::Time off = second + character + odd;
  int step = 0;
  const auto go_on = [&](iut::Bench& bench) {
    switch (step++) {
      case 0:
        bench.set_driver(0, true, kNow);
        device_.next = first;
        return;
      case 1:
        bench.send(0, first, std::array<std::uint16_t, 1>{0x141});
        device_.next = second;
        return;
      case 2:
        bench.send(0, second, std::array<std::uint16_t, 1>{0x142});
        device_.next = off;
        return;
      default:
        bench.set_driver(0, false, off);
    }
  };
  EXPECT_EQ(complaint(go_on), "");
  EXPECT_EQ(step, 4);
  const OnTheLine line = on_the_line(driven_, configuration_.rules);
  ASSERT_EQ(line.driven.size(), 1U);
  EXPECT_EQ(line.driven[0].first, kNow);
  EXPECT_LE(std::chrono::abs(line.driven[0].second - off), kernel::kNanosecond);
  ASSERT_EQ(line.heard.size(), 2U);
  EXPECT_EQ(line.heard[0].data, 0x141);
  EXPECT_LE(std::chrono::abs(line.heard[0].start - first), kernel::kNanosecond);
  EXPECT_LE(std::chrono::abs(line.heard[1].start - second), kernel::kNanosecond);
  node_->end();
  EXPECT_EQ(well_ended_, 1);
}

TEST_F(AttachedNodeTest, CharactersHaveNoMoreBitsThanTheFormat) {
  const auto send = [](std::uint16_t character) {
    return [character](iut::Bench& bench) {
      bench.set_driver(0, true, kNow);
      bench.send(0, kNow, std::array{character});
    };
  };
  EXPECT_THAT(complaint(send(0x241)), testing::HasSubstr("characters here have 9 bits"));
}

TEST_F(AttachedNodeTest, DriverThatHangsIsAFindingAfterTheLimitAndAtTheEnd) {
  EXPECT_EQ(complaint([](iut::Bench& bench) { bench.set_driver(0, true, kNow); }), "");
  segment_.run_for(9 * kSecond);
  try {
    node_->end();
    ADD_FAILURE() << "is taken for an end";
  } catch (const iut::Misbehaviour& done) {
    EXPECT_THAT(done.what(), testing::HasSubstr("has its driver still on at the end of the case"));
  }
  EXPECT_EQ(well_ended_, 0);
}

TEST_F(AttachedNodeTest, DriverIsOnForTenSecondsAtMost) {
  EXPECT_EQ(complaint([](iut::Bench& bench) { bench.set_driver(0, true, kNow); }), "");
  EXPECT_THAT([&] { segment_.run_for(11 * kSecond); },
              testing::ThrowsMessage<iut::Misbehaviour>(
                  testing::HasSubstr("has its driver on since " + kernel::describe(kNow))));
  EXPECT_EQ(node_->next_time(), kNever);
}

// A case may end while an answer is under way.
TEST_F(AttachedNodeTest, DriverOfAnAnswerUnderWayIsNoneThatHangs) {
  device_.at_time = [](iut::Bench& bench) {
    bench.set_driver(0, true, kNow);
    bench.send(0, kNow, std::vector<std::uint16_t>(3, 0x155));
  };
  device_.next = kNow;
  attach();
  segment_.run_until(kNow + 4 * character_time(configuration_.rules));
  node_->end();
  EXPECT_EQ(well_ended_, 1);
}

TEST_F(AttachedNodeTest, WritesAndReadsReachTheBoards) {
  boards_.set_input(0, 0xBEEF);
  std::uint64_t switches = 0;
  EXPECT_EQ(complaint([&](iut::Bench& bench) {
              switches = bench.read(kLimitSwitches, kNow);
              bench.write(kValves, 0xA55A, kNow);
            }),
            "");
  EXPECT_EQ(switches, 0xBEEFU);
  EXPECT_EQ(boards_.valves(), 0xA55A);
}

// Before it is wired there is no line that could be driven.
TEST_F(AttachedNodeTest, NothingCanBeDoneWhileTheCaseBegins) {
  line::Waveform wave;
  wave.levels.append(0, 1);
  const std::vector<ActingDevice::Act> acts = {
      [](iut::Bench& bench) { bench.set_driver(0, true, kStart); },
      [](iut::Bench& bench) { bench.send(0, kStart, std::array<std::uint16_t, 1>{1}); },
      [&](iut::Bench& bench) { bench.transmit(0, wave); },
      [](iut::Bench& bench) { bench.write(kValves, 1, kStart); },
      [](iut::Bench& bench) { bench.read(kLimitSwitches, kStart); }};
  for (const ActingDevice::Act& act : acts) {
    device_.at_begin = act;
    EXPECT_THROW(attach(), iut::Misbehaviour);
  }
}

struct Impossible {
  const char* name;
  ActingDevice::Act act;
};

std::vector<Impossible> impossible_acts() {
  const kernel::Time soon = kNow + kMillisecond;
  const kernel::Time first{kernel::Duration::min()};
  const std::vector<std::uint16_t> ten(10, 0x100);
  const auto drives_at = [](unsigned port, kernel::Time on) {
    return [=](iut::Bench& bench) { bench.set_driver(port, true, on); };
  };
  const auto transmits = [](kernel::Time on, kernel::Time start, kernel::Time off,
                            const std::vector<std::uint16_t>& characters) {
    return [=](iut::Bench& bench) { transmit(bench, on, start, off, characters); };
  };
  const auto drives = [](unsigned port, kernel::Time start, std::size_t levels) {
    return [=](iut::Bench& bench) {
      line::Waveform wave;
      wave.start = start;
      wave.levels.append_idle(levels);
      bench.transmit(port, wave);
    };
  };
  const auto writes = [](iut::Item item, std::uint64_t value, kernel::Time when) {
    return [=](iut::Bench& bench) { bench.write(item, value, when); };
  };
  const auto reads = [](iut::Item item, kernel::Time when) {
    return [=](iut::Bench& bench) { bench.read(item, when); };
  };
  return {{"port_1", drives_at(1, kNow)},
          {"characters_at_port_1",
           [](iut::Bench& bench) { bench.send(1, kNow, std::array<std::uint16_t, 1>{1}); }},
          {"driver_on_behind_start", transmits(soon, kNow, soon, ten)},
          {"characters_without_a_driver", [=](iut::Bench& bench) { bench.send(0, kNow, ten); }},
          {"characters_behind_the_driver",
           [=](iut::Bench& bench) {
             transmit(bench, kNow, kNow, soon, {1});
             bench.send(0, soon, ten);
           }},
          {"characters_into_others",
           [=](iut::Bench& bench) {
             bench.set_driver(0, true, kNow);
             bench.send(0, kNow, ten);
             bench.send(0, kNow + kMicrosecond, ten);
           }},
          {"driver_off_within_characters", transmits(kNow, kNow, kNow + kMicrosecond, ten)},
          {"drives_11_seconds", transmits(kNow, kNow, kNow + 11 * kSecond, {})},
          {"5000_characters", transmits(kNow, kNow, kNow + kSecond, std::vector<std::uint16_t>(5000))},
          {"drives_in_the_past", drives_at(0, kNow - kMicrosecond)},
          {"drives_never", drives_at(0, kNever)},
          {"starts_never", transmits(kNow, kNever, kNever, ten)},
          {"drives_before_all_time", drives_at(0, first)},
          {"ends_before_all_time", transmits(kNow, kNow, first, {})},
          {"levels_at_port_1", drives(1, kNow, 1)},
          {"no_levels", drives(0, kNow, 0)},
          {"levels_for_11_seconds", drives(0, kNow, 11)},
          {"levels_never", drives(0, kNever, 1)},
          {"levels_before_all_time", drives(0, first, 1)},
          {"writes_limit_switches", writes(kLimitSwitches, 0, kNow)},
          {"writes_17_valves", writes(kValves, 0x10000, kNow)},
          {"writes_in_the_past", writes(kValves, 1, kNow - kernel::kPicosecond)},
          {"writes_never", writes(kValves, 1, kNever)},
          {"reads_valves", reads(kValves, kNow)},
          {"reads_in_the_past", reads(kLimitSwitches, kNow - kernel::kPicosecond)},
          {"reads_never", reads(kLimitSwitches, kNever)},
          {"writes_backwards", [=](iut::Bench& bench) {
             bench.write(kValves, 1, soon);
             bench.write(kValves, 2, kNow);
           }}};
}

class AttachedNodeActs : public AttachedNodeTest, public testing::WithParamInterface<std::size_t> {};

TEST_P(AttachedNodeActs, ThatNoNodeCanDoIsRefused) {
  const Impossible one = impossible_acts()[GetParam()];
  EXPECT_NE(complaint(one.act), "") << one.name;
}

INSTANTIATE_TEST_SUITE_P(Impossible, AttachedNodeActs,
                         testing::Range(std::size_t{0}, impossible_acts().size()),
                         [](const auto& one) { return std::string(impossible_acts()[one.param].name); });

// A node of ours that says its driver and its characters instead of its levels.
class InCharacters final : public iut::Device, private iut::Bench {
 public:
  explicit InCharacters(const Rules& rules)
      : rules_(rules),
        codec_(rules),
        node_([](const NodeConfiguration& wanted) { return std::make_unique<Node>(wanted); }) {}

  iut::UnitKind unit_kind() const override { return iut::UnitKind::characters; }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override {
    bench_ = &bench;
    return node_.begin(begin, *this);
  }
  void set_power(bool is_on, kernel::Time now) override { node_.set_power(is_on, now); }
  void receive(unsigned, const line::Waveform&) override { FAIL() << "is reported characters"; }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time) override {
    for (const iut::Character& one : characters) {
      line::Waveform wave{one.start, rules_.bit_rate, {}};
      codec_.append_character(wave.levels, one.data);
      node_.receive(port, wave);
    }
    say();
  }
  void on_time(kernel::Time now) override {
    node_.on_time(now);
    say();
  }
  kernel::Time next_time() const override { return node_.next_time(); }
  void end() override { node_.end(); }

 private:
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override { FAIL(); }
  void transmit(unsigned, line::Waveform& wave) override { driven_.push_back(std::exchange(wave, {})); }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override {
    bench_->write(item, value, when);
  }
  std::uint64_t read(iut::Item item, kernel::Time when) override { return bench_->read(item, when); }

  void say() {
    if (driven_.empty()) return;
    bench_->set_driver(0, true, driven_.front().start);
    for (const line::Waveform& wave : driven_) {
      codec_.decode(wave, [&](const line::UartCharacter& one) {
        bench_->send(0, one.start, std::array<std::uint16_t, 1>{one.data});
      });
    }
    bench_->set_driver(0, false, driven_.back().end());
    driven_.clear();
  }

  Rules rules_;
  CharacterCodec codec_;
  ServedNode node_;
  iut::Bench* bench_ = nullptr;
  std::vector<line::Waveform> driven_;
};

struct Exchange {
  std::uint64_t fingerprint = 0;
  std::uint64_t records = 0;
  std::uint16_t valves = 0;

  friend bool operator==(const Exchange&, const Exchange&) = default;
};

Exchange exchange_with(bool in_characters, const NodeConfiguration& configuration,
                       const std::vector<Command>& commands) {
  segment::Segment segment;
  segment::Medium line(segment, "line", segment::ContentionRule::noise, kernel::Random(1));
  ValveBlock boards;
  boards.set_input(0, 0xBEEF);
  std::unique_ptr<NodeDevice> node = std::make_unique<Node>(configuration);
  if (in_characters) {
    const auto said = std::make_shared<InCharacters>(configuration.rules);
    node = std::make_unique<AttachedNode>(iut::Attachment{said.get(), said, {}}, configuration,
                                          "valve_bus/node/x", 7);
  }
  node->wire(line.attach("node/in", segment.attach(*node, "node"), 0, {}), boards);
  segment::MediumPort& host = line.listen("host", {});
  node->set_power(true, kStart);
  CharacterCodec codec(configuration.rules);
  for (const Command& command : commands) {
    segment.run_for(20 * kMillisecond);
    codec.drive(host, octets_of(command), segment.now(), {});
  }
  segment.run_for(100 * kMillisecond);
  node->end();
  return {segment.trace().fingerprint(), segment.trace().record_count(), boards.valves()};
}

// To the bit: whatever rounding the rate asks for.
RC_GTEST_PROP(AttachedNodeProperty, WhoSaysCharactersIsOnTheLineAsWhoDrivesThem, ()) {
  NodeConfiguration configuration;
  configuration.address_units = 5;
  configuration.rules.bit_rate = *rc::gen::inRange<std::int64_t>(9'600, 500'000);
  configuration.rules.answers_writes = *rc::gen::arbitrary<bool>();
  configuration.rules.characters = *rc::gen::element(CharacterProfile::eight_bits, Rules{}.characters);
  std::vector<Command> commands;
  for (const std::uint16_t data : *rc::gen::arbitrary<std::vector<std::uint16_t>>()) {
    commands.push_back({5, static_cast<std::uint8_t>(data % 2), static_cast<std::uint8_t>(data >> 8),
                        static_cast<std::uint8_t>(data)});
  }
  commands.push_back({5, 1, 0, 0});
  const Exchange direct = exchange_with(false, configuration, commands);
  const Exchange said = exchange_with(true, configuration, commands);
  RC_ASSERT(direct.records > commands.size() * kCommandOctets);  // it has answered
  RC_ASSERT(said == direct);
}

// Keeps what a served node does.
class KeepingBench final : public iut::Bench {
 public:
  void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
  void transmit(unsigned, line::Waveform& wave) override { wave.levels.clear(); }
  void write(iut::Item, std::uint64_t value, kernel::Time when) override {
    value_ = value;
    when_ = when;
  }
  std::uint64_t read(iut::Item, kernel::Time) override { return 0; }

  std::uint64_t value_ = 0;
  kernel::Time when_{};
};

TEST(ServedNodeTest, PlaysTheNodeOfTheSettings) {
  ServedNode served([](const NodeConfiguration& wanted) { return std::make_unique<Node>(wanted); });
  NodeConfiguration configuration;
  configuration.address_units = 5;
  KeepingBench bench;
  for (const kernel::Time start : {kNow, kStart}) {  // nothing of the case before counts
    ASSERT_TRUE(served.begin({"valve_bus/node/x", 1, node_settings(configuration)}, bench));
    served.set_power(true, kStart);
    line::Waveform wave;
    wave.start = start;
    wave.rate = configuration.rules.bit_rate;
    CharacterCodec(configuration.rules).append(wave.levels, octets_of(Command{5, 0, 0x21, 0x43}));
    served.receive(0, wave);
    const kernel::Time known = served.next_time();
    EXPECT_GT(known, wave.end());
    served.on_time(known);
    EXPECT_EQ(bench.value_, 0x4321U);
    EXPECT_EQ(bench.when_, known);
    served.end();
    EXPECT_EQ(served.next_time(), kNever);
  }
}

}  // namespace
}  // namespace fieldproof::valve_bus
