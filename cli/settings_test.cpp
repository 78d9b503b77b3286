#include "cli/settings.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

Environment variables(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const std::string& name) -> std::optional<std::string> {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
}

Settings typed(std::map<std::string, std::vector<std::string>, std::less<>> values,
               std::map<std::string, std::string> environment = {}) {
  return Settings({"run", {}, std::move(values)}, variables(std::move(environment)));
}

std::string refusal(kernel::ErrorKind kind, const std::function<void()>& request) {
  try {
    request();
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "the value was accepted";
  return {};
}

constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();

TEST(Settings, NumbersAreWholeAndInRange) {
  EXPECT_EQ(typed({{"seed", {"18446744073709551615"}}}).number("seed", 0, kMax), kMax);
  for (const char* wrong : {"18446744073709551616", "-1", "", "1.0", " 1", "0x10"}) {
    EXPECT_THROW(typed({{"seed", {wrong}}}).number("seed", 0, kMax), kernel::Error) << wrong;
  }
  EXPECT_THROW(typed({{"jobs", {"1025"}}}).number("jobs", 1, 1024), kernel::Error);
}

TEST(Settings, TimesHaveAUnit) {
  using std::chrono::milliseconds;
  EXPECT_EQ(typed({{"max-time", {"90s"}}}).duration("max-time"), milliseconds(90'000));
  EXPECT_EQ(typed({{"max-time", {"15 min"}}}).duration("max-time"), milliseconds(900'000));
  EXPECT_EQ(typed({{"max-time", {"7"}}}).duration("max-time"), milliseconds(7'000));
  EXPECT_EQ(typed({{"max-time", {"1.5s"}}}).duration("max-time"), milliseconds(1'500));
  EXPECT_EQ(typed({{"max-time", {"0.25 h"}}}).duration("max-time"), milliseconds(900'000));
  EXPECT_EQ(typed({{"max-time", {"2.000ms"}}}).duration("max-time"), milliseconds(2));
  EXPECT_EQ(typed({}).duration("max-time"), std::nullopt);
  for (const char* wrong : {"0s", "s", "1d", "-1s", "1.5ms", "1.s", ".5s", "1.2.3s", "0.0000001h", "0.0s",
                            "1000001h", "99999999999999999999s"}) {
    EXPECT_THROW(typed({{"max-time", {wrong}}}).duration("max-time"), kernel::Error) << wrong;
  }
}

TEST(Settings, ErrorSaysWhereTheValueCameFrom) {
  const std::string line =
      refusal(kernel::ErrorKind::usage, [] { typed({{"seed", {"x"}}}).number("seed", 0, kMax); });
  EXPECT_EQ(line.rfind("--seed: 'x'", 0), 0U) << line;
  const std::string variable = refusal(kernel::ErrorKind::configuration,
                                       [] { typed({}, {{"FIELDPROOF_SEED", "x"}}).number("seed", 0, kMax); });
  EXPECT_EQ(variable.rfind("FIELDPROOF_SEED: 'x'", 0), 0U) << variable;
  refusal(kernel::ErrorKind::configuration, [] { typed({}, {{"FIELDPROOF_STRICT", "perhaps"}}); });
}

TEST(Settings, CommandLineGoesBeforeEnvironmentBeforeFileBeforeStoredRun) {
  const auto folder = std::filesystem::path(testing::TempDir());
  const auto file = folder / "settings_lab.json";
  const auto stored = folder / "settings_stored.json";
  std::ofstream(file) << R"({"seed": 1, "volume": "quick", "jobs": 9})";
  std::ofstream(stored) << R"({"seed": 4, "volume": "full", "network": "/n.json", "out": "elsewhere"})";
  Settings settings = typed({{"config", {file.string()}}, {"jobs", {"7"}}}, {{"FIELDPROOF_SEED", "2"}});
  settings.add_file(stored, Origin::stored_run);
  EXPECT_EQ(settings.text("jobs"), "7");
  EXPECT_EQ(settings.text("seed"), "2");
  EXPECT_EQ(settings.text("volume"), "quick");
  EXPECT_EQ(settings.text("network"), "/n.json");
  EXPECT_FALSE(settings.is_set("out"));  // decides no outcome
}

TEST(Settings, FileOfACallGivesTheSameSettings) {
  const auto file = std::filesystem::path(testing::TempDir()) / "settings_again.json";
  const Settings before =
      typed({{"seed", {"7"}}, {"iut", {"slave@3=mutant:x y", "ref"}}, {"strict", {"true"}}});
  std::ofstream(file) << before.as_file();
  const Settings after = typed({{"config", {file.string()}}});
  EXPECT_EQ(after.list("iut"), before.list("iut"));
  EXPECT_TRUE(after.is_set("strict"));
  EXPECT_EQ(after.reproduce_options(), before.reproduce_options());
  EXPECT_EQ(after.reproduce_options(), "--iut 'slave@3=mutant:x y' --iut ref --seed 7");
}

}  // namespace
}  // namespace fieldproof::cli
