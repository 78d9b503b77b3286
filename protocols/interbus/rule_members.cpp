#include "protocols/interbus/rule_members.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "harness/config/document.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
namespace {

using config::ObjectReader;
using config::Value;
using field::Fact;
using field::GivenSettings;
using field::Settings;
using field::SettingWords;
using judge::Standing;

// ---- the header of telegrams ----

struct Flag {
  const char* name;
  bool line::TelegramLayout::* member;
};
constexpr std::array kFlags{Flag{"select_level", &line::TelegramLayout::select_level},
                            Flag{"control_level", &line::TelegramLayout::control_level},
                            Flag{"data_flag_level", &line::TelegramLayout::data_flag_level},
                            Flag{"most_significant_first", &line::TelegramLayout::most_significant_first}};
struct Place {
  const char* name;
  line::HeaderLevel level;
};
constexpr std::array kPlaces{Place{"select_place", line::HeaderLevel::select},
                             Place{"control_place", line::HeaderLevel::control},
                             Place{"flag_place", line::HeaderLevel::flag}};

const line::TelegramLayout& layout_of(const void* member) {
  return *static_cast<const line::TelegramLayout*>(member);
}

void put_telegram(const void* member, Settings& settings) {
  const line::TelegramLayout& layout = layout_of(member);
  for (const auto& [name, level] : kPlaces) {
    settings.emplace_back(name, std::ranges::find(layout.header, level) - layout.header.begin());
  }
  for (const auto& [name, flag] : kFlags) settings.emplace_back(name, layout.*flag ? 1 : 0);
}

void take_telegram(const GivenSettings& given, void* member) {
  auto& layout = *static_cast<line::TelegramLayout*>(member);
  const auto before = layout.header;
  for (const auto& [name, level] : kPlaces) {
    const auto absent = std::ranges::find(before, level) - before.begin();
    layout.header.at(static_cast<std::size_t>(given.within(name, {0, 2}, absent))) = level;
  }
  for (const auto& [name, flag] : kFlags) {
    layout.*flag = given.within(name, field::kTruthRange, layout.*flag ? 1 : 0) != 0;
  }
}

std::vector<Fact> facts_of_telegram(std::string_view name, const void* member) {
  const line::TelegramLayout& layout = layout_of(member);
  std::string text = "start 0";
  for (const line::HeaderLevel level : layout.header) {
    switch (level) {
      case line::HeaderLevel::select:
        text += fmt::format(", SL {} = set", layout.select_level ? 1 : 0);
        break;
      case line::HeaderLevel::control:
        text += fmt::format(", CR {} = set", layout.control_level ? 1 : 0);
        break;
      case line::HeaderLevel::flag:
        text += fmt::format(", FL {} = data", layout.data_flag_level ? 1 : 0);
        break;
    }
  }
  text += layout.most_significant_first ? ", D7..D0, stop 1" : ", D0..D7, stop 1";
  return {{std::string(name), text,
           "order and polarity are this project's choice; 5 + 8 bit: Park 2004, section 2.2", Standing::own}};
}

std::array<line::HeaderLevel, 3> read_header(const Value& value) {
  std::array<line::HeaderLevel, 3> header{};
  const auto names = value.as_array(header.size(), header.size());
  for (std::size_t n = 0; n < header.size(); ++n) {
    header[n] = names[n].as_choice<line::HeaderLevel>({{"select", line::HeaderLevel::select},
                                                       {"control", line::HeaderLevel::control},
                                                       {"flag", line::HeaderLevel::flag}});
    const auto until = header.begin() + static_cast<std::ptrdiff_t>(n);
    if (std::find(header.begin(), until, header[n]) != until) {
      config::fail(names[n], "this header level is there already; write each of the three once");
    }
  }
  return header;
}

void read_telegram(const Value& value, void* member) {
  config::read_object(value, [&](ObjectReader& object) {
    auto& layout = *static_cast<line::TelegramLayout*>(member);
    if (const auto header = object.optional("header")) layout.header = read_header(*header);
    for (const auto& [name, flag] : kFlags) {
      if (const auto written = object.optional(name)) layout.*flag = written->as_bool();
    }
  });
}

constexpr std::array kTelegramWords{
    SettingWords{"select_place", "0 to 2", "which of the three levels after the start level is SL"},
    SettingWords{"control_place", "0 to 2", "which is CR"},
    SettingWords{"flag_place", "0 to 2", "which is FL"},
    SettingWords{"select_level", "0 or 1", "the level of SL that means set"},
    SettingWords{"control_level", "0 or 1", "the level of CR that means set"},
    SettingWords{"data_flag_level", "0 or 1", "the level of FL in a data telegram"},
    SettingWords{"most_significant_first", "0 or 1", "the order of the data bits of a telegram"}};

constexpr std::string_view kTelegramSchema = R"({
  "type": "object",
  "additionalProperties": false,
  "properties": {
    "header": {"type": "array", "minItems": 3, "maxItems": 3, "uniqueItems": true,
               "items": {"enum": ["select", "control", "flag"]}},
    "select_level": {"type": "boolean"},
    "control_level": {"type": "boolean"},
    "data_flag_level": {"type": "boolean"},
    "most_significant_first": {"type": "boolean"}
  }
})";

// ---- the frame check ----

// "check_polynomial" ...: a name would be of use to nobody who has no catalogue.
void put_check(const line::FrameCheckParameters& check, Settings& settings) {
  settings.emplace_back("check_polynomial", static_cast<std::int64_t>(check.poly));
  settings.emplace_back("check_preset", static_cast<std::int64_t>(check.init));
  settings.emplace_back("check_final_xor", static_cast<std::int64_t>(check.xorout));
  settings.emplace_back("check_is_reflected", check.refin ? 1 : 0);
}

void put_frame_check(const void* member, Settings& settings) {
  put_check(line::frame_check_named(*static_cast<const std::string*>(member)), settings);
}

void take_frame_check(const GivenSettings& given, void* member) {
  auto& name = *static_cast<std::string*>(member);
  Settings wanted;
  put_frame_check(member, wanted);
  for (auto& [setting, value] : wanted) value = given.find(setting).value_or(value);
  for (const line::FrameCheckParameters& check : line::frame_check_catalogue()) {
    if (check.width != 16) continue;
    Settings candidate;
    put_check(check, candidate);
    if (candidate != wanted) continue;
    name = std::string(check.name);
    return;
  }
  throw kernel::Error(kernel::ErrorKind::implementation, "the bench gives a frame check that nobody knows");
}

std::vector<Fact> facts_of_frame_check(std::string_view name, const void* member) {
  const auto& check = *static_cast<const std::string*>(member);
  return {{fmt::format("{}[polynomial, preset]", name), check,
           "CCITT polynomial: an encoder manual; registers preset with 1: Buesing/Meyer, Practical Guide",
           Standing::searched},
          {fmt::format("{}[bit order, final XOR]", name), check,
           "this project's choice; the standard was not at hand", Standing::own}};
}

void read_frame_check(const Value& value, void* member) {
  const std::string_view name = value.as_string();
  const line::FrameCheckParameters* parameters = line::find_frame_check(name);
  if (parameters == nullptr) {
    const auto names = line::frame_check_names();
    const auto near = config::nearest(name, names, 3);
    config::fail(value,
                 fmt::format("no frame check has this name; near to it are {}", fmt::join(near, ", ")));
  }
  if (parameters->width != 16 || parameters->refin != parameters->refout) {
    config::fail(value, fmt::format("{} does not fill the 16 bit of a check word; write for example "
                                    "\"CRC-16/IBM-3740\" or \"CRC-16/GENIBUS\"",
                                    parameters->name));
  }
  *static_cast<std::string*>(member) = std::string(parameters->name);
}

constexpr std::array kFrameCheckWords{
    SettingWords{"check_polynomial", "0 to 65535", "of the 16-bit check"},
    SettingWords{"check_preset", "0 to 65535", "of its register"},
    SettingWords{"check_final_xor", "0 to 65535", "of the register at the end"},
    SettingWords{"check_is_reflected", "0 or 1",
                 "1: octets go in, and the check comes out, least significant bit first, low octet first; "
                 "polynomial and preset are not turned, the XOR comes last"}};

// ---- length codes ----

constexpr unsigned kLengthCodes = 32;
// 14h is the only entry that was not read in the table of the manual.
constexpr std::uint8_t kLengthCodeFromMemory = 0x14;

std::span<const LengthCode> codes_in(const void* member) {
  const auto& codes = *static_cast<const std::vector<LengthCode>*>(member);
  return codes.empty() ? published_length_codes() : codes;
}

std::string setting_of_code(unsigned code) {
  return fmt::format("words_of_length_code_{}", code);
}

void put_length_codes(const void* member, Settings& settings) {
  for (const LengthCode& one : codes_in(member)) {
    settings.emplace_back(setting_of_code(one.code), one.words);
  }
}

void take_length_codes(const GivenSettings& given, void* member) {
  auto& codes = *static_cast<std::vector<LengthCode>*>(member);
  codes.clear();
  for (unsigned code = 0; code < kLengthCodes; ++code) {
    const std::int64_t words = given.within(setting_of_code(code), {-1, 0xFF}, -1);
    if (words >= 0) codes.push_back({static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(words)});
  }
}

std::string length_codes_text(std::span<const LengthCode> codes, bool from_memory) {
  std::string text;
  for (const LengthCode& entry : codes) {
    if ((entry.code == kLengthCodeFromMemory) != from_memory) continue;
    text += fmt::format("{}{:02X}h = {}", text.empty() ? "" : ", ", entry.code, entry.words);
  }
  return text.empty() ? "none" : text + (from_memory ? " words" : " words; other codes undefined");
}

std::vector<Fact> facts_of_length_codes(std::string_view name, const void* member) {
  const auto codes = codes_in(member);
  return {{fmt::format("{}[00h..13h, 15h..17h]", name), length_codes_text(codes, false),
           "Schneider 890USE196; three points also in the Schneider 170 series table", Standing::searched},
          {fmt::format("{}[14h]", name), length_codes_text(codes, true), "literature from memory",
           Standing::memory}};
}

LengthCode read_length_code(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    LengthCode entry{};
    entry.code = object.required("code").as_hex_or_integer<std::uint8_t>(kLengthCodes - 1);
    entry.words = object.required("words").as_integer<std::uint8_t>(0, 255);
    return entry;
  });
}

void read_length_codes(const Value& value, void* member) {
  std::vector<LengthCode> codes;
  for (const Value& element : value.as_array(1, kLengthCodes)) {
    const LengthCode entry = read_length_code(element);
    if (std::ranges::find(codes, entry.code, &LengthCode::code) != codes.end()) {
      config::fail(element, fmt::format("length code {:02X}h is there already; write it once", entry.code));
    }
    codes.push_back(entry);
  }
  *static_cast<std::vector<LengthCode>*>(member) = std::move(codes);
}

constexpr std::array kLengthCodeWords{
    SettingWords{"words_of_length_code_N", "0 to 255",
                 "length of the register for the length code N, 0 to 31 (bits 8 to 12 of an ID code); a code "
                 "without this setting is not defined"}};

constexpr std::string_view kLengthCodesSchema = R"({
  "type": "array", "minItems": 1, "maxItems": 32,
  "items": {
    "type": "object",
    "additionalProperties": false,
    "required": ["code", "words"],
    "properties": {
      "code": {"oneOf": [{"type": "integer", "minimum": 0, "maximum": 31},
                         {"type": "string", "pattern": "^0[xX]0*(1[0-9A-Fa-f]|[0-9A-Fa-f])$"}]},
      "words": {"type": "integer", "minimum": 0, "maximum": 255}
    }
  }
})";

}  // namespace

constexpr field::Custom kTelegramMember{.put = put_telegram,
                                        .take = take_telegram,
                                        .words = kTelegramWords,
                                        .facts = facts_of_telegram,
                                        .read = read_telegram,
                                        .schema = kTelegramSchema};
constexpr field::Custom kFrameCheckMember{.put = put_frame_check,
                                          .take = take_frame_check,
                                          .words = kFrameCheckWords,
                                          .facts = facts_of_frame_check,
                                          .read = read_frame_check,
                                          .schema = R"({"type": "string", "minLength": 1})"};
constexpr field::Custom kLengthCodesMember{.put = put_length_codes,
                                           .take = take_length_codes,
                                           .words = kLengthCodeWords,
                                           .facts = facts_of_length_codes,
                                           .read = read_length_codes,
                                           .schema = kLengthCodesSchema};

}  // namespace fieldproof::interbus
