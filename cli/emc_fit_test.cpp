// Subject: `fieldproof emc PROTOCOL --fit FILE` and the file of counts.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "cli/counts_file.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

const std::string kHead = "level_v,repetition,polarity,time_s,frames,frames_bad,undetected\n";

std::string refusal_of(const std::string& text) {
  try {
    read_counts(text, "counts.csv");
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "taken";
}

TEST(CountsFile, IsReadRowByRow) {
  const auto rows = read_counts(
      "# a comment\r\n" + kHead + "500,5kHz,+,60,73640,446,1\r\n# between\n1e3,100kHz,-,0.5,1,1,0",
      "counts.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].volts, 500);
  EXPECT_EQ(rows[0].frames, 73'640U);
  EXPECT_EQ(rows[0].bad, 446U);
  EXPECT_EQ(rows[0].undetected, 1U);
  EXPECT_EQ(rows[1].repetition, emc::Repetition::khz_100);
  EXPECT_EQ(rows[1].polarity, emc::Polarity::negative);
}

TEST(CountsFile, RefusesWithTheLineWhatItCannotRead) {
  const std::string good = "500,5kHz,+,60,100,4,0\n";
  EXPECT_HOLDS(refusal_of(""), "counts.csv:1: the first line must be 'level_v,repetition");
  EXPECT_HOLDS(refusal_of(good), "counts.csv:1: the first line must be");
  EXPECT_EQ(refusal_of("\xEF\xBB\xBF" + kHead + good), "taken");  // of a spreadsheet
  EXPECT_HOLDS(refusal_of(kHead), "no row follows the head");
  EXPECT_HOLDS(refusal_of(kHead + good + "\n" + good), "counts.csv:3: 0 values; write 7");
  EXPECT_HOLDS(refusal_of(kHead + good + "500,5kHz,+,60,100,4\n"), "counts.csv:3: 6 values; write 7");
  EXPECT_HOLDS(refusal_of(kHead + "0,5kHz,+,60,100,4,0\n"),
               "counts.csv:2: level_v: '0' is none; write a number from 1");
  EXPECT_HOLDS(refusal_of(kHead + "nan,5kHz,+,60,100,4,0\n"), "level_v: 'nan' is none");
  EXPECT_HOLDS(refusal_of(kHead + "500,7kHz,+,60,100,4,0\n"),
               "repetition: '7kHz' is none; write one of 5kHz, 100kHz, 2.5kHz");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,x,60,100,4,0\n"), "polarity: 'x' is none; write one of +, -");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,+,0,100,4,0\n"), "time_s: '0' is none");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,+,60,-1,4,0\n"),
               "frames: '-1' is none; write a whole number from 1");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,+,60,100,101,0\n"),
               "frames_bad: '101' is none; write a whole number from 0 to 100");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,+,60,100,4,5\n"),
               "undetected: '5' is none; write a whole number from 0 to 4");
  EXPECT_HOLDS(refusal_of(kHead + "500,5kHz,+,60,100, 4,0\n"), "frames_bad: ' 4' is none");
  EXPECT_EQ(refusal_of(kHead + "5\x1b[2J,5kHz,+,60,100,4,0\n").find('\x1b'), std::string::npos);
  std::string many = kHead;
  for (std::size_t n = 0; n <= kMostCountRows; ++n) many += good;
  EXPECT_HOLDS(refusal_of(many), "more than 10000 rows");
  EXPECT_HOLDS(refusal_of(std::string(std::size_t{2} << 20, '#')), "larger than 1 MiB");
}

RC_GTEST_PROP(CountsFileProperty, AnyTextIsReadOrRefused, (const std::string& text)) {
  try {
    read_counts(kHead + text, "counts.csv");
  } catch (const kernel::Error& error) {
    RC_ASSERT(std::string(error.what()).starts_with("counts.csv:"));
  }
}

class EmcFitVerb : public ProgramFixture {
 protected:
  Called fit(const std::string& file, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"emc", "interbus", "--fit", file});
    return call(std::move(more));
  }
  static std::string example() { return (kSourceFolder / "examples/burst_counts.csv").string(); }
};

TEST_F(EmcFitVerb, FindsTheParametersOfTheExample) {
  const Called called = fit(example(), {"--bits", "182", "--json", "fit.json"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.out, "frames of 182 bits at 500000 bit/s");
  EXPECT_HOLDS(called.out, "consistent: the counts follow level, repetition and polarity");
  const nlohmann::json document = json("fit.json");
  EXPECT_EQ(document.at("verdict"), "consistent");
  EXPECT_LT(document.at("gain").at("from"), document.at("gain").at("value"));
  EXPECT_LT(document.at("gain").at("value"), document.at("gain").at("to"));
  EXPECT_EQ(document.at("rows").size(), 20U);
  expect_valid({"fit.json"}, "emc_fit");
}

TEST_F(EmcFitVerb, SaysWhatContradictsAndWhatIsOpen) {
  std::string rows = kHead;
  for (const char* level : {"250", "500", "1000", "2000"}) {
    for (const char* repetition : {"5kHz", "100kHz"})
      rows += std::string(level) + "," + repetition + ",+,60,73640,300,0\n";
  }
  write("flat.csv", rows);
  const Called flat = fit("flat.csv", {"--bits", "182"});
  EXPECT_EQ(flat.exit_code, 1) << flat.out << flat.err;
  EXPECT_HOLDS(flat.out, "contradicts: no gain and strength explain them");
  write("one.csv", kHead + "500,5kHz,+,60,73640,300,0\n");
  const Called one = fit("one.csv", {"--json", "one.json"});
  EXPECT_EQ(one.exit_code, 2) << one.out << one.err;
  EXPECT_HOLDS(one.out, "open: too few conditions");
  expect_valid({"one.json"}, "emc_fit");
}

TEST_F(EmcFitVerb, RefusesWhatCannotBe) {
  write("bad.csv", kHead + "500,5kHz,+,60,73640,446,0\n500,5kHz,+,60,many,0,0\n");
  const Called bad = fit("bad.csv");
  EXPECT_EQ(bad.exit_code, 65) << bad.out;
  EXPECT_HOLDS(bad.err, "bad.csv:3: frames: 'many' is none");
  EXPECT_EQ(fit("missing.csv").exit_code, 65);
  EXPECT_EQ(fit(".").exit_code, 65);
  write("fast.csv", kHead + "500,5kHz,+,1,73640,446,0\n");
  const Called fast = fit("fast.csv");
  EXPECT_EQ(fast.exit_code, 65);
  EXPECT_HOLDS(fast.err, "--bits N says how long one is");
  EXPECT_EQ(fit(example(), {"--test-levels", "3"}).exit_code, 64);
  EXPECT_EQ(fit(example(), {"--bits", "0"}).exit_code, 64);
}

}  // namespace
}  // namespace fieldproof::cli
