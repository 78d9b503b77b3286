// Subject: what README.md says of settings, frames and events is what the code has.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/field/json_schema.hpp"
#include "harness/field/written_table.hpp"
#include "protocols/token_bus/cable_rules.hpp"
#include "protocols/token_bus/device.hpp"
#include "protocols/token_bus/dual_channel_settings.hpp"
#include "protocols/token_bus/rules_table.hpp"
#include "protocols/token_bus/station_settings.hpp"
#include "protocols/token_bus/translator_settings.hpp"

namespace fieldproof::token_bus {
namespace {

void expect_on_token_bus_page(const std::string& text, const std::string& name = "README.md") {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/token_bus/" + name);
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find("\n" + text), std::string::npos) << name << " of this folder must have:\n" << text;
}

TEST(TokenBusPage, HasEverySettingOfAStation) {
  expect_on_token_bus_page(field::markdown_of(kStationTable) + "\n");
}

TEST(TokenBusPage, HasEveryNumberOfALine) {
  expect_on_token_bus_page(field::markdown_of(kCableRulesTable) + "\n");
}

TEST(TokenBusPage, HasEverySettingOfATranslator) {
  expect_on_token_bus_page(field::markdown_of(kTranslatorTable) + "\n", "translator.md");
}

TEST(TokenBusPage, HasEverySettingOfAChannelManager) {
  expect_on_token_bus_page(field::markdown_of(kChannelManagerTable) + "\n", "channel_manager.md");
}

TEST(TokenBusPage, HasEveryEventOfAChannelManager) {
  for (unsigned n = 0; n < kChannelEventKinds; ++n) {
    expect_on_token_bus_page(fmt::format("| {} | {} | ", n, text_of(static_cast<ChannelEventKind>(n))),
                             "channel_manager.md");
  }
}

TEST(TokenBusPage, HasEveryEvent) {
  for (unsigned n = 0; n < kEventKinds; ++n)
    expect_on_token_bus_page(fmt::format("| {} | {} | ", n, text_of(static_cast<EventKind>(n))));
}

TEST(TokenBusPage, HasEveryFrame) {
  using enum FrameKind;
  const Rules rules;
  const std::vector<Frame> samples{
      {.kind = claim_token, .source = 0x0A},
      {.kind = solicit_successor_1, .destination = 4, .source = 0x0A},
      {.kind = solicit_successor_2, .destination = 0x0E, .source = 0x0A},
      {.kind = who_follows, .destination = 4, .source = 0x0A, .data = {4, 0}},
      {.kind = resolve_contention, .destination = 0x0A, .source = 0x0A},
      {.kind = token, .destination = 4, .source = 0x0A},
      {.kind = set_successor, .destination = 0x0A, .source = 6, .data = {6, 0}},
      {.kind = data, .priority = 6, .destination = 4, .source = 0x0A, .data = {0x41}},
      {.kind = data,
       .action = Action::request_with_response,
       .priority = 6,
       .destination = 4,
       .source = 0x0A,
       .data = {0x41}},
      {.kind = data,
       .action = Action::response,
       .priority = 6,
       .destination = 0x0A,
       .source = 4,
       .data = {0x42}},
  };
  std::string text = "| octets between the delimiters, with their check | which reads |\n|---|---|\n";
  for (const Frame& frame : samples) {
    text += fmt::format("| `{:02X}` | {} |\n", fmt::join(with_check(octets_of(frame, rules)), " "),
                        describe(frame, rules));
  }
  expect_on_token_bus_page(text);
}

// In a file of a ring the same numbers have the same ranges.
TEST(RingSchema, HasTheRangesOfTheRules) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/token_bus/ring_network.schema.json");
  const auto shipped = nlohmann::ordered_json::parse(file)["properties"];
  const auto wanted = field::properties_of(kRulesInARingFile);
  ASSERT_EQ(wanted.size(), 3U);
  for (const auto& [name, property] : wanted.items()) {
    ASSERT_TRUE(shipped.contains(name)) << name;
    const auto of_numbers = [](const auto& one) { return one.contains("items") ? one["items"] : one; };
    for (const char* end : {"minimum", "maximum"})
      EXPECT_EQ(of_numbers(shipped[name])[end], of_numbers(property)[end]) << name << " " << end;
  }
}

}  // namespace
}  // namespace fieldproof::token_bus
