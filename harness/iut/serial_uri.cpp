#include <fmt/format.h>

#include <charconv>

#include "harness/iut/serial_line.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::iut {
namespace {

constexpr std::int64_t kLeastBaud = 50;
constexpr std::int64_t kMostBaud = 4'000'000;

[[noreturn]] void refuse_uri(const std::string& uri, const std::string& why) {
  throw kernel::Error(
      kernel::ErrorKind::usage,
      fmt::format("'{}' {}; write serial:/dev/ttyUSB0?baud=9600&format=8e1, and perhaps &latency=200us and "
                  "&upper=unix:PATH",
                  uri, why));
}

std::optional<std::int64_t> whole(std::string_view digits) {
  std::int64_t value = 0;
  const char* const last = digits.data() + digits.size();
  const auto [rest, failure] = std::from_chars(digits.data(), last, value);
  if (failure != std::errc{} || rest != last) return std::nullopt;
  return value;
}

void set_value(SerialSettings& settings, const std::string& uri, std::string_view name,
               std::string_view value) {
  constexpr std::string_view kMicroseconds = "us";
  if (name == "baud") {
    settings.bit_rate = whole(value);
    if (!settings.bit_rate || *settings.bit_rate < kLeastBaud || *settings.bit_rate > kMostBaud)
      refuse_uri(
          uri, fmt::format("names no bit rate: '{}' is not within {} and {}", value, kLeastBaud, kMostBaud));
  } else if (name == "format") {
    settings.format = character_format_of(value);
    if (!settings.format)
      refuse_uri(uri, fmt::format("names no character format: '{}' is not like 8e1", value));
  } else if (name == "latency") {
    const auto count = value.ends_with(kMicroseconds)
                           ? whole(value.substr(0, value.size() - kMicroseconds.size()))
                           : std::nullopt;
    if (!count || *count < 0 || *count > 1'000'000)
      refuse_uri(uri, fmt::format("names no latency: '{}' is not like 200us", value));
    settings.latency = *count * kernel::kMicrosecond;
  } else if (name == "echo") {
    if (value != "yes" && value != "no")
      refuse_uri(uri,
                 fmt::format("says echo={}; write echo=yes where the adapter receives its own echo", value));
    settings.receives_own_echo = value == "yes";
  } else {
    refuse_uri(uri, fmt::format("says '{}', which is nothing that a line has", name));
  }
}

}  // namespace

std::optional<line::CharacterFormat> character_format_of(std::string_view text) {
  constexpr std::string_view kParities = "neoms";  // in the order of line::Parity
  if (text.size() != 3 || text[0] < '5' || text[0] > '8' || (text[2] != '1' && text[2] != '2'))
    return std::nullopt;
  const std::size_t parity = kParities.find(text[1]);
  if (parity == std::string_view::npos) return std::nullopt;
  line::CharacterFormat format;
  format.data_bits = static_cast<unsigned>(text[0] - '0');
  format.parity = static_cast<line::Parity>(parity);
  format.stop_bits = text[2] == '1' ? line::StopBits::one : line::StopBits::two;
  return format;
}

SerialSettings serial_settings(const std::string& uri) {
  constexpr std::string_view kUpper = "upper=";
  SerialSettings settings;
  if (!uri.starts_with(kSerialUri)) refuse_uri(uri, "is no serial line");
  const std::size_t question = uri.find('?');
  settings.path = uri.substr(kSerialUri.size(), question - kSerialUri.size());
  if (settings.path.empty()) refuse_uri(uri, "names no device");
  std::string_view rest =
      question == std::string::npos ? std::string_view{} : std::string_view(uri).substr(question + 1);
  while (!rest.empty()) {
    if (rest.starts_with(kUpper)) {  // has '&' and '?' of its own
      settings.upper = rest.substr(kUpper.size());
      break;
    }
    const std::string_view one = rest.substr(0, rest.find('&'));
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos) refuse_uri(uri, fmt::format("says '{}' without a value", one));
    set_value(settings, uri, one.substr(0, equals), one.substr(equals + 1));
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
  }
  return settings;
}

}  // namespace fieldproof::iut
