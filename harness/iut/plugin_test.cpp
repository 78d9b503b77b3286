#include "harness/iut/plugin.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>

#include <functional>
#include <string>
#include <vector>

#include "harness/iut/limits.hpp"
#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr kernel::Time kSupply{kernel::Duration{1000}};

// Writes down what the library does; a write of 13 is one that the bench refuses.
class Diary final : public Bench {
 public:
  void set_driver(unsigned port, bool is_on, kernel::Time at) override {
    lines.push_back(fmt::format("driver {} {:d} {}", port, is_on, at.time_since_epoch().count()));
  }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    lines.push_back(
        fmt::format("sends {} {} {:X}", port, start.time_since_epoch().count(), characters.back()));
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    lines.push_back(fmt::format("drives {} {} {}", port, wave.rate, wave.levels.text()));
  }
  void write(Item item, std::uint64_t value, kernel::Time) override {
    if (item == 13) throw Misbehaviour(reasons::kImpossible, "the bench has no item 13");
    lines.push_back(fmt::format("writes {} {:X}", item, value));
  }
  std::uint64_t read(Item item, kernel::Time) override { return item * 0x100; }

  std::vector<std::string> lines;
};

std::unique_ptr<Device> odd_device(const std::string& does) {
  return load_plugin(ODD_PLUGIN, "odd", does);
}

// What is told about a library that does this when the supply comes.
std::string blamed_for(const std::string& does, std::string_view reason) {
  const auto device = odd_device(does);
  Diary diary;
  EXPECT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  try {
    device->set_power(true, kSupply);
  } catch (const Misbehaviour& done) {
    EXPECT_EQ(done.reason(), reason);
    return done.what();
  }
  return {};
}

std::string refusal_to_load(const std::string& path, const std::string& protocol = "odd") {
  try {
    load_plugin(path, protocol, "acts");
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    return error.what();
  }
  return {};
}

// Of levels alone: it sends back what it hears.
fieldproof_implementation echo_of_levels() {
  return {
      .version = FIELDPROOF_PLUGIN_VERSION,
      .size = sizeof(fieldproof_implementation),
      .name = "echo",
      .unit = FIELDPROOF_LEVELS,
      .create = [](const char*, const char* role, const fieldproof_bench* bench) -> void* {
        return std::string_view(role) == "echo" ? const_cast<fieldproof_bench*>(bench) : nullptr;
      },
      .destroy = [](void*) {},
      .begin = [](void*, const fieldproof_case*, fieldproof_time*) { return 1; },
      .set_power = [](void*, int, fieldproof_time) { return FIELDPROOF_NEVER; },
      .receive = nullptr,
      .receive_levels =
          [](void* self, unsigned port, fieldproof_time, fieldproof_time rate, const unsigned char* levels,
             unsigned count, fieldproof_time now) {
            const auto* bench = static_cast<const fieldproof_bench*>(self);
            bench->transmit_levels(bench->context, port, now, rate, levels, count);
            return now + 1;
          },
      .on_time = [](void*, fieldproof_time) { return FIELDPROOF_NEVER; },
      .end = [](void*) {},
      .on_activity = nullptr,
  };
}

TEST(PluginTest, ActsThroughTheBench) {
  const auto device = odd_device("acts");
  EXPECT_EQ(device->unit_kind(), UnitKind::characters);
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {{"next", 77}}}, diary));
  EXPECT_EQ(device->next_time(), kernel::Time{kernel::Duration{77}});
  device->set_power(true, kSupply);
  EXPECT_THAT(diary.lines, ElementsAre("driver 1 1 1000", "sends 1 1001 155", "driver 1 0 1002",
                                       "drives 2 1000 010110101", "writes 3 401"));
}

TEST(PluginTest, IsToldCharactersWithTheirErrors) {
  const auto device = odd_device("hears");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  const std::vector<Character> characters{
      {{}, {}, 0x1A5, false, false}, {{}, {}, 1, true, false}, {{}, {}, 2, true, true}};
  device->receive(5, characters, kSupply);
  EXPECT_THAT(diary.lines, ElementsAre("writes 5 1A500", "writes 5 101", "writes 5 203"));
}

TEST(PluginTest, EachCallReturnsWhenTheNextOneIsWanted) {
  const auto device = odd_device("hears");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {{"next", 77}}}, diary));
  const std::vector<Character> characters(3);
  device->receive(5, characters, kSupply);
  EXPECT_EQ(device->next_time(), kSupply + kernel::Duration{3});
  device->on_time(kSupply);
  EXPECT_EQ(device->next_time(), kSupply);
  device->set_power(true, kSupply);  // in the past, as it says
  EXPECT_EQ(device->next_time(), kernel::Time{kernel::Duration{77}});
  device->set_power(false, kSupply);
  EXPECT_EQ(device->next_time(), kernel::kNever);
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));  // which leaves it as it was given
  EXPECT_EQ(device->next_time(), kernel::kNever);
}

TEST(PluginTest, AsksForActivityWithItsFunction) {
  const auto device = odd_device("senses");
  EXPECT_TRUE(device->capabilities().senses_activity);
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  device->on_activity(5, true, kSupply);
  EXPECT_EQ(device->next_time(), kSupply + kernel::Duration{7});
  device->on_activity(5, false, kSupply);
  EXPECT_EQ(device->next_time(), kernel::kNever);
  EXPECT_THAT(diary.lines, ElementsAre("writes 5 1", "writes 5 0"));
}

// As one that was built before there was activity.
TEST(PluginTest, ShorterTableAsksForNoActivity) {
  fieldproof_implementation table = echo_of_levels();
  table.on_activity = [](void*, unsigned, int, fieldproof_time now) { return now; };
  EXPECT_TRUE(make_plugin(table, "odd", "echo")->capabilities().senses_activity);
  table.size = offsetof(fieldproof_implementation, on_activity);
  EXPECT_FALSE(make_plugin(table, "odd", "echo")->capabilities().senses_activity);
  --table.size;
  EXPECT_THROW(make_plugin(table, "odd", "echo"), kernel::Error);
}

TEST(PluginTest, ActsAreCountedWithinEachCallAlone) {
  const auto device = odd_device("hears");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  const std::vector<Character> most(kMostActions);
  const std::vector<Character> too_many(kMostActions + 1);
  device->receive(5, most, kSupply);
  device->receive(5, most, kSupply);
  EXPECT_THROW(device->receive(5, too_many, kSupply), Misbehaviour);
  device->receive(5, most, kSupply);
  EXPECT_EQ(diary.lines.size(), 4 * kMostActions);
}

TEST(PluginTest, RefusedCaseIsAnAnswerAndTheEndIsTheEnd) {
  const auto device = odd_device("acts");
  Diary diary;
  EXPECT_FALSE(device->begin({"odd/refused", 1, {}}, diary));
  EXPECT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  device->end();
  EXPECT_TRUE(diary.lines.empty());
}

TEST(PluginTest, ItemThatIsTooGreatIsNotTakenForAnother) {
  EXPECT_THAT(blamed_for("writes item 65536", reasons::kImpossible), HasSubstr("item 65536"));
  EXPECT_THAT(blamed_for("reads item 65537", reasons::kImpossible), HasSubstr("item 65537"));
}

TEST(PluginTest, RateThatNoLineHasIsRefused) {
  EXPECT_THAT(blamed_for("drives at rate 0", reasons::kImpossible), HasSubstr("drives 0 levels per second"));
}

TEST(PluginTest, ActsWithoutEndAreAFlood) {
  EXPECT_THAT(blamed_for("floods", reasons::kFloods), HasSubstr("more than 20000 things within one call"));
}

TEST(PluginTest, ImplementationThatTheProgramHoldsIsCalledLikeALibrary) {
  const fieldproof_implementation echo = echo_of_levels();
  const auto device = make_plugin(echo, "odd", "echo");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  line::Waveform wave{kSupply, 1'000, {}};
  wave.levels.append(0b1011, 4);
  device->receive(2, wave);
  EXPECT_THAT(diary.lines, ElementsAre("drives 2 1000 1101"));
  EXPECT_THROW(make_plugin(echo, "odd", "silence"), kernel::Error);
}

TEST(PluginTest, RoleThatIsToldCharactersTooNeedsWhoTakesThem) {
  fieldproof_implementation echo = echo_of_levels();
  try {
    make_plugin(echo, "odd", "echo", UnitOffer::in_characters_too);
    FAIL() << "it was made";
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    EXPECT_STREQ(
        error.what(),
        "plugin echo: has no function 'receive'; its role receives characters whatever the unit of its "
        "line");
  }
  echo.receive = [](void*, unsigned, const fieldproof_character*, unsigned, fieldproof_time) {
    return FIELDPROOF_NEVER;
  };
  EXPECT_NE(make_plugin(echo, "odd", "echo", UnitOffer::in_characters_too), nullptr);
}

// A role that tells characters in spite of what it promised is refused when it does.
TEST(PluginTest, CharactersAreRefusedWhereNobodyTakesThem) {
  const fieldproof_implementation echo = echo_of_levels();
  const auto device = make_plugin(echo, "odd", "echo");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  const Character character;
  EXPECT_THAT([&] { device->receive(0, std::span(&character, 1), kSupply); },
              testing::ThrowsMessage<kernel::Error>(testing::HasSubstr("has no function 'receive'")));
}

// The library is between the bench and whoever catches: it must not be unwound.
TEST(PluginTest, WhatTheBenchRefusesIsToldBehindTheCall) {
  const auto device = odd_device("hears");
  Diary diary;
  ASSERT_TRUE(device->begin({"odd/case", 1, {}}, diary));
  const std::vector<Character> characters(3);
  EXPECT_THROW(device->receive(13, characters, kSupply), Misbehaviour);
  device->receive(12, characters, kSupply);
  EXPECT_EQ(diary.lines.size(), 3U);
}

TEST(PluginTest, FileThatIsNoSuchLibraryIsNamedWithWhatIsWrong) {
  EXPECT_THAT(refusal_to_load("./nothing.so"),
              HasSubstr("plugin:./nothing.so: cannot be loaded: there is no such file; write the path"));
  EXPECT_THAT(refusal_to_load("."), HasSubstr("cannot be loaded: this is no file"));
  const std::string source = std::string(FIELDPROOF_SOURCE_DIR) + "/harness/iut/odd_plugin.c";
  EXPECT_THAT(refusal_to_load(source),
              testing::AllOf(HasSubstr("this is no shared library that can be loaded here"),
                             HasSubstr("invalid ELF header"), HasSubstr("build it with -shared -fPIC"),
                             testing::Not(HasSubstr("boost"))));
  EXPECT_THAT(refusal_to_load(ODD_PLUGIN_NO_ENTRY), HasSubstr("does not export 'fieldproof_plugin'"));
  EXPECT_THAT(refusal_to_load(ODD_PLUGIN_OTHER_VERSION), HasSubstr("is not made for version 3"));
  EXPECT_THAT(refusal_to_load(ODD_PLUGIN_LEAVES_OUT), HasSubstr("leaves a function out"));
  EXPECT_THAT(refusal_to_load(ODD_PLUGIN, "even"), HasSubstr("does not serve the role 'even/acts'"));
}

}  // namespace
}  // namespace fieldproof::iut
