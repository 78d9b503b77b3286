// Subject: what README.md says of the network file is what the code has.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "harness/field/written_table.hpp"
#include "protocols/bandwidth/network.hpp"

namespace fieldproof::bandwidth {
namespace {

TEST(BandwidthPage, HasEveryRowOfTheNetwork) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/bandwidth/README.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string table = field::markdown_of(kNetworkTable);
  EXPECT_NE(page.find("\n" + table + "\n"), std::string::npos) << "protocols/bandwidth/README.md must have:\n"
                                                               << table;
}

}  // namespace
}  // namespace fieldproof::bandwidth
