#include "harness/config/name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/kernel/error.hpp"

namespace fieldproof::config {
namespace {

std::string name_in(const std::string& text) {
  const Document document = Document::parse(text, "network.json");
  return read_object(document.root(),
                     [](ObjectReader& object) { return read_name(object.required("name")); });
}

TEST(ReadName, TakesWhatASchemaTakes) {
  EXPECT_EQ(name_in(R"({"name": "boiler"})"), "boiler");
  EXPECT_EQ(name_in(R"({"name": " "})"), " ");
  for (const char* text : {R"({"name": ""})", R"({"name": 7})"}) {
    try {
      name_in(text);
      ADD_FAILURE() << text << " was taken";
    } catch (const kernel::Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("/name")) << text;
    }
  }
}

}  // namespace
}  // namespace fieldproof::config
