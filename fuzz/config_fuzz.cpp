// The configuration reader fed with arbitrary octets. Invariants: every text is either read or refused with
// kernel::Error(configuration); what is read can be walked, every value knows its place, and every typed
// reader answers or refuses with the place of the value. Nothing else may leave the reader.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "harness/config/document.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace {

using fieldproof::config::Document;
using fieldproof::config::ObjectReader;
using fieldproof::config::Value;
using fieldproof::kernel::Error;
using fieldproof::kernel::ErrorKind;

constexpr std::string_view kName = "fuzz.json";

void check(const Error& error) {
  FIELDPROOF_CHECK(error.kind() == ErrorKind::configuration, "a bad file is a configuration error");
  FIELDPROOF_CHECK(std::string_view(error.what()).starts_with(std::string(kName) + ":"),
                   "an error of a file begins with its name");
}

template <typename Read>
void attempt(Read read) {
  try {
    read();
  } catch (const Error& error) {
    check(error);
  }
}

// One typed reader for each value, in turn: refusals are exceptions, and ten for each value would leave the
// fuzzer little time for texts.
void read_typed(const Value& value, std::size_t turn) {
  static constexpr std::string_view kChoices[] = {"remote", "local", "bus_coupler"};
  switch (turn % 10) {
    case 0:
      return (void)value.as_string();
    case 1:
      return (void)value.as_bool();
    case 2:
      return (void)value.as_integer<std::int16_t>(-5, 300);
    case 3:
      return (void)value.as_integer<std::uint64_t>();
    case 4:
      return (void)value.as_number(-1.0, 1e6);
    case 5:
      return (void)value.as_hex_or_integer<std::uint16_t>();
    case 6:
      return (void)value.as_choice(kChoices);
    case 7:
      return (void)value.as_duration();
    case 8:
      return (void)value.as_bit_rate();
    default:
      return (void)value.as_length_m();
  }
}

// At most `budget` values, so that one input stays cheap.
void walk(const Value& value, std::size_t& budget) {
  if (budget == 0) return;
  --budget;
  FIELDPROOF_CHECK(value.line() >= 1 && value.column() >= 1, "a value has a place");
  attempt([&] { read_typed(value, budget); });
  if (value.is_array()) {
    for (const Value& element : value.as_array()) walk(element, budget);
  }
  if (value.is_object()) {
    attempt([&] {
      read_object(value, [](ObjectReader& o) {
        (void)o.optional("stations");
        (void)o.required("name");
      });
    });
    for (const auto& [key, member] : value.as_members()) walk(member, budget);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  attempt([&] {
    const Document document =
        Document::parse(std::string(reinterpret_cast<const char*>(data), size), std::string(kName));
    std::size_t budget = 40;
    walk(document.root(), budget);
  });
  return 0;
}
