// Subject: documents that are written and read again.
// The reader held against the library it is built on, over random values and random texts.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::config {
namespace {

using nlohmann::json;

json random_scalar() {
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return nullptr;
    case 1:
      return *rc::gen::arbitrary<bool>();
    case 2:
      return *rc::gen::arbitrary<std::int64_t>();
    case 3:
      return *rc::gen::arbitrary<std::uint64_t>();
    case 4:
      return *rc::gen::arbitrary<double>();
    default:
      return *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
  }
}

json random_json(int depth) {
  const int kind = depth == 0 ? 0 : *rc::gen::inRange(0, 4);
  if (kind < 2) return random_scalar();
  json container = kind == 2 ? json::array() : json::object();
  const int count = *rc::gen::inRange(0, 5);
  for (int n = 0; n < count; ++n) {
    if (kind == 2) {
      container.push_back(random_json(depth - 1));
    } else {
      const std::string key =
          *rc::gen::container<std::string>(rc::gen::element('a', '/', '~', '"', '\\', '\n', '0'));
      container[key] = random_json(depth - 1);
    }
  }
  return container;
}

// The text from the place of a value on.
std::string_view text_at(const Document& document, const Value& value) {
  std::string_view text = document.text();
  for (std::size_t line = 1; line < value.line(); ++line) text.remove_prefix(text.find('\n') + 1);
  return text.substr(value.column() - 1);
}

void expect_same(const Document& document, const Value& value, const json& model,
                 const json::json_pointer& pointer) {
  RC_ASSERT(value.pointer() == pointer.to_string());
  const std::string written = model.is_array() ? "[" : model.is_object() ? "{" : model.dump();
  RC_ASSERT(text_at(document, value).starts_with(written));
  switch (value.kind()) {
    case ValueKind::null:
      RC_ASSERT(model.is_null());
      break;
    case ValueKind::boolean:
      RC_ASSERT(model == value.as_bool());
      break;
    case ValueKind::integer:
      RC_ASSERT(model.is_number_integer());
      if (model.is_number_unsigned()) {
        RC_ASSERT(model == value.as_integer<std::uint64_t>());
      } else {
        RC_ASSERT(model == value.as_integer());
      }
      break;
    case ValueKind::number:
      RC_ASSERT(model.is_number_float());
      RC_ASSERT(model == value.as_number());
      break;
    case ValueKind::string:
      RC_ASSERT(model == std::string(value.as_string()));
      break;
    case ValueKind::array: {
      const auto elements = value.as_array();
      RC_ASSERT(model.is_array() && model.size() == elements.size());
      for (std::size_t n = 0; n < elements.size(); ++n) {
        expect_same(document, elements[n], model[n], pointer / n);
      }
      break;
    }
    case ValueKind::object: {
      const auto members = value.as_members();
      RC_ASSERT(model.is_object() && model.size() == members.size());
      for (const auto& [key, member] : members) {
        expect_same(document, member, model.at(std::string(key)), pointer / std::string(key));
      }
      break;
    }
  }
}

RC_GTEST_PROP(RoundTrip, RandomValuesKeepContentPlaceAndPointer, ()) {
  const json model = random_json(4);
  const int indent = *rc::gen::inRange(-1, 4);
  const Document document = Document::parse(model.dump(indent), "x.json");
  expect_same(document, document.root(), model, json::json_pointer());
}

// A right text with a few tokens strewn in, so that many texts are nearly or wholly right.
std::string random_text() {
  static const std::vector<std::string> tokens{
      "{",   "}",    "[",    "]",  ":",      ",",           "\"a\"",    "1",    "-0",       "01",
      "1.5", "true", " ",    "\n", "//x\n",  "/**/",        "/* \n*/",  "/",    "\"",       "\\",
      "\r",  " ",    "//\n", "\t", "\"\n\"", "\"\\u00e4\"", "\xC3\xA4", "/**/", "\"a\":1,", "\xFF"};
  std::string text = random_json(3).dump(*rc::gen::inRange(-1, 3));
  const auto strewn = *rc::gen::inRange<std::size_t>(0, 4);
  for (std::size_t n = 0; n < strewn; ++n) {
    text.insert(*rc::gen::inRange<std::size_t>(0, text.size() + 1), *rc::gen::elementOf(tokens));
  }
  return text;
}

RC_GTEST_PROP(RoundTrip, RandomTextsAreReadAsTheLibraryReadsThemOrRefused, ()) {
  const std::string text = random_text();
  constexpr bool kIgnoresComments = true;
  try {
    const Document document = Document::parse(text, "x.json");
    RC_TAG("read");
    RC_ASSERT(json::accept(text, kIgnoresComments));
    const json model = json::parse(text, nullptr, true, kIgnoresComments);
    RC_ASSERT(document.root().is_object() == model.is_object());
    if (model.is_object()) {
      for (const auto& [key, member] : document.root().as_members()) {
        RC_ASSERT(model.contains(std::string(key)));
        RC_ASSERT(std::string_view("/ \r\n:,").find(text_at(document, member).front()) ==
                  std::string_view::npos);
      }
    }
  } catch (const kernel::Error& error) {
    const std::string sentence = error.what();
    RC_ASSERT(sentence.starts_with("x.json:"));
    const bool is_stricter = sentence.find("is already on line") != std::string::npos ||
                             sentence.find("not valid UTF-8") != std::string::npos;
    RC_TAG(is_stricter ? "refused for strictness" : "refused");
    RC_ASSERT(is_stricter || !json::accept(text, kIgnoresComments));
  }
}

RC_GTEST_PROP(RoundTrip, RandomOctetsAreReadOrRefused, (const std::string& octets)) {
  try {
    (void)Document::parse(octets, "x.json");
  } catch (const kernel::Error& error) {
    RC_ASSERT(std::string(error.what()).starts_with("x.json:"));
  }
}

RC_GTEST_PROP(RoundTrip, DurationsAreExactInEveryUnit, ()) {
  struct Unit {
    const char* name;
    std::int64_t picoseconds;
    int decimals;
  };
  const auto unit = *rc::gen::elementOf(std::vector<Unit>{{"ps", 1, 0},
                                                          {"ns", 1'000, 3},
                                                          {"us", 1'000'000, 6},
                                                          {"ms", 1'000'000'000, 9},
                                                          {"s", 1'000'000'000'000, 12}});
  const auto count = *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 62);
  std::string number = fmt::format("{}", count / unit.picoseconds);
  if (unit.decimals > 0) number += fmt::format(".{:0{}}", count % unit.picoseconds, unit.decimals);
  const Document document = Document::parse(fmt::format("\"{} {}\"", number, unit.name), "x.json");
  RC_ASSERT(document.root().as_duration() == kernel::Duration{count});
}

}  // namespace
}  // namespace fieldproof::config
