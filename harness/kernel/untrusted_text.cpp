#include "harness/kernel/untrusted_text.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "harness/kernel/check.hpp"

namespace fieldproof::kernel {
namespace {

struct Lead {
  std::size_t length;
  char32_t bits;
  char32_t smallest;  // a smaller code point was not written in its shortest form
};

std::optional<Lead> lead_of(unsigned char octet) {
  if (octet < 0x80) return Lead{1, octet, 0};
  if ((octet & 0xE0U) == 0xC0) return Lead{2, octet & 0x1FU, 0x80};
  if ((octet & 0xF0U) == 0xE0) return Lead{3, octet & 0x0FU, 0x800};
  if ((octet & 0xF8U) == 0xF0) return Lead{4, octet & 0x07U, 0x10000};
  return std::nullopt;
}

// Code points that change how a terminal shows what stands around them.
bool is_unseen(char32_t point) {
  return point < 0x20 || (point >= 0x7F && point < 0xA0) || (point >= 0x200B && point <= 0x200F) ||
         (point >= 0x2028 && point <= 0x202E) || (point >= 0x2060 && point <= 0x206F) || point == 0x061C ||
         point == 0xFEFF;
}

bool is_scalar_value(char32_t point) {
  return point <= 0x10FFFF && (point < 0xD800 || point > 0xDFFF);
}

}  // namespace

std::optional<char32_t> take_code_point(std::string_view& rest) {
  FIELDPROOF_CHECK(!rest.empty(), "a code point is taken off a text that has one");
  const std::string_view text = rest;
  rest.remove_prefix(1);
  const std::optional<Lead> lead = lead_of(static_cast<unsigned char>(text.front()));
  if (!lead || text.size() < lead->length) return std::nullopt;
  char32_t point = lead->bits;
  for (const char c : text.substr(1, lead->length - 1)) {
    const auto octet = static_cast<unsigned char>(c);
    if ((octet & 0xC0U) != 0x80) return std::nullopt;
    point = (point << 6U) | (octet & 0x3FU);
  }
  if (point < lead->smallest || !is_scalar_value(point)) return std::nullopt;
  rest = text.substr(lead->length);
  return point;
}

std::string escaped_octet(char octet) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  const auto value = static_cast<unsigned char>(octet);
  return {'\\', 'x', kDigits[value >> 4U], kDigits[value & 0x0FU]};
}

std::string as_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::string_view before = text;
    if (take_code_point(text)) {
      valid += before.substr(0, before.size() - text.size());
    } else {
      valid += escaped_octet(before.front());
    }
  }
  return valid;
}

std::string escaped_line(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::string_view before = text;
    const auto point = take_code_point(text);
    const std::string_view octets = before.substr(0, before.size() - text.size());
    if (point && !is_unseen(*point)) {
      out += octets;
    } else if (!point || *point < 0x80) {
      out += escaped_octet(octets.front());
    } else {
      out += fmt::format("\\u{{{:04X}}}", static_cast<std::uint32_t>(*point));
    }
  }
  return out;
}

}  // namespace fieldproof::kernel
