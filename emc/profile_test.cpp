#include "emc/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(FIELDPROOF_SOURCE_DIR) / "emc/profile_corpus";

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Profile read_text(const std::string& text) {
  const config::Document document = config::Document::parse(text, "profile.json");
  return Profile::read(document.root());
}

double ns(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / 1000;
}

struct Expected {
  const char* profile;
  double threshold_volts;
  // In ns at 0.5, 1, 2, 4 and 4.5 kV: wrong for level 1, and from the first to the last wrong instant of any
  // level.
  std::array<double, 5> level_one;
  std::array<double, 5> span;
};

constexpr std::array kVolts{500.0, 1000.0, 2000.0, 4000.0, 4500.0};
constexpr std::array<double, 5> kNone{};

// The table of wrong-output times that the model was specified by, each figure rounded to whole nanoseconds.
const std::array kTable{
    Expected{"A", 47, {403, 501, 599, 695, 699}, {403, 501, 599, 695, 699}},
    Expected{"A2", 373, {0, 44, 102, 146, 156}, {37, 123, 221, 312, 316}},
    Expected{"A3", 1181, {0, 0, 27, 69, 80}, {0, 0, 106, 206, 211}},
    Expected{"B", 1483, {0, 0, 200, 212, 295}, {0, 0, 200, 212, 295}},
    Expected{"B2", 6178, kNone, kNone},
    Expected{"C", 37'000, kNone, kNone},
    Expected{"D", 205, {46, 91, 132, 171, 180}, {115, 211, 308, 404, 408}},
    Expected{"E", 1691, kNone, {0, 0, 33, 73, 78}},
};

TEST(ProfileTest, ReproducesTheTableOfWrongOutputTimes) {
  for (const Expected& expected : kTable) {
    const LineResponse response(Profile::named(expected.profile).coupling);
    EXPECT_NEAR(response.threshold_volts(), expected.threshold_volts, 0.01 * expected.threshold_volts)
        << expected.profile;
    for (std::size_t n = 0; n < kVolts.size(); ++n) {
      const WrongOutput wrong = response.wrong_output(kVolts.at(n), Polarity::positive);
      const Interval hull = wrong.hull();
      const double level_one = expected.level_one.at(n);
      const double span = expected.span.at(n);
      EXPECT_NEAR(ns(wrong.duration(true)), level_one, std::max(0.02 * level_one, 0.6))
          << expected.profile << " at " << kVolts.at(n);
      EXPECT_NEAR(ns(hull.to - hull.from), span, std::max(0.02 * span, 0.6))
          << expected.profile << " at " << kVolts.at(n);
    }
  }
}

TEST(ProfileTest, ShieldBondedAllAroundIsQuietAndNoShieldIsNot) {
  const LineResponse shielded(Profile::named("C").coupling);
  const LineResponse open(Profile::named("A").coupling);
  for (const Polarity polarity : {Polarity::positive, Polarity::negative}) {
    for (double volts = 1000; volts <= 4500; volts += 500) {
      EXPECT_TRUE(shielded.wrong_output(volts, polarity).empty()) << volts;
    }
    const double level_one = Level::standard(PortKind::signal, 1).open_circuit_volts();
    EXPECT_FALSE(open.wrong_output(level_one, polarity).empty());
  }
}

TEST(ProfileTest, NamesAreFoundInAnyCaseAndMisspellingsToldWithTheNearest) {
  EXPECT_EQ(Profile::named("a2").name, "A2");
  EXPECT_EQ(Profile::built_in().size(), 10U);
  try {
    (void)Profile::named("A5");
    FAIL();
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::usage);
    EXPECT_NE(std::string(error.what()).find("A, A2, A3, B, B2, C, D, E, E2, F"), std::string::npos)
        << error.what();
  }
}

TEST(ProfileTest, AFileChangesWhatItIsBasedOn) {
  const Profile profile = read_text(
      R"({"name": "mine", "based_on": "B", "coupling": {"shield_db": 24, "common_mode_limit_v": null,
          "pulse": "double_exponential", "method": "coupling_network", "forced_level": 1}})");
  Coupling expected = Profile::named("B").coupling;
  expected.shield_db = 24;
  expected.common_mode_limit_v = std::numeric_limits<double>::infinity();
  expected.pulse = PulseShape::double_exponential;
  expected.method = CouplingMethod::coupling_network;
  expected.forced_level = true;
  EXPECT_EQ(profile.coupling, expected);
  EXPECT_EQ(profile.title, "mine");
  EXPECT_EQ(read_text(R"({"name": "plain"})").coupling, Coupling{});
}

TEST(ProfileTest, EveryParameterOfTheTableIsRead) {
  for (const CouplingParameter& parameter : coupling_parameters()) {
    const double value = parameter.smallest;
    const std::string text = R"({"name": "x", "coupling": {")" + std::string(parameter.name) +
                             "\": " + std::to_string(value) + "}}";
    EXPECT_DOUBLE_EQ(read_text(text).coupling.*parameter.member, value) << text;
  }
}

TEST(ProfileCorpusTest, GoodFilesAreRead) {
  const auto files = files_in(kCorpus / "good");
  ASSERT_GE(files.size(), 4U);
  for (const fs::path& file : files) EXPECT_NO_THROW((void)Profile::load(file)) << file;
}

TEST(ProfileCorpusTest, BadFilesAreRefused) {
  for (const char* folder : {"bad", "bad_semantic"}) {
    const auto files = files_in(kCorpus / folder);
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) {
      try {
        (void)Profile::load(file);
        ADD_FAILURE() << file << " was taken";
      } catch (const kernel::Error& error) {
        EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration) << error.what();
        EXPECT_NE(std::string(error.what()).find(file.filename().string() + ":"), std::string::npos);
      }
    }
  }
}

TEST(ProfileTest, CaveatsNameTheProfileAndEveryUnverifiedParameter) {
  for (const Profile& profile : Profile::built_in()) {
    const auto caveats = caveats_of(profile);
    ASSERT_EQ(caveats.size(), 3U);
    EXPECT_NE(caveats.at(0).find("profile " + profile.name + " "), std::string::npos);
    EXPECT_NE(caveats.at(0).find("not calibrated"), std::string::npos);
    for (const CouplingParameter& parameter : coupling_parameters()) {
      const bool is_named = caveats.at(2).find(std::string(parameter.name) + " ") != std::string::npos;
      EXPECT_EQ(is_named, parameter.standing != Standing::standard) << parameter.name;
    }
  }
}

}  // namespace
}  // namespace fieldproof::emc
