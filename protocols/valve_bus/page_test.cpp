// Subject: what README.md says of settings is what the code has.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "harness/field/written_table.hpp"
#include "protocols/valve_bus/host_settings.hpp"
#include "protocols/valve_bus/node_settings.hpp"

namespace fieldproof::valve_bus {
namespace {

void expect_on_page(const std::string& text) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/valve_bus/README.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find("\n" + text + "\n"), std::string::npos) << "protocols/valve_bus/README.md must have:\n"
                                                              << text;
}

TEST(ValveBusPage, HasEverySettingOfANode) {
  expect_on_page(field::markdown_of(kNodeTable));
}

TEST(ValveBusPage, HasEverySettingOfAHost) {
  expect_on_page(field::markdown_of(kHostTable));
}

}  // namespace
}  // namespace fieldproof::valve_bus
