#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/dlpdu_layout.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr unsigned kTypeBits = 0xF0;
constexpr unsigned kReservedBit = 0x08;
constexpr std::size_t kHeader = 3;  // type, destination, source

// How the types differ in their first octet and in what follows the addresses.
struct Shape {
  IsaType type;
  std::string_view name;
  std::uint8_t IsaCodes::* code;
  bool has_priority;
  bool may_be_final;
  bool is_always_final;
  std::size_t fields;  // octets behind the addresses, besides data
  bool has_data;
};

constexpr std::array kShapes{
    Shape{IsaType::cd, "CD", &IsaCodes::cd, true, false, false, 0, false},
    Shape{IsaType::dt, "DT", &IsaCodes::dt, true, true, false, 0, true},
    Shape{IsaType::du, "DU", &IsaCodes::du, true, true, false, 0, true},
    Shape{IsaType::et, "ET", &IsaCodes::et, true, false, false, 0, false},
    Shape{IsaType::es, "ES", &IsaCodes::es, true, false, false, 2, false},
    Shape{IsaType::ee, "EE", &IsaCodes::ee, false, true, true, 1, false},
    Shape{IsaType::tl, "TL", &IsaCodes::tl, false, false, false, 2, false},
};

const Shape& shape_of(IsaType type) {
  return kShapes[static_cast<std::size_t>(type)];
}

const Shape* shape_of_code(unsigned code, const IsaCodes& codes) {
  for (const Shape& shape : kShapes) {
    if (codes.*shape.code == code) return &shape;
  }
  return nullptr;
}

bool is_individual(std::uint8_t address, const IsaRules& rules) {
  return address >= rules.first_address && address <= rules.last_address;
}

bool is_control_right(unsigned control, const Shape& shape) {
  const bool is_final = (control & kFinalBit) != 0;
  return (control & kReservedBit) == 0 && ((control & kPriorityBits) != 0) == shape.has_priority &&
         (!is_final || shape.may_be_final) && (is_final || !shape.is_always_final);
}

bool are_addresses_right(const IsaDlpdu& dlpdu, const IsaRules& rules) {
  const bool is_to_all = dlpdu.type == IsaType::du && dlpdu.destination == rules.everybody;
  return (is_to_all || is_individual(dlpdu.destination, rules)) && is_individual(dlpdu.source, rules);
}

std::uint16_t word_of(std::span<const std::uint8_t> octets) {
  return static_cast<std::uint16_t>(octets[0] << 8 | octets[1]);
}

void append_word(Octets& octets, std::uint16_t word) {
  octets.push_back(static_cast<std::uint8_t>(word >> 8));
  octets.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

// False: the fields after the addresses do not exist so.
bool read_fields(std::span<const std::uint8_t> octets, IsaDlpdu& dlpdu) {
  switch (dlpdu.type) {
    case IsaType::es:
      dlpdu.duration = word_of(octets);
      return dlpdu.duration != 0;
    case IsaType::ee:
      dlpdu.reason = static_cast<EndReason>(octets[0]);
      return octets[0] <= static_cast<std::uint8_t>(EndReason::single_frame_done);
    case IsaType::tl:
      dlpdu.schedule_version = word_of(octets);
      return true;
    default:
      return true;
  }
}

void append_fields(Octets& octets, const IsaDlpdu& dlpdu) {
  if (dlpdu.type == IsaType::es) append_word(octets, dlpdu.duration);
  if (dlpdu.type == IsaType::ee) octets.push_back(static_cast<std::uint8_t>(dlpdu.reason));
  if (dlpdu.type == IsaType::tl) append_word(octets, dlpdu.schedule_version);
}

std::string_view reason_text(EndReason reason) {
  switch (reason) {
    case EndReason::nothing_to_send:
      return "nothing to send";
    case EndReason::no_time:
      return "no time";
    case EndReason::single_frame_done:
      return "single frame done";
  }
  return "";
}

std::string_view layout_of_fields(IsaType type) {
  switch (type) {
    case IsaType::es:
      return ", duration in octets, not 0 (2)";
    case IsaType::ee:
      return ", reason (1): 0 nothing to send, 1 no time, 2 single frame done";
    case IsaType::tl:
      return ", version of the schedule (2)";
    default:
      return "";
  }
}

}  // namespace

std::string layout_text(IsaType type, const IsaCodes& codes) {
  const Shape& shape = shape_of(type);
  unsigned free_bits = shape.has_priority ? kPriorityBits : 0U;
  if (shape.may_be_final && !shape.is_always_final) free_bits |= kFinalBit;
  const unsigned code = codes.*shape.code | (shape.is_always_final ? kFinalBit : 0U);
  return fmt::format("{}, destination (1), source (1){}{}", first_octet_text(code, free_bits),
                     layout_of_fields(type), shape.has_data ? ", DLSDU" : "");
}

std::optional<IsaDlpdu> isa_dlpdu_of(std::span<const std::uint8_t> octets, const IsaRules& rules) {
  if (octets.size() < kHeader) return std::nullopt;
  const unsigned control = octets[0];
  const Shape* const shape = shape_of_code(control & kTypeBits, rules.codes);
  if (shape == nullptr || !is_control_right(control, *shape)) return std::nullopt;
  IsaDlpdu dlpdu;
  dlpdu.type = shape->type;
  if (shape->has_priority) dlpdu.priority = static_cast<Priority>(control & kPriorityBits);
  dlpdu.is_final = !shape->is_always_final && (control & kFinalBit) != 0;
  dlpdu.destination = octets[1];
  dlpdu.source = octets[2];
  if (!are_addresses_right(dlpdu, rules)) return std::nullopt;
  const std::span<const std::uint8_t> rest = octets.subspan(kHeader);
  if (shape->has_data) {
    if (rest.size() > most_data(rules.link, dlpdu.priority)) return std::nullopt;
    dlpdu.data.assign(rest.begin(), rest.end());
    return dlpdu;
  }
  if (rest.size() != shape->fields || !read_fields(rest, dlpdu)) return std::nullopt;
  return dlpdu;
}

Octets octets_of(const IsaDlpdu& dlpdu, const IsaRules& rules) {
  const Shape& shape = shape_of(dlpdu.type);
  unsigned control = rules.codes.*shape.code;
  if (shape.has_priority) control |= static_cast<unsigned>(dlpdu.priority);
  if (shape.is_always_final || (shape.may_be_final && dlpdu.is_final)) control |= kFinalBit;
  Octets octets{static_cast<std::uint8_t>(control), dlpdu.destination, dlpdu.source};
  append_fields(octets, dlpdu);
  if (shape.has_data) octets.insert(octets.end(), dlpdu.data.begin(), dlpdu.data.end());
  return octets;
}

std::size_t octets_on_line(IsaType type, std::size_t data) {
  const Shape& shape = shape_of(type);
  FIELDPROOF_CHECK(data == 0 || shape.has_data, "only DT and DU carry data");
  return kHeader + shape.fields + data + kCheckOctets;
}

bool is_of_scheduler(IsaType type) {
  return type == IsaType::et || type == IsaType::es || type == IsaType::tl;
}

std::string describe(const IsaDlpdu& dlpdu) {
  const Shape& shape = shape_of(dlpdu.type);
  std::string text(shape.name);
  if (shape.has_priority) text += fmt::format(" {}", text_of(dlpdu.priority));
  text += fmt::format(" {:02X} -> {:02X}", dlpdu.source, dlpdu.destination);
  if (dlpdu.is_final) text += " final";
  if (dlpdu.type == IsaType::es) text += fmt::format(" for {} octets", dlpdu.duration);
  if (dlpdu.type == IsaType::ee) text += fmt::format(", {}", reason_text(dlpdu.reason));
  if (dlpdu.type == IsaType::tl) text += fmt::format(", schedule {}", dlpdu.schedule_version);
  if (shape.has_data && !dlpdu.data.empty()) text += fmt::format(": {:02X}", fmt::join(dlpdu.data, " "));
  return text;
}

std::string words_of(std::span<const std::uint8_t> octets, const IsaRules& rules) {
  const auto dlpdu = isa_dlpdu_of(octets, rules);
  return dlpdu ? describe(*dlpdu) : no_dlpdu_text(octets);
}

}  // namespace fieldproof::fieldbus_dll
