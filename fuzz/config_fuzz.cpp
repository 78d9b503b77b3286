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

void read_scalar(const Value& value) {
  static constexpr std::string_view kChoices[] = {"remote", "local", "bus_coupler"};
  attempt([&] { (void)value.as_string(); });
  attempt([&] { (void)value.as_bool(); });
  attempt([&] { (void)value.as_integer<std::int16_t>(-5, 300); });
  attempt([&] { (void)value.as_integer<std::uint64_t>(); });
  attempt([&] { (void)value.as_number(-1.0, 1e6); });
  attempt([&] { (void)value.as_hex_or_integer<std::uint16_t>(); });
  attempt([&] { (void)value.as_choice(kChoices); });
  attempt([&] { (void)value.as_duration(); });
  attempt([&] { (void)value.as_bit_rate(); });
  attempt([&] { (void)value.as_length_m(); });
}

// At most `budget` values, so that one input stays cheap.
void walk(const Value& value, std::size_t& budget) {
  if (budget == 0) return;
  --budget;
  FIELDPROOF_CHECK(value.line() >= 1 && value.column() >= 1, "a value has a place");
  read_scalar(value);
  attempt([&] {
    read_object(value, [](ObjectReader& o) {
      (void)o.optional("stations");
      (void)o.required("name");
    });
  });
  if (value.is_array()) {
    for (const Value& element : value.as_array()) walk(element, budget);
  }
  if (value.is_object()) {
    for (const auto& [key, member] : value.as_members()) walk(member, budget);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  attempt([&] {
    const Document document =
        Document::parse(std::string(reinterpret_cast<const char*>(data), size), std::string(kName));
    std::size_t budget = 200;
    walk(document.root(), budget);
  });
  return 0;
}
