// Subject: `fieldproof residual` as its user meets it.
#include "cli/residual_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

class ResidualVerb : public ProgramFixture {
 protected:
  Called call(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "residual");
    return ProgramFixture::call(std::move(arguments));
  }

  nlohmann::json json_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "residual.json"});
    const Called called = call(std::move(arguments));
    EXPECT_EQ(called.exit_code, 0) << called.err;
    return json("residual.json");
  }
};

TEST_F(ResidualVerb, PrintsTheWeightsAndTheProbabilityAtEachRate) {
  const Called called = call({"--fcs", "crc-16/ibm-3740", "--bits", "64", "--ber", "1e-3", "--ber", "0.5"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* part :
       {"CRC-16/IBM-3740: 16 check bits, polynomial 0x1021, 64 bits", "Hamming distance 4", "  4 flips  84\n",
        "1.52588e-05", "IEC 61784-3 [memory, unverified]; 3600 messages per hour, 1 receivers"}) {
    EXPECT_NE(called.out.find(part), std::string::npos) << part << " in\n" << called.out;
  }
  EXPECT_EQ(called.out.find("simulated"), std::string::npos);
}

TEST_F(ResidualVerb, WritesJsonThatHoldsWhatItSays) {
  const nlohmann::json json = json_of({"--fcs", "CRC-16/IBM-3740", "--bits", "64", "--ber", "1e-2",
                                       "--messages", "7200", "--receivers", "3"});
  EXPECT_EQ(json.at("hamming_distance"), 4);
  EXPECT_EQ(json.at("weights").at(1).at("count"), "84");
  const nlohmann::json& point = json.at("points").at(0);
  EXPECT_DOUBLE_EQ(point.at("rate_per_hour"), point.at("probability").get<double>() * 7200 * 3);
  EXPECT_TRUE(point.at("proper_bound_exceeded"));
  EXPECT_FALSE(point.contains("counted"));
}

TEST_F(ResidualVerb, SimulatesBesideTheExactValueAndRepeatsWithItsSeed) {
  const std::vector<std::string> arguments = {"--fcs", "CRC-16/MODBUS", "--bits", "64",     "--ber",
                                              "3e-2",  "--samples",     "50000",  "--seed", "7"};
  const nlohmann::json json = json_of(arguments);
  const nlohmann::json& point = json.at("points").at(0);
  const nlohmann::json& sampled = point.at("sampled");
  EXPECT_NEAR(sampled.at("probability"), point.at("probability"),
              5 * sampled.at("standard_error").get<double>());
  EXPECT_GT(point.at("counted").at("upper_bound_95"), point.at("share_of_corrupted"));
  EXPECT_EQ(json_of(arguments), json);
  EXPECT_NE(call(arguments).out.find("simulated at 0.03, seed 7"), std::string::npos);
}

TEST_F(ResidualVerb, JsonIsValidForItsSchema) {
  json_of({"--fcs", "CRC-8/SMBUS", "--bits", "40", "--samples", "100"});
  std::filesystem::rename(folder_ / "residual.json", folder_ / "with_samples.json");
  json_of({"--fcs", "CRC-8/SMBUS", "--bits", "8"});
  expect_valid({"with_samples.json", "residual.json"}, "residual");
}

TEST_F(ResidualVerb, RefusesWithOneSentenceThatSaysWhatWouldBeRight) {
  struct Refused {
    std::vector<std::string> arguments;
    std::string says;
  };
  for (const auto& [arguments, says] : std::vector<Refused>{
           {{"--bits", "64"}, "residual needs --fcs"},
           {{"--fcs", "CRC-8/SMBUS"}, "residual needs --bits"},
           {{"--fcs", "CRC-16/MODBSU", "--bits", "64"}, "the nearest are 'CRC-16/MODBUS'"},
           {{"--fcs", "CRC-64/XZ", "--bits", "64"}, "at most 32"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "0"}, "1 to 131072"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "131073"}, "1 to 131072"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "64", "--ber", "0.6"}, "0.6 is no bit-error rate"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "64", "--ber", "nan"}, "is no bit-error rate"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "64", "--ber", "1e-3x"}, "'1e-3x' is no number"},
           {{"--fcs", "CRC-8/SMBUS", "--bits", "64", "--samples", "-1"}, "no whole number"}}) {
    const Called called = call(arguments);
    EXPECT_EQ(called.exit_code, 64) << says;
    EXPECT_NE(called.err.find(says), std::string::npos) << called.err;
    EXPECT_EQ(std::count(called.err.begin(), called.err.end(), '\n'), 1) << called.err;
  }
}

TEST_F(ResidualVerb, RefusesAWrongVariableOfTheEnvironmentAsConfiguration) {
  Call made = prepared({"residual", "--fcs", "CRC-8/SMBUS", "--bits", "64"});
  made.environment = {{"FIELDPROOF_BER", "1e-3;x"}};
  const Called called = made.run();
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_NE(called.err.find("FIELDPROOF_BER"), std::string::npos) << called.err;
}

TEST_F(ResidualVerb, NamesAVariableThatSetsNothing) {
  Call made = prepared({"residual", "--fcs", "CRC-8/SMBUS", "--bits", "64"});
  made.environment = {{"FIELDPROOF_BERS", "1e-3"}, {"FIELDPROOF_SEED", "3"}};
  const Called called = made.run();
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.err,
            "fieldproof: the variable FIELDPROOF_BERS sets nothing; the nearest one that does is "
            "FIELDPROOF_BER\n");
}

TEST_F(ResidualVerb, RefusesACodeWordShorterThanItsCheck) {
  const Called called = prepared({"residual", "--fcs", "CRC-16/IBM-3740", "--bits", "15"}).run();
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_NE(called.err.find("has 16 check bits; write 16 or more"), std::string::npos) << called.err;
}

}  // namespace
}  // namespace fieldproof::cli
