#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::config {
namespace {

using namespace std::chrono_literals;
using Reader = std::function<void(const Value&)>;

std::string error_of(const Value& value, const Reader& read) {
  try {
    read(value);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

// Reads the text as the value of /stations/3/x on line 6.
std::string error_of(const std::string& text, const Reader& read) {
  const Document document =
      Document::parse("{ \"stations\": [\n0,\n1,\n2,\n// the fourth\n{ \"x\": " + text + "}]}", "x.json");
  const Value station = document.root().as_members().at(0).value.as_array().at(3);
  return error_of(station.as_members().at(0).value, read);
}

struct BadValue {
  const char* name;
  const char* text;
  Reader read;
  const char* sentence;  // the whole sentence behind place and pointer
};

void PrintTo(const BadValue& bad, std::ostream* out) {
  *out << bad.name;
}

class BadValues : public testing::TestWithParam<BadValue> {};

TEST_P(BadValues, AreRefusedWithPlacePointerAndWhatWouldBeRight) {
  EXPECT_EQ(error_of(GetParam().text, GetParam().read),
            std::string("x.json:6: /stations/3/x: ") + GetParam().sentence);
}

const auto name_of_row = [](const auto& row) { return std::string(row.param.name); };

void text(const Value& v) {
  (void)v.as_string();
}
void truth(const Value& v) {
  (void)v.as_bool();
}
void any_whole(const Value& v) {
  (void)v.as_integer();
}
void octet(const Value& v) {
  (void)v.as_integer<std::uint8_t>(1, 200);
}
void seed(const Value& v) {
  (void)v.as_integer<std::uint64_t>();
}
void part(const Value& v) {
  (void)v.as_number(0.0, 1.5);
}
void id_code(const Value& v) {
  (void)v.as_hex_or_integer<std::uint8_t>();
}
void pair(const Value& v) {
  (void)v.as_array(2, 2);
}
void members(const Value& v) {
  (void)v.as_members();
}
void pause(const Value& v) {
  (void)v.as_duration(1us, 25ms);
}
void bit_rate(const Value& v) {
  (void)v.as_bit_rate(9600, 2'000'000);
}
void cable(const Value& v) {
  (void)v.as_length_m(0.0, 400.0);
}
void kind(const Value& v) {
  const std::string_view names[] = {"bus_coupler", "remote", "local"};
  (void)v.as_choice(names);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadValues,
    testing::Values(
        BadValue{"string_is_number", "5", text, "5 is a whole number; write a string"},
        BadValue{"string_is_null", "null", text, "this is null; write a string"},
        BadValue{"bool_is_string", "\"true\"", truth, "\"true\" is a string; write true or false"},
        BadValue{"integer_is_array", "[1]", any_whole, "this is an array; write a whole number"},
        BadValue{"integer_is_bool", "true", octet,
                 "true is a truth value; write a whole number from 1 to 200"},
        BadValue{"integer_has_fraction", "5.0", octet,
                 "5.0 is a number with a fraction or an exponent; write a whole number from 1 to 200"},
        BadValue{"number_is_string", "\"1\"", part, "\"1\" is a string; write a number from 0 to 1.5"},
        BadValue{"array_is_object", "{}", pair, "this is an object; write an array of 2 elements"},
        BadValue{"object_is_string", "\"a\"", members, "\"a\" is a string; write an object"}),
    name_of_row);

INSTANTIATE_TEST_SUITE_P(
    Ranges, BadValues,
    testing::Values(
        BadValue{"below", "0", octet, "0 is out of range; write a whole number from 1 to 200"},
        BadValue{"above", "201", octet, "201 is out of range; write a whole number from 1 to 200"},
        BadValue{"negative", "-1", seed, "-1 is out of range; write a whole number from 0"},
        BadValue{"above_64_bit", "18446744073709551616", seed,
                 "18446744073709551616 is out of range; write a whole number from 0"},
        BadValue{"above_63_bit", "9223372036854775808", any_whole,
                 "9223372036854775808 is out of range; write a whole number"},
        BadValue{"far_below", "-99999999999999999999", any_whole,
                 "-99999999999999999999 is out of range; write a whole number"},
        BadValue{"number_above", "1.6", part, "1.6 is out of range; write a number from 0 to 1.5"},
        BadValue{"array_too_short", "[1]", pair, "the array has 1 element; write at least 2"},
        BadValue{"array_too_long", "[1, 2, 3]", pair, "the array has 3 elements; write at most 2"}),
    name_of_row);

INSTANTIATE_TEST_SUITE_P(
    Words, BadValues,
    testing::Values(
        BadValue{"bad_digit", "\"0x1G\"", id_code,
                 "\"0x1G\" is not a hexadecimal number; write for example \"0xBE\""},
        BadValue{"no_prefix", "\"BE\"", id_code,
                 "\"BE\" is not a hexadecimal number; write for example \"0xBE\""},
        BadValue{"no_digits", "\"0x\"", id_code,
                 "\"0x\" is not a hexadecimal number; write for example \"0xBE\""},
        BadValue{"hex_sign", "\"0x-1\"", id_code,
                 "\"0x-1\" is not a hexadecimal number; write for example \"0xBE\""},
        BadValue{"hex_above", "\"0x100\"", id_code, "\"0x100\" is out of range; write at most \"0xFF\""},
        BadValue{"hex_above_64_bit", "\"0x10000000000000000\"", id_code,
                 "\"0x10000000000000000\" is out of range; write at most \"0xFF\""},
        BadValue{"integer_above", "256", id_code, "256 is out of range; write a whole number from 0 to 255"},
        BadValue{"misspelled", "\"bus_cuopler\"", kind,
                 "\"bus_cuopler\" is not known; did you mean \"bus_coupler\"? (known: \"bus_coupler\", "
                 "\"remote\", \"local\")"},
        BadValue{"unlike", "\"master\"", kind,
                 "\"master\" is not known; write one of \"bus_coupler\", \"remote\", \"local\""},
        BadValue{"no_word", "1", kind,
                 "1 is a whole number; write one of \"bus_coupler\", \"remote\", \"local\""}),
    name_of_row);

#define TIME_RULE "write a number and a unit, for example \"25 ms\" (units: ps, ns, us, ms, s)"
#define RATE_RULE \
  "write a number and a unit, for example \"500 kbit/s\" (units: bit/s, kbit/s, Mbit/s, Gbit/s)"
#define LENGTH_RULE "write a number and a unit, for example \"12 m\" (units: mm, cm, m, km)"

INSTANTIATE_TEST_SUITE_P(
    Quantities, BadValues,
    testing::Values(
        BadValue{"plain_duration", "25", pause, "a duration needs its unit; " TIME_RULE},
        BadValue{"plain_rate", "5e5", bit_rate, "a bit rate needs its unit; " RATE_RULE},
        BadValue{"plain_length", "12", cable, "a length needs its unit; " LENGTH_RULE},
        BadValue{"no_quantity", "[]", pause, "this is not a duration; " TIME_RULE},
        BadValue{"no_unit", "\"25\"", pause, "\"25\" has no unit; " TIME_RULE},
        BadValue{"no_number", "\"ms\"", pause, "\"ms\" is not a duration; " TIME_RULE},
        BadValue{"empty", "\"\"", pause, "\"\" is not a duration; " TIME_RULE},
        BadValue{"two_points", "\"1.2.3 ms\"", pause, "\"1.2.3 ms\" is not a duration; " TIME_RULE},
        BadValue{"bare_point", "\"1. ms\"", pause, "\"1. ms\" is not a duration; " TIME_RULE},
        BadValue{"exponent", "\"1e3 us\"", pause, "\"e3 us\" is not a unit of a duration; " TIME_RULE},
        BadValue{"unknown_unit", "\"25 msec\"", pause, "\"msec\" is not a unit of a duration; " TIME_RULE},
        BadValue{"wrong_case", "\"25 MS\"", pause, "\"MS\" is not a unit of a duration; " TIME_RULE},
        BadValue{"text_behind", "\"25 ms \"", pause, "\"ms \" is not a unit of a duration; " TIME_RULE},
        BadValue{"below_a_picosecond", "\"0.0000005 us\"", pause,
                 "\"0.0000005 us\" is not a whole number of picoseconds; write fewer decimals"},
        BadValue{"half_a_bit", "\"1000.5 bit/s\"", bit_rate,
                 "\"1000.5 bit/s\" is not a whole number of bits per second; write fewer decimals"},
        BadValue{"duration_below", "\"0.999999 us\"", pause,
                 "\"0.999999 us\" is too small; write at least 1.000 us"},
        BadValue{"duration_above", "\"25.000000001 ms\"", pause,
                 "\"25.000000001 ms\" is too large; write at most 25.000 ms"},
        BadValue{"duration_overflow", "\"99999999999999999999 s\"", pause,
                 "\"99999999999999999999 s\" is too large; write at most 25.000 ms"},
        BadValue{"duration_negative", "\"-5 us\"", pause, "\"-5 us\" is too small; write at least 1.000 us"},
        BadValue{"length_minus_zero", "\"-0 m\"", cable, "\"-0 m\" is too small; write at least 0 m"},
        BadValue{"rate_above", "\"2.000001 Mbit/s\"", bit_rate,
                 "\"2.000001 Mbit/s\" is too large; write at most 2000000 bit/s"},
        BadValue{"length_above", "\"0.401 km\"", cable, "\"0.401 km\" is too large; write at most 400 m"}),
    name_of_row);

Document in_array(const std::string& text) {
  return Document::parse("[" + text + "]", "x.json");
}

TEST(Value, IntegersAreReadUpToTheirLimits) {
  const Document document =
      in_array("-9223372036854775808, 9223372036854775807, 18446744073709551615, 1, 200");
  const auto values = document.root().as_array();
  EXPECT_EQ(values[0].as_integer(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(values[1].as_integer(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(values[2].as_integer<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(values[2].as_hex_or_integer(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(values[3].as_integer<std::uint8_t>(1, 200), 1);
  EXPECT_EQ(values[4].as_integer<std::uint8_t>(1, 200), 200);
}

TEST(Value, HexadecimalNumbersAreReadInBothCases) {
  const Document document = in_array(R"("0xBE", "0Xbe", 190, "0xFFFFFFFFFFFFFFFF")");
  const auto values = document.root().as_array();
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(values[n].as_hex_or_integer<std::uint8_t>(), 0xBE);
  EXPECT_EQ(values[3].as_hex_or_integer(), std::numeric_limits<std::uint64_t>::max());
}

TEST(Value, ChoicesGiveTheirMeaning) {
  enum class Parity { none, even, odd };
  const Document document = in_array("\"even\"");
  EXPECT_EQ(document.root().as_array()[0].as_choice<Parity>(
                {{"none", Parity::none}, {"even", Parity::even}, {"odd", Parity::odd}}),
            Parity::even);
}

TEST(Value, QuantitiesAreExact) {
  const Document document = in_array(R"("25 ms", "0.1us", "13.33 us", "9223372.036854775807 s", "0 s", )"
                                     R"("500 kbit/s", "31.25 kbit/s", "0.0115 km", "12.7 cm")");
  const auto values = document.root().as_array();
  EXPECT_EQ(values[0].as_duration(), 25ms);
  EXPECT_EQ(values[1].as_duration(), 100ns);
  EXPECT_EQ(values[2].as_duration(), kernel::Duration{13'330'000});
  EXPECT_EQ(values[3].as_duration(), kernel::Duration::max());
  EXPECT_EQ(values[4].as_duration(), kernel::Duration::zero());
  EXPECT_EQ(values[5].as_bit_rate(), 500'000);
  EXPECT_EQ(values[6].as_bit_rate(), 31'250);
  EXPECT_EQ(values[7].as_length_m(), 11.5);
  EXPECT_EQ(values[8].as_length_m(), 0.127);
}

TEST(Value, NegativeDurationsNeedANegativeMinimum) {
  const Document document = in_array("\"-1.5 us\"");
  EXPECT_EQ(document.root().as_array()[0].as_duration(-1ms, 1ms), kernel::Duration{-1'500'000});
}

// What 64 bit do not hold is no long duration, but another one than was written.
TEST(Value, DurationsThatDoNotFitAreRefusedWithoutALimitToo) {
  const Document document =
      in_array(R"("9223372036854775807 ps", "9223372036854775808 ps", "99999999999 s")");
  const auto values = document.root().as_array();
  EXPECT_EQ(values[0].as_duration(), kernel::Duration::max());
  EXPECT_THROW(values[1].as_duration(), kernel::Error);
  EXPECT_THROW(values[2].as_duration(), kernel::Error);
}

TEST(Value, NothingNegativeIsNothingWithASign) {
  const Document document = in_array(R"("-0 us")");
  EXPECT_THROW(document.root().as_array()[0].as_duration(), kernel::Error);
  EXPECT_EQ(document.root().as_array()[0].as_duration(-1ms, 1ms), kernel::Duration::zero());
}

TEST(Value, KnowsItsPlaceAndPointer) {
  const Document document = Document::parse("{\"a/b\":\n {\"m~n\": [true,\n\t\"x\"]}}", "x.json");
  EXPECT_EQ(document.root().pointer(), "");
  const Value x = document.root().as_members()[0].value.as_members()[0].value.as_array()[1];
  EXPECT_EQ(x.pointer(), "/a~1b/m~0n/1");
  EXPECT_EQ(x.line(), 3U);
  EXPECT_EQ(x.column(), 2U);
}

TEST(Value, ASemanticErrorHasItsPlaceToo) {
  EXPECT_EQ(error_of("7", [](const Value& v) { fail(v, "the ring has no station 7; it has 0 to 5"); }),
            "x.json:6: /stations/3/x: the ring has no station 7; it has 0 to 5");
}

TEST(Value, AViolationIsThatOfTheNearestPlaceThatIsThere) {
  const Document document = Document::parse("{\"data\":\n [{\"to\": 4},\n {\"to\": 5}]}", "x.json");
  const auto error_at = [&](const char* at) {
    try {
      fail(document.root(), Violation{at, "no"});
    } catch (const kernel::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_at("/data/1/to"), "x.json:3: /data/1/to: no");
  EXPECT_EQ(error_at("/data/1/from"), "x.json:3: /data/1: no");
  EXPECT_EQ(error_at("/data/2/to"), "x.json:2: /data: no");
  EXPECT_EQ(error_at("/data/x"), "x.json:2: /data: no");
  EXPECT_EQ(error_at("/cable"), "x.json:1: the top level: no");
  EXPECT_EQ(error_at(""), "x.json:1: the top level: no");
}

TEST(Value, LongWordsAreCutAtACharacter) {
  std::string word = "\"";
  for (int n = 0; n < 100; ++n) word += "\xE2\x82\xAC";
  const std::string error = error_of(word + "\"", kind);
  EXPECT_NE(error.find("\xE2\x82\xAC...\" is not known"), std::string::npos) << error;
}

}  // namespace
}  // namespace fieldproof::config
