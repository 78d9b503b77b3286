// Subject: what README.md says of settings, and the schema of rules, is what the code has.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/field/json_schema.hpp"
#include "harness/field/written_table.hpp"
#include "protocols/interbus/master_settings.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::interbus {
namespace {

void expect_on_page(const std::string& text) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/interbus/README.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find("\n" + text + "\n"), std::string::npos) << "protocols/interbus/README.md must have:\n"
                                                              << text;
}

TEST(InterbusPage, HasEverySettingOfASlave) {
  expect_on_page(field::markdown_of(kSlaveTable));
}

TEST(InterbusPage, HasEverySettingOfAMaster) {
  expect_on_page(field::markdown_of(kMasterTable));
}

TEST(InterbusSchema, HasTheRulesOfTheTable) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/interbus/network.schema.json");
  const auto schema = nlohmann::ordered_json::parse(file);
  const auto& shipped = schema["definitions"]["rules"]["properties"];
  const auto wanted = field::properties_of(kRulesInAFile);
  EXPECT_EQ(shipped, wanted) << wanted.dump(2);
}

}  // namespace
}  // namespace fieldproof::interbus
