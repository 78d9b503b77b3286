#include "protocols/token_bus/frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "harness/kernel/check.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr unsigned kDataBits = 0x40;        // 01 MMM PPP
constexpr unsigned kManagementBits = 0x80;  // 10 MMM PPP

struct ControlCode {
  FrameKind kind;
  std::uint8_t code;
  bool has_address;  // the data unit is one
};
// claim_token carries what its contest needs.
constexpr std::array kControlCodes{ControlCode{FrameKind::claim_token, 0x00, false},
                                   ControlCode{FrameKind::solicit_successor_1, 0x01, false},
                                   ControlCode{FrameKind::solicit_successor_2, 0x02, false},
                                   ControlCode{FrameKind::who_follows, 0x03, true},
                                   ControlCode{FrameKind::resolve_contention, 0x04, false},
                                   ControlCode{FrameKind::token, 0x08, false},
                                   ControlCode{FrameKind::set_successor, 0x0C, true}};

std::uint8_t reversed(std::uint8_t octet) {
  return static_cast<std::uint8_t>(line::reflect(octet, 8));
}

bool is_data_kind(FrameKind kind) {
  return kind == FrameKind::data || kind == FrameKind::management_data;
}

const line::FrameCheck& shared_check() {
  static const line::FrameCheck check(line::frame_check_named("CRC-32/ISO-HDLC"));
  return check;
}

// Kind, action and priority; nothing of a code that is none.
std::optional<Frame> frame_of_code(unsigned code) {
  if ((code & 0xC0U) == kDataBits || (code & 0xC0U) == kManagementBits) {
    const unsigned action = code >> 3 & 7U;
    if (action > static_cast<unsigned>(Action::response)) return std::nullopt;
    return Frame{.kind = (code & kDataBits) != 0 ? FrameKind::data : FrameKind::management_data,
                 .action = static_cast<Action>(action),
                 .priority = code & 7U};
  }
  for (const ControlCode& control : kControlCodes) {
    if (control.code == code) return Frame{.kind = control.kind};
  }
  return std::nullopt;
}

bool has_its_data(const Frame& frame, const Rules& rules) {
  if (is_data_kind(frame.kind) || frame.kind == FrameKind::claim_token) return true;
  for (const ControlCode& control : kControlCodes) {
    if (control.kind == frame.kind) {
      return frame.data.size() == (control.has_address ? address_octets(rules) : 0U);
    }
  }
  return false;
}

}  // namespace

Address broadcast(const Rules& rules) {
  return (Address{1} << 8 * address_octets(rules)) - 1;
}

std::string text_of(Address address, const Rules& rules) {
  return fmt::format("{:0{}X}", address, 2 * address_octets(rules));
}

Octets octets_of(Address address, const Rules& rules) {
  Octets octets(address_octets(rules));
  for (std::size_t n = 0; n < octets.size(); ++n) octets[n] = static_cast<std::uint8_t>(address >> 8 * n);
  return octets;
}

Address address_of(std::span<const std::uint8_t> octets) {
  Address address = 0;
  for (std::size_t n = 0; n < octets.size(); ++n) address |= Address{octets[n]} << 8 * n;
  return address;
}

std::string_view text_of(FrameKind kind) {
  switch (kind) {
    case FrameKind::claim_token:
      return "claim_token";
    case FrameKind::solicit_successor_1:
      return "solicit_successor_1";
    case FrameKind::solicit_successor_2:
      return "solicit_successor_2";
    case FrameKind::who_follows:
      return "who_follows";
    case FrameKind::resolve_contention:
      return "resolve_contention";
    case FrameKind::token:
      return "token";
    case FrameKind::set_successor:
      return "set_successor";
    case FrameKind::data:
      return "data";
    case FrameKind::management_data:
      return "management data";
  }
  return "";
}

std::string_view text_of(Action action) {
  switch (action) {
    case Action::request_with_no_response:
      return "request with no response";
    case Action::request_with_response:
      return "request with response";
    case Action::response:
      return "response";
  }
  return "";
}

std::string_view text_of(ReceptionKind kind) {
  switch (kind) {
    case ReceptionKind::frame:
      return "frame";
    case ReceptionKind::non_silence:
      return "non-silence";
    case ReceptionKind::fragment:
      return "frame fragment";
    case ReceptionKind::fcs_error:
      return "FCS error";
    case ReceptionKind::e_bit_error:
      return "E bit error";
    case ReceptionKind::too_long:
      return "frame too long";
  }
  return "";
}

std::uint8_t control_octet(const Frame& frame) {
  if (is_data_kind(frame.kind)) {
    const unsigned upper = frame.kind == FrameKind::data ? kDataBits : kManagementBits;
    const unsigned code = upper | static_cast<unsigned>(frame.action) << 3 | (frame.priority & 7U);
    return reversed(static_cast<std::uint8_t>(code));
  }
  for (const ControlCode& control : kControlCodes) {
    if (control.kind == frame.kind) return reversed(control.code);
  }
  FIELDPROOF_CHECK(false, "each kind of frame has its code");
  return 0;
}

std::uint8_t code_of(std::uint8_t control) {
  return reversed(control);
}

Octets octets_of(const Frame& frame, const Rules& rules) {
  Octets octets{control_octet(frame)};
  for (const Address address : {frame.destination, frame.source}) {
    const Octets its = octets_of(address, rules);
    octets.insert(octets.end(), its.begin(), its.end());
  }
  octets.insert(octets.end(), frame.data.begin(), frame.data.end());
  return octets;
}

std::optional<Frame> frame_of(std::span<const std::uint8_t> octets, const Rules& rules) {
  const std::size_t width = address_octets(rules);
  if (octets.size() < 1 + 2 * width) return std::nullopt;
  auto frame = frame_of_code(code_of(octets[0]));
  if (!frame) return std::nullopt;
  frame->destination = address_of(octets.subspan(1, width));
  frame->source = address_of(octets.subspan(1 + width, width));
  const auto data = octets.subspan(1 + 2 * width);
  frame->data.assign(data.begin(), data.end());
  if (is_group(frame->source) || !has_its_data(*frame, rules)) return std::nullopt;
  return frame;
}

std::string describe(const Frame& frame, const Rules& rules) {
  std::string text{text_of(frame.kind)};
  if (is_data_kind(frame.kind))
    text += fmt::format(", {}, priority {}", text_of(frame.action), frame.priority);
  text += fmt::format(", {} -> {}", text_of(frame.source, rules), text_of(frame.destination, rules));
  if (frame.kind == FrameKind::claim_token) {
    text += fmt::format(", {} octets", frame.data.size());
  } else if (frame.kind == FrameKind::set_successor || frame.kind == FrameKind::who_follows) {
    text += ": " + text_of(address_of(frame.data), rules);
  } else if (!frame.data.empty()) {
    text += fmt::format(": {:02X}", fmt::join(frame.data, " "));
  }
  return text;
}

// ---- the check ----

Octets with_check(std::span<const std::uint8_t> octets) {
  Octets all(octets.begin(), octets.end());
  shared_check().append_check(all);
  return all;
}

bool has_right_check(std::span<const std::uint8_t> octets) {
  return shared_check().is_code_word(octets);
}

// ---- between delimiters ----

void append_framed(MacSymbols& symbols, std::span<const std::uint8_t> octets, const Delimiting& delimiting) {
  symbols.insert(symbols.end(), 8 * std::size_t{delimiting.preamble_octets}, MacSymbol::pad_idle);
  const MacSymbols start = start_delimiter();
  symbols.insert(symbols.end(), start.begin(), start.end());
  for (const std::uint8_t octet : octets) append_octet(symbols, octet);
  const MacSymbols end = end_delimiter(delimiting.more_follows, delimiting.has_error);
  symbols.insert(symbols.end(), end.begin(), end.end());
}

line::Levels levels_of(const Frame& frame, const Rules& rules) {
  MacSymbols symbols;
  append_framed(symbols, with_check(octets_of(frame, rules)), {.preamble_octets = rules.preamble_octets});
  return half_bits_of(symbols);
}

}  // namespace fieldproof::token_bus
