// Subject: what README.md says of settings and frames is what the code has.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "harness/field/written_table.hpp"
#include "protocols/fieldbus_dll/dlpdu_layout.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"
#include "protocols/fieldbus_dll/test_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

void expect_in_words(const std::string& text) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/fieldbus_dll/README.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find(text), std::string::npos) << "protocols/fieldbus_dll/README.md must have:\n" << text;
}

// The beginning of a line.
void expect_line(const std::string& text) {
  expect_in_words("\n" + text);
}

void expect_on_page(const std::string& text) {
  expect_line(text + "\n");
}

TEST(FieldbusDllPage, HasEverySettingOfFoundationFieldbus) {
  expect_on_page(field::markdown_of(kFfTable));
}

TEST(FieldbusDllPage, HasEverySettingOfIsa) {
  expect_on_page(field::markdown_of(kIsaTable));
}

template <typename Kind>
void expect_events(Kind last) {
  for (unsigned n = 0; n <= static_cast<unsigned>(last); ++n)
    expect_line(fmt::format("| {} | {} | ", n, text_of(static_cast<Kind>(n))));
}

TEST(FieldbusDllPage, HasEveryEvent) {
  expect_events(FfEventKind::left);
  expect_events(IsaEventKind::scheduler_taken);
}

// The frames that the words on basic devices name.
TEST(FieldbusDllPage, HasTheFramesOfABasicDevice) {
  const FfRules rules;
  const auto on_page = [&](const FfDlpdu& dlpdu) {
    expect_in_words(fmt::format("{:02X}`", fmt::join(octets_of(dlpdu, rules), " ")));
  };
  on_page({.type = FfType::dt1,
           .priority = Priority::normal,
           .destination = 0x2130,
           .source = 0x2230,
           .data = {0x41}});
  on_page({.type = FfType::sr, .is_final = true, .status = FfStatus::unknown_address});
  on_page({.type = FfType::sr, .is_final = true, .status = FfStatus::nothing_written});
  on_page({.type = FfType::dt1,
           .priority = Priority::normal,
           .destination = address_of(0x21),
           .source = address_of(0x10),
           .data = {static_cast<std::uint8_t>(SpduKind::activation)}});
}

template <typename Dlpdu, typename Rules>
std::string frames_text(const std::vector<Dlpdu>& samples, const Rules& rules) {
  std::string text = "| DLPDU, octet by octet | on the line, with its check | which reads |\n|---|---|---|\n";
  for (const Dlpdu& dlpdu : samples) {
    text += fmt::format("| {} | `{:02X}` | {} |\n", layout_text(dlpdu.type, rules.codes),
                        fmt::join(with_check(octets_of(dlpdu, rules)), " "), describe(dlpdu));
  }
  return text;
}

// One of each type, in their order.
TEST(FieldbusDllPage, HasEveryFrameOfFoundationFieldbus) {
  using enum FfType;
  const std::vector<FfDlpdu> samples{
      {.type = cd, .priority = Priority::normal, .destination = 0x2020},
      {.type = dt1,
       .priority = Priority::urgent,
       .is_final = true,
       .destination = 0x2100,
       .source = 0x2000,
       .data = {0x41, 0x42}},
      {.type = dt3, .priority = Priority::normal, .source = 0x2020, .writes = 7, .data = {0x41, 0x42}},
      {.type = sr, .status = FfStatus::nothing_written},
      {.type = pt,
       .priority = Priority::time_available,
       .begins_circulation = true,
       .node = 0x20,
       .duration = 280},
      {.type = rt},
      {.type = ri, .duration = 100},
      {.type = pn, .node = 0x20},
      {.type = pr, .node = 0x20},
      {.type = td, .link_time = 32'000},
      {.type = ct, .node = 0x20},
      {.type = cl, .node = 0x10},
      {.type = tl, .node = 0x11, .schedule_version = 1},
      {.type = idle},
  };
  for (std::size_t n = 0; n < samples.size(); ++n) EXPECT_EQ(samples[n].type, static_cast<FfType>(n));
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(idle) + 1);
  const FfRules rules;
  for (const FfDlpdu& dlpdu : samples) EXPECT_EQ(ff_dlpdu_of(octets_of(dlpdu, rules), rules), dlpdu);
  expect_on_page(frames_text(samples, rules));
}

TEST(FieldbusDllPage, HasEveryFrameOfIsa) {
  using enum IsaType;
  const std::vector<IsaDlpdu> samples{
      {.type = cd, .priority = Priority::normal, .destination = 0x21, .source = 0x10},
      {.type = dt,
       .priority = Priority::normal,
       .is_final = true,
       .destination = 0x10,
       .source = 0x21,
       .data = {0x41, 0x42}},
      {.type = du, .priority = Priority::urgent, .destination = 0xFF, .source = 0x21, .data = {0x41}},
      {.type = et, .priority = Priority::normal, .destination = 0x21, .source = 0x10},
      {.type = es, .priority = Priority::normal, .destination = 0x21, .source = 0x10, .duration = 1'000},
      {.type = ee, .destination = 0x10, .source = 0x21, .reason = EndReason::single_frame_done},
      {.type = tl, .destination = 0x11, .source = 0x10, .schedule_version = 1},
  };
  for (std::size_t n = 0; n < samples.size(); ++n) EXPECT_EQ(samples[n].type, static_cast<IsaType>(n));
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(tl) + 1);
  const IsaRules rules;
  for (const IsaDlpdu& dlpdu : samples) EXPECT_EQ(isa_dlpdu_of(octets_of(dlpdu, rules), rules), dlpdu);
  expect_on_page(frames_text(samples, rules));
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
